-- The experiment database: input files, hourly samples, designs, comfort windows, optima, runs.
--
-- Serves: a run that adds only what is missing (keys of content in source_file, hourly_sample and hvac_design), and
-- analysts, who read the views at the end and need nothing else. Temperatures are kept in kelvin and shown in Celsius.
-- Cost: about 120 bytes an optimum.

-- One row per input file, refused ones included.
CREATE TABLE source_file (
    source_file_id INTEGER PRIMARY KEY,
    path           TEXT NOT NULL UNIQUE,  -- as the study names it
    kind           TEXT NOT NULL,         -- mission, weather, shadow
    blake3         TEXT NOT NULL,         -- of the content, hexadecimal
    bytes          INTEGER NOT NULL,
    rows           INTEGER NOT NULL,      -- data rows, without the header
    first_utc      TEXT,                  -- RFC 3339
    last_utc       TEXT,
    outcome        TEXT NOT NULL CHECK (outcome IN ('accepted', 'refused')),
    reading_key    TEXT NOT NULL          -- BLAKE3 of the content and of the settings that it was read with
) STRICT;

-- What was noticed in an input file: refused rows, gaps, duplicates, impossible values.
CREATE TABLE data_quality (
    source_file_id INTEGER NOT NULL REFERENCES source_file ON DELETE CASCADE,
    position       INTEGER NOT NULL,      -- order within the file's record
    kind           TEXT NOT NULL,
    count          INTEGER NOT NULL,
    line           INTEGER,               -- first line concerned, the header is line 1
    column_name    TEXT,
    message        TEXT NOT NULL,         -- what it is and what to do
    PRIMARY KEY (source_file_id, position)
) STRICT, WITHOUT ROWID;

-- What a mission file says of each of its segments, kept so that an unchanged file need not be read again.
CREATE TABLE mission_segment (
    source_file_id     INTEGER NOT NULL REFERENCES source_file ON DELETE CASCADE,
    segment            INTEGER NOT NULL,  -- counts from 0 at the start of the mission
    mission            TEXT NOT NULL,
    bus                INTEGER NOT NULL,
    start_utc          TEXT NOT NULL,
    duration_s         INTEGER NOT NULL,
    passengers         REAL,              -- mean; null where the segment is excluded
    door_open_fraction REAL,
    first_line         INTEGER,
    last_line          INTEGER,
    excluded           TEXT,              -- why the telemetry gives no sample, null where it does
    PRIMARY KEY (source_file_id, segment)
) STRICT, WITHOUT ROWID;

-- Segments that gave no sample.
CREATE TABLE excluded_segment (
    mission   TEXT NOT NULL,
    segment   INTEGER NOT NULL,
    start_utc TEXT NOT NULL,
    reason    TEXT NOT NULL,
    PRIMARY KEY (mission, segment)
) STRICT, WITHOUT ROWID;

-- One row per hourly sample: the disturbances and where they come from.
CREATE TABLE hourly_sample (
    sample_id           INTEGER PRIMARY KEY,  -- bus × 10¹⁰ + start in seconds since 1970
    source_file_id      INTEGER NOT NULL REFERENCES source_file ON DELETE CASCADE,
    mission             TEXT NOT NULL,
    bus                 INTEGER NOT NULL,
    segment             INTEGER NOT NULL,
    first_line          INTEGER NOT NULL,     -- lines of the mission file
    last_line           INTEGER NOT NULL,
    start_utc           TEXT NOT NULL,
    duration_s          INTEGER NOT NULL,
    month               INTEGER NOT NULL CHECK (month BETWEEN 1 AND 12),  -- local
    ambient_temperature_k REAL NOT NULL,
    dni_w_m2            REAL NOT NULL,
    dhi_w_m2            REAL NOT NULL,
    passengers          REAL NOT NULL,
    door_open_fraction  REAL NOT NULL,
    solar_altitude_rad  REAL NOT NULL,
    solar_azimuth_rad   REAL NOT NULL,
    shadow_fraction     REAL NOT NULL,
    interpolated_s      REAL NOT NULL         -- seconds of the segment whose weather is interpolated
) STRICT;
CREATE INDEX hourly_sample_by_month ON hourly_sample (month);
CREATE INDEX hourly_sample_by_file ON hourly_sample (source_file_id);

