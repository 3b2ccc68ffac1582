//! What a thing is, is its content: where it lies, what it is called and what stands beside it make nothing stale.

use crate::common::{Run, Scratch};

const OPTIMA: &str = "SELECT * FROM optimum ORDER BY sample_id, design, pmv_limit";
const SIMULATIONS: &str = "SELECT * FROM simulation ORDER BY mission, design, pmv_limit, controller";

fn small() -> Scratch {
    let scratch = Scratch::small(4, "[0.5, 0.7, 1.0]", "[1.0]");
    scratch.expect(0, &["run"]);
    scratch
}

fn said(run: &Run, what: &str) {
    assert!(run.stderr.contains(what), "{what}\n{}", run.stderr);
}

fn computes(run: &Run, points: usize, simulations: usize) {
    said(run, &format!(" {points} points computed now"));
    said(run, &format!("INFO {simulations} missions simulated now"));
}

#[test]
fn cli_moved_renamed_and_packed_inputs_invalidate_nothing() {
    let scratch = small();
    let results = || [OPTIMA, SIMULATIONS].map(|sql| scratch.query(sql));
    let before = results();
    let nothing = |what: &str| {
        let run = scratch.expect(0, &["run"]);
        said(&run, " 0 read now, 0 no longer there");
        said(&run, "0 new or changed, 0 withdrawn");
        computes(&run, 0, 0);
        assert!(before == results(), "{what}");
    };
    scratch.zip_missions("missions.zip");
    std::fs::create_dir(scratch.path("buses")).unwrap();
    std::fs::rename(scratch.path("ztbus"), scratch.path("buses/2021")).unwrap();
    scratch.edit("study.toml", "path = \"ztbus\"", "path = \"buses/2021\"");
    nothing("a moved folder");
    let paths = scratch.query("SELECT DISTINCT source_path FROM sample");
    assert!(paths.iter().all(|p| p[0].starts_with("buses/2021/B183_")), "{paths:?}");
    scratch.edit("study.toml", "path = \"buses/2021\"", "path = \"missions.zip\"");
    nothing("an archive");
    let weather = "weather/ogd-smn_sma_h_historical_2020-2029.csv";
    std::fs::rename(scratch.path(weather), scratch.path("weather/ogd-smn_sma_h_2020.csv")).unwrap();
    std::fs::rename(scratch.path("shadow.csv"), scratch.path("streets.csv")).unwrap();
    scratch.edit("study.toml", "path = \"shadow.csv\"", "path = \"streets.csv\"");
    nothing("other names");
}

#[test]
fn cli_a_copy_that_is_found_first_takes_the_missions_place() {
    let scratch = small();
    let before = scratch.query(OPTIMA);
    let name = scratch.missions().remove(0);
    scratch.edit("study.toml", "path = \"ztbus\"", "path = \"*/B183*.csv\"");
    std::fs::create_dir(scratch.path("a")).unwrap();
    std::fs::copy(scratch.path("ztbus").join(&name), scratch.path("a").join(&name)).unwrap();
    let run = scratch.expect(1, &["run"]);
    computes(&run, 0, 0);
    said(&run, &format!("refused: ztbus/{name}"));
    assert!(before == scratch.query(OPTIMA));
    std::fs::remove_dir_all(scratch.path("a")).unwrap();
    let run = scratch.expect(0, &["run"]);
    computes(&run, 0, 0);
    assert!(before == scratch.query(OPTIMA));
}

