//! The tables and views on a few rows made by hand.

#![expect(clippy::unwrap_used, reason = "a test ends where something is not as expected")]

use cabin::{StandardRange, Temperatures};
use solve::{Infeasible, OperatingMode, Operation, Optimum, Outcome};
use store::{
    Counts, DesignRow, ExclusionRow, FileRow, FindingRow, PointId, RunEnd, SampleRow, SegmentRow, Store, StoreError,
    WindowRow,
};
use tempfile::TempDir;

const WINDOW: WindowRow = WindowRow { pmv_min: -1.0, pmv_max: 1.0, pmv_limit: 1.0 };

fn scratch() -> (TempDir, Store) {
    let folder = tempfile::tempdir().unwrap();
    let store = Store::open(&folder.path().join("study.db")).unwrap();
    (folder, store)
}

fn file(path: &str, key: &str) -> FileRow {
    FileRow {
        path: path.to_owned(),
        kind: "mission".to_owned(),
        blake3: "b".repeat(64),
        bytes: 10,
        rows: 3600,
        first_utc: Some("2022-01-05T05:00:00Z".to_owned()),
        last_utc: None,
        accepted: true,
        reading_key: key.to_owned(),
        findings: vec![FindingRow {
            kind: "time_gap".to_owned(),
            count: 2,
            line: Some(7),
            column: None,
            message: "it's \"quoted\"; -- | <b>".to_owned(),
        }],
    }
}

fn segment(mission: &str, number: u32) -> SegmentRow {
    SegmentRow {
        mission: mission.to_owned(),
        bus: 183,
        segment: number,
        start_utc: format!("2022-01-05T{:02}:00:00Z", 5 + number),
        duration_s: 3600,
        content: if number < 3 { Ok((10.5, 0.15, 2, 3601)) } else { Err("too short".to_owned()) },
    }
}

fn sample(id: i64, path: &str, month: u8) -> SampleRow {
    SampleRow {
        sample_id: id,
        mission: format!("m{path}"),
        source_path: path.to_owned(),
        bus: 183,
        segment: id as u32,
        first_line: 2,
        last_line: 3601,
        start_utc: "2022-01-05T05:00:00Z".to_owned(),
        duration_s: 3600,
        month,
        ambient_temperature_k: 273.15 + id as f64,
        dni_w_m2: 0.0,
        dhi_w_m2: 0.0,
        passengers: 10.5,
        door_open_fraction: 0.15,
        solar_altitude_rad: -std::f64::consts::FRAC_PI_6,
        solar_azimuth_rad: std::f64::consts::FRAC_PI_2,
        shadow_fraction: 1.0,
        interpolated_s: 0.0,
    }
}

fn design(name: &str, key: &str) -> DesignRow {
    DesignRow {
        name: name.to_owned(),
        heating: "ptc".to_owned(),
        heating_cop: "1".to_owned(),
        cooling_cop: "linear".to_owned(),
        radiant_heaters: false,
        air_curtain: false,
        method: "fast".to_owned(),
        design_key: key.to_owned(),
    }
}

fn solved(design: usize, mode: OperatingMode, power_w: f64) -> Optimum {
    let k = 290.15;
    let operation = Operation {
        mode,
        air_curtain_on: false,
        radiant_heaters_on: false,
        air_unit_power_w: power_w - 100.0,
        radiant_heater_power_w: 60.0,
        air_curtain_power_w: 40.0,
        air_unit_heat_w: power_w - 100.0,
        temperatures: Temperatures {
            radiant_heater_k: k,
            interior_k: k,
            cabin_k: k,
            shell_inside_k: k,
            shell_outside_k: k,
        },
        mean_radiant_temperature_k: k,
        pmv: -1.0,
        standard_range: StandardRange::Inside,
    };
    Optimum { design, window: 0, outcome: Outcome::Solved(operation, Some(5.0)) }
}

