//! What simulated missions come to in each month and in the year, and by class.

/// The months whose simulations have changed.
pub const MONTH: &str = "INSERT INTO simulation_month
SELECT
    design_id,
    window_id,
    controller,
    month,
    sum(mean_hvac_power_w * seconds ORDER BY mission) / sum(seconds),
    sum(static_mean_hvac_power_w * seconds ORDER BY mission) / sum(seconds),
    sum(saturated_fraction * seconds ORDER BY mission) / sum(seconds),
    count(*)
FROM simulated_mission
WHERE month IN (SELECT month FROM stale_simulation_month)
GROUP BY design_id, window_id, controller, month";

/// Months by their days, within a month every second alike.
pub const ANNUAL: &str = "INSERT INTO simulation_annual
SELECT
    d.name,
    w.pmv_limit,
    w.pmv_min,
    w.pmv_max,
    m.controller,
    sum(m.power_w * n.days ORDER BY month) / sum(n.days),
    sum(m.static_power_w * n.days ORDER BY month) / sum(n.days),
    sum(m.saturated_fraction * n.days ORDER BY month) / sum(n.days),
    sum(m.mission_count),
    coalesce((SELECT max(run_id) FROM run), 0)
FROM simulation_month AS m
JOIN month_weight AS n USING (month)
JOIN hvac_design AS d USING (design_id)
JOIN comfort_window AS w USING (window_id)
GROUP BY m.design_id, m.window_id, m.controller";

pub const CLASS_MONTH: &str = "INSERT INTO simulation_class_month
WITH classed AS (
    SELECT
        r.design_id,
        r.window_id,
        r.mission,
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
        AND r.month IN (SELECT month FROM stale_simulation_month)
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
    design_id,
    window_id,
    sorting * 100 + place,
    month,
    sorted_by,
    class,
    count(*),
    sum(seconds),
    sum(mean_hvac_power_w * seconds ORDER BY mission),
    sum(static_mean_hvac_power_w * seconds ORDER BY mission),
    sum(warm_w * seconds ORDER BY mission),
    sum(saturated_fraction * seconds ORDER BY mission),
    sum(max_abs_pmv_15min ORDER BY mission),
    count(max_abs_pmv_15min)
FROM all_classed
GROUP BY design_id, window_id, sorting, place, month";

pub const CLASS: &str = "INSERT INTO simulation_class
SELECT
    d.name,
    w.pmv_limit,
    w.pmv_min,
    w.pmv_max,
    m.sorted_by,
    m.class,
    m.class_order,
    sum(m.mission_count),
    sum(m.power_ws ORDER BY month) / sum(m.seconds),
    sum(m.static_ws ORDER BY month) / sum(m.seconds),
    sum(m.warm_ws ORDER BY month) / sum(m.seconds),
    sum(m.vote_sum ORDER BY month) / nullif(sum(m.vote_count), 0),
    sum(m.saturated_s ORDER BY month) / sum(m.seconds),
    coalesce((SELECT max(run_id) FROM run), 0)
FROM simulation_class_month AS m
JOIN hvac_design AS d USING (design_id)
JOIN comfort_window AS w USING (window_id)
GROUP BY m.design_id, m.window_id, m.class_order";
