//! Two databases or two runs: what differs, and what that does.

#![expect(clippy::unwrap_used, reason = "a test ends where something is not as expected")]

use crate::common::Scratch;

fn change_w(text: &str, design: &str) -> f64 {
    let line = text.lines().find(|l| l.starts_with(&format!("{design} "))).unwrap();
    line.split_whitespace().rev().nth(1).unwrap().parse().unwrap()
}

#[test]
fn cli_databases_are_compared_by_settings_inputs_samples_and_averages() {
    let scratch = Scratch::small(6, "[1.0]", "[]");
    scratch.expect(0, &["run"]);
    std::fs::copy(scratch.path("study.db"), scratch.path("before.db")).unwrap();
    let same = scratch.expect(0, &["compare", "before.db", "study.toml"]);
    assert!(same.stdout.contains("settings and inputs are the same"), "{}", same.stdout);
    assert!(same.stdout.contains("0 with other disturbances, 0 only in A, 0 only in B"), "{}", same.stdout);

    scratch.edit("study.toml", "[simulation]", "metabolic_rate_met = 1.4\n\n[simulation]");
    let gone = scratch.missions()[0].clone();
    std::fs::remove_file(scratch.path("ztbus").join(&gone)).unwrap();
    scratch.expect(0, &["run", "--forget-missing"]);
    let differs = scratch.expect(1, &["compare", "before.db", "."]);
    assert!(differs.stdout.contains("setting vehicle.metabolic_rate_met: 1.2 → 1.4"), "{}", differs.stdout);
    assert!(differs.stdout.contains(&format!("input ztbus/{gone}: ")), "{}", differs.stdout);
    assert!(differs.stdout.contains(" → –"), "{}", differs.stdout);
    assert!(differs.stdout.contains(": only in the first"), "{}", differs.stdout);
    let annual = |database: &str| -> f64 {
        let sql = "SELECT hvac_power_w FROM annual_average WHERE design = 'ptc'";
        scratch.query_of(database, sql)[0][0].parse().unwrap()
    };
    let change = annual("study.db") - annual("before.db");
    assert!(change < -100.0 && (change_w(&differs.stdout, "ptc") - change).abs() < 0.01, "{}", differs.stdout);

    let csv = scratch.expect(1, &["compare", "before.db", "study.db", "--format", "csv"]).stdout;
    let mut reader = csv::Reader::from_reader(csv.as_bytes());
    let rows: Vec<csv::StringRecord> = reader.records().map(|r| r.unwrap()).collect();
    assert!(rows.iter().all(|r| r.len() == 8));
    let ptc = rows.iter().find(|r| &r[0] == "hvac_power_w" && &r[2] == "ptc").unwrap();
    assert!((ptc[7].parse::<f64>().unwrap() - change).abs() < 1e-9);
    // What is no database and no study is said.
    let refused = scratch.expect(2, &["compare", "before.db", "nothing.db"]);
    assert!(refused.stderr.contains("there is no nothing.db; name a database"), "{}", refused.stderr);
}

#[test]
fn cli_a_number_is_followed_through_the_runs() {
    let scratch = Scratch::small(6, "[1.0]", "[]");
    let held_back = scratch.missions()[3].clone();
    std::fs::rename(scratch.path("ztbus").join(&held_back), scratch.path(&held_back)).unwrap();
    scratch.expect(0, &["run"]);
    // A night with a mission more, a night without news, a night with another setting.
    std::fs::rename(scratch.path(&held_back), scratch.path("ztbus").join(&held_back)).unwrap();
    scratch.expect(0, &["run"]);
    scratch.expect(0, &["run"]);
    scratch.edit("study.toml", "[simulation]", "metabolic_rate_met = 1.3\n\n[simulation]");
    scratch.expect(0, &["run"]);

    let changed = |from: &str, to: &str| scratch.run(&["compare", "study.db", "--runs", from, to]);
    let night = changed("1", "2");
    assert!(night.stdout.contains(&format!("run 2, input ztbus/{held_back}: – → ")), "{}", night.stdout);
    assert!(night.stdout.contains("run 2, samples samples: "), "{}", night.stdout);
    assert!(!night.stdout.contains("metabolic"), "{}", night.stdout);
    let quiet = changed("2", "3");
    assert_eq!(quiet.status, 0, "{}", quiet.stdout);
    assert_eq!(change_w(&quiet.stdout, "hp"), 0.0);
    let setting = changed("3", "4");
    assert_eq!(setting.status, 1);
    assert!(setting.stdout.contains("run 4, setting vehicle.metabolic_rate_met: 1.2 → 1.3"), "{}", setting.stdout);
    assert!(!setting.stdout.contains("input"), "{}", setting.stdout);
    let all = changed("1", "4");
    let sum = change_w(&night.stdout, "hp") + change_w(&setting.stdout, "hp");
    assert!((change_w(&all.stdout, "hp") - sum).abs() < 0.02, "{}", all.stdout);
    assert_eq!(scratch.query("SELECT DISTINCT run_id FROM annual_history ORDER BY 1").concat(), ["1", "2", "4"]);
    let unknown = scratch.expect(2, &["compare", "study.db", "--runs", "2", "9"]);
    assert!(unknown.stderr.contains("name two of 1 … 4"), "{}", unknown.stderr);
}
