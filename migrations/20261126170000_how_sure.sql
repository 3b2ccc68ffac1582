-- How sure annual figures are: intervals from the days of the year, and the year without a part of it.
--
-- Serves: whoever prints a number and has to say how many of its digits stand; whoever asks whether one route or one winter
-- carries a finding.
-- Cost: 48 bytes for each design, window, month and day of missions, some 3 MB on a year with five designs and seventeen
-- windows; 60 bytes a row of intervals. Only months that have changed are added up again.

-- The days on which the missions of a month begin, and the sums of their samples.
CREATE TABLE day_month (
    month INTEGER PRIMARY KEY,
    days  TEXT NOT NULL  -- JSON: local dates
) STRICT;
CREATE TABLE day_sum (
    month     INTEGER NOT NULL,
    design_id INTEGER NOT NULL REFERENCES hvac_design ON DELETE CASCADE,
    window_id INTEGER NOT NULL REFERENCES comfort_window ON DELETE CASCADE,
    sums      BLOB NOT NULL,  -- for each day of the month six f64, little endian: samples, power, its square, power in heating,
                              -- energy of samples with a distance, distance
    PRIMARY KEY (month, design_id, window_id)
) STRICT, WITHOUT ROWID;

-- Intervals of 90 % of the annual means. Null where a month has a single day.
CREATE TABLE annual_interval (
    design                 TEXT NOT NULL,
    pmv_limit              REAL NOT NULL,
    pmv_min                REAL NOT NULL,
    pmv_max                REAL NOT NULL,
    hvac_power_w           REAL,              -- that of annual_average
    hvac_power_low_w       REAL,
    hvac_power_high_w      REAL,
    heating_power_low_w    REAL,
    heating_power_high_w   REAL,
    cooling_power_low_w    REAL,
    cooling_power_high_w   REAL,
    kwh_per_km_low         REAL,
    kwh_per_km_high        REAL,
    reduction_vs_ptc_low   REAL,
    reduction_vs_ptc_high  REAL,
    day_count              INTEGER NOT NULL,  -- days on which a mission begins
    single_day_month_count INTEGER NOT NULL,  -- months with one of them only
    run_id                 INTEGER NOT NULL,
    PRIMARY KEY (design, pmv_min, pmv_max)
) STRICT, WITHOUT ROWID;

-- What a design saves against another one in the same hours, with intervals of 90 % from years drawn for both together.
CREATE TABLE design_interval (
    design                  TEXT NOT NULL,
    other_design            TEXT NOT NULL,
    pmv_limit               REAL NOT NULL,
    pmv_min                 REAL NOT NULL,
    pmv_max                 REAL NOT NULL,
    other_takes_more_w      REAL,
    other_takes_more_low_w  REAL,
    other_takes_more_high_w REAL,
    saving                  REAL,             -- of the other design's power
    saving_low              REAL,
    saving_high             REAL,
    run_id                  INTEGER NOT NULL,
    PRIMARY KEY (design, other_design, pmv_min, pmv_max)
) STRICT, WITHOUT ROWID;

-- How sure the mean power of a month is.
CREATE TABLE month_spread (
    design                 TEXT NOT NULL,
    pmv_limit              REAL NOT NULL,
    pmv_min                REAL NOT NULL,
    pmv_max                REAL NOT NULL,
    month                  INTEGER NOT NULL,
    sample_count           INTEGER NOT NULL,  -- solved
    day_count              INTEGER NOT NULL,
    standard_error_w       REAL,              -- of the mean, days being drawn
    effective_sample_count REAL,              -- independent samples that would have the same error
    run_id                 INTEGER NOT NULL,
    PRIMARY KEY (design, pmv_min, pmv_max, month)
) STRICT, WITHOUT ROWID;

-- The year without one route, one year or one month; weights are spread over the months that remain.
CREATE TABLE left_out (
    design           TEXT NOT NULL,
    pmv_limit        REAL NOT NULL,
    pmv_min          REAL NOT NULL,
    pmv_max          REAL NOT NULL,
    kind             TEXT NOT NULL CHECK (kind IN ('route', 'year', 'month')),
    name             TEXT NOT NULL,
    sample_count     INTEGER NOT NULL,
    month_count      INTEGER NOT NULL,
    hvac_power_w     REAL NOT NULL,
    relative_change  REAL NOT NULL,
    reduction_vs_ptc REAL,
    run_id           INTEGER NOT NULL,
    PRIMARY KEY (design, pmv_min, pmv_max, kind, name)
) STRICT, WITHOUT ROWID;

-- Days were not added up before.
INSERT OR IGNORE INTO stale_month VALUES (1), (2), (3), (4), (5), (6), (7), (8), (9), (10), (11), (12);
DELETE FROM stage_record WHERE stage = 'solve';
