//! The tables and views on a few rows made by hand.

#![expect(clippy::unwrap_used, reason = "a test ends where something is not as expected")]

use cabin::{
    ComfortWindow, Devices, Disturbances, Heating, Infeasible, OperatingMode, Operation, Optimum, Outcome,
    StandardRange, Temperatures,
};
use chrono::{DateTime, TimeDelta, Utc};
use ingest::mission::{MissionReading, Segment};
use ingest::sample::Sample;
use ingest::{ExcludedSegment, FileKind, FileRecord, FileStamp, Finding, FindingKind};
use proptest::prelude::*;
use solve::Method;
use std::collections::BTreeSet;
use store::{
    Beside, Counts, DesignRow, Energy, MissingOptima, MonthAverages, NewOptimum, RecordedStage, RunEnd, StageRecord,
    Store, StoreError, StoredGrid,
};
use tempfile::TempDir;

fn window(limit: f64) -> ComfortWindow {
    ComfortWindow::symmetric(limit).unwrap()
}

fn scratch() -> (TempDir, Store) {
    let folder = tempfile::tempdir().unwrap();
    let store = Store::open(&folder.path().join("study.db")).unwrap();
    (folder, store)
}

fn start() -> DateTime<Utc> {
    "2022-01-05T05:00:00Z".parse().unwrap()
}

fn file(path: &str, kind: FileKind) -> FileRecord {
    FileRecord {
        path: path.to_owned(),
        kind,
        blake3: "b".repeat(64),
        bytes: 10,
        rows: 3600,
        first: Some(start()),
        last: None,
        stamp: Some(FileStamp { bytes: 10, modified_ns: 1_700_000_000_000_000_000, inode: 7 }),
        accepted: true,
        findings: vec![Finding {
            kind: FindingKind::TimeGap,
            count: 2,
            line: Some(7),
            column: None,
            message: "it's \"quoted\"; -- | <b>".to_owned(),
        }],
    }
}

fn segment(path: &str, number: u32) -> Segment {
    Segment {
        mission: format!("m{path}"),
        source_path: path.to_owned(),
        bus: 183,
        segment: number,
        start: start() + TimeDelta::hours(i64::from(number)),
        duration_s: 3600,
        passengers: 10.5,
        door_open_fraction: 0.15,
        // Missions here have three segments, of which alone it is stored how the bus drives.
        distance_m: (number < 3).then_some(15_400.0),
        vehicle_power_w: (number < 3).then_some(24_800.5),
        route: (number < 3).then(|| "33".to_owned()),
        first_line: 2,
        last_line: 3601,
    }
}

fn excluded(path: &str, number: u32) -> ExcludedSegment {
    ExcludedSegment {
        mission: format!("m{path}"),
        bus: 183,
        segment: number,
        start: start() + TimeDelta::hours(i64::from(number)),
        duration_s: 1200,
        reason: "too short".to_owned(),
    }
}

fn mission(path: &str, segments: u32) -> MissionReading {
    MissionReading {
        file: file(path, FileKind::Mission),
        segments: (0..segments).map(|n| segment(path, n)).collect(),
        excluded: vec![excluded(path, segments)],
        loads: Vec::new(),
    }
}

fn sample(id: i64, path: &str, month: u8) -> Sample {
    let segment = segment(path, id as u32);
    Sample {
        id,
        month,
        disturbances: Disturbances {
            ambient_temperature_k: 273.15 + id as f64,
            dni_w_m2: 0.0,
            dhi_w_m2: 0.0,
            solar_altitude_rad: -std::f64::consts::FRAC_PI_6,
            shadow_fraction: 1.0,
            passengers: segment.passengers,
            door_open_fraction: segment.door_open_fraction,
        },
        solar_azimuth_rad: std::f64::consts::FRAC_PI_2,
        clock: None,
        interpolated_s: 0.0,
        key: format!("key {id}"),
        segment,
    }
}

fn design(name: &str, key: &str) -> DesignRow {
    DesignRow {
        name: name.to_owned(),
        heating: Heating::Ptc,
        heating_cop: "1".to_owned(),
        cooling_cop: "linear".to_owned(),
        devices: Devices::NONE,
        method: Method::Fast,
        design_key: key.to_owned(),
    }
}

