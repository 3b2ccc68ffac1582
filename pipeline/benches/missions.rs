//! Telemetry rows per second, from bytes to segments, by the number of missions that are read at a time; polars
//! takes all cores.
//!
//! Reads the real mission under `$BUSCLIMATE_DATA` or `../shared/data`, many times over; nothing is measured without it.

use divan::counter::ItemsCount;
use ingest::FileReader;
use ingest::mission::{MissionOptions, discover, read};
use pipeline::in_order;
use std::path::PathBuf;

/// The allocator of the program.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

const COPIES: usize = 100;
const OPTIONS: MissionOptions = MissionOptions { segment_s: 3600, door_open_share: 0.6, keep_partial: false };

fn main() {
    divan::main();
}

fn data() -> PathBuf {
    let beside = || PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/data"));
    std::env::var_os("BUSCLIMATE_DATA").map_or_else(beside, PathBuf::from)
}

#[divan::bench(args = [1, 2, 4], sample_count = 20)]
fn real_mission(bencher: divan::Bencher, readers: usize) {
    let Ok(found) = discover(&data(), "ztbus", &[183]) else { return };
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
