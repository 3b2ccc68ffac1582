//! Whole runs: what they store, what they compute again, and that nothing else shows in the results.

#![expect(clippy::unwrap_used, reason = "a test ends where something is not as expected")]

use crate::common::Scratch;

const SAMPLES: &str = "SELECT sample_id, mission, segment, start_utc, month, weight, ambient_temperature_c, dni_w_m2,
    dhi_w_m2, passengers, door_open_fraction, solar_altitude_deg, shadow_fraction FROM sample ORDER BY sample_id";
const OPTIMA: &str = "SELECT * FROM optimum ORDER BY sample_id, design, pmv_limit";

/// A study of 12 missions that is quick to solve.
fn small() -> Scratch {
    Scratch::small(12, "[0.0, 0.5, 1.0, 2.0]", "[1.0]")
}

fn number(text: &str) -> f64 {
    text.parse().unwrap()
}

#[test]
fn prop_a_second_run_computes_nothing_and_writes_the_same_bytes() {
    let scratch = small();
    scratch.expect(0, &["run"]);
    let (optima, report) = (scratch.query(OPTIMA), scratch.report());
    let again = scratch.expect(0, &["run"]);
    assert!(again.stderr.contains("0 read now") && again.stderr.contains(" 0 points computed now"), "{}", again.stderr);
    assert!(optima == scratch.query(OPTIMA));
    for (before, after) in report.iter().zip(scratch.report()) {
        assert!(*before == after, "{} differs", before.0);
    }
    let runs = scratch.query("SELECT status, point_count, solved_count, failed_count FROM run ORDER BY run_id");
    assert_eq!(runs.len(), 2);
    assert!(runs.iter().all(|r| r[0] == "done" && r[1] == r[2] && r[3] == "0"), "{runs:?}");
}

#[test]
fn prop_the_thread_count_shows_nowhere() {
    let scratch = small();
    scratch.expect(0, &["run", "--threads", "1"]);
    let (samples, optima, report) = (scratch.query(SAMPLES), scratch.query(OPTIMA), scratch.report());
    std::fs::remove_file(scratch.path("study.db")).unwrap();
    scratch.expect(0, &["run", "--threads", "2"]);
    assert!(samples == scratch.query(SAMPLES) && optima == scratch.query(OPTIMA));
    assert!(report == scratch.report());
}

#[test]
fn prop_stage_by_stage_is_the_same_as_all_at_once() {
    let scratch = small();
    scratch.expect(0, &["run"]);
    let report = scratch.report();
    std::fs::remove_file(scratch.path("study.db")).unwrap();
    for stage in ["ingest", "shade", "solve", "simulate", "control", "report"] {
        scratch.expect(0, &[stage]);
    }
    assert!(report == scratch.report());
}

#[test]
fn prop_permuting_and_packing_input_files_changes_nothing() {
    let scratch = small();
    scratch.expect(0, &["run"]);
    let (samples, optima) = (scratch.query(SAMPLES), scratch.query(OPTIMA));

    // The missions in a zip; the weather in two files, the later half first.
    scratch.zip_missions("missions.zip");
    let weather = scratch.read("weather/ogd-smn_sma_h_historical_2020-2029.csv");
    let (header, rows) = weather.split_once('\n').unwrap();
    let rows: Vec<&str> = rows.lines().collect();
    std::fs::create_dir(scratch.path("halves")).unwrap();
    for (name, half) in [("2", &rows[..4000]), ("1", &rows[4000..])] {
        scratch.write(&format!("halves/ogd-smn_sma_h_{name}.csv"), format!("{header}\n{}\n", half.join("\n")));
    }
    scratch.edit("study.toml", "path = \"ztbus\"", "path = \"missions.zip\"");
    scratch.edit("study.toml", "path = \"weather\"", "path = \"halves\"");
    std::fs::remove_file(scratch.path("study.db")).unwrap();
    scratch.expect(0, &["run"]);
    assert!(samples == scratch.query(SAMPLES), "the samples differ");
    assert!(optima == scratch.query(OPTIMA), "the optima differ");
}

