//! Bad input: an error or a recorded refusal that names file, line and remedy.

use crate::common::Scratch;
use std::io::Write;

/// Three missions; the first one is broken by `change`, the others must come through with exit status 1.
fn refused(change: impl FnOnce(String) -> Vec<u8>) -> String {
    let scratch = Scratch::demo(3);
    let name = scratch.missions().remove(0);
    let file = format!("ztbus/{name}");
    scratch.write(&file, change(scratch.read(&file)));
    let run = scratch.expect(1, &["run"]);
    let missions = scratch.query("SELECT count(DISTINCT mission) FROM sample");
    assert_eq!(missions, [["2"]], "{}", run.stderr);
    let outcome = scratch.query("SELECT outcome FROM source_file WHERE kind = 'mission' ORDER BY path");
    assert_eq!(outcome, [["refused"], ["accepted"], ["accepted"]]);
    assert!(run.stdout.contains("1 files refused"), "{}", run.stdout);
    // The next run says so again.
    let again = scratch.expect(1, &["run"]);
    assert!(again.stderr.contains(&file) && run.stderr.contains(&file), "{}", run.stderr);
    let report = scratch.read("report/report.md");
    assert!(report.contains("**1 input file refused**") && report.contains(&file), "{report}");
    run.stderr
}

#[test]
fn cli_one_unreadable_mission_does_not_stop_the_others() {
    let message = refused(|text| text.replacen("status_doorIsOpen", "door", 1).into_bytes());
    assert!(message.contains("line 1, column status_doorIsOpen: the column is missing"), "{message}");
    let message = refused(|text| text.replace(',', ";").into_bytes());
    assert!(message.contains("line 1: columns are separated by ';'"), "{message}");
    let message = refused(|text| text.encode_utf16().flat_map(u16::to_le_bytes).collect());
    assert!(message.contains("zero bytes") || message.contains("UTF-16"), "{message}");
    let message = refused(|_| Vec::new());
    assert!(message.contains("empty"), "{message}");
    let message = refused(|text| {
        let mut bytes = text.into_bytes();
        bytes[5000] = 0xff;
        bytes
    });
    assert!(message.contains("byte 0xff is not UTF-8"), "{message}");
}

#[test]
fn cli_where_every_mission_is_refused_the_reasons_are_said() {
    let scratch = Scratch::demo(1);
    let file = format!("ztbus/{}", scratch.missions().remove(0));
    scratch.write(&file, scratch.read(&file).replacen("status_doorIsOpen", "door", 1));
    let run = scratch.expect(3, &["run"]);
    assert!(run.stderr.contains(&format!("refused: {file}, line 1, column status_doorIsOpen")), "{}", run.stderr);
}

#[test]
fn cli_smaller_faults_of_a_mission_are_recorded_with_lines() {
    let scratch = Scratch::demo(2);
    let name = scratch.missions().remove(0);
    let file = format!("ztbus/{name}");
    let text = scratch.read(&file);
    let lines: Vec<&str> = text.split_inclusive("\r\n").collect();
    // Time runs backwards at line 101; the file ends at line 9001.
    let mut changed = lines[..9001].to_vec();
    changed.swap(99, 100);
    scratch.write(&file, changed.concat());
    scratch.expect(0, &["run"]);
    let found = scratch.query(
        "SELECT path, finding.kind, line FROM source_file JOIN data_quality AS finding
        USING (source_file_id) ORDER BY path, finding.kind",
    );
    let kinds: Vec<&str> = found.iter().filter(|r| r[0] == file).map(|r| r[1].as_str()).collect();
    assert!(kinds.contains(&"truncated"), "{found:?}");
    assert!(found.iter().any(|r| r[1] != "truncated" && (r[2] == "101" || r[2] == "100")), "{found:?}");
}

