//! What each stage says when what it builds on is out of date, and what it needs no more once it is stored.

#![expect(clippy::unwrap_used, reason = "a test ends where something is not as expected")]

use crate::common::Scratch;

const WEATHER: &str = "weather/ogd-smn_sma_h_historical_2020-2029.csv";

fn solved() -> Scratch {
    let scratch = Scratch::small(6, "[0.5, 1.0]", "[1.0]");
    scratch.expect(0, &["run"]);
    scratch
}

/// Warms one hour of the weather, in which the first sample lies.
fn touch_weather(scratch: &Scratch) {
    let start = &scratch.query("SELECT start_utc FROM sample ORDER BY sample_id LIMIT 1")[0][0];
    // The stamp is the end of the interval.
    let hour: u32 = start[11..13].parse().unwrap();
    let stamp = format!("{}.{}.{} {:02}:00", &start[8..10], &start[5..7], &start[..4], hour + 1);
    let text = scratch.read(WEATHER);
    let line = text.lines().find(|l| l.contains(&stamp)).unwrap();
    let fields: Vec<&str> = line.split(';').collect();
    let header: Vec<&str> = text.lines().next().unwrap().split(';').collect();
    let place = header.iter().position(|h| *h == "tre200h0").unwrap();
    let warmer = (fields[place].parse::<f64>().unwrap() + 3.0).to_string();
    let changed: Vec<&str> =
        fields.iter().enumerate().map(|(i, f)| if i == place { warmer.as_str() } else { f }).collect();
    scratch.edit(WEATHER, line, &changed.join(";"));
}

#[test]
fn cli_a_report_needs_no_inputs() {
    let scratch = solved();
    let report = scratch.report();
    std::fs::create_dir(scratch.path("away")).unwrap();
    for input in ["ztbus", "weather", "shadow.csv"] {
        std::fs::rename(scratch.path(input), scratch.path("away").join(input)).unwrap();
    }
    std::fs::remove_dir_all(scratch.path("report")).unwrap();
    let run = scratch.expect(0, &["report"]);
    assert!(!run.stderr.contains("stale"), "{}", run.stderr);
    assert!(report == scratch.report());
    for file in ["mission_cold.svg", "mission_hot.svg", "simulated_pareto.svg"] {
        assert!(report.iter().any(|(name, _)| name == file), "{file} is missing");
    }
}

#[test]
fn cli_a_touched_weather_file_leads_each_stage_alone_to_say_what_is_stale() {
    let scratch = solved();
    let (hash, samples) = ("SELECT blake3 FROM source_file WHERE kind = 'weather'", "SELECT * FROM sample");
    let (recorded, before) = (scratch.query(hash), scratch.query(samples));
    let report = scratch.report();
    touch_weather(&scratch);
    let stale = format!("the samples are stale: {WEATHER} or the settings of its reading have changed");
    let ingest = scratch.expect(0, &["ingest"]);
    assert!(
        ingest.stderr.contains(&stale) && ingest.stderr.contains("`busclimate shade` comes next"),
        "{}",
        ingest.stderr
    );
    for stage in ["solve", "simulate", "control"] {
        let run = scratch.expect(3, &[stage]);
        assert!(run.stderr.contains(&stale) && run.stderr.contains("run `busclimate shade` first"), "{}", run.stderr);
    }
    let run = scratch.expect(0, &["report"]);
    assert!(run.stderr.contains(&stale) && run.stderr.contains("`busclimate run` renews it"), "{}", run.stderr);
    // Nothing vouches for what was not used.
    assert_eq!(scratch.query(hash), recorded);
    assert!(before == scratch.query(samples) && report == scratch.report());

    // The remedies, one after the other: each makes the next stage the stale one.
    let shade = scratch.expect(0, &["shade"]);
    assert!(shade.stderr.contains("1 new or changed"), "{}", shade.stderr);
    assert!(scratch.query(hash) != recorded);
    for stage in ["simulate", "control"] {
        let run = scratch.expect(3, &[stage]);
        assert!(
            run.stderr.contains("the optima are stale: 1 samples have none")
                && run.stderr.contains("run `busclimate solve` first")
        );
    }
    let solve = scratch.expect(0, &["solve"]);
    assert!(solve.stderr.contains("10 points computed now (1 samples × 10)"), "{}", solve.stderr);
    let simulate = scratch.expect(0, &["simulate"]);
    assert!(simulate.stderr.contains("20 missions simulated now"), "{}", simulate.stderr);
    scratch.expect(0, &["control"]);
    let fresh = scratch.expect(0, &["report"]);
    assert!(!fresh.stderr.contains("stale"), "{}", fresh.stderr);
    assert!(report != scratch.report());
}

