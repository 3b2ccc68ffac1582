//! One run at a time, a database that knows whose it is, and a file that stands alone at rest.

#![expect(clippy::unwrap_used, reason = "a test ends where something is not as expected")]

use crate::common::Scratch;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

fn small() -> Scratch {
    let scratch = Scratch::demo(3);
    scratch.edit("study.toml", "pmv_limits = [0.0, 0.5, 1.0, 1.5, 2.0]", "pmv_limits = [1.0]");
    scratch
}

/// A run that takes some seconds, and is at work.
fn start(scratch: &Scratch) -> Child {
    let mut child = scratch.spawn(&["run", "--threads", "1", "--quiet"]);
    for _ in 0..1000 {
        if std::fs::read_to_string(scratch.path("study.db.lock")).is_ok_and(|text| text.ends_with('\n')) {
            return child;
        }
        std::thread::sleep(Duration::from_millis(2));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    panic!("the run takes no lock");
}

#[test]
fn cli_a_second_run_says_who_is_at_work_or_waits() {
    let scratch = Scratch::demo(24);
    let mut first = start(&scratch);
    let second = scratch.expect(5, &["run"]);
    let holder = format!("is being written by another run (process {} since ", first.id());
    assert!(second.stderr.contains(&holder) && second.stderr.contains("--wait SECONDS"), "{}", second.stderr);
    let waited = scratch.expect(0, &["run", "--wait", "120"]);
    assert!(waited.stderr.contains(" 0 points computed now"), "{}", waited.stderr);
    assert!(first.wait().unwrap().success(), "the first run died of the second");
    let runs = scratch.query("SELECT status FROM run ORDER BY run_id");
    assert_eq!(runs, [["done"], ["done"]]);
}

#[test]
fn cli_the_lock_of_a_killed_run_holds_nobody_back() {
    let scratch = Scratch::demo(24);
    let mut first = start(&scratch);
    first.kill().unwrap();
    first.wait().unwrap();
    assert!(scratch.path("study.db.lock").exists());
    scratch.expect(0, &["ingest"]);
    assert!(!scratch.path("study.db.lock").exists());
}

#[test]
fn cli_a_database_at_rest_stands_alone() {
    let scratch = small();
    scratch.expect(0, &["run"]);
    for beside in ["study.db-wal", "study.db-shm", "study.db.lock"] {
        assert!(!scratch.path(beside).exists(), "{beside} is left");
    }
    // Both bytes are 2 where a reader needs a write-ahead log (SQLite's file format, section 1.3.3).
    let header = std::fs::read(scratch.path("study.db")).unwrap();
    assert_eq!(header[18..20], [1, 1]);
    for command in ["status", "report"] {
        scratch.expect(0, &[command]);
        assert!(!scratch.path("study.db-wal").exists(), "{command} leaves a log");
    }
}

#[test]
fn cli_a_reader_that_leaves_early_is_no_error() {
    let scratch = small();
    scratch.expect(0, &["run"]);
    let mut status = std::process::Command::new(env!("CARGO_BIN_EXE_busclimate"))
        .args(["status", "study.toml"])
        .current_dir(scratch.folder.path())
        .stdout(std::process::Stdio::piped())
        .spawn()
        .expect("it starts");
    drop(status.stdout.take());
    assert!(status.wait().expect("it ends").success());
}

#[test]
fn cli_a_database_of_another_study_is_left_as_it_is() {
    let scratch = small();
    scratch.expect(0, &["run"]);
    let before = std::fs::read(scratch.path("study.db")).unwrap();
    scratch.edit("study.toml", "name = \"demo\"", "name = \"other\"");
    for command in ["run", "report", "status", "verify"] {
        let run = scratch.expect(3, &[command]);
        assert!(run.stderr.contains("holds the study \"demo\", not \"other\""), "{command}: {}", run.stderr);
    }
    scratch.edit("study.toml", "name = \"other\"", "name = \"demo\"");
    assert_eq!(scratch.query("SELECT count(*) FROM run"), [["1"]]);
    let after = std::fs::read(scratch.path("study.db")).unwrap();
    // A look changes SQLite's counters in the header at most, and leaves no log.
    assert!(before.len() == after.len() && before[100..] == after[100..] && after[18..20] == [1, 1]);
}

#[test]
fn cli_a_foreign_and_a_newer_database_are_told_apart() {
    let scratch = small();
    scratch.write("study.db", "");
    scratch.tamper("CREATE TABLE somebody_elses (x)");
    let theirs = std::fs::read(scratch.path("study.db")).unwrap();
    let run = scratch.expect(3, &["run"]);
    assert!(run.stderr.contains("is a SQLite database of something else"), "{}", run.stderr);
    let run = scratch.expect(3, &["status"]);
    assert!(run.stderr.contains("is a SQLite database of something else"), "{}", run.stderr);

    assert!(theirs == std::fs::read(scratch.path("study.db")).unwrap(), "it is written");
    std::fs::remove_file(scratch.path("study.db")).unwrap();
    scratch.expect(0, &["run"]);
    scratch.tamper(
        "INSERT INTO _sqlx_migrations SELECT 99991231235959, 'later', installed_on, success, checksum, execution_time
            FROM _sqlx_migrations LIMIT 1",
    );
    for command in ["run", "status", "report"] {
        let run = scratch.expect(3, &[command]);
        assert!(run.stderr.contains("was written by a newer version of busclimate"), "{command}: {}", run.stderr);
    }
}

#[test]
fn cli_an_empty_copy_is_told_apart_from_a_study() {
    let scratch = Scratch::demo(1);
    scratch.write("study.db", "");
    for command in ["status", "report"] {
        let run = scratch.expect(3, &[command]);
        assert!(
            run.stderr.contains("study.db holds nothing") && run.stderr.contains("busclimate backup"),
            "{}",
            run.stderr
        );
    }
    assert_eq!(scratch.read("study.db"), "");
    scratch.expect(0, &["run"]);
}

#[test]
fn cli_a_backup_is_whole_while_a_run_is_at_work() {
    let scratch = Scratch::demo(24);
    let mut run = start(&scratch);
    scratch.expect(0, &["backup", "study.toml", "during.db"]);
    run.wait().unwrap();
    scratch.expect(0, &["backup", "study.toml", "after.db"]);
    let count = |db: &str| {
        let mut store = store::Store::open_read_only(&scratch.path(db)).unwrap();
        assert_eq!(store.query_text("PRAGMA integrity_check").unwrap(), [["ok"]]);
        store.query_text("SELECT count(*) FROM optimum").unwrap()
    };
    count("during.db");
    assert_eq!(count("after.db"), count("study.db"));
    assert!(!scratch.path("after.db-wal").exists() && !scratch.path("after.db.part").exists());
    let again = scratch.expect(2, &["backup", "study.toml", "after.db"]);
    assert!(again.stderr.contains("is there already"), "{}", again.stderr);
    // The copy serves in the place of the original.
    std::fs::rename(scratch.path("after.db"), scratch.path("study.db")).unwrap();
    let run = scratch.expect(0, &["run"]);
    assert!(run.stderr.contains(" 0 points computed now"), "{}", run.stderr);
}

#[test]
fn cli_a_job_without_a_study_file_gets_no_demo() {
    let scratch = Scratch::empty();
    for arguments in [["run", "--quiet", "--threads", "1"], ["run", "--log", "json", "--quiet"]] {
        let run = scratch.expect(2, &arguments);
        assert!(run.stderr.contains("there is no study.toml here"), "{}", run.stderr);
    }
    assert!(!scratch.path("busclimate-demo").exists());
}

#[test]
#[cfg(unix)]
fn cli_a_signal_ends_a_simulation_soon_and_the_next_run_goes_on() {
    let scratch = Scratch::demo(24);
    let mut run = start(&scratch);
    let count = || scratch.query("SELECT count(*) FROM simulation")[0][0].parse::<u32>().unwrap();
    for _ in 0..2000 {
        if scratch.path("study.db").exists() && count() > 0 {
            break;
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    assert!(Command::new("kill").args(["-TERM", &run.id().to_string()]).status().unwrap().success());
    let since = std::time::Instant::now();
    assert_eq!(run.wait().unwrap().code(), Some(4));
    assert!(since.elapsed() < Duration::from_secs(30), "the signal is not looked at");
    // None of the result, or all of it where the stage was over when the signal came.
    let shown = scratch.query("SELECT count(*) FROM simulation_annual")[0][0].clone();
    assert!(shown == "0" || shown == "100" && count() == 24 * 5 * 5 * 4, "half a result shows: {shown}");
    scratch.expect(0, &["run"]);
    assert_eq!(count(), 24 * 5 * 5 * 4);
}

#[test]
#[cfg(target_os = "linux")]
fn cli_a_full_log_and_a_pipe_in_the_place_of_a_file_end_nothing_badly() {
    let scratch = small();
    let full = std::fs::File::options().write(true).open("/dev/full").unwrap();
    let status = Command::new(env!("CARGO_BIN_EXE_busclimate"))
        .current_dir(scratch.folder.path())
        .arg("run")
        .stdout(Stdio::null())
        .stderr(full)
        .status()
        .unwrap();
    assert_eq!(status.code(), Some(0));
    assert_eq!(scratch.query("SELECT status FROM run"), [["done"]]);
    std::fs::remove_file(scratch.path("shadow.csv")).unwrap();
    assert!(Command::new("mkfifo").arg(scratch.path("shadow.csv")).status().unwrap().success());
    let run = scratch.expect(3, &["run"]);
    assert!(run.stderr.contains("not a regular file"), "{}", run.stderr);
}
