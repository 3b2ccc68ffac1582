//! Averages of the last complete stage: renewed in the transaction that completes it, so that readers never see one of a
//! half-computed study. Sums go by missions and months, not by the ids of rows, which tell in what order things came.

use sqlx::Row;
use sqlx::sqlite::SqliteConnection;

use crate::checks::{commit, seal_averages};
use crate::row::begin;
use crate::stages::{RecordedStage, StageRecord, record_stage};
use crate::{ControlTrace, Energy, SetpointRow, Store, StoreError, StoredGrid, control_views, energy, setpoints};

/// The months whose samples, designs or windows have changed.
const MONTHLY: &str = "INSERT INTO monthly_average
SELECT
    d.name,
    w.pmv_limit,
    w.pmv_min,
    w.pmv_max,
    s.month,
    avg(p.air_unit_power_w + p.radiant_heater_power_w + p.air_curtain_power_w),
    -- Heaters and curtain count to the side on which the air unit works; alone they heat.
    avg(CASE WHEN p.operating_mode >= 0
        THEN p.air_unit_power_w + p.radiant_heater_power_w + p.air_curtain_power_w
        WHEN p.operating_mode < 0 THEN 0.0 END),
    avg(CASE WHEN p.operating_mode < 0
        THEN p.air_unit_power_w + p.radiant_heater_power_w + p.air_curtain_power_w
        WHEN p.operating_mode >= 0 THEN 0.0 END),
    count(*),
    sum(p.status <> 0),
    -- A binding limit is met to rounding; the next state inside is many orders of magnitude away.
    sum(p.status = 0 AND p.pmv < w.pmv_min + 1e-6),
    sum(p.status = 0 AND p.pmv > w.pmv_max - 1e-6),
    sum(p.status = 0 AND p.operating_mode = 1),
    sum(p.status = 0 AND p.operating_mode = -1),
    sum(p.status = 0 AND p.outside_standard_range),
    coalesce((SELECT max(run_id) FROM run), 0)
FROM hourly_sample AS s
-- Samples in the order of their ids, whatever the planner knows of the tables: sums depend on it in their last digits.
CROSS JOIN optimum_point AS p USING (sample_id)
CROSS JOIN hvac_design AS d USING (design_id)
CROSS JOIN comfort_window AS w USING (window_id)
WHERE s.month IN (SELECT month FROM stale_month)
GROUP BY p.design_id, p.window_id, s.month";

/// From all months; a sample weighs 1/N · days/365 (paper, eq. meanPower), renormalised over the months present.
const ANNUAL: &str = "INSERT INTO annual_average
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
const HISTORY: &str = "INSERT OR REPLACE INTO annual_history
SELECT run_id, design, pmv_limit, pmv_min, pmv_max, hvac_power_w, sample_count, unsolved_count
FROM annual_average WHERE run_id IN (SELECT run_id FROM run)";

/// In which share of the solved year a limit of comfort binds, and the air unit cools.
const LIMIT_SHARE: &str = "INSERT INTO limit_share
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
const ANNUAL_ENERGY: &str = "INSERT INTO annual_energy
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
const UNMET_DEMAND: &str = "INSERT INTO unmet_demand
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

/// The months whose simulations have changed.
const SIMULATION_MONTH: &str = "INSERT INTO simulation_month
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
const SIMULATION_ANNUAL: &str = "INSERT INTO simulation_annual
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

const SIMULATION_CLASS_MONTH: &str = "INSERT INTO simulation_class_month
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

const SIMULATION_CLASS: &str = "INSERT INTO simulation_class
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

/// Months by their days, within a month every second alike, for votes every passenger-second.
const CONTROL_ANNUAL: &str = "INSERT INTO control_annual
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

const CONTROL_CLASS: &str = "INSERT INTO control_class
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
const CONTROL_OUTSIDE: &str = "INSERT INTO control_outside
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

