//! From samples to the committed database: `cargo bench -p busclimate-store`.

use cabin::Vehicle;
use divan::{Bencher, counter::ItemsCount};
use solve::solve_blocks;
use store::{DesignRow, FileRow, PointId, SampleRow, Store, WindowRow};
use year::{SAMPLES, grid, samples};

#[path = "../../solve/benches/year/mod.rs"]
mod year;

fn main() {
    divan::main();
}

/// Samples that exist in an otherwise empty database; solving all of them and committing is timed.
#[divan::bench(sample_count = 5, sample_size = 1)]
fn solve_and_commit(bencher: Bencher) {
    let (vehicle, grid, disturbances) = (Vehicle::default(), grid(), samples());
    let points = grid.points();
    let rows: Vec<SampleRow> = disturbances
        .iter()
        .enumerate()
        .map(|(i, d)| SampleRow {
            sample_id: 1_830_000_000_000 + 3600 * i as i64,
            mission: "m".to_owned(),
            source_path: "m.csv".to_owned(),
            bus: 183,
            segment: i as u32,
            first_line: 2,
            last_line: 3601,
            start_utc: "2022-01-05T05:00:00Z".to_owned(),
            duration_s: 3600,
            month: (i * 12 / SAMPLES) as u8 + 1,
            ambient_temperature_k: d.ambient_temperature_k,
            dni_w_m2: d.dni_w_m2,
            dhi_w_m2: d.dhi_w_m2,
            passengers: d.passengers,
            door_open_fraction: d.door_open_fraction,
            solar_altitude_rad: d.solar_altitude_rad,
            solar_azimuth_rad: 0.0,
            shadow_fraction: d.shadow_fraction,
            interpolated_s: 0.0,
        })
        .collect();
    let designs: Vec<DesignRow> = grid
        .designs()
        .iter()
        .map(|d| DesignRow {
            name: d.name.clone(),
            heating: "ptc".to_owned(),
            heating_cop: "1".to_owned(),
            cooling_cop: "linear".to_owned(),
            radiant_heaters: d.radiant_heaters,
            air_curtain: d.air_curtain,
            method: "fast".to_owned(),
            design_key: d.name.clone(),
        })
        .collect();
    let windows: Vec<WindowRow> = grid
        .windows()
        .iter()
        .map(|w| WindowRow { pmv_min: w.pmv_min(), pmv_max: w.pmv_max(), pmv_limit: w.pmv_limit() })
        .collect();
    let prepare = || {
        let folder = tempfile::tempdir().expect("a scratch folder");
        let mut store = Store::open(&folder.path().join("study.db")).expect("a new database");
        let file = FileRow {
            path: "m.csv".to_owned(),
            kind: "mission".to_owned(),
            blake3: String::new(),
            bytes: 0,
            rows: 0,
            first_utc: None,
            last_utc: None,
            accepted: true,
            reading_key: String::new(),
            findings: Vec::new(),
        };
        store.put_file(&file, &[]).expect("the file is stored");
        store.put_samples(&rows, &[]).expect("the samples are stored");
        let ids = store.put_study(&designs, &windows).expect("the study is stored");
        (folder, store, ids)
    };
    bencher.counter(ItemsCount::new(SAMPLES * points)).with_inputs(prepare).bench_local_values(
        |(folder, mut store, ids)| {
            solve_blocks(&vehicle, &grid, &disturbances, |first, optima| {
                let keyed = optima.iter().enumerate().map(|(i, optimum)| {
                    let id = PointId {
                        sample_id: rows[first + i / points].sample_id,
                        design_id: ids.design_ids[optimum.design],
                        window_id: ids.window_ids[optimum.window],
                    };
                    (id, optimum, None)
                });
                let samples: Vec<i64> =
                    rows[first..first + optima.len() / points].iter().map(|r| r.sample_id).collect();
                store.put_optima(&samples, keyed).expect("the optima are stored");
                true
            });
            store.close().expect("the log is folded into the file");
            folder
        },
    );
}
