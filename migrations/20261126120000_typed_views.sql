-- Views whose columns have the same type in every tool.
--
-- Serves: DuckDB, which runs a view's text itself and takes REAL for 32 bits and a bare expression for text; Datasette, whose
-- filters compare an expression without a type as text; whoever asks SQLite for the columns of a view.
-- Cost: none.

DROP VIEW month_weight;
CREATE VIEW month_weight AS
WITH month_days (month, days) AS (
    VALUES (1, 31), (2, 28), (3, 31), (4, 30), (5, 31), (6, 30), (7, 31), (8, 31), (9, 30), (10, 31), (11, 30), (12, 31)
),
present AS (
    SELECT month, count(*) AS sample_count FROM hourly_sample GROUP BY month
)
SELECT
    month,
    CAST(days AS BIGINT) AS days,
    CAST(sample_count AS BIGINT) AS sample_count,
    CAST(CAST(days AS DOUBLE) / sum(days) OVER () AS DOUBLE) AS month_share,
    CAST(CAST(days AS DOUBLE) / sum(days) OVER () / sample_count AS DOUBLE) AS sample_weight
FROM present JOIN month_days USING (month);

DROP VIEW sample;
CREATE VIEW sample AS
SELECT
    s.sample_id,
    s.mission,
    s.bus,
    s.segment,
    s.start_utc,
    s.month,
    w.sample_weight AS weight,
    CAST(s.ambient_temperature_k - 273.15 AS DOUBLE) AS ambient_temperature_c,
    s.dni_w_m2,
    s.dhi_w_m2,
    s.passengers,
    s.door_open_fraction,
    -- degrees() is an optional function of SQLite.
    CAST(s.solar_altitude_rad * 57.29577951308232 AS DOUBLE) AS solar_altitude_deg,
    CAST(s.solar_azimuth_rad * 57.29577951308232 AS DOUBLE) AS solar_azimuth_deg,
    s.shadow_fraction,
    s.interpolated_s,
    f.path AS source_path,
    s.first_line,
    s.last_line,
    g.distance_m,
    g.vehicle_power_w,
    g.route
FROM hourly_sample AS s
JOIN month_weight AS w USING (month)
JOIN source_file AS f USING (source_file_id)
LEFT JOIN mission_segment AS g ON g.source_file_id = s.source_file_id AND g.segment = s.segment;

DROP VIEW optimum;
CREATE VIEW optimum AS
SELECT
    p.sample_id,
    d.name AS design,
    w.pmv_limit,
    w.pmv_min,
    w.pmv_max,
    CAST(CASE p.status
        WHEN 0 THEN 'solved'
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

DROP VIEW limit_share;
CREATE VIEW limit_share AS
WITH month_days (month, days) AS (
    VALUES (1, 31), (2, 28), (3, 31), (4, 30), (5, 31), (6, 30), (7, 31), (8, 31), (9, 30), (10, 31), (11, 30), (12, 31)
)
SELECT
    design,
    pmv_limit,
    pmv_min,
    pmv_max,
    CAST(sum(sample_count - unsolved_count) AS BIGINT) AS solved_count,
    CAST(sum(lower_count) AS BIGINT) AS lower_count,
    CAST(sum(upper_count) AS BIGINT) AS upper_count,
    CAST(sum(heating_count) AS BIGINT) AS heating_count,
    CAST(sum(cooling_count) AS BIGINT) AS cooling_count,
    CAST(sum(lower_count * CAST(days AS DOUBLE) / sample_count)
        / sum((sample_count - unsolved_count) * CAST(days AS DOUBLE) / sample_count) AS DOUBLE) AS lower_weight,
    CAST(sum(cooling_count * CAST(days AS DOUBLE) / sample_count)
        / sum((sample_count - unsolved_count) * CAST(days AS DOUBLE) / sample_count) AS DOUBLE) AS cooling_weight,
    CAST(sum(outside_range_count) AS BIGINT) AS outside_range_count
FROM monthly_average JOIN month_days USING (month)
GROUP BY design, pmv_limit, pmv_min, pmv_max
HAVING sum(sample_count - unsolved_count) > 0;

DROP VIEW simulation;
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
    CAST(r.ambient_k - 273.15 AS DOUBLE) AS ambient_temperature_c
FROM simulated_mission AS r
JOIN hvac_design AS d USING (design_id)
JOIN comfort_window AS w USING (window_id);

DROP VIEW simulation_trace;
CREATE VIEW simulation_trace AS
SELECT
    t.label,
    f.path AS source_path,
    d.name AS design,
    w.pmv_limit,
    w.pmv_min,
    w.pmv_max,
    m.minute,
    CAST(m.ambient_k - 273.15 AS DOUBLE) AS ambient_temperature_c,
    m.passengers,
    m.door_open_fraction,
    CAST(m.cabin_k - 273.15 AS DOUBLE) AS cabin_temperature_c,
    CAST(m.interior_k - 273.15 AS DOUBLE) AS interior_temperature_c,
    CAST(m.shell_inside_k - 273.15 AS DOUBLE) AS shell_inside_temperature_c,
    CAST(m.shell_outside_k - 273.15 AS DOUBLE) AS shell_outside_temperature_c,
    CAST(m.radiant_heater_k - 273.15 AS DOUBLE) AS radiant_heater_temperature_c,
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

DROP VIEW control;
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
    CAST(r.ambient_k - 273.15 AS DOUBLE) AS ambient_temperature_c
FROM controlled_mission AS r
JOIN hvac_design AS d USING (design_id)
JOIN comfort_window AS w USING (window_id);
