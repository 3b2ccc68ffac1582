//! Simulated seconds per second on one core: `cargo bench --workspace --bench mission`.

use cabin::{Cabin, ComfortWindow, Design, Disturbances, Heating, PassengerViews, Vehicle, kelvin};
use divan::{Bencher, counter::ItemsCount};
use simulate::{Change, Conduct, Dynamics, Hour, Mission, simulate};
use solve::{Grid, Optimum, Outcome, SampleSolver};

const HOURS: usize = 10;

fn main() {
    divan::main();
}

#[divan::bench]
fn winter_day(bencher: Bencher) {
    let vehicle = Vehicle::default();
    let views = PassengerViews::new(&vehicle);
    let design = Design {
        name: "hp+curtain".to_owned(),
        heating: Heating::HeatPump,
        heating_cop: cabin::named_heating_cops().swap_remove(0).1,
        cooling_cop: cabin::named_cooling_cops().swap_remove(0).1,
        radiant_heaters: false,
        air_curtain: true,
    };
    let sample = Disturbances {
        ambient_temperature_k: kelvin(1.0),
        dni_w_m2: 0.0,
        dhi_w_m2: 40.0,
        solar_altitude_rad: 0.2,
        shadow_fraction: 0.8,
        passengers: 20.0,
        door_open_fraction: 0.15,
    };
    let grid = Grid::new(vec![design.clone()], vec![ComfortWindow::symmetric(1.0).expect("valid")]).expect("valid");
    let mut optima = [Optimum { design: 0, window: 0, outcome: Outcome::NotConverged }];
    SampleSolver::new(&vehicle, &views, &grid).solve(&sample, &mut optima);
    let Outcome::Solved(optimum, _) = optima[0].outcome else { return };
    let hours = [Hour { optimum, band_k: [optimum.temperatures.cabin_k, optimum.temperatures.cabin_k + 6.0] }; HOURS];
    let minutes = vec![Cabin::new(&vehicle, &views, &sample); 60 * HOURS];
    // A stop of 20 s every 80 s.
    let changes: Vec<Change> = (0..3600 * HOURS as u32 / 40)
        .map(|i| Change { second: 80 * (i / 2) + 20 * (i % 2), passengers: f64::from(i % 41), door_open: i % 2 == 0 })
        .collect();
    let mission =
        Mission { changes: &changes, minutes: &minutes, hours: &hours, segment_s: 3600, door_open_share: 0.6 };
    let dynamics = Dynamics::default();
    bencher
        .counter(ItemsCount::new(3600 * HOURS))
        .bench_local(|| simulate(divan::black_box(&mission), &design, &dynamics, Conduct::Paper, |_| ()));
}
