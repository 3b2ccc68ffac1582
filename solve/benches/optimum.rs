//! Time of an optimum on one core, and of a year's grid on all cores: `cargo bench -p busclimate-solve`.

use cabin::{PassengerViews, Vehicle};
use divan::{Bencher, counter::ItemsCount};
use solve::{Optimum, Outcome, SampleSolver, solve_blocks};
use year::{SAMPLES, grid, samples};

mod year;

fn main() {
    divan::main();
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
