//! Missions under all controllers of their designs.

use cabin::{ComfortWindow, Operation};
use ingest::sample::Sample;
use rayon::prelude::*;
use simulate::control::Law;
use simulate::{Limits, Scenario, Segment, Start, Summary, Variant, simulate_distinct};
use std::collections::BTreeMap;
use store::{ControlId, ControlRow, ControlledMission, Store};
use study::keys;

use super::clouds::year;
use super::controllers::{Controllers, Driven};
use crate::basis::{SimulationBasis, optima};
use crate::missions::MissionInTime;
use crate::{PipelineError, Progress};

/// As in the paper's validation: from the depot, with the devices' limits.
pub(super) const SCENARIO: Scenario = Scenario { start: Start::Depot, limits: Limits::Rated };

/// What drives, and on what.
pub(super) struct Driving<'a> {
    pub basis: SimulationBasis<'a>,
    pub controllers: Controllers,
}

/// A mission to be driven, with all that comes out of the database for it.
pub(super) struct Job<'a> {
    samples: &'a [Sample],
    loads: Vec<cabin::LoadChange>,
    designs: Vec<OfDesign>,
}

/// A design of a mission, with its key, and the optima of its segments in every window or why there are none.
struct OfDesign {
    id: ControlId,
    key: String,
    optima: Result<BTreeMap<usize, Vec<Operation>>, String>,
}

/// What the optima of a mission foresee within a window.
struct Foreseen {
    mean_hvac_power_w: f64,
    max_abs_pmv: f64,
    /// Over the passengers; `None` where there are none.
    mean_abs_pmv: Option<f64>,
}

impl Foreseen {
    fn of(optima: &[Operation], samples: &[Sample]) -> Self {
        let passengers = |s: &Sample| s.disturbances.passengers;
        let all: f64 = samples.iter().map(passengers).sum();
        let votes: f64 = optima.iter().zip(samples).map(|(o, s)| passengers(s) * o.pmv.abs()).sum();
        Self {
            mean_hvac_power_w: optima.iter().map(Operation::hvac_power_w).sum::<f64>() / optima.len() as f64,
            max_abs_pmv: optima.iter().map(|o| o.pmv.abs()).fold(0.0, f64::max),
            mean_abs_pmv: (all > 0.0).then(|| votes / all),
        }
    }
}

