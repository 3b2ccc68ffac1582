//! Optima of many samples, read by several connections at a time: decoding a row takes longer than computing it did.

use ingest::sample::Sample;
use store::{Store, StoredOptimum};
use study::Study;

use crate::{PipelineError, open};

/// Samples whose optima are read at once.
const BLOCK: usize = 256;

/// Samples in blocks of which each can be read at once: they lie side by side.
pub(crate) fn blocks<'b, 's>(samples: &'b [&'s Sample]) -> impl Iterator<Item = &'b [&'s Sample]> {
    samples.chunks(BLOCK)
}

/// A connection of a thread; opened when it is first used.
#[derive(Default)]
pub(crate) struct Reader(Option<Store>);

impl Reader {
    /// The stored optima of a block, in the order of samples, designs and windows.
    pub fn optima(
        &mut self,
        study: &Study,
        grid: &store::StoredGrid,
        block: &[&Sample],
    ) -> Result<Vec<StoredOptimum>, PipelineError> {
        let store = match &mut self.0 {
            Some(store) => store,
            none => none.insert(open::for_reading(study)?),
        };
        let ids: Vec<i64> = block.iter().map(|sample| sample.id).collect();
        Ok(store.optima(grid, &ids)?)
    }
}

impl Drop for Reader {
    fn drop(&mut self) {
        if let Some(store) = self.0.take() {
            // It wrote nothing: there is nothing to lose.
            let _ = store.close();
        }
    }
}
