//! Time of an optimum on one core, and of a year's grid on all cores: `cargo bench --workspace --bench optimum`.

use cabin::{ComfortWindow, Optimum, PassengerViews, Vehicle};
use divan::{Bencher, counter::ItemsCount};
use solve::{Bus, Grid, SampleSolver, YearSamples, YearStates, solve_blocks};
use std::sync::Arc;
use testing::{YEAR_SAMPLES, paper_designs, paper_grid, year};

fn main() {
    divan::main();
}

#[divan::bench]
fn one_core(bencher: Bencher) {
    let (vehicle, grid, samples) = (Vehicle::default(), paper_grid(), year());
    let views = PassengerViews::new(&vehicle);
    let mut optima = vec![Optimum::UNSOLVED; grid.points()];
    bencher.counter(ItemsCount::new(YEAR_SAMPLES * grid.points())).bench_local(|| {
        let mut solver = SampleSolver::new(&vehicle, &views, &grid);
        for sample in &samples {
            solver.solve(divan::black_box(sample), &mut optima);
            divan::black_box(&optima);
        }
    });
}

#[divan::bench]
fn all_cores(bencher: Bencher) {
    let (vehicle, grid, samples) = (Vehicle::default(), paper_grid(), year());
    bencher.counter(ItemsCount::new(YEAR_SAMPLES * grid.points())).bench_local(|| {
        solve_blocks(&vehicle, &grid, &samples, |_, optima| {
            divan::black_box(optima);
            true
        })
    });
}

/// Buses with other constants on one core, five designs and one window: what a study of many buses is made of.
#[divan::bench]
fn many_buses(bencher: Bencher) {
    const BUSES: usize = 8;
    let window = ComfortWindow::symmetric(1.0).expect("1 is a limit");
    let grid = Grid::new(paper_designs(), vec![window]).expect("the designs differ");
    let mut samples = YearSamples::default();
    for (i, sample) in year().into_iter().enumerate() {
        samples.add((i % 12) as u8 + 1, sample);
    }
    let vehicle = Vehicle::default();
    let views = Arc::new(PassengerViews::new(&vehicle));
    let states = YearStates::new(&samples, &vehicle, &grid);
    let bus = |i: usize| {
        let conduction_shell_w_m2_k = vehicle.conduction_shell_w_m2_k * (0.8 + 0.05 * i as f64);
        let vehicle = Vehicle { conduction_shell_w_m2_k, ..vehicle.clone() };
        Bus { vehicle, views: views.clone(), designs: grid.designs().to_vec() }
    };
    let buses: Vec<Bus> = (0..BUSES).map(bus).collect();
    bencher.counter(ItemsCount::new(BUSES * YEAR_SAMPLES * grid.points())).bench_local(|| {
        for bus in &buses {
            divan::black_box(states.means(bus, |sample| *sample));
        }
    });
}
