//! What a job's owner is told: how runs ended and why, what is pending, what is late, in words, JSON and metrics.

#![expect(clippy::unwrap_used, reason = "a test ends where something is not as expected")]

use crate::common::Scratch;
use std::collections::BTreeMap;

fn small() -> Scratch {
    Scratch::small(4, "[0.5, 1.0]", "[1.0]")
}

fn status(scratch: &Scratch, exit: i32) -> serde_json::Value {
    serde_json::from_str(&scratch.expect(exit, &["status", "--json"]).stdout).unwrap()
}

/// The values of a metrics file by name and labels.
fn metrics(text: &str) -> BTreeMap<String, f64> {
    assert!(text.ends_with("# EOF\n"), "{text}");
    let samples = text.lines().filter(|line| !line.starts_with('#'));
    samples.map(|line| line.rsplit_once(' ').unwrap()).map(|(name, v)| (name.to_owned(), v.parse().unwrap())).collect()
}

#[test]
fn cli_status_metrics_and_log_say_how_a_run_ended() {
    let scratch = small();
    let run = scratch.expect(0, &["run", "--log", "json", "--metrics", "night.prom"]);
    let lines: Vec<serde_json::Value> = run.stderr.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    for stage in ["ingest", "shade", "solve", "simulate", "control", "report"] {
        let line = lines.iter().find(|line| line["stage"] == stage).unwrap();
        assert!(line["run_id"] == 1 && line["duration_s"].is_f64() && line["computed"].as_u64() > Some(0), "{line}");
    }
    let end = lines.iter().find(|line| line["message"] == "run ended").unwrap();
    assert!(end["run_id"] == 1 && end["pending"] == 0 && end["points"] == end["solved"], "{end}");

    let values = metrics(&scratch.read("night.prom"));
    let points = end["points"].as_f64().unwrap();
    let value = |name: &str| values[&format!("busclimate_{name}")];
    assert_eq!(value("points{study=\"demo\",state=\"solved\"}"), points);
    assert_eq!(value("stage_computed{study=\"demo\",stage=\"solve\"}"), points);
    assert_eq!(value("last_run_status{study=\"demo\",status=\"done\"}"), 1.0);
    let newest = scratch.query("SELECT unixepoch(max(last_utc)) FROM source_file WHERE kind = 'mission'");
    assert_eq!(value("newest_mission_timestamp_seconds{study=\"demo\"}").to_string(), newest[0][0]);
    let now = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).unwrap().as_secs_f64();
    assert!((now - value("last_success_timestamp_seconds{study=\"demo\"}")).abs() < 600.0);

    let said = status(&scratch, 0);
    assert_eq!(said["last_stages"].as_array().unwrap().len(), 6);
    assert!(said["last_success_utc"].is_string() && said["newest_mission_utc"].is_string(), "{said}");

    // A run that fails says why, in the record and to the monitoring, and the last success stays.
    std::fs::rename(scratch.path("weather"), scratch.path("away")).unwrap();
    scratch.expect(3, &["run", "--metrics", "night.prom"]);
    let failed = status(&scratch, 6);
    assert_eq!(failed["last_run"]["status"], "failed");
    assert!(failed["last_run"]["reason"].as_str().unwrap().contains("weather"), "{failed}");
    assert_eq!(failed["last_success_utc"], said["last_success_utc"]);
    assert!(scratch.expect(6, &["status"]).stdout.contains("failed: "));
    let values = metrics(&scratch.read("night.prom"));
    assert_eq!(values["busclimate_last_run_status{study=\"demo\",status=\"failed\"}"], 1.0);
    // The database is complete all the same.
    scratch.expect(0, &["report"]);
    std::fs::rename(scratch.path("away"), scratch.path("weather")).unwrap();
    scratch.expect(0, &["run"]);
    assert_eq!(status(&scratch, 0)["last_run"]["reason"], serde_json::Value::Null);
}

#[test]
fn cli_what_is_pending_is_said_with_a_status_of_its_own() {
    let scratch = small();
    scratch.expect(0, &["run"]);
    let averages = "SELECT * FROM annual_average";
    let before = scratch.query(averages);
    let mission = format!("ztbus/{}", scratch.missions()[0]);
    let text = scratch.read(&mission);
    scratch.write(&mission, text.replace(",1,1,1,", ",0,1,1,"));
    scratch.expect(0, &["ingest"]);
    scratch.expect(0, &["shade"]);
    // As a run that was killed here leaves it.
    scratch
        .tamper("UPDATE run SET status = 'running', finished_utc = NULL WHERE run_id = (SELECT max(run_id) FROM run)");
    let said = status(&scratch, 6);
    assert_eq!(said["last_run"]["status"], "interrupted");
    assert!(said["pending"].as_u64() > Some(0), "{said}");
    assert!(before == scratch.query(averages), "readers see a part of the study");
    let report = scratch.expect(6, &["report"]);
    assert!(report.stdout.contains(" pending: the averages are those of the last time"), "{}", report.stdout);
    scratch.expect(0, &["run"]);
    scratch.expect(0, &["status"]);
    assert!(before != scratch.query(averages));
}

#[test]
fn cli_late_and_half_copied_data_are_news() {
    let scratch = small();
    scratch.edit("study.toml", "# expect_newest_within_hours = 36", "expect_newest_within_hours = 36");
    let run = scratch.expect(1, &["run"]);
    assert!(
        run.stderr.contains("WARN the newest mission ends ") && run.stderr.contains("last 36 hours"),
        "{}",
        run.stderr
    );
    assert!(!run.stderr.contains("half copied"));
    // What is expected changes no result.
    let report = scratch.report();
    scratch.edit("study.toml", "expect_newest_within_hours = 36", "expect_newest_within_hours = 1e6");
    scratch.expect(0, &["run"]);
    assert!(report == scratch.report());
    let newest = format!("ztbus/{}", scratch.missions().last().unwrap());
    let text = scratch.read(&newest);
    let lines: Vec<&str> = text.lines().collect();
    scratch.write(&newest, lines[..lines.len() - 4000].join("\n"));
    let run = scratch.expect(1, &["run"]);
    assert!(run.stderr.contains("the newest mission may be half copied: ztbus/"), "{}", run.stderr);
    std::fs::remove_file(scratch.path(&newest)).unwrap();
    let run = scratch.expect(0, &["run", "--forget-missing"]);
    assert!(run.stderr.contains("WARN missions are no longer there") && run.stderr.contains(&newest), "{}", run.stderr);
    scratch.edit("study.toml", "expect_newest_within_hours = 1e6", "expect_newest_within_hours = -1");
    let run = scratch.expect(2, &["run"]);
    assert!(run.stderr.contains("[missions] expect_newest_within_hours = -1 must be"), "{}", run.stderr);
}
