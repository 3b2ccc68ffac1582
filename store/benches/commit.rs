//! From samples to the committed database: `cargo bench --workspace --bench commit`.

use cabin::{Design, Vehicle};
use chrono::DateTime;
use divan::{Bencher, counter::ItemsCount};
use ingest::mission::Segment;
use ingest::sample::Sample;
use ingest::{FileKind, FileRecord};
use solve::{Method, solve_blocks};
use store::{DesignRow, NewOptimum, Store};
use testing::{YEAR_SAMPLES, paper_grid, year};

fn main() {
    divan::main();
}

/// Samples that exist in an otherwise empty database; solving all of them and committing is timed.
#[divan::bench(sample_count = 5, sample_size = 1)]
fn solve_and_commit(bencher: Bencher) {
    let (vehicle, grid, disturbances) = (Vehicle::default(), paper_grid(), year());
    let points = grid.points();
    let sample = |(i, d): (usize, &cabin::Disturbances)| Sample {
        id: 1_830_000_000_000 + 3600 * i as i64,
        segment: Segment {
            mission: "m".to_owned(),
            source_path: "m.csv".to_owned(),
            bus: 183,
            segment: i as u32,
            start: DateTime::UNIX_EPOCH,
            duration_s: 3600,
            passengers: d.passengers,
            door_open_fraction: d.door_open_fraction,
            distance_m: Some(15_400.0),
            vehicle_power_w: Some(24_800.5),
            route: Some("33".to_owned()),
            first_line: 2,
            last_line: 3601,
        },
        month: (i * 12 / YEAR_SAMPLES) as u8 + 1,
        disturbances: *d,
        solar_azimuth_rad: 0.0,
        clock: None,
        interpolated_s: 0.0,
        key: i.to_string(),
    };
    let samples: Vec<Sample> = disturbances.iter().enumerate().map(sample).collect();
    let row = |d: &Design| DesignRow {
        name: d.name.clone(),
        heating: d.heating,
        heating_cop: "1".to_owned(),
        cooling_cop: "linear".to_owned(),
        devices: d.devices,
        method: Method::Fast,
        design_key: d.name.clone(),
    };
    let designs: Vec<DesignRow> = grid.designs().iter().map(row).collect();
    let prepare = || {
        let folder = tempfile::tempdir().expect("a scratch folder");
        let mut store = Store::open(&folder.path().join("study.db")).expect("a new database");
        let file = FileRecord {
            path: "m.csv".to_owned(),
            kind: FileKind::Mission,
            blake3: String::new(),
            bytes: 0,
            rows: 0,
            first: None,
            last: None,
            stamp: None,
            accepted: true,
            findings: Vec::new(),
        };
        store.put_file(&file, "k").expect("the file is stored");
        store.put_samples(&samples, &[], &[]).expect("the samples are stored");
        let stored = store.put_grid(&designs, grid.windows()).expect("the study is stored").grid;
        (folder, store, stored)
    };
    bencher.counter(ItemsCount::new(YEAR_SAMPLES * points)).with_inputs(prepare).bench_local_values(
        |(folder, mut store, stored)| {
            solve_blocks(&vehicle, &grid, &disturbances, |first, optima| {
                let new = optima.iter().enumerate().map(|(i, o)| NewOptimum::of(samples[first + i / points].id, o));
                store.put_optima(&stored, new).expect("the optima are stored");
                true
            });
            store.close().expect("the log is folded into the file");
            folder
        },
    );
}