impl Driving<'_> {
    /// The key of every mission and design that the study drives.
    pub fn keys(&self) -> BTreeMap<ControlId, String> {
        let study = self.basis.study;
        let windows: Vec<String> = self.windows().iter().map(|w| format!("{} {}", w.pmv_min(), w.pmv_max())).collect();
        let windows = windows.join(" ");
        let mut texts = BTreeMap::new();
        for (design, of_years) in &self.controllers {
            for (year, driven) in of_years {
                texts.insert((*design, *year), keys::hash(&[&format!("{driven:?}")]));
            }
        }
        let mut keys = BTreeMap::new();
        for samples in &self.basis.missions {
            let (mission, year) = (self.basis.mission_key(samples), year(study, &samples[0]));
            for design in self.controllers.keys() {
                let Some(controllers) = texts.get(&(*design, year)) else { continue };
                let of_design = &study.design_rows[*design].design_key;
                let key = keys::hash(&[&mission, of_design, &windows, controllers]);
                let source_path = samples[0].segment.source_path.clone();
                keys.insert(ControlId { source_path, design: *design }, key);
            }
        }
        keys
    }

    /// The windows that are driven.
    fn windows(&self) -> Vec<ComfortWindow> {
        let study = self.basis.study;
        study.control.windows.iter().map(|w| study.grid.windows()[*w]).collect()
    }

    /// What is missing of some missions.
    pub fn jobs<'s>(
        &self,
        store: &mut Store,
        missions: &'s [Vec<Sample>],
        missing: &dyn Fn(&ControlId) -> Option<String>,
    ) -> Result<Vec<Job<'s>>, PipelineError> {
        let mut jobs = Vec::new();
        for samples in missions {
            let source_path = &samples[0].segment.source_path;
            let id = |design: &usize| ControlId { source_path: source_path.clone(), design: *design };
            let open: Vec<(ControlId, String)> =
                self.controllers.keys().map(id).filter_map(|id| missing(&id).map(|key| (id, key))).collect();
            if open.is_empty() {
                continue;
            }
            let of_designs: Vec<usize> = open.iter().map(|(id, _)| id.design).collect();
            let windows = &self.basis.study.control.windows;
            let mut optima = optima(store, &self.basis.grid, samples, &of_designs, windows)?;
            let mut of_design = |(id, key): (ControlId, String)| {
                let windows = self.basis.study.control.windows.iter();
                let of_window = |w: &usize| {
                    let none = || Err("no optimum".to_owned());
                    Ok((*w, optima.remove(&(id.design, *w)).unwrap_or_else(none)?))
                };
                let optima = windows.map(of_window).collect();
                OfDesign { id, key, optima }
            };
            let designs = open.into_iter().map(&mut of_design).collect();
            jobs.push(Job { samples, loads: store.loads(source_path)?, designs });
        }
        Ok(jobs)
    }

    /// Drives missions, up to where somebody asks to stop: each row is whole by itself.
    pub fn run(&self, jobs: &[Job<'_>], progress: &dyn Progress) -> Vec<ControlRow> {
        let rows = |job: &Job<'_>| if progress.stop() { Vec::new() } else { self.rows(job) };
        jobs.par_iter().flat_map_iter(rows).collect()
    }

    fn rows(&self, job: &Job<'_>) -> Vec<ControlRow> {
        let (basis, samples) = (&self.basis, job.samples);
        let in_time = MissionInTime::new(basis.study, &basis.views, &basis.surroundings, samples, &job.loads);
        let ambient_k =
            samples.iter().map(|s| s.disturbances.ambient_temperature_k).sum::<f64>() / samples.len() as f64;
        let row = |of: &OfDesign| ControlRow {
            id: of.id.clone(),
            key: of.key.clone(),
            mission: samples[0].segment.mission.clone(),
            month: samples[0].month,
            ambient_k,
            result: match (&in_time, &of.optima) {
                (Ok(in_time), Ok(optima)) => self.driven(in_time, samples, of.id.design, optima),
                (Err(reason), _) | (_, Err(reason)) => Err(reason.clone()),
            },
        };
        job.designs.iter().map(row).collect()
    }

    /// The controllers of a design that drive a mission.
    pub fn of_mission(&self, design: usize, samples: &[Sample]) -> &[Driven] {
        let of_years = self.controllers.get(&design);
        of_years.and_then(|of| of.get(&year(self.basis.study, &samples[0]))).map_or(&[], Vec::as_slice)
    }

    /// A mission under all controllers of a design.
    fn driven(
        &self,
        in_time: &MissionInTime<'_>,
        samples: &[Sample],
        design: usize,
        optima: &BTreeMap<usize, Vec<Operation>>,
    ) -> Result<Vec<ControlledMission>, String> {
        let study = self.basis.study;
        let windows = self.windows();
        let segments: BTreeMap<usize, Vec<Segment>> =
            optima.iter().map(|(w, o)| (*w, in_time.segments(o, study.grid.windows()[*w]))).collect();
        let foreseen: BTreeMap<usize, Foreseen> = optima.iter().map(|(w, o)| (*w, Foreseen::of(o, samples))).collect();
        let all = &study.control.windows;
        let driven = self.of_mission(design, samples);
        // Who follows a profile of some years alone is judged by its window alone.
        let judges = |driven: &Driven| {
            let own = all.iter().position(|w| Some(*w) == driven.window).filter(|_| !driven.judged_by_all);
            own.map_or(0..all.len(), |place| place..place + 1)
        };
        let variant = |driven| variant(study, design, driven, &segments[&all[0]], &windows[judges(driven)]);
        let variants: Vec<Variant<'_>> = driven.iter().map(variant).collect();
        let summaries = simulate_distinct(&in_time.mission(), &study.dynamics, &variants);
        let summaries = summaries.ok_or_else(|| "no weather up to its end".to_owned())?;
        let judged = |(driven, s): (&Driven, &Summary)| -> Vec<ControlledMission> {
            let by = |(place, window): (usize, &usize)| ControlledMission {
                controller: driven.name.clone(),
                window: *window,
                seconds: s.seconds,
                mean_hvac_power_w: s.mean_hvac_power_w,
                static_mean_hvac_power_w: foreseen[window].mean_hvac_power_w,
                max_abs_pmv_15min: s.max_abs_pmv_15min,
                static_max_abs_pmv: foreseen[window].max_abs_pmv,
                mean_abs_pmv: s.rides.mean_abs_pmv,
                static_mean_abs_pmv: foreseen[window].mean_abs_pmv,
                passenger_hours: s.rides.passenger_hours,
                passenger_hours_outside: s.rides.hours_outside[place],
                outside: if driven.window.is_none() || !driven.judged_by_all {
                    Vec::new()
                } else {
                    all.iter().copied().zip(s.rides.hours_outside.iter().copied()).collect()
                },
                saturated_fraction: s.saturated_fraction,
                tracking_error_k: s.tracking_error_k,
            };
            let judging = all[judges(driven)].iter().enumerate();
            judging.filter(|(_, window)| driven.window.is_none_or(|own| own == **window)).map(by).collect()
        };
        Ok(driven.iter().zip(&summaries).flat_map(judged).collect())
    }
}

/// A controller on a mission. The optima of `segments` are only what it is compared with.
pub(super) fn variant<'m>(
    study: &'m study::Study,
    design: usize,
    driven: &'m Driven,
    segments: &'m [Segment],
    windows: &'m [ComfortWindow],
) -> Variant<'m> {
    let law = Law::Causal(&driven.controller);
    Variant { design: &study.grid.designs()[design], scenario: SCENARIO, law, segments, windows }
}
