//! Positions of the sun per second on one core: `cargo bench -p busclimate-shading`.

use chrono::{DateTime, TimeDelta};
use divan::{Bencher, counter::ItemsCount};
use shading::Site;

fn main() {
    divan::main();
}

/// A year, an hour at a time.
#[divan::bench]
fn year_of_hours(bencher: Bencher) {
    let site = Site::new(47.38, 8.54).expect("on Earth");
    let start = DateTime::from_timestamp(1_640_995_200, 0).expect("a time");
    bencher.counter(ItemsCount::new(8760_usize)).bench_local(|| {
        for hour in 0..8760 {
            divan::black_box(site.sun(divan::black_box(start + TimeDelta::hours(hour))));
        }
    });
}
