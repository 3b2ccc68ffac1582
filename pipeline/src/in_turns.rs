//! Missions a portion at a time: while some are computed, those before are written and those after are read.

use ingest::sample::Sample;
use store::Store;

use crate::{PipelineError, Progress};

/// Computes missions in portions of so many per thread. `read` says what is to be done
/// for a portion, `compute` does it, `write` stores the rows of one portion in one transaction.
///
/// # Errors
/// Those of `read` and `write`; [`PipelineError::Interrupted`] where somebody asks to stop: what is computed by then is written.
pub(crate) fn in_turns<'s, Job: Send + Sync, Row: Send + Sync>(
    store: &mut Store,
    missions: &'s [Vec<Sample>],
    a_thread: usize,
    progress: &dyn Progress,
    mut read: impl FnMut(&mut Store, &'s [Vec<Sample>]) -> Result<Vec<Job>, PipelineError> + Send,
    compute: impl Fn(&[Job]) -> Vec<Row> + Send + Sync,
    mut write: impl FnMut(&mut Store, &[Row]) -> Result<(), PipelineError> + Send,
) -> Result<(), PipelineError> {
    let mut portions = missions.chunks(a_thread * rayon::current_num_threads());
    let mut next = |store: &mut Store| match portions.next() {
        Some(portion) => read(store, portion).map(|jobs| Some((portion.len(), jobs))),
        None => Ok(None),
    };
    let mut put = |store: &mut Store, rows: &[Row]| if rows.is_empty() { Ok(()) } else { write(store, rows) };
    let (mut open, mut done) = (next(store)?, Vec::new());
    while let Some((count, jobs)) = open {
        if progress.stop() {
            break;
        }
        let (rows, beside) = rayon::join(|| compute(&jobs), || put(store, &done).and_then(|()| next(store)));
        (open, done) = (beside?, rows);
        progress.advance(count as u64);
    }
    put(store, &done)?;
    progress.end();
    if progress.stop() { Err(PipelineError::Interrupted) } else { Ok(()) }
}
