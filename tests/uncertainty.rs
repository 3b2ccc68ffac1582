//! How sure a year is: intervals beside the figures that they belong to, and the year without a part of it.

#![expect(clippy::unwrap_used, reason = "a test ends where something is not as expected")]

use crate::common::Scratch;

fn numbers(row: &[String]) -> Vec<f64> {
    row.iter().map(|cell| cell.parse().unwrap()).collect()
}

/// Two rows to rounding.
fn close(row: &[f64], other: &[f64]) -> bool {
    row.iter().zip(other).all(|(a, b)| (a - b).abs() <= 1e-11 * a.abs().max(1.0))
}

#[test]
fn prop_intervals_hold_their_figures() {
    let scratch = Scratch::small(48, "[0.0, 0.5, 1.0]", "[]");
    scratch.expect(0, &["run"]);
    let rows = scratch.query(
        "SELECT i.hvac_power_low_w, i.hvac_power_w, i.hvac_power_high_w, i.heating_power_low_w, a.heating_power_w,
            i.heating_power_high_w, i.cooling_power_low_w, a.cooling_power_w, i.cooling_power_high_w, i.kwh_per_km_low,
            e.kwh_per_km, i.kwh_per_km_high, i.reduction_vs_ptc_low, a.reduction_vs_ptc, i.reduction_vs_ptc_high
         FROM annual_interval AS i JOIN annual_average AS a USING (design, pmv_min, pmv_max)
            JOIN annual_energy AS e USING (design, pmv_min, pmv_max) WHERE a.hvac_power_w = i.hvac_power_w",
    );
    assert_eq!(rows.len(), 15);
    for row in &rows {
        for ends in numbers(row).chunks_exact(3) {
            assert!(ends[0] <= ends[1] && ends[1] <= ends[2] && (ends[0] < ends[2] || ends[1] == 0.0), "{ends:?}");
        }
    }
    // What more comfort costs is that of the averages, and surer than what either takes: a cold year is cold for both.
    let costs = scratch.query(
        "SELECT i.change_vs_pmv_1_low, i.change_vs_pmv_1, i.change_vs_pmv_1_high, i.hvac_power_w / o.hvac_power_w - 1,
            (i.hvac_power_high_w - i.hvac_power_low_w) / o.hvac_power_w
         FROM annual_interval AS i JOIN annual_average AS o USING (design) WHERE o.pmv_limit = 1",
    );
    assert_eq!(costs.len(), 15);
    for row in costs.iter().map(|row| numbers(row)) {
        assert!(row[0] <= row[1] && row[1] <= row[2] && (row[1] - row[3]).abs() < 1e-12, "{row:?}");
        assert!(row[2] - row[0] < row[4], "{row:?}");
    }
    // What is saved is surer than what is taken: the weather of a drawn year is the same for both designs.
    let paired = scratch.query(
        "SELECT p.saving_high - p.saving_low, (a.hvac_power_high_w - a.hvac_power_low_w) / o.hvac_power_w
         FROM design_interval AS p JOIN annual_interval AS a USING (design, pmv_min, pmv_max)
         JOIN annual_interval AS o ON o.design = p.other_design AND o.pmv_min = p.pmv_min AND o.pmv_max = p.pmv_max
         WHERE p.design = 'hp' AND p.other_design = 'ptc'",
    );
    assert!(paired.iter().all(|row| numbers(row)[0] < 0.5 * numbers(row)[1]), "{paired:?}");
}

#[test]
fn prop_a_month_of_one_day_leaves_no_interval() {
    let scratch = Scratch::small(3, "[1.0]", "[]");
    scratch.expect(0, &["run"]);
    let rows = scratch.query("SELECT hvac_power_low_w, single_day_month_count FROM annual_interval");
    assert!(rows.len() == 5 && rows.iter().all(|row| row[0].is_empty() && row[1] != "0"), "{rows:?}");
    let page = scratch.read("report/report.md");
    assert!(!page.contains("90 % interval"), "{page}");
}