impl Store {
    /// Completes the optima: renews the averages of the months that have changed, and records the stage.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn complete_optima(
        &mut self,
        record: &StageRecord,
        grid: &StoredGrid,
        energy: &Energy,
    ) -> Result<(), StoreError> {
        let renew = [
            "DELETE FROM monthly_average WHERE month IN (SELECT month FROM stale_month)",
            MONTHLY,
            "DELETE FROM annual_average",
            ANNUAL,
            HISTORY,
            "DELETE FROM limit_share",
            LIMIT_SHARE,
            "DELETE FROM annual_energy",
            ANNUAL_ENERGY,
            "DELETE FROM unmet_demand",
            UNMET_DEMAND,
            "DELETE FROM stale_month",
        ];
        self.complete(RecordedStage::Solve, record, &renew, Some((grid, energy)))
    }

    /// Completes the simulations: renews what they come to in the year and by class, and records the stage.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn complete_simulations(&mut self, record: &StageRecord) -> Result<(), StoreError> {
        let renew = [
            "DELETE FROM simulation_month WHERE month IN (SELECT month FROM stale_simulation_month)",
            SIMULATION_MONTH,
            "DELETE FROM simulation_annual",
            SIMULATION_ANNUAL,
            "DELETE FROM simulation_class_month WHERE month IN (SELECT month FROM stale_simulation_month)",
            SIMULATION_CLASS_MONTH,
            "DELETE FROM simulation_class",
            SIMULATION_CLASS,
            "DELETE FROM stale_simulation_month",
        ];
        self.complete(RecordedStage::Simulate, record, &renew, None)
    }

    /// Completes the missions under controllers: renews the setpoints that they follow, what they come to in the year and by
    /// class, and the mission that is shown in time, and records the stage.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn complete_controls(
        &mut self,
        record: &StageRecord,
        rows: &[SetpointRow],
        traces: &[ControlTrace],
    ) -> Result<(), StoreError> {
        let renew = [
            "DELETE FROM control_annual",
            CONTROL_ANNUAL,
            "DELETE FROM control_class",
            CONTROL_CLASS,
            "DELETE FROM control_outside",
            CONTROL_OUTSIDE,
        ];
        self.drive(async |c| {
            let mut tx = begin(c).await?;
            let run_id = last_run(&mut tx).await?;
            setpoints::put(&mut tx, run_id, rows).await?;
            control_views::put_traces(&mut tx, run_id, traces).await?;
            for sql in renew {
                execute(&mut tx, sql).await?;
            }
            describe(&mut tx).await?;
            seal_averages(&mut tx).await?;
            record_stage(&mut tx, RecordedStage::Control, record).await?;
            commit(tx).await
        })
    }

    fn complete(
        &mut self,
        stage: RecordedStage,
        record: &StageRecord,
        renew: &[&'static str],
        energy: Option<(&StoredGrid, &Energy)>,
    ) -> Result<(), StoreError> {
        self.drive(async |c| {
            let mut tx = begin(c).await?;
            if let Some((grid, energy)) = energy {
                let run_id = last_run(&mut tx).await?;
                energy::put(&mut tx, run_id, grid, energy).await?;
            }
            for &sql in renew {
                execute(&mut tx, sql).await?;
            }
            describe(&mut tx).await?;
            seal_averages(&mut tx).await?;
            record_stage(&mut tx, stage, record).await?;
            commit(tx).await
        })
    }
}

/// Tells the planner how large tables are: without it a question about a year's optima and samples takes twenty times as long.
async fn describe(c: &mut SqliteConnection) -> Result<(), StoreError> {
    execute(c, "PRAGMA analysis_limit = 1000").await?;
    execute(c, "ANALYZE").await
}

async fn last_run(c: &mut SqliteConnection) -> Result<i64, StoreError> {
    Ok(sqlx::query("SELECT coalesce(max(run_id), 0) FROM run").fetch_one(c).await?.try_get(0)?)
}

async fn execute(c: &mut SqliteConnection, sql: &'static str) -> Result<(), StoreError> {
    sqlx::query(sql).execute(c).await?;
    Ok(())
}
