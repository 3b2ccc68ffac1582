//! Verification from outside: a sound database passes, and a row that somebody has changed is found.

use crate::common::Scratch;

fn solved() -> Scratch {
    let scratch = Scratch::demo(4);
    scratch.edit("study.toml", "{ from = 0.0, to = 2.0, step = 0.125 }", "[0.0, 0.5, 1.0]");
    for stage in ["ingest", "shade", "solve"] {
        scratch.expect(0, &[stage]);
    }
    scratch
}

#[test]
fn cli_a_sound_database_passes_and_the_result_is_stored() {
    let scratch = solved();
    let run = scratch.expect(0, &["verify", "--fraction", "1"]);
    assert!(run.stdout.contains("0 violations") && run.stdout.contains("power by the other method"), "{}", run.stdout);
    assert_eq!(scratch.query("SELECT violation_count FROM verification"), [["0"]]);
    let again = scratch.expect(0, &["verify", "--fraction", "0.1", "--seed", "7"]);
    assert!(again.stdout.contains("seed 7"), "{}", again.stdout);
    scratch.expect(2, &["verify", "--fraction", "1.5"]);
}

#[test]
fn cli_a_changed_row_is_found() {
    let scratch = solved();
    scratch.tamper(
        "UPDATE optimum_point SET air_unit_power_w = air_unit_power_w + 10 WHERE (sample_id, design_id, window_id) =
            (SELECT sample_id, design_id, window_id FROM optimum_point WHERE air_unit_power_w > 100 LIMIT 1)",
    );
    let run = scratch.expect(1, &["verify", "--fraction", "1"]);
    assert!(run.stdout.contains("violated: power by the other method: sample "), "{}", run.stdout);
    assert!(run.stdout.contains("violated: parts of the power from heat and COP"), "{}", run.stdout);

    let scratch = solved();
    scratch.tamper(
        "UPDATE optimum_point SET cabin_k = cabin_k + 0.01 WHERE (sample_id, design_id, window_id) =
            (SELECT sample_id, design_id, window_id FROM optimum_point LIMIT 1)",
    );
    let run = scratch.expect(1, &["verify", "--fraction", "0"]);
    assert!(run.stdout.contains("violated: five balances of the exact model"), "{}", run.stdout);

    let scratch = solved();
    scratch.tamper(
        "DELETE FROM optimum_point WHERE sample_id = (SELECT min(sample_id) FROM optimum_point) AND window_id = 1",
    );
    let run = scratch.expect(1, &["verify", "--fraction", "0"]);
    assert!(run.stdout.contains("violated: all points of a sample there"), "{}", run.stdout);
}

#[test]
fn prop_the_papers_method_gives_the_same_study_within_its_door_law() {
    let scratch = solved();
    let powers = "SELECT hvac_power_w FROM annual_average ORDER BY design, pmv_limit";
    let fast = scratch.query(powers);
    scratch.expect(0, &["solve", "--method", "nlp"]);
    assert_eq!(scratch.query("SELECT DISTINCT method FROM optimum"), [["nlp"]]);
    let paper = scratch.query(powers);
    assert_eq!(fast.len(), paper.len());
    for (a, b) in fast.iter().zip(&paper) {
        let (a, b): (f64, f64) = (a[0].parse().unwrap(), b[0].parse().unwrap());
        assert!(a != b && (a - b).abs() < 1.0, "{a} {b}");
    }
    let worst = scratch.query("SELECT max(kkt_residual) FROM optimum");
    assert!(worst[0][0].parse::<f64>().unwrap() <= 1e-8, "{worst:?}");
    scratch.expect(0, &["verify", "--fraction", "0.2"]);
}
