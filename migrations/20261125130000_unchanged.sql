-- What makes a night without news short: how files looked when they were read, and what each stage was last completed for.
--
-- Serves: `run`, which reads no file again that is as it was, and skips a stage whose inputs are those of its last completion.
-- Cost: 32 bytes a file, four rows.

-- Size, modification time and inode of a file (of the archive, for an entry of one) when its content was read; no row where
-- the file was so young that a later write could have left the same.
CREATE TABLE file_stamp (
    source_file_id INTEGER PRIMARY KEY REFERENCES source_file ON DELETE CASCADE,
    bytes          INTEGER NOT NULL,
    modified_ns    INTEGER NOT NULL,  -- since 1970
    inode          INTEGER NOT NULL
) STRICT;

-- The inputs for which a stage was last completed, hashed, and what it came to.
CREATE TABLE stage_record (
    stage     TEXT PRIMARY KEY,       -- solve, simulate, report
    stage_key TEXT NOT NULL,
    result    TEXT NOT NULL           -- JSON, of the stage's own
) STRICT, WITHOUT ROWID;

-- Whatever takes optima or simulations away by a cascade leaves the stages incomplete that made them.
CREATE TRIGGER sample_withdrawn AFTER DELETE ON hourly_sample
BEGIN DELETE FROM stage_record WHERE stage IN ('solve', 'simulate'); END;
CREATE TRIGGER design_withdrawn AFTER DELETE ON hvac_design
BEGIN DELETE FROM stage_record WHERE stage IN ('solve', 'simulate'); END;
CREATE TRIGGER window_withdrawn AFTER DELETE ON comfort_window
BEGIN DELETE FROM stage_record WHERE stage IN ('solve', 'simulate'); END;
CREATE TRIGGER file_withdrawn AFTER DELETE ON source_file
BEGIN DELETE FROM stage_record WHERE stage IN ('solve', 'simulate'); END;

-- The classes of simulated missions once more, joined by key instead of by names: the same rows in a hundredth of the time.
DROP VIEW simulation_class;
CREATE VIEW simulation_class AS
WITH classed AS (
    SELECT
        r.design_id,
        r.window_id,
        r.mean_hvac_power_w,
        r.static_mean_hvac_power_w,
        r.max_abs_pmv_15min,
        r.saturated_fraction,
        r.seconds,
        r.month,
        r.ambient_k - 273.15 AS ambient_temperature_c,
        v.mean_hvac_power_w AS warm_w
    FROM simulated_mission AS r
    JOIN simulated_mission AS v USING (source_file_id, design_id, window_id)
    WHERE r.controller = 'paper' AND v.controller = 'warm-start'
),
all_classed AS (
    SELECT *, 0 AS sorting, 'month' AS sorted_by, month AS place, printf('%02d', month) AS class FROM classed
    UNION ALL
    SELECT *, 1, 'ambient temperature in °C', CAST(ambient_temperature_c / 5 + 100 AS INTEGER) - 100,
        printf('%d … %d', 5 * (CAST(ambient_temperature_c / 5 + 100 AS INTEGER) - 100),
            5 * (CAST(ambient_temperature_c / 5 + 100 AS INTEGER) - 99))
    FROM classed
    UNION ALL
    SELECT *, 2, 'mission length in h', min(seconds / 14400, 4),
        CASE WHEN seconds >= 57600 THEN '16 and more'
            ELSE printf('%d … %d', 4 * (seconds / 14400), 4 * (seconds / 14400 + 1)) END
    FROM classed
)
SELECT
    d.name AS design,
    w.pmv_limit,
    w.pmv_min,
    w.pmv_max,
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
JOIN hvac_design AS d USING (design_id)
JOIN comfort_window AS w USING (window_id)
GROUP BY d.position, w.position, a.sorting, a.place;