#[test]
fn cli_overlapping_missions_and_climbing_archives_are_refused() {
    let scratch = Scratch::demo(2);
    let name = scratch.missions().remove(0);
    let text = scratch.read(&format!("ztbus/{name}"));
    // The same bus again, half an hour later.
    let start = &name[5..24];
    let minute: u32 = start[14..16].parse().unwrap_or(0);
    let later = format!("{}{:02}{}", &start[..14], (minute + 1) % 60, &start[16..]);
    let twin = name.replacen(start, &later, 1);
    scratch.write(&format!("ztbus/{twin}"), &text);
    let run = scratch.expect(1, &["run"]);
    assert!(run.stderr.contains("refused"), "{}", run.stderr);
    assert_eq!(scratch.query("SELECT count(*) FROM data_quality WHERE kind = 'overlap'"), [["1"]]);

    let file = std::fs::File::create(scratch.path("missions.zip")).expect("a file in a scratch folder");
    let mut zip = zip::ZipWriter::new(file);
    for entry in [format!("ok/{name}"), format!("../../{twin}")] {
        let stored = zip::write::SimpleFileOptions::default();
        zip.start_file(entry, stored).expect("an entry");
        zip.write_all(text.as_bytes()).expect("its bytes");
    }
    zip.finish().expect("an archive");
    scratch.edit("study.toml", "path = \"ztbus\"", "path = \"missions.zip\"");
    let run = scratch.expect(1, &["run"]);
    assert!(run.stderr.contains("its path leads out of the archive"), "{}", run.stderr);
    assert!(!scratch.path(&format!("../../{twin}")).exists());
}

#[test]
fn cli_unusable_inputs_end_with_3_and_say_what_to_do() {
    let scratch = Scratch::demo(1);
    let fails = |from: &str, to: &str, expected: &str| {
        scratch.edit("study.toml", from, to);
        let run = scratch.expect(3, &["run"]);
        assert!(run.stderr.contains(expected), "{}", run.stderr);
        scratch.edit("study.toml", to, from);
    };
    fails("path = \"ztbus\"", "path = \"nowhere\"", "there is no such file or folder");
    fails("path = \"ztbus\"", "path = \"./weather\"", "no missions that can be used");
    fails("buses = [183]", "buses = [7]", "of the buses [7], but of [183]");
    fails("path = \"weather\"", "path = \"./ztbus\"", "csv: line 1: not a file of the format meteoswiss-ogd");
    fails("# station = \"sma\"", "station = \"ber\"", "no files of the station \"ber\"; there are [\"sma\"]");
    fails("path = \"shadow.csv\"", "path = \"shade.csv\"", "shade.csv");

    let shadow = scratch.read("shadow.csv");
    scratch.write("shadow.csv", shadow.replacen("1.0000", "1.5000", 1));
    let run = scratch.expect(3, &["run"]);
    assert!(run.stderr.contains("shadow.csv: line 2, column shadow_fraction: \"1.5000\""), "{}", run.stderr);
    assert_eq!(run.stderr.matches("1.5000").count(), 1, "{}", run.stderr);
    scratch.write("shadow.csv", shadow);

    let weather = "weather/ogd-smn_sma_h_historical_2020-2029.csv";
    let text = scratch.read(weather);
    scratch.write(weather, text.replacen("tre200h0", "temperature", 1));
    let run = scratch.expect(3, &["run"]);
    assert!(run.stderr.contains("column tre200h0"), "{}", run.stderr);
    scratch.write(weather, text);

    scratch.write("study.db", "this is no database, but long enough to look like a file with pages in it".repeat(99));
    let run = scratch.expect(3, &["run"]);
    assert!(run.stderr.contains("study.db"), "{}", run.stderr);
}

