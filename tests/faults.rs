//! Runs that are killed, or whose writes fail, at any moment: nothing that was finished is lost, and the next run ends where an
//! undisturbed one does.
//!
//! `BUSCLIMATE_FAULTS` says how many faults of each kind are tried. Faults at system calls need `strace`, full disks need
//! `unshare` and the right to mount; without them a line says that they were left out.

#![expect(clippy::unwrap_used, reason = "a test ends where something is not as expected")]

use crate::common::world::World;
use crate::common::{CONTENT, Scratch};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use std::cell::Cell;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

const PROGRAM: &str = env!("CARGO_BIN_EXE_busclimate");

/// How many faults of a kind are tried.
fn faults(otherwise: usize) -> usize {
    std::env::var("BUSCLIMATE_FAULTS").ok().and_then(|text| text.parse().ok()).unwrap_or(otherwise)
}

/// A study before a night's work, and what it comes to without disturbance.
struct Night {
    before: Scratch,
    after: Scratch,
    /// Whether the night starts from nothing.
    cold: bool,
    judged: Cell<u32>,
}

impl Night {
    fn cold(world: &World) -> Self {
        let [before, after] = [Scratch::empty(), Scratch::empty()];
        world.write(&before);
        world.write(&after);
        after.expect(0, &["run"]);
        Self { before, after, cold: true, judged: Cell::new(0) }
    }

    /// One mission is new, another has changed, and the study has another window.
    fn of_changes(world: &World) -> Self {
        let mut night = Self::cold(world);
        let mut earlier = world.clone();
        let names: Vec<String> = world.missions.keys().cloned().collect();
        earlier.missions.insert(names[0].clone(), None);
        let other = earlier.missions[&names[1]].clone().map(|text| text.replace(",1,1,1,", ",0,1,1,"));
        earlier.missions.insert(names[1].clone(), other);
        earlier.limits = vec![0.5];
        earlier.simulated = vec![0.5];
        night.cold = false;
        earlier.write(&night.before);
        night.before.expect(0, &["run"]);
        world.write(&night.before);
        night
    }

    /// The study as it is before the night, in a folder of its own.
    fn copy(&self) -> Scratch {
        let copy = Scratch::empty();
        let from = format!("{}/.", self.before.folder.path().display());
        assert!(Command::new("cp").args(["-a", &from]).arg(copy.folder.path()).status().unwrap().success());
        copy
    }

    /// A database after a fault: sound, and complete after one more run.
    fn judge(&self, scratch: &Scratch, fault: &str) {
        // Now a reader comes first, now the next run.
        self.judged.set(self.judged.get() + 1);
        if self.judged.get().is_multiple_of(2) && scratch.path("study.db").exists() {
            // A reader sees it, whatever the run has left; one that was killed before its first table has left none.
            let status = scratch.run(&["status"]);
            let empty = status.stderr.contains("holds nothing");
            assert!(empty || matches!(status.status, 0 | 6), "{fault}: {}", status.stderr);
            assert_eq!(scratch.exact("PRAGMA integrity_check").unwrap(), ["integrity_check=ok"], "{fault}");
            assert!(scratch.exact("PRAGMA foreign_key_check").unwrap().is_empty(), "{fault}");
        }
        let run = scratch.run(&["run"]);
        assert_eq!(run.status, 0, "{fault}: {}", run.stderr);
        self.same(scratch, fault);
    }

    fn same(&self, scratch: &Scratch, fault: &str) {
        for sql in CONTENT {
            assert!(scratch.exact(sql).unwrap() == self.after.exact(sql).unwrap(), "{fault}: {sql}");
        }
        assert!(scratch.report() == self.after.report(), "{fault}: the report");
        let left = ["study.db-wal", "study.db-shm", "study.db.lock", "report.new", "report.old"];
        assert!(left.iter().all(|name| !scratch.path(name).exists()), "{fault}: something is left beside the database");
    }
}

fn nights() -> [Night; 2] {
    let demo = Scratch::demo(4);
    let world = World::of_demo(&demo);
    [Night::cold(&world), Night::of_changes(&world)]
}

fn exists(tool: &str) -> bool {
    Command::new(tool).arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status().is_ok()
}

/// The run under `strace` with options of it.
fn traced(scratch: &Scratch, options: &[String]) -> std::process::Output {
    Command::new("strace")
        .args(["-f", "-qq", "-o", "/dev/null"])
        .args(options)
        .args([PROGRAM, "run", "--threads", "2"])
        .current_dir(scratch.folder.path())
        .output()
        .unwrap()
}

#[test]
fn cli_a_run_that_is_killed_at_any_moment_loses_nothing() {
    let mut dice = ChaCha8Rng::seed_from_u64(7);
    for night in nights() {
        let begin = Instant::now();
        night.copy().expect(0, &["run"]);
        let whole_us = begin.elapsed().as_micros() as u64;
        for _ in 0..faults(8) {
            let scratch = night.copy();
            let after_us = dice.next_u64() % whole_us;
            scratch.run_and_kill(Duration::from_micros(after_us));
            night.judge(&scratch, &format!("killed after {after_us} µs of {whole_us} (from nothing: {})", night.cold));
        }
    }
}

