-- Averages of the last complete stage, as tables.
--
-- Serves: readers, who never see the average of a half-computed study: `solve` and `simulate` renew these tables in the
-- transaction that completes them; and nights, which compute again only the months that have changed.
-- Cost: a row for each design, window and month; a second on a year of a database of the version before.

DROP VIEW limit_share;
DROP VIEW annual_average;
DROP VIEW monthly_average;
DROP VIEW simulation_annual;
DROP VIEW simulation_class;

-- Means over the solved samples of a month: all samples of a month weigh alike.
CREATE TABLE monthly_average (
    design              TEXT NOT NULL,
    pmv_limit           REAL NOT NULL,
    pmv_min             REAL NOT NULL,
    pmv_max             REAL NOT NULL,
    month               INTEGER NOT NULL,  -- local, 1 … 12
    hvac_power_w        REAL,              -- null while nothing is solved
    heating_power_w     REAL,
    cooling_power_w     REAL,
    sample_count        INTEGER NOT NULL,
    unsolved_count      INTEGER NOT NULL,
    lower_count         INTEGER NOT NULL,  -- solved samples at the lower limit of comfort
    upper_count         INTEGER NOT NULL,
    heating_count       INTEGER NOT NULL,  -- solved samples in which the air unit heats
    cooling_count       INTEGER NOT NULL,
    outside_range_count INTEGER NOT NULL,  -- solved samples outside the range of use of ISO 7730
    run_id              INTEGER NOT NULL,  -- the run that completed it
    PRIMARY KEY (design, pmv_min, pmv_max, month)
) STRICT, WITHOUT ROWID;

-- The annual means: every month by its days, within a month the solved samples alike.
CREATE TABLE annual_average (
    design           TEXT NOT NULL,
    pmv_limit        REAL NOT NULL,
    pmv_min          REAL NOT NULL,
    pmv_max          REAL NOT NULL,
    hvac_power_w     REAL,
    heating_power_w  REAL,
    cooling_power_w  REAL,
    sample_count     INTEGER NOT NULL,
    unsolved_count   INTEGER NOT NULL,
    unsolved_weight  REAL NOT NULL,
    reduction_vs_ptc REAL,                 -- fraction; null without a design ptc
    run_id           INTEGER NOT NULL,
    PRIMARY KEY (design, pmv_min, pmv_max)
) STRICT, WITHOUT ROWID;

-- Annual means of simulated and of steady-state power: months by their days, within a month every second alike.
CREATE TABLE simulation_annual (
    design                   TEXT NOT NULL,
    pmv_limit                REAL NOT NULL,
    pmv_min                  REAL NOT NULL,
    pmv_max                  REAL NOT NULL,
    controller               TEXT NOT NULL,
    mean_hvac_power_w        REAL NOT NULL,
    static_mean_hvac_power_w REAL NOT NULL,
    saturated_fraction       REAL NOT NULL,
    mission_count            INTEGER NOT NULL,
    run_id                   INTEGER NOT NULL,
    PRIMARY KEY (design, pmv_min, pmv_max, controller)
) STRICT, WITHOUT ROWID;

-- Simulated missions by month, by ambient temperature and by length, driven as in the paper: means over all their seconds.
CREATE TABLE simulation_class (
    design                   TEXT NOT NULL,
    pmv_limit                REAL NOT NULL,
    pmv_min                  REAL NOT NULL,
    pmv_max                  REAL NOT NULL,
    sorted_by                TEXT NOT NULL,
    class                    TEXT NOT NULL,
    class_order              INTEGER NOT NULL,
    mission_count            INTEGER NOT NULL,
    mean_hvac_power_w        REAL NOT NULL,
    static_mean_hvac_power_w REAL NOT NULL,
    warm_start_power_w       REAL NOT NULL,
    mean_max_abs_pmv_15min   REAL,
    saturated_fraction       REAL NOT NULL,
    run_id                   INTEGER NOT NULL,
    PRIMARY KEY (design, pmv_min, pmv_max, class_order)
) STRICT, WITHOUT ROWID;

-- In how many samples the limits of comfort bind, and what the air unit does.
CREATE VIEW limit_share AS
WITH month_days (month, days) AS (
    VALUES (1, 31), (2, 28), (3, 31), (4, 30), (5, 31), (6, 30), (7, 31), (8, 31), (9, 30), (10, 31), (11, 30), (12, 31)
)
SELECT
    design,
    pmv_limit,
    pmv_min,
    pmv_max,
    sum(sample_count - unsolved_count) AS solved_count,
    sum(lower_count) AS lower_count,
    sum(upper_count) AS upper_count,
    sum(heating_count) AS heating_count,
    sum(cooling_count) AS cooling_count,
    sum(lower_count * CAST(days AS REAL) / sample_count)
        / sum((sample_count - unsolved_count) * CAST(days AS REAL) / sample_count) AS lower_weight,
    sum(cooling_count * CAST(days AS REAL) / sample_count)
        / sum((sample_count - unsolved_count) * CAST(days AS REAL) / sample_count) AS cooling_weight,
    sum(outside_range_count) AS outside_range_count
FROM monthly_average JOIN month_days USING (month)
GROUP BY design, pmv_min, pmv_max
HAVING sum(sample_count - unsolved_count) > 0;

-- Months whose averages are older than their samples, designs or windows.
CREATE TABLE stale_month (month INTEGER PRIMARY KEY) STRICT;
CREATE TRIGGER sample_put AFTER INSERT ON hourly_sample
BEGIN INSERT OR IGNORE INTO stale_month VALUES (NEW.month); END;
CREATE TRIGGER sample_gone AFTER DELETE ON hourly_sample
BEGIN INSERT OR IGNORE INTO stale_month VALUES (OLD.month); END;
CREATE TRIGGER design_put AFTER INSERT ON hvac_design
BEGIN INSERT OR IGNORE INTO stale_month VALUES (1), (2), (3), (4), (5), (6), (7), (8), (9), (10), (11), (12); END;
CREATE TRIGGER design_gone AFTER DELETE ON hvac_design
BEGIN INSERT OR IGNORE INTO stale_month VALUES (1), (2), (3), (4), (5), (6), (7), (8), (9), (10), (11), (12); END;
CREATE TRIGGER window_put AFTER INSERT ON comfort_window
BEGIN INSERT OR IGNORE INTO stale_month VALUES (1), (2), (3), (4), (5), (6), (7), (8), (9), (10), (11), (12); END;
CREATE TRIGGER window_gone AFTER DELETE ON comfort_window
BEGIN INSERT OR IGNORE INTO stale_month VALUES (1), (2), (3), (4), (5), (6), (7), (8), (9), (10), (11), (12); END;

-- The next runs of `solve` and `simulate` fill the tables.
INSERT INTO stale_month VALUES (1), (2), (3), (4), (5), (6), (7), (8), (9), (10), (11), (12);
DELETE FROM stage_record;
