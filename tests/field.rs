//! Inputs as people have them: what common tools make of telemetry is read as it was meant, or refused with the likely cause.

#![expect(clippy::unwrap_used, reason = "a test ends where something is not as expected")]

use crate::common::{CONTENT, Scratch};
use std::io::Write;

const SAMPLES: &str = "SELECT sample_id, passengers, door_open_fraction, ambient_temperature_c FROM sample";

/// One mission that is only joined with weather, and its file.
fn one() -> (Scratch, String) {
    let scratch = Scratch::small(1, "[1.0]", "[]");
    let file = format!("ztbus/{}", scratch.missions()[0]);
    (scratch, file)
}

/// The telemetry with one column changed.
fn with_column(text: &str, column: &str, change: impl Fn(&str) -> String) -> String {
    let place = text.lines().next().unwrap().split(',').position(|name| name == column).unwrap();
    let changed = |(i, line): (usize, &str)| {
        if i == 0 {
            return line.to_owned();
        }
        let fields = line.split(',').enumerate();
        fields.map(|(i, f)| if i == place { change(f) } else { f.to_owned() }).collect::<Vec<_>>().join(",")
    };
    text.lines().enumerate().map(changed).collect::<Vec<_>>().join("\n") + "\n"
}

#[test]
fn prop_numbers_and_flags_of_common_tools_are_read_as_they_were_meant() {
    let (scratch, file) = one();
    let text = scratch.read(&file);
    scratch.expect(0, &["run"]);
    let meant = scratch.exact(SAMPLES).unwrap();
    let flags = |f: &str| match f {
        "1" => "True".to_owned(),
        "0" => "False".to_owned(),
        other => other.to_owned(),
    };
    let empty = |f: &str| if f == "NaN" { String::new() } else { f.to_owned() };
    for (what, changed) in [
        ("doors True and False", with_column(&text, "status_doorIsOpen", flags)),
        ("seconds with a decimal", with_column(&text, "time_unix", |f| format!("{f}.0"))),
        ("empty counts", with_column(&text, "itcs_numberOfPassengers", empty)),
    ] {
        scratch.write(&file, changed);
        let run = scratch.expect(0, &["run"]);
        assert!(run.stderr.contains("1 read now"), "{what}: {}", run.stderr);
        assert_eq!(meant, scratch.exact(SAMPLES).unwrap(), "{what}");
        assert_eq!(scratch.query("SELECT count(*) FROM data_quality WHERE kind = 'refused_value'"), [["0"]], "{what}");
    }
}

#[test]
fn cli_a_counter_that_drifts_below_none_means_an_empty_bus() {
    let (scratch, file) = one();
    // Three hours with seven on board, and from half of them on two less than none.
    let text = scratch.read(&file);
    let count = std::cell::Cell::new(0);
    let drifting = with_column(&text, "itcs_numberOfPassengers", |_| {
        count.set(count.get() + 1);
        if count.get() <= 1800 { "7".to_owned() } else { "-2".to_owned() }
    });
    scratch.write(&file, drifting);
    scratch.expect(0, &["run"]);
    assert_eq!(scratch.query("SELECT passengers FROM sample ORDER BY sample_id LIMIT 2"), [["3.5"], ["0.0"]]);
    let noted = scratch.query("SELECT kind, line FROM data_quality WHERE column_name = 'itcs_numberOfPassengers'");
    assert_eq!(noted, [["negative_offset", "1802"]]);
}

#[test]
fn cli_a_needed_column_that_is_mostly_unusable_refuses_the_file_with_the_cause() {
    let (scratch, file) = one();
    let text = scratch.read(&file);
    for (column, value, cause) in [
        ("itcs_numberOfPassengers", "\"3,5\"", "\"3,5\": "),
        ("status_doorIsOpen", "open", "\"open\": "),
        ("itcs_numberOfPassengers", "4711", "\"4711\": "),
    ] {
        scratch.write(&file, with_column(&text, column, |_| value.to_owned()));
        let run = scratch.expect(3, &["run"]);
        assert!(run.stderr.contains(&format!("refused: {file}, line 2, column {column}: {cause}")), "{}", run.stderr);
        assert!(run.stderr.contains("values cannot be used, more than 10 %; probably "), "{}", run.stderr);
    }
    scratch.write(&file, with_column(&text, "itcs_numberOfPassengers", |_| "\"3,5\"".to_owned()));
    assert!(scratch.expect(3, &["run"]).stderr.contains("decimal commas; export the file with decimal points"));
    // A few of them are news: the last state holds in their place.
    let count = std::cell::Cell::new(0);
    let few = with_column(&text, "status_doorIsOpen", |f| {
        count.set(count.get() + 1);
        if count.get() % 100 == 0 { "ajar".to_owned() } else { f.to_owned() }
    });
    scratch.write(&file, few);
    let run = scratch.expect(1, &["run"]);
    let said = format!(
        "1 missions have values that cannot be used, the first: {file}, line 101, column status_doorIsOpen: \"ajar\""
    );
    assert!(run.stderr.contains(&said), "{}", run.stderr);
}