/// System calls that change the disk.
const WRITING: [&str; 7] = ["pwrite64", "write", "fsync", "fdatasync", "ftruncate", "rename", "unlink"];

#[test]
fn cli_a_run_that_is_killed_at_a_system_call_loses_nothing() {
    if !exists("strace") {
        eprintln!("strace is not there: no run is killed at a system call");
        return;
    }
    let mut dice = ChaCha8Rng::seed_from_u64(8);
    for night in nights() {
        for i in 0..faults(7) {
            let call = WRITING[i % WRITING.len()];
            let when = 1 + dice.next_u64() % if call == "pwrite64" { 200 } else { 12 };
            let scratch = night.copy();
            traced(&scratch, &["-e".to_owned(), format!("inject={call}:signal=KILL:when={when}")]);
            night.judge(&scratch, &format!("killed at {call} {when} (from nothing: {})", night.cold));
        }
    }
}

#[test]
fn cli_a_run_whose_writes_fail_says_so_and_loses_nothing() {
    if !exists("strace") {
        eprintln!("strace is not there: no write fails");
        return;
    }
    let mut dice = ChaCha8Rng::seed_from_u64(9);
    for night in nights() {
        for i in 0..faults(8) {
            let call = ["pwrite64", "fsync", "fdatasync", "ftruncate", "openat", "rename"][i % 6];
            let error = ["ENOSPC", "EIO"][i / 2 % 2];
            let when = match call {
                "pwrite64" => 1 + dice.next_u64() % 200,
                // Libraries are opened first.
                "openat" => 12 + dice.next_u64() % 60,
                _ => 1 + dice.next_u64() % 10,
            };
            // Once, or from then on.
            let (from_then_on, scratch) = (if dice.next_u64() % 2 == 0 { "+" } else { "" }, night.copy());
            let options = ["-e".to_owned(), format!("inject={call}:error={error}:when={when}{from_then_on}")];
            let output = traced(&scratch, &options);
            let fault = format!("{call} {when}{from_then_on} ends with {error} (from nothing: {})", night.cold);
            let said = String::from_utf8_lossy(&output.stderr);
            match output.status.code() {
                // A fault where it does not matter, or after the end: all is there.
                Some(0) => night.same(&scratch, &fault),
                Some(code @ (1..=5)) => assert!(said.contains("ERROR") || code == 1, "{fault}: {code}: {said}"),
                Some(127) => {}
                other => panic!("{fault}: {other:?}: {said}"),
            }
            night.judge(&scratch, &fault);
        }
    }
}

/// Runs in a file system of `kib` KiB beside the inputs, then with room enough, and copies database and reports out.
const ON_A_SMALL_DISK: &str = r#"
mount -t tmpfs -o size=256m tmpfs "$1" || exit 90
cp -a "$2/." "$1" && cd "$1" || exit 91
mount -o remount,size=$(( $(du -sk . | cut -f1) + $3 ))k "$1" || exit 90
"$4" run --quiet > "$5/output" 2> "$5/message"
echo $? > "$5/status"
mount -o remount,size=256m "$1" || exit 90
"$4" run --quiet > "$5/output" 2>> "$5/message" || exit 92
cp -a study.db report "$5"
"#;

#[test]
fn cli_a_full_disk_of_any_size_loses_nothing() {
    let [night, _] = nights();
    let place = tempfile::tempdir().unwrap();
    let mut failed = 0;
    for i in 0..faults(3).min(40) {
        let kib = [64, 400, 1000, 16, 150, 250, 600, 800, 1400, 2000][i % 10] + 8 * (i / 10);
        let out = Scratch::empty();
        let run = Command::new("unshare")
            .args(["-rm", "sh", "-c", ON_A_SMALL_DISK, "sh"])
            .args([place.path(), night.before.folder.path(), Path::new(&kib.to_string())])
            .args([Path::new(PROGRAM), out.folder.path()])
            .output();
        let Ok(run) = run else { return eprintln!("unshare is not there: no disk is full") };
        match run.status.code() {
            Some(0) => {}
            Some(90 | 1) => return eprintln!("nothing can be mounted here: no disk is full"),
            other => panic!("{kib} KiB: {other:?}: {}", String::from_utf8_lossy(&run.stderr)),
        }
        let (status, message) = (out.read("status"), out.read("message"));
        if status.trim() != "0" {
            failed += 1;
            assert_eq!(status.trim(), "3", "{kib} KiB: {message}");
            assert!(message.contains("full") || message.contains("space"), "{kib} KiB: {message}");
        }
        night.same(&out, &format!("a disk with {kib} KiB left"));
    }
    assert!(failed > 0, "no disk was full");
}
