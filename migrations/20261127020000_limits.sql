-- Designs whose air unit is limited, with a back-up heater or without.
--
-- Serves: whoever asks in how many hours a smaller heat pump leaves passengers out of their comfort, how far, and what a back-up
-- heater does about it.
-- Cost: two numbers an optimum. All optima are found anew once, since the search has become another one.

-- The check of a row stays the last column; what was solved had no limits.
ALTER TABLE optimum_point DROP COLUMN row_check;
ALTER TABLE optimum_point ADD COLUMN backup_heater_power_w REAL;
ALTER TABLE optimum_point ADD COLUMN unmet_heat_w REAL;
ALTER TABLE optimum_point ADD COLUMN row_check INTEGER;
UPDATE optimum_point SET backup_heater_power_w = 0.0, unmet_heat_w = 0.0 WHERE status = 0;

DROP VIEW optimum;
CREATE VIEW optimum AS
SELECT
    p.sample_id,
    d.name AS design,
    w.pmv_limit,
    w.pmv_min,
    w.pmv_max,
    CAST(CASE p.status
        WHEN 0 THEN CASE WHEN p.unmet_heat_w > 0.0 THEN 'limited' ELSE 'solved' END
        WHEN 1 THEN 'infeasible: too warm'
        WHEN 2 THEN 'infeasible: too cold'
        ELSE 'not converged'
    END AS TEXT) AS status,
    CAST(p.air_unit_power_w + p.radiant_heater_power_w + p.air_curtain_power_w AS DOUBLE) AS hvac_power_w,
    p.air_unit_power_w,
    p.radiant_heater_power_w,
    p.air_curtain_power_w,
    p.operating_mode,
    p.air_curtain_on,
    p.radiant_heaters_on,
    p.air_unit_heat_w,
    p.backup_heater_power_w,
    p.unmet_heat_w,
    CAST(p.cabin_k - 273.15 AS DOUBLE) AS cabin_temperature_c,
    CAST(p.interior_k - 273.15 AS DOUBLE) AS interior_temperature_c,
    CAST(p.shell_inside_k - 273.15 AS DOUBLE) AS shell_inside_temperature_c,
    CAST(p.shell_outside_k - 273.15 AS DOUBLE) AS shell_outside_temperature_c,
    CAST(p.radiant_heater_k - 273.15 AS DOUBLE) AS radiant_heater_temperature_c,
    CAST(p.mean_radiant_k - 273.15 AS DOUBLE) AS mean_radiant_temperature_c,
    p.pmv,
    p.outside_standard_range,
    p.runner_up_excess_w,
    d.method,
    p.kkt_residual,
    p.subproblem_count
FROM optimum_point AS p
JOIN hvac_design AS d USING (design_id)
JOIN comfort_window AS w USING (window_id);

-- How often and how far the limits of a design keep it from a comfort window.
CREATE TABLE limited_annual (
    design              TEXT NOT NULL,
    pmv_limit           REAL NOT NULL,
    pmv_min             REAL NOT NULL,
    pmv_max             REAL NOT NULL,
    limited_count       INTEGER NOT NULL,
    limited_weight      REAL NOT NULL,
    mean_unmet_heat_w   REAL NOT NULL,
    largest_unmet_heat_w REAL NOT NULL,
    mean_pmv_miss       REAL NOT NULL,
    largest_pmv_miss    REAL NOT NULL,
    backup_heater_power_w REAL NOT NULL,
    run_id              INTEGER NOT NULL,
    PRIMARY KEY (design, pmv_min, pmv_max)
) STRICT, WITHOUT ROWID;

INSERT OR IGNORE INTO stale_month VALUES (1), (2), (3), (4), (5), (6), (7), (8), (9), (10), (11), (12);
DELETE FROM stage_record WHERE stage IN ('solve', 'simulate', 'control');