#[test]
fn prop_a_change_reaches_what_depends_on_it_and_no_more() {
    let scratch = small();
    scratch.expect(0, &["run"]);
    let points: usize = scratch.query("SELECT count(*) FROM optimum")[0][0].parse().unwrap();

    // A mission that is to be forgotten takes its samples along; put back, it alone is computed.
    let name = scratch.missions().remove(3);
    let of_mission = format!("SELECT count(*) FROM sample WHERE source_path = 'ztbus/{name}'");
    let samples: usize = scratch.query(&of_mission)[0][0].parse().unwrap();
    let before = scratch.report();
    std::fs::rename(scratch.path("ztbus").join(&name), scratch.path("aside.csv")).unwrap();
    let without = scratch.expect(0, &["run", "--forget-missing"]);
    assert!(without.stderr.contains("1 no longer there") && without.stderr.contains(" 0 points computed now"));
    assert_eq!(scratch.query("SELECT count(*) FROM optimum")[0][0], (points - samples * 20).to_string());
    assert!(before != scratch.report());
    std::fs::rename(scratch.path("aside.csv"), scratch.path("ztbus").join(&name)).unwrap();
    let with = scratch.expect(0, &["run"]);
    assert!(with.stderr.contains(&format!("{} points computed now", samples * 20)), "{}", with.stderr);
    assert!(before == scratch.report());

    // A constant of the bus concerns every point, white space and the database's place none.
    scratch.edit("study.toml", "# air_velocity_m_s = 0.1", "air_velocity_m_s = 0.2");
    let changed = scratch.expect(0, &["run"]);
    assert!(changed.stderr.contains(&format!("{points} points computed now")), "{}", changed.stderr);
    scratch.edit("study.toml", "air_velocity_m_s = 0.2", "air_velocity_m_s   =   0.1 # as it was");
    scratch.expect(0, &["run"]);
    assert!(before == scratch.report());
}

#[test]
fn prop_weights_and_averages_are_those_of_the_samples() {
    let scratch = small();
    scratch.expect(0, &["run"]);
    let sum = number(&scratch.query("SELECT sum(weight) FROM sample")[0][0]);
    assert!((sum - 1.0).abs() < 1e-12, "{sum}");
    let rows = scratch.query(
        "SELECT a.hvac_power_w, sum(s.weight * o.hvac_power_w), a.heating_power_w + a.cooling_power_w,
            a.sample_count, count(*), a.reduction_vs_ptc,
            1 - a.hvac_power_w / (SELECT hvac_power_w FROM annual_average WHERE design = 'ptc' AND pmv_limit = a.pmv_limit)
        FROM annual_average AS a
        JOIN optimum AS o ON o.design = a.design AND o.pmv_limit = a.pmv_limit
        JOIN sample AS s USING (sample_id)
        GROUP BY a.design, a.pmv_limit",
    );
    assert_eq!(rows.len(), 20);
    for row in rows {
        let v: Vec<f64> = row.iter().map(|c| number(c)).collect();
        assert!((v[0] - v[1]).abs() < 1e-9 * v[0], "{row:?}");
        assert!((v[0] - v[2]).abs() < 1e-9 * v[0], "{row:?}");
        assert_eq!(v[3], v[4]);
        assert!((v[5] - v[6]).abs() < 1e-12, "{row:?}");
    }
    let monthly = scratch.query("SELECT count(*), count(DISTINCT month) FROM monthly_average");
    assert_eq!(monthly, [["240", "12"]]);
}