#[test]
fn cli_wrong_study_files_and_arguments_end_with_2() {
    let scratch = Scratch::demo(1);
    let fails = |from: &str, to: &str, expected: &str| {
        scratch.edit("study.toml", from, to);
        let run = scratch.expect(2, &["run"]);
        assert!(run.stderr.contains(expected), "{}", run.stderr);
        scratch.edit("study.toml", to, from);
    };
    fails(
        "door_open_share",
        "door_opn_share",
        "study.toml:19:1: unknown key `door_opn_share`; did you mean `door_open_share`?",
    );
    fails(
        "latitude_deg = 47.3779",
        "latitude_deg = 147.0",
        "study.toml:10:16: [location] latitude_deg = 147 is outside -90 … 90",
    );
    fails(
        "\"Europe/Zurich\"",
        "\"Europe/Zuerich\"",
        "study.toml:13:13: [location] time_zone = \"Europe/Zuerich\" is not known",
    );
    fails("step = 0.125", "step = 0.0", "step must be above 0");
    fails("split = \"erbs\"", "split = \"orgill\"", "did you mean `erbs`?");
    fails("air_curtain = true", "heating_cop = [[0.0, 2.0], [9.0, 3.0]]", "rises with the lift");
    fails("air_curtain = true", "heating_cop = \"vecto\"", "known are: vecto-continuous");
    fails("# air_velocity_m_s = 0.1", "air_velocity_m_s = -1.0", "air_velocity_m_s");
    fails("# ghi_column", "ghi_column", "ghi_column belongs to format = \"csv\" only");
    scratch.expect(2, &["run", "absent.toml"]);
    scratch.expect(2, &["frobnicate"]);
    scratch.expect(0, &["init", "new"]);
    let again = scratch.expect(2, &["init", "new"]);
    assert!(again.stderr.contains("is there already"), "{}", again.stderr);
    let run = scratch.expect(3, &["demo", "x", "--like", "shadow.csv"]);
    assert!(run.stderr.contains("the column busNumber is missing"), "{}", run.stderr);
}

#[test]
fn cli_the_same_mission_under_two_names_counts_once() {
    let scratch = Scratch::demo(2);
    let name = scratch.missions().remove(0);
    let content = scratch.read(&format!("ztbus/{name}"));
    // The same content as a mission of another bus, and as a copy that a file manager has made.
    scratch.write(&format!("ztbus/{}", name.replacen("B183", "B208", 1)), &content);
    scratch.write(&format!("ztbus/{}", name.replacen(".csv", " (1).csv", 1)), &content);
    scratch.edit("study.toml", "buses = [183]", "buses = []");
    for _ in 0..2 {
        let run = scratch.expect(1, &["run"]);
        assert!(run.stderr.contains("under another name; remove one of them"), "{}", run.stderr);
        assert!(run.stderr.contains("the name is not that of a mission"), "{}", run.stderr);
        assert_eq!(scratch.query("SELECT count(DISTINCT mission) FROM sample"), [["2"]]);
    }
}

#[test]
fn cli_impossible_values_are_recorded_with_lines() {
    let scratch = Scratch::demo(2);
    // An ambient temperature in °C where kelvin belong.
    let file = format!("ztbus/{}", scratch.missions().remove(0));
    let text = scratch.read(&file);
    let header: Vec<&str> = text.lines().next().unwrap_or("").trim_end().split(',').collect();
    let column = header.iter().position(|h| *h == "temperature_ambient").expect("the column is there");
    let line = text.lines().nth(50).expect("a row").to_owned();
    let mut fields: Vec<&str> = line.split(',').collect();
    // Stop names are quoted and may hold a comma, but stand behind this column or nowhere near row 50.
    fields[column] = "11.5";
    scratch.write(&file, text.replacen(&line, &fields.join(","), 1));
    // A negative irradiance in the weather, far below what a sensor shows at night.
    let weather = "weather/ogd-smn_sma_h_historical_2020-2029.csv";
    let text = scratch.read(weather);
    let line = text.lines().nth(4000).expect("a row").to_owned();
    let mut fields: Vec<&str> = line.split(';').collect();
    fields[3] = "-120";
    scratch.write(weather, text.replacen(&line, &fields.join(";"), 1));
    scratch.expect(0, &["run"]);
    let found = scratch.query(
        "SELECT q.kind, q.line, q.column_name FROM source_file JOIN data_quality AS q USING (source_file_id) ORDER BY q.kind",
    );
    let has =
        |kind: &str, line: &str, column: &str| found.iter().any(|r| r[0] == kind && r[1] == line && r[2] == column);
    assert!(has("wrong_unit", "51", "temperature_ambient"), "{found:?}");
    assert!(has("out_of_range", "4001", "gre000h0"), "{found:?}");
}

