//! Time of an optimum on one core, and of a year's grid on all cores: `cargo bench --workspace --bench optimum`.

use cabin::{Optimum, PassengerViews, Vehicle};
use divan::{Bencher, counter::ItemsCount};
use solve::{SampleSolver, solve_blocks};
use testing::{YEAR_SAMPLES, paper_grid, year};

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
