//! Optima by shares: processes that know nothing of each other, one of which dies, come to what one process comes to.

#![expect(clippy::unwrap_used, reason = "a test ends where something is not as expected")]

use crate::common::{CONTENT, Scratch};
use std::path::PathBuf;
use std::time::Duration;

/// Missions that are read and joined, nothing solved.
fn prepared() -> Scratch {
    let scratch = Scratch::small(36, "[0.25, 0.5, 1.0]", "[]");
    for stage in ["ingest", "shade"] {
        scratch.expect(0, &[stage, "--quiet"]);
    }
    scratch
}

fn shares(scratch: &Scratch) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(scratch.path("shares")).unwrap();
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    paths
}

/// All that the database says.
fn content(scratch: &Scratch) -> Vec<Vec<String>> {
    CONTENT.iter().map(|sql| scratch.exact(sql).unwrap()).collect()
}

fn solve(scratch: &Scratch, share: &str) {
    scratch.expect(0, &["solve", "--quiet", "--shard", share, "--to", "shares"]);
}

#[test]
fn cli_shares_come_to_what_one_process_comes_to() {
    let scratch = prepared();
    std::fs::copy(scratch.path("study.db"), scratch.path("before.db")).unwrap();
    scratch.expect(0, &["solve", "--quiet"]);
    let whole = content(&scratch);
    std::fs::rename(scratch.path("before.db"), scratch.path("study.db")).unwrap();

    // Four at once, of which one is killed wherever it is, and runs again.
    let share =
        |n: usize| ["solve".to_owned(), "--shard".to_owned(), format!("{n}/4"), "--to".to_owned(), "shares".to_owned()];
    let spawn = |n: usize| scratch.spawn(&share(n).each_ref().map(String::as_str));
    let mut running: Vec<_> = (1..=4).map(spawn).collect();
    std::thread::sleep(Duration::from_millis(60));
    let _ = running[1].kill();
    for (n, process) in running.iter_mut().enumerate() {
        let status = process.wait().unwrap();
        assert!(status.success() || n == 1, "{status}");
    }
    solve(&scratch, "2/4");
    let files = shares(&scratch);
    // What is there is not computed again.
    let again = scratch.expect(0, &["solve", "--shard", "2/4", "--to", "shares"]);
    assert!(again.stdout.contains("0 of them written now"), "{}", again.stdout);
    assert_eq!(shares(&scratch), files);

    let merged = scratch.expect(0, &["merge", ".", "shares"]);
    assert!(merged.stderr.contains("points taken from shares"), "{}", merged.stderr);
    assert!(merged.stderr.contains("0 points computed now"), "{}", merged.stderr);
    assert!(content(&scratch) == whole, "merged and undivided differ");
    scratch.expect(0, &["verify", "--quiet"]);
}

#[test]
fn cli_what_shares_lack_is_solved_and_what_is_damaged_is_left() {
    let scratch = prepared();
    solve(&scratch, "1/3");
    solve(&scratch, "2/3");
    let files = shares(&scratch);
    let mut bytes = std::fs::read(&files[0]).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    std::fs::write(&files[0], &bytes).unwrap();
    std::fs::write(scratch.path("shares/notes.txt"), "mine").unwrap();
    // Of other designs and windows, and twice the same rows in files of another division.
    scratch.edit("study.toml", "[0.25, 0.5, 1.0]", "[0.5, 2.0]");
    solve(&scratch, "1/2");
    scratch.edit("study.toml", "[0.5, 2.0]", "[0.25, 0.5, 1.0]");

    let merged = scratch.expect(0, &["merge", ".", "shares"]);
    let name = files[0].file_name().unwrap().to_string_lossy().into_owned();
    assert!(
        merged.stderr.contains(&format!("{name} is left: its content is not what its name says")),
        "{}",
        merged.stderr
    );
    let merged = content(&scratch);
    std::fs::remove_file(scratch.path("study.db")).unwrap();
    for stage in ["ingest", "shade", "solve"] {
        scratch.expect(0, &[stage, "--quiet"]);
    }
    assert!(content(&scratch) == merged, "merged and undivided differ");
}

#[test]
fn cli_wrong_shares_are_errors_that_say_what_to_do() {
    let scratch = prepared();
    for (arguments, words) in [
        (["solve", "--shard", "5/4", "--to", "shares"].as_slice(), "give I/N with I from 1 to N, such as 2/4"),
        (&["solve", "--shard", "1/4"], "--to <DIR>"),
        (&["solve", "--shard", "1/4", "--to", "shares", "--method", "nlp"], "shares are solved by the method fast"),
        (&["merge", ".", "nowhere"], "nowhere cannot be read"),
    ] {
        let run = scratch.expect(2, arguments);
        assert!(run.stderr.contains(words), "{}", run.stderr);
    }
}
