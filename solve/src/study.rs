//! All samples of a study, in parallel, in a fixed order.

use cabin::{Disturbances, PassengerViews, Vehicle};
use rayon::prelude::*;

use crate::{Grid, Optimum, Outcome, SampleSolver};

/// Samples that one task solves before it hands over: large enough that the hand-over costs nothing.
const BLOCK: usize = 64;

/// Solves every sample for every point of the grid on rayon's current pool and hands the results over in blocks, in the
/// order of the samples whatever the thread count: `consume(first_sample, optima)`, with [`Grid::points`] optima a
/// sample. It stops early when `consume` returns `false`, and then returns `false` itself.
///
/// At most a few blocks a thread are held at a time, so that memory does not grow with the study.
pub fn solve_blocks(
    vehicle: &Vehicle,
    grid: &Grid,
    samples: &[Disturbances],
    mut consume: impl FnMut(usize, &[Optimum]) -> bool,
) -> bool {
    let views = PassengerViews::new(vehicle);
    let unsolved = Optimum { design: 0, window: 0, outcome: Outcome::NotConverged };
    let wave = BLOCK * rayon::current_num_threads() * 4;
    let mut buffer = vec![unsolved; wave.min(samples.len()) * grid.points()];
    for (w, wave_samples) in samples.chunks(wave).enumerate() {
        let optima = &mut buffer[..wave_samples.len() * grid.points()];
        optima.par_chunks_mut(BLOCK * grid.points()).zip(wave_samples.par_chunks(BLOCK)).for_each(
            |(optima, samples)| {
                let mut solver = SampleSolver::new(vehicle, &views, grid);
                for (sample, optima) in samples.iter().zip(optima.chunks_mut(grid.points())) {
                    solver.solve(sample, optima);
                }
            },
        );
        if !consume(w * wave, optima) {
            return false;
        }
    }
    true
}