#[test]
fn cli_weather_that_does_not_cover_the_missions_excludes_them_with_a_reason() {
    let scratch = Scratch::demo(6);
    let weather = "weather/ogd-smn_sma_h_historical_2020-2029.csv";
    let text = scratch.read(weather);
    let half: Vec<&str> = text.split_inclusive('\n').take(4000).collect();
    scratch.write(weather, half.concat());
    let run = scratch.expect(0, &["run"]);
    assert!(run.stderr.contains("segments excluded"), "{}", run.stderr);
    let reasons = scratch.query("SELECT DISTINCT reason FROM excluded_segment WHERE reason LIKE 'outside%'");
    assert_eq!(reasons, [["outside the weather record"]]);
    assert!(scratch.read("report/report.md").contains("outside the weather record"));
    let none: Vec<&str> = text.split_inclusive('\n').take(20).collect();
    scratch.write(weather, none.concat());
    let run = scratch.expect(3, &["run"]);
    assert!(run.stderr.contains("no samples") && run.stderr.contains("outside the weather record"), "{}", run.stderr);
}

#[test]
fn cli_tables_that_would_fill_the_memory_are_refused_with_the_limit() {
    let scratch = Scratch::demo(2);
    let file = format!("ztbus/{}", scratch.missions()[0]);
    let (mission, shadow) = (scratch.read(&file), scratch.read("shadow.csv"));
    let run_says = |name: &str, text: &str, status: i32, what: &str| {
        scratch.write(name, text);
        let run = scratch.expect(status, &["run"]);
        assert!(
            run.stderr.contains(&format!("{name}, {what}")) || run.stderr.contains(&format!("{name}: {what}")),
            "{}",
            run.stderr
        );
    };
    let header = mission.lines().next().unwrap();
    run_says(&file, &format!("{header}{}\n1\n", ",x".repeat(2000)), 1, "line 1: 2026 columns; at most 1000 are read");
    let long = format!("{header}\n\"{}\",1\n", "x".repeat(70_000));
    run_says(&file, &long, 1, "line 2: a line of 70004 bytes; at most 65536 are read");
    let many = format!("{header}\n{}", ",\n".repeat(2_000_000));
    run_says(&file, &many, 1, "line 1814402: more than 1814400 rows");
    scratch.write(&file, &mission);
    let wide = format!("time_utc,shadow_fraction{}\n", ",".repeat(1_000_000));
    run_says("shadow.csv", &wide, 3, "line 1: a line of 1000024 bytes; at most 65536 are read");
    scratch.write("shadow.csv", &shadow);
    scratch.expect(0, &["run"]);
}

#[test]
fn cli_all_missing_inputs_are_said_at_once_and_once() {
    let scratch = Scratch::empty();
    scratch.expect(0, &["init", "new"]);
    for command in ["run", "check"] {
        let run = scratch.expect(3, &[command, "new"]);
        let said = format!("{}{}", run.stdout, run.stderr);
        for input in ["new/ztbus: ", "new/weather: ", "new/shadow.csv: "] {
            assert_eq!(said.matches(input).count(), 1, "{command}: {input}: {said}");
        }
    }
    scratch.edit("new/study.toml", "[vehicle]", "[vehicle]\nmetabolic_rate_met = -1.0");
    let run = scratch.expect(2, &["run", "new"]);
    assert!(run.stderr.contains("[vehicle] metabolic_rate_met = -1: "), "{}", run.stderr);
}