fn solved(design: usize, mode: OperatingMode, power_w: f64) -> Optimum {
    let k = 290.15;
    let operation = Operation {
        mode,
        devices: Devices::NONE,
        air_unit_power_w: power_w - 100.0,
        radiant_heater_power_w: 60.0,
        air_curtain_power_w: 40.0,
        backup_heater_power_w: 0.0,
        air_unit_heat_w: power_w - 100.0,
        unmet_heat_w: 0.0,
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

/// Of the months that have changed.
fn averages(store: &mut Store, grid: &StoredGrid) -> Energy {
    let (months, samples) = (store.stale_months().unwrap(), store.samples().unwrap());
    let of_month = |month: u8| {
        let mut averages = MonthAverages::new(month, grid);
        for sample in samples.iter().filter(|s| s.month == month) {
            store.optima(grid, &[sample.id]).unwrap().iter().for_each(|optimum| averages.add(optimum));
        }
        averages
    };
    Energy { averages: months.into_iter().map(of_month).collect(), ..Energy::default() }
}

/// Two files, four samples in January and July, two designs, one window.
fn filled(store: &mut Store) {
    for path in ["a", "b"] {
        store.put_missions([(&mission(path, 3), "k1")]).unwrap();
    }
    let samples = [sample(1, "a", 1), sample(2, "a", 1), sample(3, "b", 1), sample(4, "b", 7)];
    let weather = (file("w", FileKind::Weather), "wk".to_owned());
    assert_eq!(store.put_samples(&samples, &[excluded("a", 3)], &[weather]).unwrap(), (4, 0));
    let change = store.put_grid(&[design("ptc", "x"), design("hp", "y")], &[window(1.0)]).unwrap();
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
            points.push((sample.id, optimum));
        }
    }
    store.put_optima(&change.grid, points.iter().map(|(id, optimum)| NewOptimum::of(*id, optimum))).unwrap();
    assert!(store.annual().unwrap().is_empty(), "averages show before the stage is complete");
    let energy = averages(store, &change.grid);
    store
        .complete_optima(
            &StageRecord { key: "k".to_owned(), result: "[]".to_owned() },
            &change.grid,
            &energy,
            &Beside::default(),
        )
        .unwrap();
    let stored = store.optima(&change.grid, &[1, 2, 3, 4]).unwrap();
    assert_eq!(stored.len(), points.len());
    for (row, (id, optimum)) in stored.iter().zip(&points) {
        assert_eq!((row.sample_id, row.design, row.window), (*id, optimum.design, optimum.window));
        assert_eq!(row.outcome, Some(optimum.outcome));
    }
}

#[test]
fn prop_an_optimum_of_nothing_is_refused_and_keys_hold_after_it() {
    let (_folder, mut store) = scratch();
    filled(&mut store);
    let stored = |store: &mut Store| store.query_text("SELECT count(*) FROM optimum_point").unwrap();
    let before = stored(&mut store);
    let grid = store.put_grid(&[design("ptc", "x"), design("hp", "y")], &[window(1.0)]).unwrap().grid;
    let optimum = solved(0, OperatingMode::Heating, 1.0);
    let error = store.put_optima(&grid, [NewOptimum::of(77, &optimum)].into_iter()).unwrap_err();
    assert!(matches!(error, store::StoreError::UnknownPoint { table: "hourly_sample", id: 77 }), "{error}");
    assert_eq!(stored(&mut store), before);
    // Samples that go take their optima along, as before.
    store.put_samples(&[], &[], &[]).unwrap();
    assert_eq!(stored(&mut store), [["0"]]);
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
    assert_eq!(
        rows[0],
        [solved(1, OperatingMode::Heating, 500.0).outcome.words(), "500.0", "1", "17.0", "-1.0", "5.0"]
    );
    assert_eq!(rows[2], [Outcome::Infeasible(Infeasible::TooWarm).words(), "", "", "", "", ""]);
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
    store.put_missions([(&mission("a", 1), "k1")]).unwrap();
    assert_eq!(points(&mut store), "8");
    store.put_missions([(&mission("a", 1), "k2")]).unwrap();
    assert_eq!(points(&mut store), "4");
    // Its two segments wait for weather again, beside three of the other mission.
    assert_eq!(store.unjoined_segments().unwrap(), 5);
    let other: BTreeSet<String> =
        store.known_files(FileKind::Mission).unwrap().into_keys().filter(|path| path != "a").collect();
    assert_eq!(other.len(), 1);
    // That it is missing is recorded, and changes nothing.
    store.put_missing(&other, "gone").unwrap();
    assert_eq!((store.missing_files().unwrap(), points(&mut store)), (other.clone(), "4".to_owned()));
    store.put_missing(&BTreeSet::new(), "gone").unwrap();
    assert!(store.missing_files().unwrap().is_empty());
    store.forget_files(&other).unwrap();
    assert_eq!(points(&mut store), "0");
    assert!(store.query_text("PRAGMA foreign_key_check").unwrap().is_empty());
}

