-- What a report shows, all of it as rows: traces of two missions, classes of simulated missions, how often limits bind; and of
-- what each row was made.
--
-- Serves: `report`, which reads nothing but this database; stages, which compute again what was made from something else;
-- analysts who ask why a mission is not simulated.
-- Cost: some 150 bytes for each minute of the two missions, 64 bytes a sample.

-- BLAKE3 of the reading of the mission, weather and shade of the sample's hours, place and time zone. Empty in a database of an
-- earlier version until `shade` runs: the values tell then whether the sample is the same.
ALTER TABLE hourly_sample ADD COLUMN sample_key TEXT NOT NULL DEFAULT '';

-- Excluded segments had no length; the last one of a mission ends where the mission's name says.
UPDATE mission_segment
SET duration_s = min(
    coalesce((SELECT max(g.duration_s) FROM mission_segment AS g WHERE g.duration_s > 0), 3600),
    unixepoch(substr(mission, -19, 10) || ' ' || replace(substr(mission, -8), '-', ':')) + 1 - unixepoch(start_utc))
WHERE duration_s = 0
    AND unixepoch(substr(mission, -19, 10) || ' ' || replace(substr(mission, -8), '-', ':')) >= unixepoch(start_utc);

-- Missions that could not be simulated with a design and window.
CREATE TABLE unsimulated_mission (
    source_file_id INTEGER NOT NULL REFERENCES source_file ON DELETE CASCADE,
    design_id      INTEGER NOT NULL REFERENCES hvac_design ON DELETE CASCADE,
    window_id      INTEGER NOT NULL REFERENCES comfort_window ON DELETE CASCADE,
    simulation_key TEXT NOT NULL,
    mission        TEXT NOT NULL,
    reason         TEXT NOT NULL,
    PRIMARY KEY (source_file_id, design_id, window_id)
) STRICT, WITHOUT ROWID;

-- The two missions that the report shows in time, simulated as in the paper.
CREATE TABLE mission_trace (
    trace_id       INTEGER PRIMARY KEY,
    label          TEXT NOT NULL UNIQUE,  -- cold, hot
    source_file_id INTEGER NOT NULL REFERENCES source_file ON DELETE CASCADE,
    design_id      INTEGER NOT NULL REFERENCES hvac_design ON DELETE CASCADE,
    window_id      INTEGER NOT NULL REFERENCES comfort_window ON DELETE CASCADE,
    of_paper       INTEGER NOT NULL CHECK (of_paper IN (0, 1)),  -- named like a mission that the paper shows
    segment_count  INTEGER NOT NULL,      -- segments that it covers, from the mission's first sample on
    simulation_key TEXT NOT NULL
) STRICT;

-- Their means over each minute.
CREATE TABLE trace_minute (
    trace_id               INTEGER NOT NULL REFERENCES mission_trace ON DELETE CASCADE,
    minute                 INTEGER NOT NULL,  -- from the start of the mission's first sample
    ambient_k              REAL NOT NULL,     -- in the middle of the minute
    passengers             REAL NOT NULL,
    door_open_fraction     REAL NOT NULL,
    cabin_k                REAL NOT NULL,
    interior_k             REAL NOT NULL,
    shell_inside_k         REAL NOT NULL,
    shell_outside_k        REAL NOT NULL,
    radiant_heater_k       REAL NOT NULL,
    pmv                    REAL NOT NULL,
    pmv_15min              REAL NOT NULL,
    air_unit_power_w       REAL NOT NULL,     -- negative in cooling
    radiant_heater_power_w REAL NOT NULL,
    air_curtain_power_w    REAL NOT NULL,
    hvac_power_w           REAL NOT NULL,
    PRIMARY KEY (trace_id, minute)
) STRICT, WITHOUT ROWID;

-- Missions without a simulation, with the reason.
CREATE VIEW simulation_failure AS
SELECT
    u.mission,
    d.name AS design,
    w.pmv_limit,
    w.pmv_min,
    w.pmv_max,
    u.reason
FROM unsimulated_mission AS u
JOIN hvac_design AS d USING (design_id)
JOIN comfort_window AS w USING (window_id);

-- The traces in the units of analysts.
CREATE VIEW simulation_trace AS
SELECT
    t.label,
    f.path AS source_path,
    d.name AS design,
    w.pmv_limit,
    w.pmv_min,
    w.pmv_max,
    m.minute,
    m.ambient_k - 273.15 AS ambient_temperature_c,
    m.passengers,
    m.door_open_fraction,
    m.cabin_k - 273.15 AS cabin_temperature_c,
    m.interior_k - 273.15 AS interior_temperature_c,
    m.shell_inside_k - 273.15 AS shell_inside_temperature_c,
    m.shell_outside_k - 273.15 AS shell_outside_temperature_c,
    m.radiant_heater_k - 273.15 AS radiant_heater_temperature_c,
    m.pmv,
    m.pmv_15min,
    m.air_unit_power_w,
    m.radiant_heater_power_w,
    m.air_curtain_power_w,
    m.hvac_power_w
