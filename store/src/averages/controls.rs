//! What missions under causal controllers come to in the year, by class, and outside one window.

/// Months by their days, within a month every second alike, for votes every passenger-second.
pub const ANNUAL: &str = "INSERT INTO control_annual
WITH monthly AS (
    SELECT
        design_id,
        window_id,
        controller,
        month,
        sum(mean_hvac_power_w * seconds ORDER BY mission) / sum(seconds) AS power_w,
        sum(static_mean_hvac_power_w * seconds ORDER BY mission) / sum(seconds) AS static_w,
        sum(saturated_fraction * seconds ORDER BY mission) / sum(seconds) AS saturated_fraction,
        sum(passenger_hours ORDER BY mission) AS hours,
        sum(passenger_hours_outside ORDER BY mission) AS hours_outside,
        sum(mean_abs_pmv * passenger_hours ORDER BY mission)
            / nullif(sum(passenger_hours ORDER BY mission), 0.0) AS abs_pmv,
        sum(static_mean_abs_pmv * passenger_hours ORDER BY mission)
            / nullif(sum(passenger_hours ORDER BY mission), 0.0) AS static_abs_pmv,
        count(*) AS mission_count
    FROM controlled_mission
    GROUP BY design_id, window_id, controller, month
)
SELECT
    d.name,
    w.pmv_limit,
    w.pmv_min,
    w.pmv_max,
    m.controller,
    sum(m.power_w * n.days ORDER BY month) / sum(n.days),
    sum(m.static_w * n.days ORDER BY month) / sum(n.days),
    sum(m.abs_pmv * n.days ORDER BY month) / sum(CASE WHEN m.abs_pmv IS NOT NULL THEN n.days END),
    sum(m.static_abs_pmv * n.days ORDER BY month) / sum(CASE WHEN m.static_abs_pmv IS NOT NULL THEN n.days END),
    sum(m.hours ORDER BY month),
    sum(m.hours_outside ORDER BY month),
    sum(m.hours_outside / nullif(m.hours, 0.0) * n.days ORDER BY month) / sum(CASE WHEN m.hours > 0.0 THEN n.days END),
    sum(m.saturated_fraction * n.days ORDER BY month) / sum(n.days),
    sum(m.mission_count),
    coalesce((SELECT max(run_id) FROM run), 0)
FROM monthly AS m
JOIN month_weight AS n USING (month)
JOIN hvac_design AS d USING (design_id)
JOIN comfort_window AS w USING (window_id)
GROUP BY m.design_id, m.window_id, m.controller";

pub const CLASS: &str = "INSERT INTO control_class
WITH classed AS (
    SELECT *, 'month' AS sorted_by, month AS place, printf('%02d', month) AS class FROM controlled_mission
    UNION ALL
    SELECT *, 'ambient temperature in °C', CAST((ambient_k - 273.15) / 5 + 100 AS INTEGER),
        printf('%d … %d', 5 * (CAST((ambient_k - 273.15) / 5 + 100 AS INTEGER) - 100),
            5 * (CAST((ambient_k - 273.15) / 5 + 100 AS INTEGER) - 99))
    FROM controlled_mission
)
SELECT
    d.name,
    w.pmv_limit,
    w.pmv_min,
    w.pmv_max,
    c.controller,
    c.sorted_by,
    c.class,
    c.place,
    sum(c.mean_hvac_power_w * c.seconds ORDER BY mission) / sum(c.seconds),
    sum(c.static_mean_hvac_power_w * c.seconds ORDER BY mission) / sum(c.seconds),
    sum(c.mean_abs_pmv * c.passenger_hours ORDER BY mission) / nullif(sum(c.passenger_hours ORDER BY mission), 0.0),
    sum(c.static_mean_abs_pmv * c.passenger_hours ORDER BY mission) / nullif(sum(c.passenger_hours ORDER BY mission), 0.0),
    sum(c.passenger_hours_outside ORDER BY mission) / nullif(sum(c.passenger_hours ORDER BY mission), 0.0),
    count(*),
    coalesce((SELECT max(run_id) FROM run), 0)
FROM classed AS c
JOIN hvac_design AS d USING (design_id)
JOIN comfort_window AS w USING (window_id)
GROUP BY c.design_id, c.window_id, c.controller, c.place";

/// What follows a profile is judged by all windows in a table of its own; the annual power is that of its own window.
pub const OUTSIDE: &str = "INSERT INTO control_outside
WITH monthly AS (
    SELECT
        o.design_id,
        o.profile_id,
        o.window_id,
        r.month,
        sum(o.passenger_hours_outside ORDER BY r.mission)
            / nullif(sum(r.passenger_hours ORDER BY r.mission), 0.0) AS outside
    FROM controlled_outside AS o
    JOIN controlled_mission AS r ON r.source_file_id = o.source_file_id AND r.design_id = o.design_id
        AND r.window_id = o.profile_id AND r.controller = 'extracted'
    GROUP BY o.design_id, o.profile_id, o.window_id, r.month
),
annual AS (
    SELECT
        d.name AS design,
        p.pmv_min AS profile_pmv_min,
        p.pmv_max AS profile_pmv_max,
        w.pmv_limit,
        w.pmv_min,
        w.pmv_max,
        sum(m.outside * n.days ORDER BY month) / sum(CASE WHEN m.outside IS NOT NULL THEN n.days END) AS outside_fraction
    FROM monthly AS m
    JOIN month_weight AS n USING (month)
    JOIN hvac_design AS d USING (design_id)
    JOIN comfort_window AS w USING (window_id)
    JOIN comfort_window AS p ON p.window_id = m.profile_id
    GROUP BY m.design_id, m.profile_id, m.window_id
)
SELECT
    a.design, 'extracted', a.profile_pmv_min, a.profile_pmv_max, a.pmv_limit, a.pmv_min, a.pmv_max, c.mean_hvac_power_w,
    a.outside_fraction, c.run_id
FROM annual AS a
JOIN control_annual AS c ON c.design = a.design AND c.controller = 'extracted' AND c.pmv_min = a.profile_pmv_min
    AND c.pmv_max = a.profile_pmv_max
UNION ALL
SELECT
    design, controller, NULL, NULL, pmv_limit, pmv_min, pmv_max, mean_hvac_power_w, outside_fraction, run_id
FROM control_annual
WHERE controller NOT LIKE 'extracted%'";