/// Two files, four samples in January and July, two designs, one window.
fn filled(store: &mut Store) {
    for path in ["a", "b"] {
        let segments: Vec<SegmentRow> = (0..4).map(|n| segment(&format!("m{path}"), n)).collect();
        store.put_file(&file(path, "k1"), &segments).unwrap();
    }
    let samples = [sample(1, "a", 1), sample(2, "a", 1), sample(3, "b", 1), sample(4, "b", 7)];
    let exclusion = ExclusionRow {
        mission: "ma".to_owned(),
        segment: 3,
        start_utc: "2022-01-05T08:00:00Z".to_owned(),
        reason: "too short".to_owned(),
    };
    assert_eq!(store.put_samples(&samples, &[exclusion]).unwrap(), (4, 0));
    let change = store.put_study(&[design("ptc", "x"), design("hp", "y")], &[WINDOW]).unwrap();
    assert_eq!(change.changed_designs, ["ptc", "hp"]);
    let heating = [1000.0, 2000.0, 3000.0];
    let mut points = Vec::new();
    for (i, sample) in samples.iter().enumerate() {
        for d in 0..2 {
            let optimum = match (i, d) {
                (2, 1) => Optimum { design: 1, window: 0, outcome: Outcome::Infeasible(Infeasible::TooWarm) },
                (3, _) => solved(d, OperatingMode::Cooling, 500.0),
                _ => solved(d, OperatingMode::Heating, heating[i] / (1 + d) as f64),
            };
            let (design_id, window_id) = (change.design_ids[d], change.window_ids[0]);
            points.push((PointId { sample_id: sample.sample_id, design_id, window_id }, optimum));
        }
    }
    store.put_optima(&[], points.iter().map(|(id, optimum)| (*id, optimum, None))).unwrap();
}

#[test]
fn prop_annual_averages_weigh_months_by_their_days_and_leave_unsolved_points_out() {
    let (_folder, mut store) = scratch();
    filled(&mut store);
    let annual = store.annual().unwrap();
    assert_eq!(annual.iter().map(|r| r.design.as_str()).collect::<Vec<_>>(), ["ptc", "hp"]);
    // January and July have 31 days each: (2000 + 500) / 2.
    assert_eq!(annual[0].hvac_power_w, Some(1250.0));
    assert_eq!((annual[0].heating_power_w, annual[0].cooling_power_w), (Some(1000.0), Some(250.0)));
    assert_eq!((annual[0].sample_count, annual[0].unsolved_count, annual[0].reduction_vs_ptc), (4, 0, Some(0.0)));
    // January's solved samples: (500 + 1000) / 2, then (750 + 500) / 2.
    assert_eq!(annual[1].hvac_power_w, Some(625.0));
    assert_eq!((annual[1].unsolved_count, annual[1].unsolved_weight), (1, 1.0 / 6.0));
    assert_eq!(annual[1].reduction_vs_ptc, Some(0.5));

    let weights: f64 = store.query_text("SELECT sum(weight) FROM sample").unwrap()[0][0].parse().unwrap();
    assert!((weights - 1.0).abs() < 1e-15);
    let monthly: Vec<_> = store.monthly().unwrap().iter().map(|m| m.hvac_power_w).collect();
    assert_eq!(monthly, [2000.0, 500.0, 750.0, 500.0].map(Some));
    let counts = store.status_counts().unwrap();
    assert_eq!((counts.solved, counts.infeasible, counts.not_converged), (7, 1, 0));
    let shares = store.limit_shares().unwrap();
    assert_eq!((shares[0].lower_count, shares[0].cooling_count, shares[0].cooling_weight), (4, 1, 0.5));
}

#[test]
fn prop_the_views_speak_celsius_degrees_and_words() {
    let (_folder, mut store) = scratch();
    filled(&mut store);
    let sql = "SELECT status, hvac_power_w, operating_mode, cabin_temperature_c, pmv, runner_up_excess_w FROM optimum
        WHERE design = 'hp' ORDER BY sample_id";
    let rows = store.query_text(sql).unwrap();
    assert_eq!(rows[0], ["solved", "500.0", "1", "17.0", "-1.0", "5.0"]);
    assert_eq!(rows[2], ["infeasible: too warm", "", "", "", "", ""]);
    assert_eq!(rows[3][2], "-1");
    let sql = "SELECT ambient_temperature_c, solar_altitude_deg FROM sample WHERE sample_id = 2";
    let numbers: Vec<f64> = store.query_text(sql).unwrap()[0].iter().map(|c| c.parse().unwrap()).collect();
    assert!((numbers[0] - 2.0).abs() < 1e-9 && (numbers[1] + 30.0).abs() < 1e-9, "{numbers:?}");
}

