//! The two missions that the report shows in time: the paper's own, where their files are there, else the coldest and the
//! hottest, with the best equipped design.

use ingest::sample::Sample;
use simulate::{Replay, Trace, simulate_with};
use std::collections::BTreeMap;
use store::{SimulationId, Store, TraceRow};
use study::Study;

use crate::PipelineError;
use crate::basis::{SimulationBasis, optima};
use crate::missions::MissionInTime;

/// The missions that the paper shows.
const PAPER: [&str; 2] =
    ["B183_2022-12-10_06-34-55_2022-12-10_23-26-20", "B183_2019-07-24_02-51-19_2019-07-24_17-15-53"];
/// The comfort limits of the paper's two figures.
const PAPER_LIMITS: [f64; 2] = [1.0, 0.5];
const LABELS: [&str; 2] = ["cold", "hot"];

/// Stores the traces that are missing; those of other missions go.
pub(crate) fn trace(
    basis: &SimulationBasis<'_>,
    store: &mut Store,
    keys: &BTreeMap<SimulationId, String>,
) -> Result<(), PipelineError> {
    let stored = store.trace_keys()?;
    let (mut rows, mut kept) = (Vec::new(), Vec::new());
    for (i, label) in LABELS.into_iter().enumerate() {
        let (Some(samples), Some(window)) = (
            shown_mission(&basis.missions, label),
            nearest_window(basis.study, &basis.study.simulated_windows, PAPER_LIMITS[i]),
        ) else {
            continue;
        };
        let design = basis.study.grid.designs().len() - 1;
        let id = SimulationId { source_path: samples[0].segment.source_path.clone(), design, window };
        let Some(key) = keys.get(&id) else { continue };
        let name = &basis.study.design_rows[design].name;
        if stored.iter().any(|[l, d, k]| l == label && d == name && k == key) {
            kept.push(label);
        } else {
            rows.extend(row(basis, store, samples, label, id, key)?);
        }
    }
    Ok(store.put_traces(&basis.grid, &rows, &kept)?)
}

fn row(
    basis: &SimulationBasis<'_>,
    store: &mut Store,
    samples: &[Sample],
    label: &'static str,
    id: SimulationId,
    key: &str,
) -> Result<Option<TraceRow>, PipelineError> {
    let study = basis.study;
    let loads = store.loads(&id.source_path)?;
    let Ok(in_time) = MissionInTime::new(study, &basis.views, &basis.surroundings, samples, &loads) else {
        return Ok(None);
    };
    let mut of_point = optima(store, &basis.grid, samples, &[id.design], &[id.window])?;
    let Some(Ok(optima)) = of_point.remove(&(id.design, id.window)) else { return Ok(None) };
    let segments = in_time.segments(&optima, study.grid.windows()[id.window]);
    let mission = in_time.mission();
    let mut trace = Trace::default();
    let variants = [Replay::PAPER.of(&study.grid.designs()[id.design], &segments)];
    if simulate_with(&mission, &study.dynamics, &variants, &mut |_, now| trace.add(now)).is_none() {
        return Ok(None);
    }
    Ok(Some(TraceRow {
        label,
        id,
        key: key.to_owned(),
        of_paper: PAPER.contains(&samples[0].segment.mission.as_str()),
        segment_count: samples.len() as u32,
        minutes: trace.finish(&mission),
    }))
}

/// The mission that stands for a `cold` or a `hot` day.
pub(crate) fn shown_mission<'m>(missions: &'m [Vec<Sample>], label: &str) -> Option<&'m Vec<Sample>> {
    let which = usize::from(label == LABELS[1]);
    if let Some(own) = missions.iter().find(|m| m[0].segment.mission == PAPER[which]) {
        return Some(own);
    }
    let mean_k = |m: &[Sample]| m.iter().map(|s| s.disturbances.ambient_temperature_k).sum::<f64>() / m.len() as f64;
    let sign = if which == 0 { 1.0 } else { -1.0 };
    missions.iter().min_by(|a, b| (sign * mean_k(a)).total_cmp(&(sign * mean_k(b))))
}

/// Of some windows of the study, by their places, the one whose limit is nearest.
pub(crate) fn nearest_window(study: &Study, among: &[usize], limit: f64) -> Option<usize> {
    let off = |w: &usize| (study.grid.windows()[*w].pmv_limit() - limit).abs();
    among.iter().copied().min_by(|a, b| off(a).total_cmp(&off(b)))
}