#[test]
fn prop_the_year_without_a_part_is_that_of_the_other_samples() {
    let scratch = Scratch::small(24, "[1.0]", "[]");
    scratch.expect(0, &["run"]);
    let left = |kind: &str, name: &str, others: &str| {
        let one = scratch.query(&format!(
            "SELECT design, sample_count, month_count, hvac_power_w FROM left_out WHERE kind = '{kind}' AND name = '{name}'
             ORDER BY design"
        ));
        let other = scratch.query(&format!(
            "SELECT design, sum(n), count(*), sum(days * mean) / sum(days) FROM (
                SELECT design, month, count(*) AS n, avg(hvac_power_w) AS mean
                FROM optimum JOIN sample USING (sample_id) WHERE {others} GROUP BY design, month
             ) JOIN month_weight USING (month) GROUP BY design ORDER BY design"
        ));
        assert!(one.len() == 5 && other.len() == 5, "{kind} {name}");
        for (row, other) in one.iter().zip(&other) {
            assert!(row[..3] == other[..3] && close(&numbers(&row[3..]), &numbers(&other[3..])), "{row:?} {other:?}");
        }
    };
    let routes = scratch.query("SELECT DISTINCT route FROM sample WHERE route IS NOT NULL ORDER BY 1");
    assert!(routes.len() > 2);
    for route in &routes {
        left("route", &route[0], &format!("coalesce(route, 'none') <> '{}'", route[0]));
    }
    left("month", "07", "month <> 7");
    // Of a single year nothing remains.
    assert!(scratch.query("SELECT * FROM left_out WHERE kind = 'year'").is_empty());
}

#[test]
fn prop_months_are_as_sure_as_their_days() {
    let scratch = Scratch::small(48, "[1.0]", "[]");
    scratch.expect(0, &["run"]);
    let stored = scratch.query(
        "SELECT month, sample_count, day_count, standard_error_w * standard_error_w FROM month_spread
         WHERE design = 'hp' AND effective_sample_count IS NOT NULL ORDER BY month",
    );
    // The synthetic missions of a month begin in it, one a day, and end before the next one.
    let summed = scratch.query(
        "WITH hour AS (
            SELECT month, mission, hvac_power_w, avg(hvac_power_w) OVER (PARTITION BY month) AS mean
            FROM optimum JOIN sample USING (sample_id) WHERE design = 'hp'
         ),
         day AS (SELECT month, mission, count(*) AS n, sum(hvac_power_w - mean) AS off FROM hour GROUP BY month, mission)
         SELECT month, sum(n), count(*), sum(off * off) / sum(n) / sum(n) * count(*) / (count(*) - 1.0) FROM day
         GROUP BY month HAVING count(*) > 1 ORDER BY month",
    );
    assert!(stored.len() > 6);
    for (row, other) in stored.iter().zip(&summed) {
        assert!(close(&numbers(row), &numbers(other)), "{row:?} {other:?}");
    }
}

#[test]
fn prop_intervals_of_driven_missions_hold_their_figures() {
    let scratch = Scratch::small(36, "[0.5, 1.0]", "[1.0]");
    scratch.expect(0, &["run"]);
    for kind in ["simulation", "control"] {
        let rows = scratch.query(&format!(
            "SELECT i.mean_hvac_power_low_w, a.mean_hvac_power_w, i.mean_hvac_power_high_w, i.relative_difference_low,
                a.mean_hvac_power_w / a.static_mean_hvac_power_w - 1, i.relative_difference_high
             FROM {kind}_interval AS i JOIN {kind}_annual AS a USING (design, pmv_min, pmv_max, controller)"
        ));
        let all = scratch.query(&format!("SELECT count(*) FROM {kind}_annual"));
        assert_eq!(rows.len().to_string(), all[0][0]);
        for row in &rows {
            let row = numbers(row);
            assert!(row[0] < row[1] && row[1] < row[2], "{kind} {row:?}");
            assert!(row[3] < row[4] && row[4] < row[5], "{kind} {row:?}");
            // Mission and optima are drawn together: how far they are apart is surer than either, where one follows the other.
            assert!(kind == "control" || row[5] - row[3] < (row[2] - row[0]) / row[1], "{kind} {row:?}");
        }
    }
}