#[test]
fn prop_comfort_and_equipment_are_monotone() {
    let scratch = small();
    scratch.expect(0, &["run"]);
    let worse = scratch.query(
        "SELECT count(*) FROM optimum AS narrow JOIN optimum AS wide USING (sample_id, design)
        WHERE wide.pmv_limit > narrow.pmv_limit AND wide.hvac_power_w > narrow.hvac_power_w + 1e-6",
    );
    assert_eq!(worse, [["0"]], "a wider window costs more");
    let worse = scratch.query(
        "SELECT count(*) FROM optimum AS less JOIN optimum AS more USING (sample_id, pmv_limit)
        WHERE ((less.design = 'ptc' AND more.design = 'ptc+rh')
            OR (less.design = 'hp' AND more.design IN ('hp+rh', 'hp+curtain')))
        AND more.hvac_power_w > less.hvac_power_w + 1e-6",
    );
    assert_eq!(worse, [["0"]], "an option costs more");
}

#[test]
fn prop_missing_months_are_said_and_the_weights_still_sum_to_one() {
    let scratch = Scratch::demo(3);
    scratch.expect(0, &["run"]);
    let sum = number(&scratch.query("SELECT sum(weight) FROM sample")[0][0]);
    assert!((sum - 1.0).abs() < 1e-12, "{sum}");
    let report = scratch.read("report/report.md");
    assert!(report.matches("Months without samples:").count() >= 6, "{report}");
    let status = scratch.expect(0, &["status"]).stdout;
    assert!(status.contains("months without samples: ["), "{status}");
}

#[test]
fn cli_run_without_a_study_file_makes_the_demo() {
    let scratch = Scratch::empty();
    let run = scratch.expect(0, &["run"]);
    assert!(run.stdout.contains("48 missions") && run.stdout.contains("16065 points"), "{}", run.stdout);
    assert!(scratch.path("busclimate-demo/report/pareto.svg").exists());
    let report = scratch.read("busclimate-demo/report/report.md");
    assert!(report.contains("Synthetic data") && !report.contains("Months without"));
    let again = scratch.expect(0, &["run"]);
    assert!(!again.stderr.contains("making the demo"), "{}", again.stderr);
}

#[test]
fn cli_check_status_and_show_tell_what_is_there() {
    let scratch = small();
    let check = scratch.expect(0, &["check"]).stdout;
    assert!(check.contains("5 designs × 4 comfort windows = 20 points a sample"), "{check}");
    assert_eq!(scratch.expect(3, &["status"]).stderr.matches("run the study first").count(), 1);
    scratch.expect(0, &["run"]);
    let json: serde_json::Value = serde_json::from_str(&scratch.expect(0, &["status", "--json"]).stdout).unwrap();
    assert_eq!((&json["pending"], &json["last_run"]["status"]), (&0.into(), &"done".into()));

    let id = scratch.query("SELECT sample_id FROM sample ORDER BY ambient_temperature_c LIMIT 1").remove(0).remove(0);
    let show = scratch.expect(0, &["show", "--sample", &id, "--design", "hp+curtain", "--pmv-limit", "1"]).stdout;
    let of = format!(
        "SELECT hvac_power_w, source_path, first_line FROM optimum JOIN sample USING (sample_id)
        WHERE sample_id = {id} AND design = 'hp+curtain' AND pmv_limit = 1.0"
    );
    let row = scratch.query(&of).remove(0);
    assert!(show.contains(&format!("stored: solved, {:.3} W", number(&row[0]))), "{show}");
    assert!(show.contains(&format!("from {} lines {}–", row[1], row[2])), "{show}");
    for part in ["neither", "curtain", "through open doors", "largest residual of the five balances"] {
        assert!(show.contains(part), "{part} is missing in {show}");
    }
    let arguments = ["show", "--sample", &id, "--design", "ptc+rh", "--pmv-limit", "1", "--figure", "flows.svg"];
    scratch.expect(0, &arguments);
    let svg = scratch.read("flows.svg");
    for part in ["<svg", "cabin air", "shell in", "role=\"img\"", "</svg>"] {
        assert!(svg.contains(part), "{part} is missing in {svg}");
    }
    let wrong = scratch.expect(2, &["show", "--sample", &id, "--design", "hpp", "--pmv-limit", "1"]);
    assert!(wrong.stderr.contains("it has: ptc, ptc+rh, hp"), "{}", wrong.stderr);
    scratch.expect(2, &["show", "--sample", "1", "--design", "hp", "--pmv-limit", "1"]);
    scratch.expect(2, &["show", "--sample", &id, "--design", "hp", "--pmv-limit", "0.3"]);
}

