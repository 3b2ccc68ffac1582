//! Segments, weather, sun and shade into hourly samples.

use ingest::sample::Surroundings;
use store::Store;
use study::Study;

use crate::{Inputs, PipelineError, Progress};

pub(crate) fn join(
    study: &Study,
    inputs: &Inputs,
    store: &mut Store,
    progress: &dyn Progress,
) -> Result<(), PipelineError> {
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
    let (changed, withdrawn) = store.put_samples(&samples, &excluded, &inputs.records()?)?;
    if samples.is_empty() {
        let reason = excluded.first().map_or_else(|| "there are no segments".to_owned(), |e| e.reason.clone());
        return Err(PipelineError::NoSamples { excluded: excluded.len(), reason });
    }
    progress.info(&format!(
        "{} samples: {changed} new or changed, {withdrawn} withdrawn; {} segments excluded",
        samples.len(),
        excluded.len()
    ));
    Ok(())
}
