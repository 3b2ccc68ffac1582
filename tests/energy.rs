//! Where the year's energy goes: classes, heat flows and power limits beside the optima themselves.

#![expect(clippy::unwrap_used, reason = "a test ends where something is not as expected")]

use crate::common::Scratch;
use pipeline::{Point, show};
use study::Study;

fn number(text: &str) -> f64 {
    text.parse().unwrap()
}

fn close(a: f64, b: f64, tolerance: f64) -> bool {
    (a - b).abs() <= tolerance * a.abs().max(1.0)
}

/// The rows of two queries: as many, the first columns alike, the last ones to rounding.
fn alike(scratch: &Scratch, names: usize, one: &str, other: &str) {
    let (rows, others) = (scratch.query(one), scratch.query(other));
    assert!(!rows.is_empty() && rows.len() == others.len(), "{} and {} rows: {one}", rows.len(), others.len());
    for (row, other) in rows.iter().zip(&others) {
        assert_eq!(row[..names], other[..names], "{one}");
        for (a, b) in row[names..].iter().zip(&other[names..]) {
            assert!(close(number(a), number(b), 1e-11), "{row:?} {other:?}");
        }
    }
}

#[test]
fn prop_classes_are_sums_of_optima() {
    let scratch = Scratch::small(24, "[0.0, 0.5, 1.0]", "[]");
    scratch.expect(0, &["run"]);
    let weights = scratch.query(
        "SELECT sorted_by, design, pmv_limit, sum(weight) FROM energy_class GROUP BY design, pmv_limit, sorted_by",
    );
    assert_eq!(weights.len(), 5 * 3 * 7);
    assert!(weights.iter().all(|w| close(number(&w[3]), 1.0, 1e-12)), "{weights:?}");
    let of = |kind: &str, class: &str| {
        let stored = format!(
            "SELECT design, class, sample_count, weight, hvac_power_w, kwh_per_km, vehicle_power_share FROM energy_class
             WHERE sorted_by = '{kind}' AND pmv_limit = 0.5 ORDER BY design, class"
        );
        let summed = format!(
            "SELECT design, {class} AS class, count(*), sum(weight), sum(weight * hvac_power_w) / sum(weight),
                sum(weight * hvac_power_w * duration_s) / sum(weight * distance_m) / 3600.0,
                sum(weight * hvac_power_w) / sum(weight * vehicle_power_w)
             FROM optimum JOIN sample USING (sample_id) WHERE pmv_limit = 0.5 GROUP BY design, class ORDER BY design, class"
        );
        alike(&scratch, 3, &stored, &summed);
    };
    of("year", "'all'");
    of("month", "printf('%02d', month)");
    of("local hour", "printf('%02d', local_hour)");
    of("route", "coalesce(route, 'none')");
    of(
        "weekday",
        "CASE weekday WHEN 1 THEN 'Monday' WHEN 2 THEN 'Tuesday' WHEN 3 THEN 'Wednesday' WHEN 4 THEN 'Thursday'
        WHEN 5 THEN 'Friday' WHEN 6 THEN 'Saturday' ELSE 'Sunday' END",
    );
    let power = "SELECT design, pmv_limit, hvac_power_w FROM annual_average ORDER BY 1, 2";
    alike(
        &scratch,
        2,
        power,
        "SELECT design, pmv_limit, hvac_power_w FROM energy_class WHERE sorted_by = 'year' ORDER BY 1, 2",
    );
    alike(
        &scratch,
        2,
        power,
        "SELECT design, pmv_limit, kwh_per_operating_hour * 1000 FROM annual_energy ORDER BY 1, 2",
    );
    // Local time: Zurich is one hour ahead of UTC, two in summer.
    let clock = scratch.query(
        "SELECT count(*) FROM sample WHERE local_hour <> (CAST(strftime('%H', start_utc) AS INTEGER)
            + CASE WHEN month IN (11, 12, 1, 2) THEN 1 WHEN month BETWEEN 4 AND 9 THEN 2 ELSE
                (local_hour - CAST(strftime('%H', start_utc) AS INTEGER) + 24) % 24 END) % 24
            OR weekday <> (CAST(strftime('%w', start_utc, '+' || ((local_hour -
                CAST(strftime('%H', start_utc) AS INTEGER) + 24) % 24) || ' hours') AS INTEGER) + 6) % 7 + 1",
    );
    assert_eq!(clock, [["0"]]);
    // No vote lies outside its window.
    let outside =
        "SELECT count(*) FROM pmv_histogram WHERE bin_from < pmv_min - 0.1 + 1e-9 OR bin_to > max(pmv_max, 0.1) + 1e-9";
    assert_eq!(scratch.query(outside), [["0"]]);
}

