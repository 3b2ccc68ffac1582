//! The mission that the report shows under some controllers: the paper's summer day where its file is there, else the hottest.

use cabin::{Operation, celsius};
use ingest::sample::Sample;
use simulate::{Segment, Trace, simulate_with};
use store::{ControlMinute, ControlTrace, Store};

use super::controllers::Driven;
use super::drive::{Driving, variant};
use crate::PipelineError;
use crate::basis::optima;
use crate::missions::MissionInTime;
use crate::traces::{nearest_window, shown_mission};

/// The profiles that are shown (paper, figure `causal-time-resolved`), by the limit of their windows.
const SHOWN_LIMITS: [f64; 2] = [0.25, 1.0];
/// Published setpoints that are shown. The paper's own second is not public; VBZ's bus is the paper's.
const SHOWN_PUBLISHED: [&str; 2] = ["vdv-comfort", "vbz-18"];

/// The mission with the last of the designs that are driven; nothing where it cannot be driven.
pub(super) fn traces(driving: &Driving<'_>, store: &mut Store) -> Result<Vec<ControlTrace>, PipelineError> {
    let basis = &driving.basis;
    let study = basis.study;
    let (Some(design), Some(samples), Some(window)) = (
        study.control.designs.last().copied(),
        shown_mission(&basis.missions, "hot"),
        nearest_window(study, &study.control.windows, 1.0),
    ) else {
        return Ok(Vec::new());
    };
    let loads = store.loads(&samples[0].segment.source_path)?;
    let Ok(in_time) = MissionInTime::new(study, &basis.views, &basis.surroundings, samples, &loads) else {
        return Ok(Vec::new());
    };
    let mut optima = optima(store, &basis.grid, samples, &[design], &[window])?;
    let Some(Ok(optima)) = optima.remove(&(design, window)) else { return Ok(Vec::new()) };
    let limits: Vec<Option<usize>> =
        SHOWN_LIMITS.iter().map(|limit| nearest_window(study, &study.control.windows, *limit)).collect();
    let is_shown = |d: &&Driven| match d.window {
        Some(_) => d.name == "extracted" && limits.contains(&d.window),
        None => SHOWN_PUBLISHED.contains(&d.name.as_str()),
    };
    let shown = driving.of_mission(design, samples).iter().filter(is_shown);
    Ok(shown.filter_map(|driven| trace(driving, &in_time, samples, (design, window), &optima, driven)).collect())
}

fn trace(
    driving: &Driving<'_>,
    in_time: &MissionInTime<'_>,
    samples: &[Sample],
    (design, window): (usize, usize),
    optima: &[Operation],
    driven: &Driven,
) -> Option<ControlTrace> {
    let study = driving.basis.study;
    let segments: Vec<Segment> = in_time.segments(optima, study.grid.windows()[window]);
    let mission = in_time.mission();
    let mut trace = Trace::default();
    let mut setpoints: Vec<Vec<f64>> = Vec::new();
    let variants = [variant(study, design, driven, &segments, &[])];
    simulate_with(&mission, &study.dynamics, &variants, &mut |_, now| {
        trace.add(now);
        if now.second % 60 == 0 {
            setpoints.push(Vec::new());
        }
        if let (Some(minute), Some(setpoint_k)) = (setpoints.last_mut(), now.setpoint_k) {
            minute.push(setpoint_k);
        }
    })?;
    let mean =
        |values: &Vec<f64>| (!values.is_empty()).then(|| celsius(values.iter().sum::<f64>() / values.len() as f64));
    let minute = |(m, setpoints): (&simulate::TraceMinute, &Vec<f64>)| ControlMinute {
        ambient_temperature_c: celsius(m.ambient_k),
        setpoint_c: mean(setpoints),
        cabin_temperature_c: celsius(m.cabin_k),
        pmv: m.pmv,
        pmv_15min: m.pmv_15min,
        air_unit_power_w: m.air_unit_power_w,
        hvac_power_w: m.hvac_power_w,
    };
    Some(ControlTrace {
        design: study.design_rows[design].name.clone(),
        window: study.grid.windows()[driven.window.unwrap_or(window)],
        controller: driven.name.clone(),
        mission: samples[0].segment.mission.clone(),
        minutes: trace.finish(&mission).iter().zip(&setpoints).map(minute).collect(),
    })
}
