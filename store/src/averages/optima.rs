//! What the optima come to in the year, from the averages of its months.

/// From all months; a sample weighs 1/N · days/365 (paper, eq. meanPower), renormalised over the months present.
pub const ANNUAL: &str = "INSERT INTO annual_average
WITH month_days (month, days) AS (
    VALUES (1, 31), (2, 28), (3, 31), (4, 30), (5, 31), (6, 30), (7, 31), (8, 31), (9, 30), (10, 31), (11, 30), (12, 31)
),
present AS (
    SELECT month, days, CAST(days AS REAL) / sum(days) OVER () / sample_count AS sample_weight
    FROM (SELECT month, max(sample_count) AS sample_count FROM monthly_average GROUP BY month) JOIN month_days USING (month)
),
annual AS (
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
    JOIN present AS w USING (month)
    GROUP BY m.design, m.pmv_min, m.pmv_max
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
    (r.hvac_power_w - a.hvac_power_w) / nullif(r.hvac_power_w, 0.0),
    coalesce((SELECT max(run_id) FROM run), 0)
FROM annual AS a
LEFT JOIN annual AS r ON r.design = 'ptc' AND r.pmv_min = a.pmv_min AND r.pmv_max = a.pmv_max";

/// What the run came to, for whoever asks later when a number moved.
pub const HISTORY: &str = "INSERT OR REPLACE INTO annual_history
SELECT run_id, design, pmv_limit, pmv_min, pmv_max, hvac_power_w, sample_count, unsolved_count
FROM annual_average WHERE run_id IN (SELECT run_id FROM run)";

/// Beside the intervals stand the figures that every other table has, to the last bit.
pub const ANNUAL_INTERVAL: &str = "UPDATE annual_interval AS i SET
    hvac_power_w = a.hvac_power_w,
    change_vs_pmv_1 = a.hvac_power_w / nullif(o.hvac_power_w, 0.0) - 1.0
FROM annual_average AS a
LEFT JOIN annual_average AS o ON o.design = a.design AND o.pmv_min = -1.0 AND o.pmv_max = 1.0
WHERE a.design = i.design AND a.pmv_min = i.pmv_min AND a.pmv_max = i.pmv_max";

pub const DESIGN_INTERVAL: &str = "UPDATE design_interval AS i SET
    other_takes_more_w = o.hvac_power_w - a.hvac_power_w,
    saving = (o.hvac_power_w - a.hvac_power_w) / nullif(o.hvac_power_w, 0.0)
FROM annual_average AS a
JOIN annual_average AS o ON o.pmv_min = a.pmv_min AND o.pmv_max = a.pmv_max
WHERE a.design = i.design AND o.design = i.other_design AND a.pmv_min = i.pmv_min AND a.pmv_max = i.pmv_max";

/// In which share of the solved year a limit of comfort binds, and the air unit cools.
pub const LIMIT_SHARE: &str = "INSERT INTO limit_share
SELECT
    m.design,
    m.pmv_limit,
    m.pmv_min,
    m.pmv_max,
    sum(m.sample_count - m.unsolved_count),
    sum(m.lower_count),
    sum(m.upper_count),
    sum(m.heating_count),
    sum(m.cooling_count),
    sum(m.lower_count * n.sample_weight ORDER BY m.month)
        / sum((m.sample_count - m.unsolved_count) * n.sample_weight ORDER BY m.month),
    sum(m.cooling_count * n.sample_weight ORDER BY m.month)
        / sum((m.sample_count - m.unsolved_count) * n.sample_weight ORDER BY m.month),
    sum(m.outside_range_count),
    max(a.run_id)
FROM monthly_average AS m
JOIN month_weight AS n USING (month)
JOIN annual_average AS a USING (design, pmv_min, pmv_max)
GROUP BY m.design, m.pmv_min, m.pmv_max
HAVING sum(m.sample_count - m.unsolved_count) > 0";

/// What a bus comes to in a year, at the hours that the missions show.
pub const ANNUAL_ENERGY: &str = "INSERT INTO annual_energy
WITH operation AS (
    SELECT
        sum(duration_s) / 3600.0 AS hours,
        count(DISTINCT bus || ' ' || substr(start_utc, 1, 7)) / 12.0 AS bus_years
    FROM mission_segment
)
SELECT
    c.design,
    c.pmv_limit,
    c.pmv_min,
    c.pmv_max,
    a.hvac_power_w / 1000.0,
    c.kwh_per_km,
    o.hours / o.bus_years,
    a.hvac_power_w / 1000.0 * o.hours / o.bus_years,
    c.vehicle_power_share,
    c.run_id
FROM energy_class AS c
JOIN annual_average AS a USING (design, pmv_min, pmv_max)
CROSS JOIN operation AS o
WHERE c.sorted_by = 'year'";

/// Months by their days, within a month all samples alike.
pub const UNMET_DEMAND: &str = "INSERT INTO unmet_demand
SELECT
    f.design,
    f.pmv_limit,
    f.pmv_min,
    f.pmv_max,
    l.heating_limit_w,
    l.cooling_limit_w,
    sum(f.over_limit_count),
    sum(f.over_limit_count * n.sample_weight ORDER BY f.month),
    sum(f.unmet_heat_w * f.sample_count * n.sample_weight ORDER BY f.month)
        / sum(f.sample_count * n.sample_weight ORDER BY f.month),
    a.unsolved_weight,
    a.run_id
FROM heat_flow_monthly AS f
JOIN month_weight AS n ON n.month = f.month
JOIN hvac_design AS d ON d.name = f.design
JOIN power_limit AS l USING (design_id)
JOIN annual_average AS a ON a.design = f.design AND a.pmv_min = f.pmv_min AND a.pmv_max = f.pmv_max
GROUP BY f.design, f.pmv_min, f.pmv_max";

/// Energy of the year times the user's prices. The reference is the first design that has figures; what is saved costs what
/// investment and maintenance take more a year, over the life of each. A design that saves nothing has no price of it.
pub const ECONOMICS: &str = "INSERT INTO economics
WITH cost AS (
    SELECT
        e.design,
        e.pmv_limit,
        e.pmv_min,
        e.pmv_max,
        i.design_order,
        i.currency,
        i.price_per_kwh,
        i.carbon_kg_per_kwh,
        e.kwh_per_bus_year AS kwh,
        i.investment / i.present_value_factor + i.maintenance_per_year AS fixed_per_year,
        i.investment + i.present_value_factor
            * (i.maintenance_per_year + e.kwh_per_bus_year * i.price_per_kwh) AS net_present_cost,
        e.run_id
    FROM annual_energy AS e
    JOIN economic_input AS i USING (design)
)
SELECT
    c.design,
    c.pmv_limit,
    c.pmv_min,
    c.pmv_max,
    c.currency,
    c.kwh,
    c.kwh * c.price_per_kwh,
    c.fixed_per_year + c.kwh * c.price_per_kwh,
    c.net_present_cost,
    c.kwh * c.carbon_kg_per_kwh,
    r.design,
    r.kwh - c.kwh,
    (r.kwh - c.kwh) * c.carbon_kg_per_kwh,
    c.fixed_per_year - r.fixed_per_year,
    CASE WHEN r.kwh > c.kwh THEN (c.fixed_per_year - r.fixed_per_year) / (r.kwh - c.kwh) END,
    CASE WHEN r.kwh > c.kwh AND c.fixed_per_year > r.fixed_per_year
        THEN (c.fixed_per_year - r.fixed_per_year) / (r.kwh - c.kwh) END,
    c.run_id
FROM cost AS c
JOIN cost AS r ON r.pmv_min = c.pmv_min AND r.pmv_max = c.pmv_max
WHERE r.design_order = (SELECT min(design_order) FROM economic_input)";

/// Points that lack heat, or whose back-up heater works: counts, shares of the year, and means over the limited ones. Windows of
/// designs without either have no row.
pub const LIMITED: &str = "INSERT INTO limited_annual
WITH limited AS (
    SELECT
        p.design_id,
        p.window_id,
        p.sample_id,
        p.unmet_heat_w,
        p.backup_heater_power_w,
        max(w.pmv_min - p.pmv, p.pmv - w.pmv_max) AS pmv_miss,
        n.sample_weight
    FROM optimum_point AS p
    JOIN hourly_sample AS s USING (sample_id)
    JOIN month_weight AS n ON n.month = s.month
    JOIN comfort_window AS w USING (window_id)
    WHERE p.status = 0 AND (p.unmet_heat_w > 0.0 OR p.backup_heater_power_w > 0.0)
)
SELECT
    d.name,
    w.pmv_limit,
    w.pmv_min,
    w.pmv_max,
    count(*) FILTER (WHERE l.unmet_heat_w > 0.0),
    coalesce(sum(l.sample_weight ORDER BY l.sample_id) FILTER (WHERE l.unmet_heat_w > 0.0), 0.0),
    coalesce(sum(l.unmet_heat_w * l.sample_weight ORDER BY l.sample_id) FILTER (WHERE l.unmet_heat_w > 0.0)
        / sum(l.sample_weight ORDER BY l.sample_id) FILTER (WHERE l.unmet_heat_w > 0.0), 0.0),
    max(l.unmet_heat_w),
    coalesce(sum(l.pmv_miss * l.sample_weight ORDER BY l.sample_id) FILTER (WHERE l.unmet_heat_w > 0.0)
        / sum(l.sample_weight ORDER BY l.sample_id) FILTER (WHERE l.unmet_heat_w > 0.0), 0.0),
    coalesce(max(l.pmv_miss) FILTER (WHERE l.unmet_heat_w > 0.0), 0.0),
    sum(l.backup_heater_power_w * l.sample_weight ORDER BY l.sample_id),
    (SELECT coalesce(max(run_id), 0) FROM run)
FROM limited AS l
JOIN hvac_design AS d USING (design_id)
JOIN comfort_window AS w USING (window_id)
GROUP BY l.design_id, l.window_id";