#[test]
fn prop_segments_come_back_as_they_were() {
    let (_folder, mut store) = scratch();
    store.put_missions([(&mission("a", 2), "k1")]).unwrap();
    let expected = [Ok(segment("a", 0)), Ok(segment("a", 1)), Err(excluded("a", 2))];
    assert_eq!(store.segments().unwrap(), expected.map(|s| ("k1".to_owned(), s)));
}

#[test]
fn prop_samples_become_exactly_those_given_and_equal_ones_keep_their_optima() {
    let (_folder, mut store) = scratch();
    filled(&mut store);
    let mut samples = store.samples().unwrap();
    assert_eq!(samples, [sample(1, "a", 1), sample(2, "a", 1), sample(3, "b", 1), sample(4, "b", 7)]);
    assert_eq!(store.put_samples(&samples, &[], &[]).unwrap(), (0, 0));
    assert!(store.known_files(FileKind::Weather).unwrap().is_empty(), "the samples are joined with no file now");
    // Made from something else that gives the same values: the optima stay, the key is new.
    "other".clone_into(&mut samples[1].key);
    assert_eq!(store.put_samples(&samples, &[], &[]).unwrap(), (0, 0));
    assert_eq!(store.samples().unwrap()[1].key, "other");
    samples.remove(3);
    samples[0].disturbances.passengers = 11.0;
    samples[0].segment.passengers = 11.0;
    assert_eq!(store.put_samples(&samples, &[], &[]).unwrap(), (1, 1));
    let left = store.query_text("SELECT DISTINCT sample_id FROM optimum ORDER BY sample_id").unwrap();
    assert_eq!(left, [["2"], ["3"]]);
    let grid = store.grid().unwrap();
    assert_eq!(
        store.missing_optima(&grid).unwrap(),
        [MissingOptima { points: vec![(0, 0), (1, 0)], samples: vec![1] }]
    );
    assert!(store.exclusion_counts().unwrap().is_empty());
    let stranger = sample(9, "nowhere", 1);
    assert!(matches!(store.put_samples(&[stranger], &[], &[]), Err(StoreError::UnknownFile(_))));
}

#[test]
fn prop_a_changed_design_alone_loses_its_optima() {
    let (_folder, mut store) = scratch();
    filled(&mut store);
    let same = store.put_grid(&[design("ptc", "x"), design("hp", "y")], &[window(1.0)]).unwrap();
    assert!(same.changed_designs.is_empty());
    assert_eq!(store.grid().unwrap(), same.grid);
    let change = store.put_grid(&[design("hp", "z"), design("ptc", "x")], &[window(1.0)]).unwrap();
    assert_eq!(change.changed_designs, ["hp"]);
    let left = store.query_text("SELECT design, count(*) FROM optimum GROUP BY design").unwrap();
    assert_eq!(left, [["ptc", "4"]]);
    let gaps = store.missing_optima(&change.grid).unwrap();
    assert_eq!(gaps, [MissingOptima { points: vec![(0, 0)], samples: vec![1, 2, 3, 4] }]);
    assert_eq!(store.put_grid(&[design("ptc", "x")], &[window(0.5)]).unwrap().removed, 2);
    assert_eq!(store.query_text("SELECT count(*) FROM optimum").unwrap(), [["0"]]);
    // What has gone on purpose is no damage.
    store.check_averages().unwrap();
}

#[test]
fn prop_a_renamed_design_keeps_its_optima() {
    let (_folder, mut store) = scratch();
    filled(&mut store);
    // Two designs that exchange their names, too.
    let swapped = store.put_grid(&[design("ptc", "y"), design("hp", "x")], &[window(1.0)]).unwrap();
    assert!(swapped.changed_designs.is_empty() && swapped.removed == 0);
    assert!(store.missing_optima(&swapped.grid).unwrap().is_empty());
    assert_eq!(store.grid().unwrap(), swapped.grid);
    let powers = "SELECT design, hvac_power_w FROM optimum WHERE sample_id = 1 ORDER BY design";
    assert_eq!(store.query_text(powers).unwrap(), [["hp", "1000.0"], ["ptc", "500.0"]]);
    assert_eq!(store.query_text("SELECT count(*) FROM stale_month").unwrap(), [["12"]]);
}

