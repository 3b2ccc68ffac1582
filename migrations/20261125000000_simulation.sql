-- Simulated missions.
--
-- Serves: the report's comparison of steady state and simulation, and analysts who look for missions where the two differ. What
-- passengers and doors do in time is kept, so that a simulation need not read the telemetry again.
-- Cost: some 12 kB of loads a mission, and about 150 bytes for each design, window and controller of a mission.

-- How passengers and doors of a mission change.
CREATE TABLE mission_load (
    source_file_id INTEGER PRIMARY KEY REFERENCES source_file ON DELETE CASCADE,
    loads          BLOB NOT NULL  -- 13 bytes each, little endian: second since the start (u32), passengers (f64), door open (u8)
) STRICT;

CREATE TABLE simulated_mission (
    source_file_id           INTEGER NOT NULL REFERENCES source_file ON DELETE CASCADE,
    design_id                INTEGER NOT NULL REFERENCES hvac_design ON DELETE CASCADE,
    window_id                INTEGER NOT NULL REFERENCES comfort_window ON DELETE CASCADE,
    controller               TEXT NOT NULL,     -- paper, warm-start, unlimited, free-mode
    simulation_key           TEXT NOT NULL,     -- BLAKE3 of samples, weather, design, window, dynamics and version
    mission                  TEXT NOT NULL,
    month                    INTEGER NOT NULL,  -- local, of the start
    ambient_k                REAL NOT NULL,     -- mean over the simulated segments
    seconds                  INTEGER NOT NULL,  -- simulated: the whole segments from the first on
    mean_hvac_power_w        REAL NOT NULL,
    static_mean_hvac_power_w REAL NOT NULL,
    max_abs_pmv_15min        REAL,              -- while somebody is on board; null where nobody ever is
    static_max_abs_pmv       REAL NOT NULL,
    saturated_fraction       REAL NOT NULL,
    tracking_error_k         REAL NOT NULL,
    PRIMARY KEY (source_file_id, design_id, window_id, controller)
) STRICT, WITHOUT ROWID;

CREATE VIEW simulation AS
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
    r.saturated_fraction,
    r.tracking_error_k,
    r.seconds,
    r.month,
    r.ambient_k - 273.15 AS ambient_temperature_c
FROM simulated_mission AS r
JOIN hvac_design AS d USING (design_id)
JOIN comfort_window AS w USING (window_id);

-- Annual means of simulated and of steady-state power: months by their days, within a month every second alike.
CREATE VIEW simulation_annual AS
WITH monthly AS (
    SELECT
        design,
        pmv_limit,
        pmv_min,
        pmv_max,
        controller,
        month,
        sum(mean_hvac_power_w * seconds) / sum(seconds) AS power_w,
        sum(static_mean_hvac_power_w * seconds) / sum(seconds) AS static_power_w,
        sum(saturated_fraction * seconds) / sum(seconds) AS saturated_fraction,
        count(*) AS mission_count
    FROM simulation
    GROUP BY design, pmv_min, pmv_max, controller, month
)
SELECT
    m.design,
    m.pmv_limit,
    m.pmv_min,
    m.pmv_max,
    m.controller,
    sum(m.power_w * w.days) / sum(w.days) AS mean_hvac_power_w,
    sum(m.static_power_w * w.days) / sum(w.days) AS static_mean_hvac_power_w,
    sum(m.saturated_fraction * w.days) / sum(w.days) AS saturated_fraction,
    sum(m.mission_count) AS mission_count
FROM monthly AS m
JOIN month_weight AS w USING (month)
GROUP BY m.design, m.pmv_min, m.pmv_max, m.controller;
