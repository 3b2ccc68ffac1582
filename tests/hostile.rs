//! Inputs that would take all memory or all time: refused with a reason, beside a mission that is read. How much memory they
//! take is in `docs/bad-input.md`.

#![cfg(unix)]
#![expect(clippy::unwrap_used, reason = "a test ends where something is not as expected")]

use crate::common::Scratch;
use std::io::Write;
use std::process::Command;

/// A name of a mission on a day of its own.
fn named(day: u32, extension: &str) -> String {
    format!("ztbus/B183_2023-01-{day:02}_06-00-00_2023-01-{day:02}_07-00-00.{extension}")
}

/// A gigabyte of one letter, compressed to a megabyte.
fn bomb(mut to: impl Write) {
    let block = vec![b'a'; 1 << 20];
    (0..1024).for_each(|_| to.write_all(&block).unwrap());
}

#[test]
fn cli_what_would_take_all_memory_or_time_is_refused_with_a_reason() {
    let scratch = Scratch::small(1, "[1.0]", "[]");
    let mission = scratch.read(&format!("ztbus/{}", scratch.missions().pop().unwrap()));
    scratch.expect(0, &["run"]);
    let results = scratch.exact("SELECT * FROM optimum").unwrap();

    // A line of a gigabyte, as it stands and compressed in two ways.
    std::fs::File::create(scratch.path(&named(1, "csv"))).unwrap().set_len(1 << 30).unwrap();
    let gzip = std::fs::File::create(scratch.path(&named(2, "csv.gz"))).unwrap();
    bomb(flate2::write::GzEncoder::new(gzip, flate2::Compression::fast()));
    let mut zip = zip::ZipWriter::new(std::fs::File::create(scratch.path("ztbus/bomb.zip")).unwrap());
    zip.start_file(named(3, "csv").replace("ztbus/", ""), zip::write::SimpleFileOptions::default()).unwrap();
    bomb(&mut zip);
    zip.finish().unwrap();
    // A million columns; quotes that never close; quotes where none can stand.
    scratch.write(&named(4, "csv"), format!("time_unix{}\n", ",x".repeat(1_000_000)));
    let header = mission.lines().next().unwrap();
    scratch.write(&named(5, "csv"), format!("{header}\n\"2023\n{}", "\n".repeat(100_000)));
    scratch.write(&named(6, "csv"), format!("{header}\n20\"23,\n1,2\n"));
    // Pipes and folders in the place of files, and a folder in itself.
    assert!(Command::new("mkfifo").arg(scratch.path(&named(7, "csv"))).status().unwrap().success());
    std::fs::create_dir(scratch.path(&named(8, "csv"))).unwrap();
    std::os::unix::fs::symlink(".", scratch.path("ztbus/round")).unwrap();

    let run = scratch.expect(1, &["run"]);
    for (name, said) in [
        (named(1, "csv"), "it holds more than 128 MiB"),
        (named(2, "csv.gz"), "it holds more than 128 MiB"),
        (format!("ztbus/bomb.zip!{}", named(3, "csv").replace("ztbus/", "")), "it holds more than 128 MiB"),
        (named(4, "csv"), "line 1: a line of 2000009 bytes; at most 65536 are read"),
        (named(5, "csv"), "line 2: a quote never closes"),
        (named(6, "csv"), "line 2: a quote never closes, or stands in a field that does not begin with one"),
        (named(7, "csv"), "not a regular file"),
    ] {
        let line = run.stderr.lines().find(|line| line.contains(&format!("refused: {name}")));
        assert!(line.is_some_and(|line| line.contains(said)), "{name}: {}", run.stderr);
    }
    assert!(run.stderr.contains("refused: ztbus/round: a link to a folder above it"), "{}", run.stderr);
    assert!(results == scratch.exact("SELECT * FROM optimum").unwrap());

    // The same in the place of weather and shade.
    let weather = "weather/ogd-smn_sma_h_historical_2020-2029.csv";
    let text = scratch.read(weather);
    std::fs::File::create(scratch.path(weather)).unwrap().set_len(1 << 30).unwrap();
    let run = scratch.expect(3, &["run"]);
    assert!(run.stderr.contains("weather/") && run.stderr.contains("it holds more than 128 MiB"), "{}", run.stderr);
    scratch.write(weather, text);
    std::fs::remove_file(scratch.path("shadow.csv")).unwrap();
    assert!(Command::new("mkfifo").arg(scratch.path("shadow.csv")).status().unwrap().success());
    let run = scratch.expect(3, &["run"]);
    assert!(run.stderr.contains("shadow.csv") && run.stderr.contains("not a regular file"), "{}", run.stderr);
}
