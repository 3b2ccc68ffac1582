//! Time of an optimum on one core, and of a year's grid on all cores: `cargo bench -p busclimate-solve`.

use cabin::{ComfortWindow, Cop, Design, Disturbances, Heating, PassengerViews, Vehicle, kelvin};
use divan::{Bencher, counter::ItemsCount};
use solve::{Grid, Optimum, Outcome, SampleSolver, solve_blocks};

const SAMPLES: usize = 7399;

fn main() {
    divan::main();
}

fn grid() -> Grid {
    let design = |name: &str, heating, radiant_heaters, air_curtain| Design {
        name: name.to_owned(),
        heating,
        heating_cop: match heating {
            Heating::Ptc => Cop::Constant(1.0),
            Heating::HeatPump => cabin::named_heating_cops().swap_remove(0).1,
        },
        cooling_cop: cabin::named_cooling_cops().swap_remove(0).1,
        radiant_heaters,
        air_curtain,
    };
    let designs = vec![
        design("ptc", Heating::Ptc, false, false),
        design("ptc+rh", Heating::Ptc, true, false),
        design("hp", Heating::HeatPump, false, false),
        design("hp+rh", Heating::HeatPump, true, false),
        design("hp+curtain", Heating::HeatPump, false, true),
    ];
    let windows = (0..17).map(|i| ComfortWindow::symmetric(0.125 * f64::from(i)).expect("valid")).collect();
    Grid::new(designs, windows).expect("valid")
}

/// A year-like spread of disturbances without random numbers: incommensurable cycles.
fn samples() -> Vec<Disturbances> {
    let cycle = |i: usize, period: f64| 0.5 - 0.5 * (i as f64 * std::f64::consts::TAU / period).cos();
    (0..SAMPLES)
        .map(|i| {
            let day = cycle(i, 24.0);
            Disturbances {
                ambient_temperature_k: kelvin(-8.0 + 28.0 * cycle(i, 7399.0) + 9.0 * day + 4.0 * cycle(i, 131.7)),
                dni_w_m2: 850.0 * day * cycle(i, 71.3),
                dhi_w_m2: 250.0 * day,
                solar_altitude_rad: -0.2 + 1.2 * day,
                shadow_fraction: 1.0 - 0.7 * day,
                passengers: 40.0 * cycle(i, 9.1),
                door_open_fraction: 0.10 + 0.08 * cycle(i, 17.9),
            }
        })
        .collect()
}

#[divan::bench]
fn one_core(bencher: Bencher) {
    let (vehicle, grid, samples) = (Vehicle::default(), grid(), samples());
    let views = PassengerViews::new(&vehicle);
    let mut optima = vec![Optimum { design: 0, window: 0, outcome: Outcome::NotConverged }; grid.points()];
    bencher.counter(ItemsCount::new(SAMPLES * grid.points())).bench_local(|| {
        let mut solver = SampleSolver::new(&vehicle, &views, &grid);
        for sample in &samples {
            solver.solve(divan::black_box(sample), &mut optima);
            divan::black_box(&optima);
        }
    });
}

#[divan::bench]
fn all_cores(bencher: Bencher) {
    let (vehicle, grid, samples) = (Vehicle::default(), grid(), samples());
    bencher.counter(ItemsCount::new(SAMPLES * grid.points())).bench_local(|| {
        solve_blocks(&vehicle, &grid, &samples, |_, optima| {
            divan::black_box(optima);
            true
        })
    });
}