#[test]
fn prop_heat_flows_are_those_of_the_model() {
    let scratch = Scratch::small(12, "[0.0, 1.0]", "[]");
    scratch.expect(0, &["run"]);
    let study = Study::open(&scratch.path("study.toml"), None).unwrap();
    let columns = "cabin_to_shell_w, interior_to_cabin_w, shell_to_ambient_w, heater_to_cabin_w, through_shell_w,
        shell_radiation_w, heater_to_shell_w, heater_to_interior_w, interior_to_shell_w, door_w, passengers_w, other_w,
        air_unit_heat_w, radiant_heater_power_w, solar_interior_w, solar_shell_inside_w, solar_shell_outside_w";
    let samples = scratch.query("SELECT sample_id FROM sample WHERE sample_id % 7 = 0 ORDER BY sample_id");
    assert!(samples.len() > 3, "{samples:?}");
    for (sample, design) in samples.iter().flat_map(|s| [(&s[0], "ptc+rh"), (&s[0], "hp+curtain")]) {
        let point = Point { sample: sample.parse().unwrap(), design: design.to_owned(), pmv_limit: 1.0 };
        let (_, flows) = show(&study, &point).unwrap().best.unwrap();
        let sql = format!(
            "SELECT {columns} FROM heat_flow WHERE sample_id = {sample} AND design = '{design}' AND pmv_limit = 1.0"
        );
        for ((name, _, flow_w), stored) in flows.named_w().iter().zip(&scratch.query(&sql)[0]) {
            assert!(close(*flow_w, number(stored), 1e-6), "{sample} {design} {name}: {flow_w} and {stored}");
        }
    }
    let means: Vec<String> = columns.split(',').map(|c| format!("avg({})", c.trim())).collect();
    let of_points = format!(
        "SELECT design, pmv_limit, month, count(*), {} FROM heat_flow JOIN sample USING (sample_id)
         GROUP BY design, pmv_limit, month ORDER BY 1, 2, 3",
        means.join(", ")
    );
    let stored =
        format!("SELECT design, pmv_limit, month, sample_count, {columns} FROM heat_flow_monthly ORDER BY 1, 2, 3");
    let (rows, others) = (scratch.query(&of_points), scratch.query(&stored));
    assert_eq!(rows.len(), others.len());
    for (a, b) in rows.iter().zip(&others).flat_map(|(row, other)| row[3..].iter().zip(&other[3..])) {
        assert!(close(number(a), number(b), 1e-6), "{a} {b}");
    }
}

#[test]
fn prop_unmet_demand_follows_the_limits_of_the_vehicle() {
    let scratch = Scratch::small(12, "[0.0, 1.0]", "[]");
    scratch.expect(0, &["run"]);
    let counted = |limit: &str| {
        format!(
            "SELECT design, pmv_limit, sum(over), total(weight * over), sum(weight * over * abs(air_unit_heat_w) * (1 - {limit} /
                max(air_unit_power_w, 1.0)))
             FROM (SELECT o.*, s.weight, air_unit_power_w > {limit} AS over FROM optimum AS o JOIN sample AS s USING (sample_id))
             WHERE design = 'hp' GROUP BY design, pmv_limit ORDER BY pmv_limit"
        )
    };
    let stored = "SELECT design, pmv_limit, over_limit_count, over_limit_weight, unmet_heat_w FROM unmet_demand
        WHERE design = 'hp' ORDER BY pmv_limit";
    alike(&scratch, 3, stored, &counted("12000.0"));
    // Another limit asks for no optimum anew.
    scratch.edit("study.toml", "[dynamics]", "[dynamics]\nheat_pump_limit_w = 5000.0\ncooling_limit_w = 5000.0");
    let run = scratch.expect(0, &["solve"]);
    assert!(run.stderr.contains(" 0 points computed now"), "{}", run.stderr);
    alike(&scratch, 3, stored, &counted("5000.0"));
}

#[test]
fn prop_another_clock_asks_for_other_classes_and_for_no_optimum() {
    let scratch = Scratch::small(12, "[1.0]", "[]");
    scratch.expect(0, &["run"]);
    let classes = "SELECT sorted_by, class, weight, hvac_power_w FROM energy_class ORDER BY design, sorted_by, class_order, class";
    let before = scratch.query(classes);
    // An hour behind: months stay as they are, hours do not.
    scratch.edit("study.toml", "time_zone = \"Europe/Zurich\"", "time_zone = \"Europe/London\"");
    let run = scratch.expect(0, &["run"]);
    assert!(run.stderr.contains(" 0 points computed now"), "{}", run.stderr);
    let after = scratch.query(classes);
    scratch.expect(0, &["run", "--db", "fresh.db"]);
    assert!(after == scratch.query_of("fresh.db", classes), "classes of the old clock");
    assert!(after != before, "the clock changed nothing");
}
