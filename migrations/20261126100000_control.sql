-- Controllers that see the present alone, on every mission: the setpoints that they follow, and what they come to.
--
-- Serves: the report's comparison of controllers, analysts who ask when and where one loses, engineers who load setpoints.
-- Cost: with one design, eight windows and the published setpoints some hundred rows of 150 bytes a mission.

-- What the controlled missions of a design were made from, or why there are none.
CREATE TABLE controlled_mission_key (
    source_file_id INTEGER NOT NULL REFERENCES source_file ON DELETE CASCADE,
    design_id      INTEGER NOT NULL REFERENCES hvac_design ON DELETE CASCADE,
    control_key    TEXT NOT NULL,     -- BLAKE3 of samples, weather, design, windows, controllers, dynamics and version
    mission        TEXT NOT NULL,
    reason         TEXT,              -- why it cannot be driven; null where it is
    row_check      INTEGER,
    PRIMARY KEY (source_file_id, design_id)
) STRICT, WITHOUT ROWID;
CREATE INDEX controlled_mission_key_unchecked ON controlled_mission_key (source_file_id) WHERE row_check IS NULL;

CREATE TABLE controlled_mission (
    source_file_id           INTEGER NOT NULL,
    design_id                INTEGER NOT NULL,
    window_id                INTEGER NOT NULL REFERENCES comfort_window ON DELETE CASCADE,  -- by which it is judged
    controller               TEXT NOT NULL,     -- extracted, extracted-other-years, extracted-one-year, or a published name
    mission                  TEXT NOT NULL,
    month                    INTEGER NOT NULL,  -- local, of the start
    ambient_k                REAL NOT NULL,     -- mean over the segments
    seconds                  INTEGER NOT NULL,
    mean_hvac_power_w        REAL NOT NULL,
    static_mean_hvac_power_w REAL NOT NULL,     -- of the steady-state optima within the window
    max_abs_pmv_15min        REAL,              -- while somebody is on board; null where nobody ever is
    static_max_abs_pmv       REAL NOT NULL,
    mean_abs_pmv             REAL,              -- over passengers and time, of 15-minute votes; null where nobody ever is
    static_mean_abs_pmv      REAL,
    passenger_hours          REAL NOT NULL,
    passenger_hours_outside  REAL NOT NULL,     -- with a 15-minute vote outside the window
    saturated_fraction       REAL NOT NULL,
    tracking_error_k         REAL NOT NULL,
    row_check                INTEGER,
    PRIMARY KEY (source_file_id, design_id, window_id, controller),
    FOREIGN KEY (source_file_id, design_id) REFERENCES controlled_mission_key ON DELETE CASCADE
) STRICT, WITHOUT ROWID;
CREATE INDEX controlled_mission_unchecked ON controlled_mission (source_file_id) WHERE row_check IS NULL;

CREATE VIEW control AS
SELECT
    r.mission,
    d.name AS design,
    w.pmv_limit,
    w.pmv_min,
    w.pmv_max,
    r.controller,
    r.mean_hvac_power_w,
    r.static_mean_hvac_power_w,
    r.max_abs_pmv_15min,
    r.static_max_abs_pmv,
    r.mean_abs_pmv,
    r.static_mean_abs_pmv,
    r.passenger_hours,
    r.passenger_hours_outside,
    r.saturated_fraction,
    r.tracking_error_k,
    r.seconds,
    r.month,
    r.ambient_k - 273.15 AS ambient_temperature_c
FROM controlled_mission AS r
JOIN hvac_design AS d USING (design_id)
JOIN comfort_window AS w USING (window_id);

CREATE VIEW control_failure AS
SELECT k.mission, d.name AS design, k.reason
FROM controlled_mission_key AS k JOIN hvac_design AS d USING (design_id)
WHERE k.reason IS NOT NULL;

-- The following tables are of the last time that all was driven.

CREATE TABLE setpoint_profile (
    design               TEXT NOT NULL,
    pmv_limit            REAL NOT NULL,
    pmv_min              REAL NOT NULL,
    pmv_max              REAL NOT NULL,
    mode                 TEXT NOT NULL,   -- heating, cooling
    kind                 TEXT,            -- quadratic, piecewise-linear; null where there is no profile
    parameters           TEXT,            -- JSON: coefficients [c0, c1, c2], or pairs of ambient and cabin temperature in °C
    valid_from_ambient_c REAL,
    valid_to_ambient_c   REAL,
    coverage             REAL,            -- share of the hours in the mode whose optimum is on its safe side
    hour_count           INTEGER,         -- samples that it was fitted to
    reason               TEXT,            -- why there is none
    run_id               INTEGER NOT NULL,
    PRIMARY KEY (design, pmv_min, pmv_max, mode)
) STRICT, WITHOUT ROWID;