#[test]
fn cli_missions_are_found_wherever_people_keep_them() {
    let scratch = Scratch::small(4, "[1.0]", "[]");
    scratch.expect(0, &["run"]);
    let meant = scratch.exact(SAMPLES).unwrap();
    let names = scratch.missions();
    // One in a sub-folder, one compressed, one in an archive of the macOS Finder; and what nobody wants read.
    std::fs::create_dir_all(scratch.path("ztbus/2022/may")).unwrap();
    std::fs::rename(scratch.path("ztbus").join(&names[0]), scratch.path("ztbus/2022/may").join(&names[0])).unwrap();
    let mut gzip = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    gzip.write_all(scratch.read(&format!("ztbus/{}", names[1])).as_bytes()).unwrap();
    scratch.write(&format!("ztbus/{}.gz", names[1]), gzip.finish().unwrap());
    std::fs::remove_file(scratch.path("ztbus").join(&names[1])).unwrap();
    let mut zip = zip::ZipWriter::new(std::fs::File::create(scratch.path("ztbus/finder.zip")).unwrap());
    for name in [names[2].clone(), format!("__MACOSX/._{}", names[2]), ".DS_Store".to_owned()] {
        zip.start_file(&name, zip::write::SimpleFileOptions::default()).unwrap();
        let text = if name == names[2] { scratch.read(&format!("ztbus/{name}")) } else { "\u{0}\u{5}".to_owned() };
        zip.write_all(text.as_bytes()).unwrap();
    }
    zip.finish().unwrap();
    std::fs::remove_file(scratch.path("ztbus").join(&names[2])).unwrap();
    scratch.write(&format!("ztbus/._{}", names[3]), "\u{0}\u{5}");
    scratch.write("ztbus/metadata_2022.csv", "a,b\n");
    let run = scratch.expect(0, &["run"]);
    assert!(run.stderr.contains("4 missions: 0 read now, 0 no longer there"), "{}", run.stderr);
    assert_eq!(meant, scratch.exact(SAMPLES).unwrap());

    // What is not read is said.
    let mut zip = zip::ZipWriter::new(std::fs::File::create(scratch.path("ztbus/outer.zip")).unwrap());
    zip.start_file("inner.zip", zip::write::SimpleFileOptions::default()).unwrap();
    zip.finish().unwrap();
    scratch.write("ztbus/more.tar", "");
    #[cfg(unix)]
    std::os::unix::fs::symlink("gone.csv", scratch.path("ztbus/link.csv")).unwrap();
    std::fs::create_dir_all(scratch.path("ztbus/1/2/3/4/5/6/7/8/9")).unwrap();
    #[cfg(unix)]
    assert!(
        std::process::Command::new("mkfifo")
            .arg(scratch.path("ztbus/B183_2022-01-01_00-00-00_2022-01-01_01-00-00.csv.gz"))
            .status()
            .unwrap()
            .success()
    );
    let run = scratch.expect(1, &["run"]);
    assert!(run.stderr.contains("refused: ztbus/1/2/3/4/5/6/7/8/9: more than 8 folders"), "{}", run.stderr);
    assert!(!cfg!(unix) || run.stderr.contains("_01-00-00.csv.gz: not a regular file"), "{}", run.stderr);
    assert!(
        run.stderr.contains("refused: ztbus/outer.zip!inner.zip: such an archive is not read; unpack it"),
        "{}",
        run.stderr
    );
    assert!(run.stderr.contains("refused: ztbus/more.tar: such an archive"), "{}", run.stderr);
    assert!(!cfg!(unix) || run.stderr.contains("refused: ztbus/link.csv: the link leads nowhere"), "{}", run.stderr);
    assert_eq!(meant, scratch.exact(SAMPLES).unwrap());
}

