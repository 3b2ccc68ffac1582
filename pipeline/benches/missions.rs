//! Telemetry rows per second, from bytes to segments, by the number of missions that are read at a time; and the same
//! columns read by polars alone, without hashing, checks and sums.
//!
//! Reads the real mission under `$BUSCLIMATE_DATA` or `../shared/data`, many times over; nothing is measured without it.

use divan::counter::ItemsCount;
use ingest::Clock;
use ingest::FileReader;
use ingest::mission::{Door, MissionFormat, MissionOptions, RouteChoice, TelemetryMap, Vehicle, discover, read};
use pipeline::in_order;
use polars::prelude::{CsvReadOptions, DataType, Field, PlSmallStr, Schema, SerReader};
use std::fmt::Write as _;
use std::io::Cursor;
use std::path::PathBuf;
use std::sync::Arc;

/// The allocator of the program.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

const COPIES: usize = 100;
const OPTIONS: MissionOptions =
    MissionOptions { segment_s: 3600, door_open_share: 0.6, keep_partial: false, routes: RouteChoice::All };

fn main() {
    divan::main();
}

fn data() -> PathBuf {
    let beside = || PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/data"));
    std::env::var_os("BUSCLIMATE_DATA").map_or_else(beside, PathBuf::from)
}

#[divan::bench(args = [1, 2, 4], sample_count = 20)]
fn real_mission(bencher: divan::Bencher, readers: usize) {
    let Ok(found) = discover(&data(), "ztbus", &MissionFormat::ZtBus, &[183]) else { return };
    let rows = (found.missions[0].end - found.missions[0].start).num_seconds() + 1;
    bencher.counter(ItemsCount::new(COPIES * rows as usize)).bench(|| {
        // Reading and hashing the file belongs to the work.
        let read = |reader: &mut FileReader, (): &()| {
            let content = found.missions[0].load(reader).expect("the mission is readable");
            let segments = read(&found.missions[0], &content, &OPTIONS).segments.len();
            reader.recycle(content);
            segments
        };
        let mut segments = 0;
        let sum = |count| {
            segments += count;
            Ok::<(), std::convert::Infallible>(())
        };
        in_order(&[(); COPIES], readers, read, sum).map(|()| segments)
    });
}

#[divan::bench(args = [1, 2], sample_count = 20)]
fn polars_alone(bencher: divan::Bencher, readers: usize) {
    let Ok(found) = discover(&data(), "ztbus", &MissionFormat::ZtBus, &[183]) else { return };
    let rows = (found.missions[0].end - found.missions[0].start).num_seconds() + 1;
    let content = found.missions[0].load(&mut FileReader::default()).expect("the mission is readable");
    let columns = [
        ("time_unix", DataType::Int64),
        ("itcs_numberOfPassengers", DataType::Float64),
        ("status_doorIsOpen", DataType::Float64),
        ("temperature_ambient", DataType::Float64),
        ("odometry_vehicleSpeed", DataType::Float64),
        ("electric_powerDemand", DataType::Float64),
        ("itcs_busRoute", DataType::String),
    ];
    let names: Arc<[PlSmallStr]> = columns.iter().map(|(name, _)| PlSmallStr::from_static(name)).collect();
    let schema = Schema::from_iter(columns.iter().map(|(name, dtype)| Field::new((*name).into(), dtype.clone())));
    let options = CsvReadOptions::default()
        .with_columns(Some(names))
        .with_schema_overwrite(Some(Arc::new(schema)))
        .with_infer_schema_length(Some(0))
        .with_n_threads(Some(1))
        .with_rechunk(false)
        .with_ignore_errors(true);
    bencher.counter(ItemsCount::new(COPIES * rows as usize)).bench(|| {
        let read = |(): &mut (), (): &()| {
            let reader = options.clone().into_reader_with_file_handle(Cursor::new(content.bytes.as_slice()));
            reader.finish().expect("polars reads it").height()
        };
        in_order(&[(); COPIES], readers, read, |_| Ok::<(), std::convert::Infallible>(()))
    });
}

/// A table of 30 missions of 20 hours at 1 Hz.
fn table() -> String {
    let mut text = "when,vehicle,load,doors,speed\n".to_owned();
    for second in 0..30 * 20 * 3600 {
        let time = 1_600_000_000 + second + second / 72_000 * 14_400;
        let (load, door, speed) = (second / 60 % 50, u8::from(second % 90 < 15), second % 130);
        let _ = writeln!(text, "{time},183,{load},{door},{}.{:02}", speed / 10, second % 100);
    }
    text
}

#[divan::bench(args = [false, true], sample_count = 10)]
fn tables_found(bencher: divan::Bencher, are_read: bool) {
    let map = TelemetryMap {
        time_column: "when".to_owned(),
        clock: Clock::Utc,
        vehicle: Vehicle::Column("vehicle".to_owned()),
        passengers_column: "load".to_owned(),
        door: Door::Flag("doors".to_owned()),
        speed_column: Some("speed".to_owned()),
        speed_unit_m_s: 1.0,
        power_column: None,
        power_unit_w: 1.0,
        route_column: None,
        hold_s: 60,
        cut_gap_s: 900,
    };
    let format = MissionFormat::Csv(Arc::new(map));
    let folder = tempfile::tempdir().expect("a folder");
    let text = table();
    std::fs::write(folder.path().join("all.csv"), &text).expect("a table");
    bencher.counter(ItemsCount::new(text.lines().count() - 1)).bench(|| {
        let found = discover(folder.path(), "all.csv", &format, &[]).expect("missions");
        let mut reader = FileReader::default();
        let mut segments = 0;
        for mission in found.missions.iter().filter(|_| are_read) {
            let content = mission.load(&mut reader).expect("the mission is readable");
            segments += read(mission, &content, &OPTIONS).segments.len();
        }
        segments
    });
}