#[test]
fn prop_a_killed_simulation_is_finished_by_the_next_run() {
    const SIMULATIONS: &str = "SELECT * FROM simulation ORDER BY mission, design, pmv_limit, controller";
    let scratch = small();
    for stage in ["ingest", "shade", "solve", "simulate"] {
        scratch.expect(0, &[stage]);
    }
    let undisturbed = scratch.query(SIMULATIONS);
    assert_eq!(undisturbed.len(), 12 * 5 * 4);
    scratch.expect(0, &["report"]);
    let report = scratch.report();

    std::fs::remove_file(scratch.path("study.db")).unwrap();
    for stage in ["ingest", "shade", "solve"] {
        scratch.expect(0, &[stage]);
    }
    let mut child = scratch.spawn(&["simulate", "--threads", "1", "--quiet"]);
    // Wherever it is when it dies, what it has committed is whole.
    let count = || number(&scratch.query("SELECT count(*) FROM simulation")[0][0]);
    for _ in 0..2000 {
        if count() > 0.0 {
            break;
        }
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    let committed = count();
    assert!(committed > 0.0 && committed % 20.0 == 0.0, "{committed}");
    scratch.expect(0, &["simulate"]);
    assert!(undisturbed == scratch.query(SIMULATIONS));
    scratch.expect(0, &["report"]);
    assert!(report == scratch.report());
}

#[test]
fn cli_json_log_lines_are_json() {
    let scratch = Scratch::demo(1);
    let run = scratch.expect(0, &["run", "--log", "json"]);
    assert!(run.stderr.lines().count() >= 3);
    for line in run.stderr.lines() {
        let value: serde_json::Value = serde_json::from_str(line).unwrap();
        assert!(value["message"].is_string() && value["level"] == "INFO", "{line}");
    }
    assert_eq!(scratch.expect(0, &["run", "--quiet"]).stderr, "");
}

#[test]
fn cli_a_report_in_the_studys_own_folder_leaves_the_folder_where_it_is() {
    let scratch = Scratch::small(1, "[1.0]", "[]");
    scratch.edit("study.toml", "report_dir = \"report\"", "report_dir = \".\"");
    let elsewhere = tempfile::tempdir().unwrap();
    let database = elsewhere.path().join("study.db");
    let place = std::fs::File::open(scratch.folder.path()).unwrap();
    let run = scratch.run(&["run", "--db", database.to_str().unwrap()]);
    assert_eq!(run.status, 0, "{}", run.stderr);
    // The folder that was open before is the one that has the report.
    assert!(scratch.path("report.md").exists() && scratch.path("study.toml").exists());
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt;
        let now = std::fs::metadata(scratch.folder.path()).unwrap();
        assert_eq!(place.metadata().unwrap().ino(), now.ino());
    }
}

#[test]
fn cli_a_demo_leaves_other_studies_alone_and_init_names_its_bus() {
    let scratch = Scratch::demo(1);
    let (study, missions) = (scratch.read("study.toml"), scratch.missions());
    scratch.expect(0, &["demo", ".", "--missions", "1"]);
    assert_eq!((scratch.read("study.toml"), scratch.missions()), (study, missions.clone()));
    for arguments in [["demo", ".", "--missions", "2"], ["demo", ".", "--seed", "2"]] {
        let run = scratch.expect(2, &arguments);
        assert!(run.stderr.contains("is there already, and not one of a demo with these arguments"), "{}", run.stderr);
    }
    scratch.edit("study.toml", "segment_s = 3600", "segment_s = 1800");
    scratch.expect(2, &["demo", ".", "--missions", "1"]);
    assert_eq!(scratch.missions(), missions);
    scratch.expect(0, &["init", "mine"]);
    assert!(scratch.read("mine/study.toml").contains("buses = [183]"));
}

