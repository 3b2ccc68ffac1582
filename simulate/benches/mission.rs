//! Simulated seconds per second on one core: `cargo bench --workspace --bench mission`.

use cabin::{Cabin, Disturbances, Heating, LoadChange, PassengerViews, Vehicle, kelvin};
use divan::{Bencher, counter::ItemsCount};
use simulate::{Dynamics, Mission, Replay, Segment};
use testing::{design, optimum};

const HOURS: usize = 10;

fn main() {
    divan::main();
}

#[divan::bench]
fn winter_day(bencher: Bencher) {
    let vehicle = Vehicle::default();
    let views = PassengerViews::new(&vehicle);
    let design = design("hp+curtain", Heating::HeatPump, false, true);
    let sample = Disturbances {
        ambient_temperature_k: kelvin(1.0),
        dni_w_m2: 0.0,
        dhi_w_m2: 40.0,
        solar_altitude_rad: 0.2,
        shadow_fraction: 0.8,
        passengers: 20.0,
        door_open_fraction: 0.15,
    };
    let optimum = optimum(&vehicle, &views, &design, &sample, 1.0);
    let band_k = [optimum.temperatures.cabin_k, optimum.temperatures.cabin_k + 6.0];
    let segments = [Segment { optimum, band_k }; HOURS];
    let minutes = vec![Cabin::new(&vehicle, &views, &sample); 60 * HOURS];
    // A stop of 20 s every 80 s.
    let stop = |i: u32| LoadChange {
        second: 80 * (i / 2) + 20 * (i % 2),
        passengers: f64::from(i % 41),
        door_open: f64::from(i.is_multiple_of(2)),
    };
    let loads: Vec<LoadChange> = (0..3600 * HOURS as u32 / 40).map(stop).collect();
    let mission =
        Mission { loads: &loads, minutes: &minutes, segments: &segments, segment_s: 3600, door_open_share: 0.6 };
    let dynamics = Dynamics::default();
    bencher
        .counter(ItemsCount::new(3600 * HOURS))
        .bench_local(|| Replay::PAPER.run(divan::black_box(&mission), &design, &dynamics, |_| ()));
}