FROM trace_minute AS m
JOIN mission_trace AS t USING (trace_id)
JOIN source_file AS f USING (source_file_id)
JOIN hvac_design AS d USING (design_id)
JOIN comfort_window AS w USING (window_id);

-- In how many samples the limits of comfort bind, and what the air unit does. A binding limit is met to rounding; the next state
-- inside is many orders of magnitude away.
CREATE VIEW limit_share AS
SELECT
    d.name AS design,
    w.pmv_limit,
    w.pmv_min,
    w.pmv_max,
    count(*) AS solved_count,
    sum(p.pmv < w.pmv_min + 1e-6) AS lower_count,
    sum(p.pmv > w.pmv_max - 1e-6) AS upper_count,
    sum(p.operating_mode = 1) AS heating_count,
    sum(p.operating_mode = -1) AS cooling_count,
    sum((p.pmv < w.pmv_min + 1e-6) * m.sample_weight) / sum(m.sample_weight) AS lower_weight,
    sum((p.operating_mode = -1) * m.sample_weight) / sum(m.sample_weight) AS cooling_weight,
    sum(p.outside_standard_range) AS outside_range_count
FROM optimum_point AS p
JOIN hourly_sample AS s USING (sample_id)
JOIN month_weight AS m USING (month)
JOIN hvac_design AS d USING (design_id)
JOIN comfort_window AS w USING (window_id)
WHERE p.status = 0
GROUP BY p.design_id, p.window_id;

-- Simulated missions by month, by ambient temperature and by length, driven as in the paper: means over all their seconds.
CREATE VIEW simulation_class AS
WITH classed AS (
    SELECT
        s.*,
        v.mean_hvac_power_w AS warm_w,
        0 AS sorting,
        'month' AS sorted_by,
        s.month AS place,
        printf('%02d', s.month) AS class
    FROM simulation AS s
    JOIN simulation AS v USING (mission, design, pmv_min, pmv_max)
    WHERE s.controller = 'paper' AND v.controller = 'warm-start'
),
all_classed AS (
    SELECT * FROM classed
    UNION ALL
    SELECT mission, design, pmv_limit, pmv_min, pmv_max, controller, mean_hvac_power_w,
        static_mean_hvac_power_w, max_abs_pmv_15min, static_max_abs_pmv, saturated_fraction,
        tracking_error_k, seconds, month, ambient_temperature_c, warm_w, 1, 'ambient temperature in °C',
        CAST(ambient_temperature_c / 5 + 100 AS INTEGER) - 100,
        printf('%d … %d', 5 * (CAST(ambient_temperature_c / 5 + 100 AS INTEGER) - 100),
            5 * (CAST(ambient_temperature_c / 5 + 100 AS INTEGER) - 99))
    FROM classed
    UNION ALL
    SELECT mission, design, pmv_limit, pmv_min, pmv_max, controller, mean_hvac_power_w,
        static_mean_hvac_power_w, max_abs_pmv_15min, static_max_abs_pmv, saturated_fraction,
        tracking_error_k, seconds, month, ambient_temperature_c, warm_w, 2, 'mission length in h',
        min(seconds / 14400, 4),
        CASE WHEN seconds >= 57600 THEN '16 and more'
            ELSE printf('%d … %d', 4 * (seconds / 14400), 4 * (seconds / 14400 + 1)) END
    FROM classed
)
SELECT
    a.design,
    a.pmv_limit,
    a.pmv_min,
    a.pmv_max,
    a.sorted_by,
    a.class,
    a.sorting * 100 + a.place AS class_order,
    count(*) AS mission_count,
    sum(a.mean_hvac_power_w * a.seconds) / sum(a.seconds) AS mean_hvac_power_w,
    sum(a.static_mean_hvac_power_w * a.seconds) / sum(a.seconds) AS static_mean_hvac_power_w,
    sum(a.warm_w * a.seconds) / sum(a.seconds) AS warm_start_power_w,
    avg(a.max_abs_pmv_15min) AS mean_max_abs_pmv_15min,
    sum(a.saturated_fraction * a.seconds) / sum(a.seconds) AS saturated_fraction
FROM all_classed AS a
JOIN hvac_design AS d ON d.name = a.design
JOIN comfort_window AS w USING (pmv_min, pmv_max)
GROUP BY d.position, w.position, a.sorting, a.place;