#[test]
fn cli_weather_that_is_gone_takes_no_results_away() {
    let scratch = Scratch::small(4, "[1.0]", "[1.0]");
    scratch.expect(0, &["run"]);
    let results = scratch.exact(CONTENT[0]).unwrap();
    let file = "weather/ogd-smn_sma_h_historical_2020-2029.csv";
    let text = scratch.read(file);
    // Half of the file, as a copy that is not done yet.
    let last = scratch.query("SELECT max(start_utc) FROM sample")[0][0].clone();
    let half: String = text
        .lines()
        .take_while(|line| !line.contains(&german_date(&last)))
        .fold(String::new(), |t, line| t + line + "\n");
    scratch.write(file, half);
    let run = scratch.expect(3, &["run"]);
    assert!(
        run.stderr.contains("samples is no longer there, the first: B183_")
            && run.stderr.contains("outside the weather record; nothing was withdrawn"),
        "{}",
        run.stderr
    );
    assert!(results == scratch.exact(CONTENT[0]).unwrap());
    scratch.write(file, &text);
    scratch.expect(0, &["run"]);
    assert!(results == scratch.exact(CONTENT[0]).unwrap());
    scratch.write(
        file,
        text.lines()
            .take_while(|line| !line.contains(&german_date(&last)))
            .fold(String::new(), |t, line| t + line + "\n"),
    );
    scratch.expect(0, &["run", "--forget-missing"]);
    assert!(results != scratch.exact(CONTENT[0]).unwrap());
}

/// `2021-07-26T…` as MeteoSwiss writes it.
fn german_date(utc: &str) -> String {
    format!("{}.{}.{}", &utc[8..10], &utc[5..7], &utc[..4])
}

#[test]
fn cli_missions_that_are_gone_are_said_and_their_results_kept() {
    let scratch = Scratch::small(4, "[1.0]", "[1.0]");
    scratch.expect(0, &["run"]);
    let (results, report) = (scratch.exact(CONTENT[0]).unwrap(), scratch.report());
    let averages = "SELECT * FROM annual_average";
    let average = scratch.exact(averages).unwrap();
    let names = scratch.missions();
    std::fs::create_dir(scratch.path("away")).unwrap();
    for name in &names[1..3] {
        std::fs::rename(scratch.path("ztbus").join(name), scratch.path("away").join(name)).unwrap();
    }
    let run = scratch.expect(1, &["run"]);
    let said = format!("WARN 2 missions are no longer there, the first: ztbus/{}", names[1]);
    assert!(run.stderr.contains(&said) && run.stderr.contains("--forget-missing"), "{}", run.stderr);
    assert!(run.stderr.contains("4 missions: 0 read now, 0 no longer there, 2 missing and kept"), "{}", run.stderr);
    assert!(results == scratch.exact(CONTENT[0]).unwrap() && average == scratch.exact(averages).unwrap());
    assert!(scratch.read("report/report.md").contains("2 missions were not there when they were last looked for"));
    // Every night says it again, and computes nothing.
    let run = scratch.expect(1, &["run"]);
    assert!(run.stderr.contains(&said) && run.stderr.contains(" 0 points computed now"), "{}", run.stderr);
    // A share that is not there at all is an error that takes nothing away.
    std::fs::rename(scratch.path("ztbus"), scratch.path("share")).unwrap();
    scratch.expect(3, &["run"]);
    std::fs::create_dir(scratch.path("ztbus")).unwrap();
    scratch.expect(3, &["run"]);
    assert!(average == scratch.exact(averages).unwrap());
    std::fs::remove_dir(scratch.path("ztbus")).unwrap();
    std::fs::rename(scratch.path("share"), scratch.path("ztbus")).unwrap();
    // Back, all is as it was.
    for name in &names[1..3] {
        std::fs::rename(scratch.path("away").join(name), scratch.path("ztbus").join(name)).unwrap();
    }
    let run = scratch.expect(0, &["run"]);
    assert!(run.stderr.contains("4 missions: 0 read now, 0 no longer there"), "{}", run.stderr);
    assert!(results == scratch.exact(CONTENT[0]).unwrap() && report == scratch.report());
    // Told to, it forgets; so it does with another bus's, and with one whose time another mission has.
    std::fs::rename(scratch.path("ztbus").join(&names[1]), scratch.path("away").join(&names[1])).unwrap();
    scratch.expect(1, &["run"]);
    let run = scratch.expect(0, &["run", "--forget-missing"]);
    assert!(run.stderr.contains("3 missions: 0 read now, 1 no longer there"), "{}", run.stderr);
    assert_eq!(scratch.query("SELECT count(DISTINCT mission) FROM sample"), [["3"]]);
    let shorter = names[2].replace(&names[2][names[2].len() - 6..], "00.csv");
    std::fs::rename(scratch.path("ztbus").join(&names[2]), scratch.path("ztbus").join(&shorter)).unwrap();
    let run = scratch.run(&["run"]);
    assert!(shorter == names[2] || run.stderr.contains("1 read now, 1 no longer there"), "{}", run.stderr);
    assert_eq!(scratch.query("SELECT count(DISTINCT mission) FROM sample"), [["3"]]);
}
