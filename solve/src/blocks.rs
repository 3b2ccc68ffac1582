//! All samples of a study, in parallel, in a fixed order: one driver for every method.

use cabin::Disturbances;
use rayon::prelude::*;

/// How work is shared out.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Block {
    /// Samples that one task solves.
    pub samples: usize,
    /// Tasks a thread before results are handed over: the more, the less threads wait for the last of them.
    pub a_thread: usize,
}

/// Solves every sample on rayon's current pool and hands the results over in blocks, in the order of the samples whatever
/// the thread count: `consume(first_sample, results)`, with `points` results a sample. It stops early when `consume`
/// returns `false`, and then returns `false` itself.
///
/// A task takes a block of samples with one solver from `solver`; `solve` fills the results of one sample, all of which start as
/// `unsolved`. So many blocks a thread are held at a time as `block` says, so that memory does not grow with the study.
pub(crate) fn in_blocks<S, R: Copy + Send + Sync>(
    samples: &[Disturbances],
    points: usize,
    block: Block,
    unsolved: R,
    solver: impl Fn() -> S + Sync,
    solve: impl Fn(&mut S, &Disturbances, &mut [R]) + Sync,
    mut consume: impl FnMut(usize, &[R]) -> bool,
) -> bool {
    let wave = block.samples * block.a_thread * rayon::current_num_threads();
    let mut buffer = vec![unsolved; wave.min(samples.len()) * points];
    for (w, wave_samples) in samples.chunks(wave).enumerate() {
        let results = &mut buffer[..wave_samples.len() * points];
        results.par_chunks_mut(block.samples * points).zip(wave_samples.par_chunks(block.samples)).for_each(
            |(results, samples)| {
                let mut solver = solver();
                for (sample, results) in samples.iter().zip(results.chunks_mut(points)) {
                    solve(&mut solver, sample, results);
                }
            },
        );
        if !consume(w * wave, results) {
            return false;
        }
    }
    true
}