#[test]
fn cli_weather_that_goes_on_makes_nothing_stale_that_it_does_not_concern() {
    let scratch = solved();
    let last = scratch.read(WEATHER).lines().last().unwrap().to_owned();
    let more = last.replace("01.01.2023 00:00", "01.01.2023 01:00");
    assert!(more != last, "{last}");
    let text = scratch.read(WEATHER);
    scratch.write(WEATHER, format!("{}\n{more}\n", text.trim_end()));
    let run = scratch.expect(0, &["run"]);
    assert!(run.stderr.contains("0 new or changed") && run.stderr.contains(" 0 points computed now"), "{}", run.stderr);
    assert!(run.stderr.contains("INFO 0 missions simulated now"), "{}", run.stderr);
}

#[test]
fn cli_a_mission_that_cannot_be_simulated_is_a_row_with_a_reason() {
    let scratch = Scratch::demo(6);
    scratch.edit("study.toml", "pmv_limits = [0.0, 0.5, 1.0, 1.5, 2.0]", "pmv_limits = [1.0]");
    for stage in ["ingest", "shade", "solve"] {
        scratch.expect(0, &[stage]);
    }
    // No window of this bus is out of reach, so a row is made that says so.
    scratch.tamper(
        "UPDATE optimum_point SET status = 2, row_check = NULL WHERE sample_id = (SELECT min(sample_id) FROM optimum_point)
            AND design_id = (SELECT design_id FROM hvac_design WHERE name = 'hp')
            AND window_id = (SELECT window_id FROM comfort_window WHERE pmv_limit = 1.0)",
    );
    let run = scratch.expect(1, &["simulate"]);
    assert!(run.stderr.contains("1 missions are not simulated, the first: B183_"), "{}", run.stderr);
    let failed = scratch.query("SELECT design, pmv_limit, reason FROM simulation_failure");
    assert_eq!(failed, [["hp", "1.0", "segment 0 has no optimum: infeasible: too cold"]]);
    assert_eq!(scratch.query("SELECT count(*) FROM simulation"), [[(4 * (6 * 5 - 1)).to_string()]]);
    scratch.expect(0, &["status"]);
    // Known already: it is not tried again, and said again.
    let again = scratch.expect(1, &["simulate"]);
    assert!(again.stderr.contains("INFO 0 missions simulated now"), "{}", again.stderr);
    scratch.expect(1, &["report"]);
    assert!(scratch.read("report/report.md").contains("- **1 missions are not simulated**"));
    assert!(scratch.read("report/simulation_failures.csv").contains("segment 0 has no optimum"));
}

/// Writes a file in place and gives it a time of its own, as if nobody had.
fn write_unnoticed(scratch: &Scratch, name: &str, content: &str) {
    let long_ago = std::time::SystemTime::UNIX_EPOCH + std::time::Duration::from_secs(1_700_000_000);
    scratch.write(name, content);
    let file = std::fs::File::options().write(true).open(scratch.path(name)).unwrap();
    file.set_modified(long_ago).unwrap();
}

