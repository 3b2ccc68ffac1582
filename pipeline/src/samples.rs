//! Segments, weather, sun and shade into hourly samples.

use ingest::sample::Surroundings;
use store::Store;
use study::Study;

use crate::{Inputs, PipelineError, Work, freshness};

pub(crate) fn join(study: &Study, inputs: &Inputs, store: &mut Store) -> Result<Work, PipelineError> {
    if !inputs.rehash() && freshness::samples(inputs, store)?.is_none() {
        inputs.restamp(store)?;
        let samples: u64 = store.months()?.iter().map(|m| m.sample_count).sum();
        let excluded = store.exclusion_counts()?.iter().map(|e| e.count).sum();
        return Ok(work(samples, 0, 0, excluded));
    }
    let (weather, _) = inputs.weather()?;
    let (shadow, _) = inputs.shadow()?;
    let surroundings = Surroundings { weather, shadow, site: &study.site, zone: study.zone };
    let (mut samples, mut excluded) = (Vec::new(), Vec::new());
    for (reading_key, segment) in store.segments()? {
        match segment.and_then(|segment| surroundings.sample(segment, &reading_key)) {
            Ok(sample) => samples.push(sample),
            Err(segment) => excluded.push(segment),
        }
    }
    if samples.is_empty() {
        // What the database holds stays: inputs that give nothing at all are more likely broken than meant.
        let reason = excluded.first().map_or_else(|| "there are no segments".to_owned(), |e| e.reason.clone());
        return Err(PipelineError::NoSamples { excluded: excluded.len(), reason });
    }
    let (changed, withdrawn) = store.put_samples(&samples, &excluded, &inputs.records()?)?;
    Ok(work(samples.len() as u64, changed, withdrawn, excluded.len() as u64))
}

fn work(total: u64, computed: u64, withdrawn: u64, excluded: u64) -> Work {
    let message =
        format!("{total} samples: {computed} new or changed, {withdrawn} withdrawn; {excluded} segments excluded");
    Work { computed, withdrawn, total, message }
}