#[test]
fn prop_averages_are_those_of_the_last_complete_stage_and_only_changed_months_are_renewed() {
    let (_folder, mut store) = scratch();
    filled(&mut store);
    let before = (store.annual().unwrap(), store.monthly().unwrap());
    assert!(store.stage(RecordedStage::Solve).unwrap().is_some());
    let mut samples = store.samples().unwrap();
    samples[3].disturbances.dhi_w_m2 = 10.0;
    assert_eq!(store.put_samples(&samples, &[], &[]).unwrap(), (1, 0));
    // July's sample has no optima now: the stage is open, the averages are as they were.
    assert!(store.stage(RecordedStage::Solve).unwrap().is_none());
    assert_eq!(store.query_text("SELECT month FROM stale_month").unwrap(), [["7"]]);
    assert_eq!((store.annual().unwrap(), store.monthly().unwrap()), before);
    let grid = store.grid().unwrap();
    let optima = [0, 1].map(|d| (4, solved(d, OperatingMode::Cooling, 700.0)));
    store.put_optima(&grid, optima.iter().map(|(id, o)| NewOptimum::of(*id, o))).unwrap();
    let energy = averages(&mut store, &grid);
    store
        .complete_optima(
            &StageRecord { key: "k2".to_owned(), result: "[]".to_owned() },
            &grid,
            &energy,
            &Beside::default(),
        )
        .unwrap();
    let monthly: Vec<_> = store.monthly().unwrap().iter().map(|m| m.hvac_power_w).collect();
    assert_eq!(monthly, [2000.0, 700.0, 750.0, 700.0].map(Some));
    assert_eq!(store.annual().unwrap()[0].hvac_power_w, Some(1350.0));
}

#[test]
fn prop_text_survives_whatever_it_holds() {
    let (_folder, mut store) = scratch();
    let hostile = file("x'; DROP TABLE source_file; --\n\"<script>", FileKind::Mission);
    store.put_file(&hostile, "k").unwrap();
    assert_eq!(store.files().unwrap(), std::slice::from_ref(&hostile));
    let known = store.known_files(FileKind::Mission).unwrap().remove(&hostile.path).unwrap();
    assert_eq!((known.reading_key.as_str(), known.stamp), ("k", hostile.stamp));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]
    #[test]
    fn prop_weights_of_the_months_present_sum_to_one(counts in prop::array::uniform12(0_u8..9)) {
        let (_folder, mut store) = scratch();
        store.put_missions([(&mission("a", 0), "k")]).unwrap();
        let months = counts.iter().enumerate().flat_map(|(m, &n)| vec![m as u8 + 1; usize::from(n)]);
        let samples: Vec<Sample> = months.enumerate().map(|(i, month)| sample(i as i64, "a", month)).collect();
        store.put_samples(&samples, &[], &[]).unwrap();
        let weights: f64 = store.months().unwrap().iter().map(|m| m.sample_weight * m.sample_count as f64).sum();
        prop_assert!(samples.is_empty() || (weights - 1.0).abs() < 1e-12, "{weights}");
        prop_assert_eq!(store.months().unwrap().len(), counts.iter().filter(|&&n| n > 0).count());
    }
}

#[test]
fn paper_the_weight_of_a_sample_is_the_days_of_its_month_over_365_and_samples() {
    let (_folder, mut store) = scratch();
    store.put_missions([(&mission("a", 0), "k")]).unwrap();
    let months = (1..=12_u8).flat_map(|month| vec![month; usize::from(month)]);
    let samples: Vec<Sample> = months.enumerate().map(|(i, month)| sample(i as i64, "a", month)).collect();
    store.put_samples(&samples, &[], &[]).unwrap();
    let weights = store.months().unwrap();
    assert!((weights[0].sample_weight - 31.0 / 365.0).abs() < 1e-15);
    assert!((weights[1].sample_weight - 28.0 / 365.0 / 2.0).abs() < 1e-15);
    assert!((weights[11].sample_weight - 31.0 / 365.0 / 12.0).abs() < 1e-15);
}

#[test]
fn prop_runs_are_recorded_and_a_broken_one_is_marked() {
    let (folder, mut store) = scratch();
    store.start_run(start(), "0.1.0", "h").unwrap();
    let id = store.start_run(start() + TimeDelta::days(1), "0.1.0", "h").unwrap();
    let counts = Counts { points: 8, solved: 7, failed: 1 };
    store.end_run(id, start() + TimeDelta::days(2), RunEnd::DoneWithLosses, Some("i"), counts, None).unwrap();
    let last = store.last_run().unwrap().unwrap();
    assert_eq!((last.status.as_str(), last.counts), ("done with losses", Some(counts)));
    assert_eq!((last.started, last.finished), (start() + TimeDelta::days(1), Some(start() + TimeDelta::days(2))));
    let all = store.query_text("SELECT status FROM run ORDER BY run_id").unwrap();
    assert_eq!(all, [["interrupted"], ["done with losses"]]);
    store.close().unwrap();
    let mut reader = Store::open_read_only(&folder.path().join("study.db")).unwrap();
    assert!(reader.last_run().unwrap().is_some());
    assert!(reader.start_run(start(), "", "").is_err(), "a reader writes");
    assert!(matches!(Store::open_read_only(&folder.path().join("other.db")), Err(StoreError::Missing(_))));
}