-- The designs of the study.
CREATE TABLE hvac_design (
    design_id       INTEGER PRIMARY KEY,
    name            TEXT NOT NULL UNIQUE,
    position        INTEGER NOT NULL,     -- order in the study
    heating         TEXT NOT NULL CHECK (heating IN ('ptc', 'hp')),
    heating_cop     TEXT NOT NULL,        -- name or table
    cooling_cop     TEXT NOT NULL,
    radiant_heaters INTEGER NOT NULL CHECK (radiant_heaters IN (0, 1)),
    air_curtain     INTEGER NOT NULL CHECK (air_curtain IN (0, 1)),
    method          TEXT NOT NULL,        -- how its optima were found: fast, nlp, nlp-surrogate
    design_key      TEXT NOT NULL         -- BLAKE3 of design, vehicle constants and version of the method
) STRICT;

-- The comfort windows of the study.
CREATE TABLE comfort_window (
    window_id INTEGER PRIMARY KEY,
    position  INTEGER NOT NULL,
    pmv_min   REAL NOT NULL,
    pmv_max   REAL NOT NULL,
    pmv_limit REAL NOT NULL,              -- the larger distance from neutral
    UNIQUE (pmv_min, pmv_max)
) STRICT;

-- One row per sample, design and window; inserted in the order of the key, so that it appends.
CREATE TABLE optimum_point (
    sample_id              INTEGER NOT NULL REFERENCES hourly_sample ON DELETE CASCADE,
    design_id              INTEGER NOT NULL REFERENCES hvac_design ON DELETE CASCADE,
    window_id              INTEGER NOT NULL REFERENCES comfort_window ON DELETE CASCADE,
    status                 INTEGER NOT NULL CHECK (status BETWEEN 0 AND 3),
    operating_mode         INTEGER,
    air_curtain_on         INTEGER,
    radiant_heaters_on     INTEGER,
    outside_standard_range INTEGER,
    air_unit_power_w       REAL,
    radiant_heater_power_w REAL,
    air_curtain_power_w    REAL,
    air_unit_heat_w        REAL,
    cabin_k                REAL,
    interior_k             REAL,
    shell_inside_k         REAL,
    shell_outside_k        REAL,
    radiant_heater_k       REAL,
    mean_radiant_k         REAL,
    pmv                    REAL,
    runner_up_excess_w     REAL,
    kkt_residual           REAL,              -- scaled; only of the methods that iterate
    subproblem_count       INTEGER,
    PRIMARY KEY (sample_id, design_id, window_id)
) STRICT, WITHOUT ROWID;

-- One row per run of the program on this database.
CREATE TABLE run (
    run_id          INTEGER PRIMARY KEY,
    started_utc     TEXT NOT NULL,
    finished_utc    TEXT,
    status          TEXT NOT NULL CHECK (status IN ('running', 'done', 'done with losses', 'interrupted', 'failed')),
    program_version TEXT NOT NULL,
    study_hash      TEXT NOT NULL,
    input_hash      TEXT,
    point_count     INTEGER,
    solved_count    INTEGER,
    failed_count    INTEGER
) STRICT;

-- Days and samples of each month that has samples, and the weight of one of its samples: 1/N · days/365 (paper,
-- eq. meanPower), renormalised over the months present.
CREATE VIEW month_weight AS
WITH month_days (month, days) AS (
    VALUES (1, 31), (2, 28), (3, 31), (4, 30), (5, 31), (6, 30), (7, 31), (8, 31), (9, 30), (10, 31), (11, 30), (12, 31)
),
present AS (
    SELECT month, count(*) AS sample_count FROM hourly_sample GROUP BY month
)
SELECT
    month,
    days,
    sample_count,
    CAST(days AS REAL) / sum(days) OVER () AS month_share,
    CAST(days AS REAL) / sum(days) OVER () / sample_count AS sample_weight
FROM present JOIN month_days USING (month);

-- The samples with their weights.
CREATE VIEW sample AS
SELECT
    s.sample_id,
    s.mission,
    s.bus,
    s.segment,
    s.start_utc,
    s.month,
    w.sample_weight AS weight,
    s.ambient_temperature_k - 273.15 AS ambient_temperature_c,
    s.dni_w_m2,
    s.dhi_w_m2,
    s.passengers,
    s.door_open_fraction,
    -- degrees() is an optional function of SQLite.
    s.solar_altitude_rad * 57.29577951308232 AS solar_altitude_deg,
    s.solar_azimuth_rad * 57.29577951308232 AS solar_azimuth_deg,
    s.shadow_fraction,
    s.interpolated_s,
    f.path AS source_path,
    s.first_line,
    s.last_line
FROM hourly_sample AS s
JOIN month_weight AS w USING (month)
JOIN source_file AS f USING (source_file_id);