CREATE TABLE curtain_threshold (
    design               TEXT NOT NULL,
    pmv_limit            REAL NOT NULL,
    pmv_min              REAL NOT NULL,
    pmv_max              REAL NOT NULL,
    mode                 TEXT NOT NULL,   -- heating, cooling
    threshold_k          REAL,            -- of the optima; null where curtains always or never run
    analytic_threshold_k REAL,            -- of the model at the mode's mean ambient temperature; null where they never pay
    misclassified_weight REAL,            -- share of the hours in the mode
    run_id               INTEGER NOT NULL,
    PRIMARY KEY (design, pmv_min, pmv_max, mode)
) STRICT, WITHOUT ROWID;

-- Only where there is one: neither for designs without heaters, nor where they always or never run.
CREATE TABLE heater_threshold (
    design               TEXT NOT NULL,
    pmv_limit            REAL NOT NULL,
    pmv_min              REAL NOT NULL,
    pmv_max              REAL NOT NULL,
    below_ambient_c      REAL NOT NULL,
    misclassified_weight REAL NOT NULL,
    heater_temperature_c REAL NOT NULL,   -- mean of the optima while they run
    run_id               INTEGER NOT NULL,
    PRIMARY KEY (design, pmv_min, pmv_max)
) STRICT, WITHOUT ROWID;

-- Annual means: months by their days, within a month every second alike, for votes every passenger-second.
CREATE TABLE control_annual (
    design                   TEXT NOT NULL,
    pmv_limit                REAL NOT NULL,
    pmv_min                  REAL NOT NULL,
    pmv_max                  REAL NOT NULL,
    controller               TEXT NOT NULL,
    mean_hvac_power_w        REAL NOT NULL,
    static_mean_hvac_power_w REAL NOT NULL,
    mean_abs_pmv             REAL,
    static_mean_abs_pmv      REAL,
    passenger_hours          REAL NOT NULL,   -- in all missions, as they were driven
    passenger_hours_outside  REAL NOT NULL,
    outside_fraction         REAL,            -- of the year's passenger-hours, months by their days
    saturated_fraction       REAL NOT NULL,
    mission_count            INTEGER NOT NULL,
    run_id                   INTEGER NOT NULL,
    PRIMARY KEY (design, pmv_min, pmv_max, controller)
) STRICT, WITHOUT ROWID;

-- The same by month and by ambient temperature: means over all seconds, and passenger-seconds, of a class of missions.
CREATE TABLE control_class (
    design                   TEXT NOT NULL,
    pmv_limit                REAL NOT NULL,
    pmv_min                  REAL NOT NULL,
    pmv_max                  REAL NOT NULL,
    controller               TEXT NOT NULL,
    sorted_by                TEXT NOT NULL,
    class                    TEXT NOT NULL,
    class_order              INTEGER NOT NULL,
    mean_hvac_power_w        REAL NOT NULL,
    static_mean_hvac_power_w REAL NOT NULL,
    mean_abs_pmv             REAL,
    static_mean_abs_pmv      REAL,
    outside_fraction         REAL,
    mission_count            INTEGER NOT NULL,
    run_id                   INTEGER NOT NULL,
    PRIMARY KEY (design, pmv_min, pmv_max, controller, class_order)
) STRICT, WITHOUT ROWID;

-- The hottest mission, or that of the paper, as means of every minute with some of the controllers.
CREATE TABLE control_trace (
    design                TEXT NOT NULL,
    pmv_min               REAL NOT NULL,      -- window of the profile, or by which published setpoints are judged
    pmv_max               REAL NOT NULL,
    controller            TEXT NOT NULL,
    mission               TEXT NOT NULL,
    minute                INTEGER NOT NULL,   -- from the start of the mission's first sample
    ambient_temperature_c REAL NOT NULL,
    setpoint_c            REAL,               -- null in a minute in which the air unit is at rest
    cabin_temperature_c   REAL NOT NULL,
    pmv                   REAL NOT NULL,
    pmv_15min             REAL NOT NULL,
    air_unit_power_w      REAL NOT NULL,      -- negative in cooling
    hvac_power_w          REAL NOT NULL,
    run_id                INTEGER NOT NULL,
    PRIMARY KEY (design, pmv_min, pmv_max, controller, minute)
) STRICT, WITHOUT ROWID;

-- Whatever takes optima away leaves this stage incomplete too.
DROP TRIGGER sample_withdrawn;
CREATE TRIGGER sample_withdrawn AFTER DELETE ON hourly_sample
BEGIN DELETE FROM stage_record WHERE stage IN ('solve', 'simulate', 'control'); END;
DROP TRIGGER design_withdrawn;
CREATE TRIGGER design_withdrawn AFTER DELETE ON hvac_design
BEGIN DELETE FROM stage_record WHERE stage IN ('solve', 'simulate', 'control'); END;
DROP TRIGGER window_withdrawn;
CREATE TRIGGER window_withdrawn AFTER DELETE ON comfort_window
BEGIN DELETE FROM stage_record WHERE stage IN ('solve', 'simulate', 'control'); END;
DROP TRIGGER file_withdrawn;
CREATE TRIGGER file_withdrawn AFTER DELETE ON source_file
BEGIN DELETE FROM stage_record WHERE stage IN ('solve', 'simulate', 'control'); END;