#[test]
fn cli_a_file_that_looks_as_it_did_is_read_again_only_when_asked() {
    let scratch = Scratch::demo(3);
    scratch.edit("study.toml", "pmv_limits = [0.0, 0.5, 1.0, 1.5, 2.0]", "pmv_limits = []");
    let mission = format!("ztbus/{}", scratch.missions()[1]);
    let text = scratch.read(&mission);
    write_unnoticed(&scratch, &mission, &text);
    write_unnoticed(&scratch, WEATHER, &scratch.read(WEATHER));
    scratch.expect(0, &["run"]);
    let samples = scratch.query("SELECT passengers FROM sample ORDER BY sample_id");

    // One passenger more or less from somewhere on, at the same length.
    let (line, more) = text
        .lines()
        .find_map(|l| {
            let column = text.lines().next()?.split(',').position(|h| h == "itcs_numberOfPassengers")?;
            let fields: Vec<&str> = l.split(',').collect();
            let count: f64 = fields.get(column)?.parse().ok().filter(|c| *c > 1.0 && *c < 8.0)?;
            let mut changed = fields.clone();
            let other = fields[column].replacen(&format!("{count:.0}"), &format!("{:.0}", count + 1.0), 1);
            changed[column] = &other;
            Some((l.to_owned(), changed.join(",")))
        })
        .unwrap();
    write_unnoticed(&scratch, &mission, &text.replacen(&line, &more, 1));
    let run = scratch.expect(0, &["run"]);
    assert!(run.stderr.contains("0 read now"), "{}", run.stderr);
    assert!(samples == scratch.query("SELECT passengers FROM sample ORDER BY sample_id"));
    let run = scratch.expect(0, &["run", "--rehash"]);
    assert!(run.stderr.contains("1 read now"), "{}", run.stderr);
    assert!(samples != scratch.query("SELECT passengers FROM sample ORDER BY sample_id"));
    // Another time alone makes no other content, and is known from then on.
    let earlier = std::time::SystemTime::UNIX_EPOCH + std::time::Duration::from_secs(1_600_000_000);
    let file = std::fs::File::options().write(true).open(scratch.path(WEATHER)).unwrap();
    file.set_modified(earlier).unwrap();
    let run = scratch.expect(0, &["run"]);
    assert!(run.stderr.contains("0 read now") && run.stderr.contains("0 new or changed"), "{}", run.stderr);
    let stamps = "SELECT modified_ns FROM file_stamp JOIN source_file USING (source_file_id) WHERE kind = 'weather'
        ORDER BY modified_ns LIMIT 1";
    assert_eq!(scratch.query(stamps), [["1600000000000000000"]]);
}

#[test]
fn cli_weather_that_gives_no_sample_at_all_takes_nothing_away() {
    let scratch = solved();
    let optima = scratch.query("SELECT count(*) FROM optimum");
    let text = scratch.read(WEATHER);
    let three: Vec<&str> = text.lines().take(3).collect();
    scratch.write(WEATHER, three.join("\n"));
    let run = scratch.expect(3, &["run"]);
    assert!(run.stderr.contains("no samples: "), "{}", run.stderr);
    assert_eq!(scratch.query("SELECT count(*) FROM optimum"), optima);
}

#[test]
fn cli_a_report_that_somebody_has_changed_is_written_again() {
    let scratch = solved();
    let report = scratch.report();
    scratch.write("report/report.md", "mine");
    std::fs::remove_file(scratch.path("report/pareto.svg")).unwrap();
    scratch.expect(0, &["run"]);
    assert!(report == scratch.report());
}

#[test]
fn cli_a_file_that_reports_no_longer_have_goes_unless_somebody_has_changed_it() {
    let scratch = solved();
    // As if the report before had had two files more, empty ones.
    scratch.tamper(
        "UPDATE stage_record SET stage_key = '', row_check = NULL, result = json_set(result,
            '$.files[#]', json_array('old.svg', 'af1349b9f5f9a1a6a0404dea36dcc9499bcb25c9adc112b7cc9a93cae41f3262'),
            '$.files[#]', json_array('own.svg', 'af1349b9f5f9a1a6a0404dea36dcc9499bcb25c9adc112b7cc9a93cae41f3262'))
         WHERE stage = 'report'",
    );
    scratch.write("report/old.svg", "");
    scratch.write("report/own.svg", "mine");
    scratch.write("report/notes.txt", "");
    scratch.expect(0, &["run"]);
    let names: Vec<String> = scratch.report().into_iter().map(|(name, _)| name).collect();
    let has = |name: &str| names.iter().any(|n| n == name);
    assert_eq!(["old.svg", "own.svg", "notes.txt", "report.md"].map(has), [false, true, true, true]);
}
