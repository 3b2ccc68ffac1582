//! Segments, weather, sun and shade into hourly samples.

use ingest::ExcludedSegment;
use ingest::sample::Surroundings;
use std::collections::BTreeSet;
use store::Store;
use study::{Study, keys};

use crate::{Inputs, PipelineError, Work, freshness};

/// The stage whose settings say how weather is read.
const STAGE: &str = "shade";

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
    if !study.forget_missing && store.settings(STAGE)? == keys::settings(study, STAGE) {
        check_weather_gone(&excluded, store)?;
    }
    // First: a run that ends in between makes the samples once more.
    store.put_shadow_year(shadow.hourly())?;
    let (changed, withdrawn) = store.put_samples(&samples, &excluded, &inputs.records()?)?;
    Ok(work(samples.len() as u64, changed, withdrawn, excluded.len() as u64))
}

/// Weather that a run before has had and that is no longer there is more likely a share that is half mounted than meant.
fn check_weather_gone(excluded: &[ExcludedSegment], store: &mut Store) -> Result<(), PipelineError> {
    if !excluded.iter().any(ExcludedSegment::lacks_weather) {
        return Ok(());
    }
    let stored = store.samples()?;
    let stored: BTreeSet<(&str, u32)> =
        stored.iter().map(|s| (s.segment.mission.as_str(), s.segment.segment)).collect();
    let is_gone = |e: &&ExcludedSegment| e.lacks_weather() && stored.contains(&(e.mission.as_str(), e.segment));
    match excluded.iter().find(is_gone) {
        None => Ok(()),
        Some(first) => {
            let (samples, first) = (excluded.iter().filter(is_gone).count(), first.clone());
            Err(PipelineError::WeatherGone {
                samples,
                mission: first.mission,
                start: first.start,
                reason: first.reason,
            })
        }
    }
}

fn work(total: u64, computed: u64, withdrawn: u64, excluded: u64) -> Work {
    let message =
        format!("{total} samples: {computed} new or changed, {withdrawn} withdrawn; {excluded} segments excluded");
    Work { computed, withdrawn, total, message }
}