#[test]
fn prop_a_changed_file_takes_its_samples_and_optima_along_and_an_unchanged_one_does_not() {
    let (_folder, mut store) = scratch();
    filled(&mut store);
    let points = |store: &mut Store| store.query_text("SELECT count(*) FROM optimum").unwrap()[0][0].clone();
    store.put_file(&file("a", "k1"), &[segment("ma", 0)]).unwrap();
    assert_eq!(points(&mut store), "8");
    store.put_file(&file("a", "k2"), &[segment("ma", 0)]).unwrap();
    assert_eq!(points(&mut store), "4");
    assert_eq!(store.keep_files("mission", &["a".to_owned()]).unwrap(), 1);
    assert_eq!(points(&mut store), "0");
    assert!(store.query_text("PRAGMA foreign_key_check").unwrap().is_empty());
}

#[test]
fn prop_samples_become_exactly_those_given_and_equal_ones_keep_their_optima() {
    let (_folder, mut store) = scratch();
    filled(&mut store);
    let mut samples = store.samples().unwrap();
    assert_eq!(samples.len(), 4);
    assert_eq!(store.put_samples(&samples, &[]).unwrap(), (0, 0));
    samples.remove(3);
    samples[0].passengers = 11.0;
    assert_eq!(store.put_samples(&samples, &[]).unwrap(), (1, 1));
    let left = store.query_text("SELECT DISTINCT sample_id FROM optimum ORDER BY sample_id").unwrap();
    assert_eq!(left, [["2"], ["3"]]);
    assert_eq!(store.complete_samples(2).unwrap().into_iter().collect::<Vec<_>>(), [2, 3]);
    assert!(store.exclusions().unwrap().is_empty());
    let stranger = sample(9, "nowhere", 1);
    assert!(matches!(store.put_samples(&[stranger], &[]), Err(StoreError::UnknownFile(_))));
}

#[test]
fn prop_a_changed_design_alone_loses_its_optima() {
    let (_folder, mut store) = scratch();
    filled(&mut store);
    let same = store.put_study(&[design("ptc", "x"), design("hp", "y")], &[WINDOW]).unwrap();
    assert!(same.changed_designs.is_empty());
    let change = store.put_study(&[design("hp", "z"), design("ptc", "x")], &[WINDOW]).unwrap();
    assert_eq!(change.changed_designs, ["hp"]);
    let left = store.query_text("SELECT design, count(*) FROM optimum GROUP BY design").unwrap();
    assert_eq!(left, [["ptc", "4"]]);
    let narrower = WindowRow { pmv_min: -0.5, pmv_max: 0.5, pmv_limit: 0.5 };
    assert_eq!(store.put_study(&[design("ptc", "x")], &[narrower]).unwrap().removed, 2);
    assert_eq!(store.query_text("SELECT count(*) FROM optimum").unwrap(), [["0"]]);
}

#[test]
fn prop_text_survives_whatever_it_holds() {
    let (_folder, mut store) = scratch();
    let hostile = "x'; DROP TABLE source_file; --\n\"<script>";
    store.put_file(&file(hostile, "k"), &[]).unwrap();
    let files = store.files().unwrap();
    assert_eq!((files.len(), files[0].path.as_str()), (1, hostile));
    assert_eq!(store.findings().unwrap()[0].finding, file("", "").findings[0]);
    assert_eq!(store.known_files("mission").unwrap()[0].reading_key, "k");
}

#[test]
fn prop_runs_are_recorded_and_a_broken_one_is_marked() {
    let (folder, mut store) = scratch();
    store.start_run("2022-01-01T00:00:00Z", "0.1.0", "h").unwrap();
    let id = store.start_run("2022-01-02T00:00:00Z", "0.1.0", "h").unwrap();
    let counts = Counts { points: 8, solved: 7, failed: 1 };
    store.end_run(id, "2022-01-02T00:00:09Z", RunEnd::DoneWithLosses, Some("i"), counts).unwrap();
    let last = store.last_run().unwrap().unwrap();
    assert_eq!((last.status.as_str(), last.counts), ("done with losses", Some(counts)));
    let all = store.query_text("SELECT status FROM run ORDER BY run_id").unwrap();
    assert_eq!(all, [["interrupted"], ["done with losses"]]);
    store.close().unwrap();
    let mut reader = Store::open_read_only(&folder.path().join("study.db")).unwrap();
    assert!(reader.last_run().unwrap().is_some());
    assert!(reader.start_run("", "", "").is_err(), "a reader writes");
    assert!(matches!(Store::open_read_only(&folder.path().join("other.db")), Err(StoreError::Missing(_))));
}