#[test]
fn prop_a_design_or_window_more_is_computed_alone_and_to_the_same_bit() {
    let scratch = small();
    let results = || [OPTIMA, SIMULATIONS].map(|sql| scratch.query(sql));
    let (before, report) = (results(), scratch.report());
    let samples: usize = scratch.query("SELECT count(*) FROM sample")[0][0].parse().unwrap();

    let design = "[designs.\"hp+rh\"]\nheating = \"hp\"\nradiant_heaters = true\n";
    scratch.edit("study.toml", design, "");
    computes(&scratch.expect(0, &["run"]), 0, 0);
    scratch.edit("study.toml", "[designs.\"hp+curtain\"]", &format!("{design}\n[designs.\"hp+curtain\"]"));
    computes(&scratch.expect(0, &["run"]), samples * 3, 4 * 4);
    assert!(before == results());

    scratch.edit("study.toml", "[0.5, 0.7, 1.0]", "[0.5, 1.0]");
    computes(&scratch.expect(0, &["run"]), 0, 0);
    // Design and window at once: neither the other points of the one nor those of the other again.
    scratch.edit("study.toml", design, "");
    computes(&scratch.expect(0, &["run"]), 0, 0);
    scratch.edit("study.toml", "[designs.\"hp+curtain\"]", &format!("{design}\n[designs.\"hp+curtain\"]"));
    scratch.edit("study.toml", "[0.5, 1.0]", "[0.5, 0.7, 1.0]");
    computes(&scratch.expect(0, &["run"]), samples * (4 + 3), 4 * 4);
    assert!(before == results());

    // Another name is none of the physics; another COP is that of one design.
    scratch.edit("study.toml", "[designs.\"hp\"]", "[designs.\"heat pump\"]");
    computes(&scratch.expect(0, &["run"]), 0, 0);
    assert_eq!(scratch.query("SELECT count(*) FROM annual_average WHERE design = 'heat pump'"), [["3"]]);
    assert_eq!(scratch.query("SELECT count(*) FROM annual_average WHERE design = 'hp'"), [["0"]]);
    scratch.edit("study.toml", "[designs.\"heat pump\"]", "[designs.\"hp\"]\nheating_cop = \"vecto-2stage\"");
    computes(&scratch.expect(0, &["run"]), samples * 3, 4 * 4);
    scratch.edit("study.toml", "heating_cop = \"vecto-2stage\"", "");
    computes(&scratch.expect(0, &["run"]), samples * 3, 4 * 4);
    assert!(before == results());
    assert!(report == scratch.report());
}

#[test]
fn cli_a_plan_says_what_a_run_would_do_and_why() {
    let scratch = small();
    let nothing = |text: &str| assert_eq!(text.matches("nothing to do").count(), 6, "{text}");
    std::thread::sleep(std::time::Duration::from_secs(2));
    // Files that were written a moment ago have no stamp before.
    scratch.expect(0, &["run"]);
    nothing(&scratch.expect(0, &["run", "--dry-run"]).stdout);
    nothing(&scratch.expect(0, &["status", "--why"]).stdout);
    let samples: usize = scratch.query("SELECT count(*) FROM sample")[0][0].parse().unwrap();
    let database = std::fs::read(scratch.path("study.db")).unwrap();

    scratch.edit("study.toml", "[designs.\"hp\"]", "[designs.\"hp\"]\nheating_cop = \"vecto-2stage\"");
    scratch.edit("study.toml", "[0.5, 0.7, 1.0]", "[0.5, 0.8, 1.0]");
    let plan = scratch.expect(0, &["run", "--dry-run"]).stdout;
    for line in [
        "ingest    nothing to do",
        "shade     nothing to do",
        &format!("solve     {} points to compute", samples * (4 + 3)),
        "the design hp has changed",
        "1 comfort windows are new",
        "designs.\"hp\".heating_cop was vecto-continuous and is vecto-2stage",
        "comfort was -0.5 … 0.5, -0.7 … 0.7, -1 … 1 and is -0.5 … 0.5, -0.8 … 0.8, -1 … 1",
        "simulate  16 missions to simulate",
    ] {
        assert!(plan.contains(line), "{line}\n{plan}");
    }
    assert!(database == std::fs::read(scratch.path("study.db")).unwrap(), "a plan writes");
    computes(&scratch.expect(0, &["run"]), samples * (4 + 3), 4 * 4);

    // Missions: one is new, one is gone, one looks different and is not.
    let names = scratch.missions();
    let text = scratch.read(&format!("ztbus/{}", names[0]));
    std::fs::rename(scratch.path("ztbus").join(&names[1]), scratch.path("aside.csv")).unwrap();
    scratch.write(&format!("ztbus/{}", names[0]), text);
    scratch.edit("study.toml", "time_zone = \"Europe/Zurich\"", "time_zone = \"Asia/Tokyo\"");
    let plan = scratch.expect(0, &["status", "--why"]).stdout;
    for line in [
        &format!("1 mission is missing, and kept: ztbus/{}", names[1]),
        &format!("1 mission is to be hashed, for size, time or inode are not as they were: ztbus/{}", names[0]),
        "location.time_zone was Europe/Zurich and is Asia/Tokyo",
    ] {
        assert!(plan.contains(line), "{line}\n{plan}");
    }
    let json = scratch.expect(0, &["status", "--why", "--json"]).stdout;
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(json["plan"][0]["to_compute"], 1);

    // Where there is no database, all is new, and none is made.
    std::fs::remove_file(scratch.path("study.db")).unwrap();
    let plan = scratch.expect(0, &["run", "--dry-run"]).stdout;
    assert!(plan.contains("3 missions are new, the first: "), "{plan}");
    assert!(!scratch.path("study.db").exists());
}
