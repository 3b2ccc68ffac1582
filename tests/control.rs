//! Setpoints for a controller on board, from the program outside.

mod common;

use common::Scratch;

/// A study of some missions of the year, solved.
fn solved() -> Scratch {
    let scratch = Scratch::small(24, "[0.5, 1.0]", "[]");
    scratch.expect(0, &["run"]);
    scratch
}

fn file(scratch: &Scratch, name: &str) -> toml::Table {
    toml::from_str(&scratch.read(&format!("setpoints/{name}"))).expect("a file of setpoints")
}

fn number(table: &toml::Table, key: &str) -> f64 {
    table[key].as_float().expect("a number")
}

#[test]
fn cli_profiles_cover_the_hours_that_they_claim() {
    let scratch = solved();
    let run = scratch.expect(0, &["control", "--coverage", "0.9"]);
    assert!(run.stdout.contains("hp+curtain within PMV -1 … 1, heating: "), "{}", run.stdout);
    assert!(run.stdout.contains("20 files in "), "{}", run.stdout);
    for limit in ["0.5", "1"] {
        let setup = file(&scratch, &format!("hp+curtain_pmv_-{limit}_{limit}.toml"));
        let heating = setup["heating"].as_table().expect("a profile");
        assert_eq!(heating["kind"].as_str(), Some("quadratic"));
        let c: Vec<f64> = heating["coefficients_c"]
            .as_array()
            .expect("three numbers")
            .iter()
            .filter_map(toml::Value::as_float)
            .collect();
        // Counted by the database, with its own weights.
        let count = |side: &str| {
            scratch.query(&format!(
                "SELECT sum(s.weight) FROM optimum AS o JOIN sample AS s USING (sample_id)
                 WHERE o.design = 'hp+curtain' AND o.pmv_limit = {limit} AND o.operating_mode = 1 AND {side}"
            ))[0][0]
                .parse::<f64>()
                .expect("a weight")
        };
        let setpoint = format!(
            "({} + {} * s.ambient_temperature_c + {} * s.ambient_temperature_c * s.ambient_temperature_c)",
            c[0], c[1], c[2]
        );
        let share = count(&format!("o.cabin_temperature_c <= {setpoint} + 2e-6")) / count("1");
        let claimed = number(heating, "coverage");
        assert!(claimed >= 0.9 && (share - claimed).abs() < 1e-6, "{limit}: {share} {claimed}");
        let curtains = setup["air_curtain"].as_array().expect("two modes");
        let heating = curtains[0].as_table().expect("a mode");
        assert_eq!(heating["mode"].as_str(), Some("heating"));
        assert!((number(heating, "on_above_difference_k") - number(heating, "analytic_difference_k")).abs() < 1.5);
    }
    // Every full degree, and a setpoint that does not fall.
    let csv = scratch.read("setpoints/hp_pmv_-1_1.csv");
    let setpoints: Vec<f64> = csv.lines().skip(1).filter_map(|l| l.split(',').nth(1)?.parse().ok()).collect();
    assert!(setpoints.len() > 10 && setpoints.is_sorted(), "{setpoints:?}");
    assert!(file(&scratch, "hp_pmv_-1_1.toml").get("air_curtain").is_none());
    assert!(file(&scratch, "ptc+rh_pmv_-1_1.toml").get("radiant_heaters").is_some());
    let published = scratch.read("setpoints/published.csv");
    assert!(published.contains("\nvbz-18,-16,13.50,,\"VBZ"), "{published}");
    // The same bytes again.
    let before = scratch.read("setpoints/hp_pmv_-1_1.toml");
    scratch.expect(0, &["control", "--coverage", "0.9", "--threads", "1"]);
    assert_eq!(before, scratch.read("setpoints/hp_pmv_-1_1.toml"));
}

#[test]
fn cli_setpoints_are_those_of_fresh_optima() {
    let scratch = solved();
    scratch.expect(2, &["control", "--coverage", "0.2"]);
    scratch.edit("study.toml", "pmv_limits = [0.5, 1.0]", "pmv_limits = [0.5, 0.75]");
    let run = scratch.expect(3, &["control"]);
    assert!(
        run.stderr.contains("the optima are stale") && run.stderr.contains("run `busclimate solve` first"),
        "{}",
        run.stderr
    );
    assert!(!scratch.path("setpoints").exists());
    // A design that never cools has no cooling profile, and says so.
    scratch.edit("study.toml", "pmv_limits = [0.5, 0.75]", "pmv_limits = [3.0]");
    scratch.expect(0, &["run"]);
    let run = scratch.expect(0, &["control", "--to", "elsewhere"]);
    assert!(run.stdout.contains("no profile; "), "{}", run.stdout);
    assert!(scratch.path("elsewhere/hp_pmv_-3_3.csv").exists());
}