-- The optima in the units of analysts.
CREATE VIEW optimum AS
SELECT
    p.sample_id,
    d.name AS design,
    w.pmv_limit,
    w.pmv_min,
    w.pmv_max,
    CASE p.status
        WHEN 0 THEN 'solved'
        WHEN 1 THEN 'infeasible: too warm'
        WHEN 2 THEN 'infeasible: too cold'
        ELSE 'not converged'
    END AS status,
    p.air_unit_power_w + p.radiant_heater_power_w + p.air_curtain_power_w AS hvac_power_w,
    p.air_unit_power_w,
    p.radiant_heater_power_w,
    p.air_curtain_power_w,
    p.operating_mode,
    p.air_curtain_on,
    p.radiant_heaters_on,
    p.air_unit_heat_w,
    p.cabin_k - 273.15 AS cabin_temperature_c,
    p.interior_k - 273.15 AS interior_temperature_c,
    p.shell_inside_k - 273.15 AS shell_inside_temperature_c,
    p.shell_outside_k - 273.15 AS shell_outside_temperature_c,
    p.radiant_heater_k - 273.15 AS radiant_heater_temperature_c,
    p.mean_radiant_k - 273.15 AS mean_radiant_temperature_c,
    p.pmv,
    p.outside_standard_range,
    p.runner_up_excess_w,
    d.method,
    p.kkt_residual,
    p.subproblem_count
FROM optimum_point AS p
JOIN hvac_design AS d USING (design_id)
JOIN comfort_window AS w USING (window_id);

-- Means over the solved samples of a month: all samples of a month weigh alike.
CREATE VIEW monthly_average AS
SELECT
    d.name AS design,
    w.pmv_limit,
    w.pmv_min,
    w.pmv_max,
    s.month,
    avg(p.air_unit_power_w + p.radiant_heater_power_w + p.air_curtain_power_w) AS hvac_power_w,
    -- Heaters and curtain count to the side on which the air unit works; alone they heat.
    avg(CASE WHEN p.operating_mode >= 0
        THEN p.air_unit_power_w + p.radiant_heater_power_w + p.air_curtain_power_w
        WHEN p.operating_mode < 0 THEN 0.0 END) AS heating_power_w,
    avg(CASE WHEN p.operating_mode < 0
        THEN p.air_unit_power_w + p.radiant_heater_power_w + p.air_curtain_power_w
        WHEN p.operating_mode >= 0 THEN 0.0 END) AS cooling_power_w,
    count(*) AS sample_count,
    sum(p.status <> 0) AS unsolved_count,
    p.design_id,
    p.window_id
FROM optimum_point AS p
JOIN hourly_sample AS s USING (sample_id)
JOIN hvac_design AS d USING (design_id)
JOIN comfort_window AS w USING (window_id)
GROUP BY p.design_id, p.window_id, s.month;

-- The annual means: every month by its days, within a month the solved samples alike.
CREATE VIEW annual_average AS
WITH annual AS (
    SELECT
        m.design,
        m.pmv_limit,
        m.pmv_min,
        m.pmv_max,
        sum(m.hvac_power_w * w.days) / sum(CASE WHEN m.hvac_power_w IS NOT NULL THEN w.days END) AS hvac_power_w,
        sum(m.heating_power_w * w.days) / sum(CASE WHEN m.hvac_power_w IS NOT NULL THEN w.days END) AS heating_power_w,
        sum(m.cooling_power_w * w.days) / sum(CASE WHEN m.hvac_power_w IS NOT NULL THEN w.days END) AS cooling_power_w,
        sum(m.sample_count) AS sample_count,
        sum(m.unsolved_count) AS unsolved_count,
        sum(m.unsolved_count * w.sample_weight) AS unsolved_weight
    FROM monthly_average AS m
    JOIN month_weight AS w USING (month)
    GROUP BY m.design_id, m.window_id
)
SELECT
    a.design,
    a.pmv_limit,
    a.pmv_min,
    a.pmv_max,
    a.hvac_power_w,
    a.heating_power_w,
    a.cooling_power_w,
    a.sample_count,
    a.unsolved_count,
    a.unsolved_weight,
    (r.hvac_power_w - a.hvac_power_w) / nullif(r.hvac_power_w, 0.0) AS reduction_vs_ptc
FROM annual AS a
LEFT JOIN annual AS r ON r.design = 'ptc' AND r.pmv_min = a.pmv_min AND r.pmv_max = a.pmv_max;