#[test]
fn cli_check_says_all_that_is_wrong_at_once() {
    let scratch = Scratch::small(3, "[1.0]", "[]");
    let names = scratch.missions();
    let text = scratch.read(&format!("ztbus/{}", names[0]));
    scratch.write(&format!("ztbus/{}", names[0]), text.replacen("status_doorIsOpen", "doors", 1));
    let text = scratch.read(&format!("ztbus/{}", names[1]));
    scratch.write(&format!("ztbus/{}", names[1]), text.replace(",1,1,1,", ",ajar,1,1,"));
    let check = scratch.run(&["check"]);
    assert_eq!(check.status, 1, "{}", check.stderr);
    assert!(check.stdout.contains("\n1 missions, ") || check.stdout.contains("\n2 missions, "), "{}", check.stdout);
    for said in [&names[0], &names[1]] {
        assert!(check.stdout.contains(&format!(": ztbus/{said}: line ")), "{}", check.stdout);
    }
    assert!(check.stdout.contains("column status_doorIsOpen: the column is missing"), "{}", check.stdout);
    scratch.edit("study.toml", "path = \"shadow.csv\"", "path = \"shade.csv\"");
    scratch.edit("study.toml", "path = \"weather\"", "path = \"wether\"");
    let check = scratch.run(&["check"]);
    assert_eq!(check.status, 3);
    for said in ["error: ", "wether: there is no such file or folder", "shade.csv: cannot be read", &names[0]] {
        assert!(check.stdout.contains(said), "{said}: {}", check.stdout);
    }
    assert!(check.stderr.contains("these 2 errors"), "{}", check.stderr);
    assert!(!scratch.path("study.db").exists());
}

#[test]
fn cli_missions_are_chosen_by_route() {
    let scratch = Scratch::small(8, "[1.0]", "[1.0]");
    scratch.expect(0, &["run"]);
    // The demo's missions are on one route each.
    let of =
        |scratch: &Scratch| scratch.query("SELECT coalesce(route, 'none'), count(*) FROM sample GROUP BY 1 ORDER BY 1");
    let all = of(&scratch);
    assert!(all.len() > 2, "{all:?}");
    let (left_out, simulations) = (&all[0], "SELECT count(DISTINCT mission) FROM simulation");
    let missions = number(&scratch.query(simulations)[0][0]);
    scratch.edit("study.toml", "segment_s = 3600", &format!("without_routes = [{:?}]\nsegment_s = 3600", left_out[0]));
    let run = scratch.expect(0, &["run"]);
    assert_eq!(of(&scratch), all[1..], "{}", run.stdout);
    assert!(number(&scratch.query(simulations)[0][0]) < missions);
    let said = scratch.query("SELECT DISTINCT reason FROM excluded_segment WHERE reason LIKE 'mission on%'");
    assert_eq!(said, [[format!("mission on route {}, which the study leaves out", left_out[0])]]);
    // Two ways to say the same.
    let names: Vec<&str> = all[1..].iter().map(|row| row[0].as_str()).collect();
    scratch.edit("study.toml", &format!("without_routes = [{:?}]", left_out[0]), &format!("routes = {names:?}"));
    scratch.expect(0, &["run"]);
    assert_eq!(of(&scratch), all[1..]);
    scratch.edit("study.toml", "routes = ", "without_routes = [\"1\"]\nroutes = ");
    let run = scratch.expect(2, &["run"]);
    assert!(run.stderr.contains("both routes and without_routes; remove one of them"), "{}", run.stderr);
}
