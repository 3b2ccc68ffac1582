//! What a run would do, and why: the same questions that each stage asks before it works, with the answers in words.

use ingest::FileKind;
use ingest::mission;
use serde::Serialize;
use simulate::Replay;
use std::collections::{BTreeMap, BTreeSet};
use store::{RecordedStage, SimulationId, Store, StoredGrid};
use study::{Study, keys};

use crate::basis::SimulationBasis;
use crate::before::{Before, Standing};
use crate::check::{POINTS_A_SECOND, ROWS_A_SECOND, SIMULATED_A_SECOND};
use crate::control::controllers_at_most as controllers;
use crate::missing::Gone;
use crate::missions::{WeatherAndShade, missions};
use crate::{Inputs, PipelineError, Stage, freshness, open, report};

/// What a stage would do.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StagePlan {
    /// Its name.
    pub stage: &'static str,
    /// Missions to be read, segments to be joined, points, simulations, reports: at least so many, where a stage before it
    /// has work of its own.
    pub to_compute: u64,
    /// Estimated time in s.
    pub seconds: f64,
    /// Why; empty where nothing is to be done.
    pub why: Vec<String>,
}

/// What a run would do with a study as it is now. Writes nothing.
///
/// # Errors
/// [`PipelineError`] where inputs or database cannot be used.
pub fn plan(study: &Study, rehash: bool) -> Result<Vec<StagePlan>, PipelineError> {
    let mut store = if study.database.exists() { open::for_reading(study)? } else { Store::in_memory()? };
    let mut planning = Planning { study, inputs: Inputs::new(study, rehash), store: &mut store, new_samples: 0 };
    let plans = planning.all()?;
    store.close()?;
    Ok(plans)
}

struct Planning<'s> {
    study: &'s Study,
    inputs: Inputs<'s>,
    store: &'s mut Store,
    /// Samples that missions to be read will give, as far as their names tell.
    new_samples: u64,
}

impl Planning<'_> {
    fn all(&mut self) -> Result<Vec<StagePlan>, PipelineError> {
        let ingest = self.ingest()?;
        let shade = self.shade(&ingest)?;
        let solve = self.solve(&shade)?;
        let simulate = self.simulate(&shade, &solve)?;
        let control = self.control(&shade, &solve)?;
        let report = self.report(&simulate, &control)?;
        Ok(vec![ingest, shade, solve, simulate, control, report])
    }

    /// A stage's plan with the settings that have changed since it was last done. The time is that of the last run that
    /// did any of it, or of a plain machine.
    fn planned(
        &mut self,
        stage: Stage,
        to_compute: u64,
        plain_s: f64,
        mut why: Vec<String>,
    ) -> Result<StagePlan, PipelineError> {
        let (then, now) = (self.store.settings(stage.name())?, keys::settings(self.study, stage.name()));
        if !then.is_empty() {
            let names: BTreeSet<&String> = then.keys().chain(now.keys()).collect();
            let value = |settings: &BTreeMap<String, String>, name: &String| {
                settings.get(name).cloned().unwrap_or_else(|| "nothing".to_owned())
            };
            let changed = names.into_iter().filter(|name| then.get(*name) != now.get(*name));
            why.extend(changed.map(|name| format!("{name} was {} and is {}", value(&then, name), value(&now, name))));
        }
        let own_s = self.store.pace_s(stage.name())?.map(|pace_s| pace_s * to_compute as f64);
        Ok(StagePlan { stage: stage.name(), to_compute, seconds: own_s.unwrap_or(plain_s), why })
    }

    fn ingest(&mut self) -> Result<StagePlan, PipelineError> {
        let study = self.study;
        let found = mission::discover(&study.base, &study.missions_path, &study.mission_format, &study.buses)?;
        let overlapping: BTreeSet<usize> = mission::overlaps(&found.missions).into_iter().map(|(i, _)| i).collect();
        let known = self.store.known_files(FileKind::Mission)?;
        let before = Before::of(study, &self.inputs, &known);
        let mut reasons: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
        let (mut rows, mut to_read) = (0, 0);
        let wanted = found.missions.iter().enumerate().filter(|(i, _)| !overlapping.contains(i)).map(|(_, m)| m);
        for source in wanted {
            let standing = before.standing(source);
            let Some(reason) = words(standing) else { continue };
            reasons.entry(reason).or_default().push(&source.path);
            if standing != Standing::Moved {
                let seconds = (source.end - source.start).num_seconds() + 1;
                rows += seconds;
                to_read += 1;
                // What is only hashed will mostly be found unchanged.
                let samples =
                    if standing == Standing::Unsure { 0 } else { seconds / i64::from(study.missions.segment_s) };
                self.new_samples += samples.unsigned_abs();
            }
        }
        let gone = Gone::of(study, &found, &known);
        let missing_before = self.store.missing_files()?;
        for path in &gone.forgotten {
            reasons.entry("no longer there").or_default().push(path);
        }
        for path in gone.missing.difference(&missing_before) {
            reasons.entry("missing, and kept").or_default().push(path);
        }
        for path in
            missing_before.iter().filter(|path| !gone.missing.contains(*path) && !gone.forgotten.contains(*path))
        {
            reasons.entry("there again").or_default().push(path);
        }
        let why = reasons.iter().map(|(reason, paths)| match paths.as_slice() {
            [one] => format!("1 mission is {reason}: {one}"),
            [first, ..] => format!("{} missions are {reason}, the first: {first}", paths.len()),
            [] => (*reason).to_owned(),
        });
        let why = why.collect();
        self.planned(Stage::Ingest, to_read, rows as f64 / ROWS_A_SECOND, why)
    }

    fn shade(&mut self, ingest: &StagePlan) -> Result<StagePlan, PipelineError> {
        let mut why = Vec::new();
        if ingest.to_compute > 0 {
            why.push(format!("{} missions are read before", ingest.to_compute));
        }
        let stale = freshness::samples(&self.inputs, self.store)?;
        why.extend(stale.map(|stale| stale.what));
        let open = self.store.unjoined_segments()?.max(self.new_samples);
        // Joining a year's samples takes a second.
        let seconds = if why.is_empty() { 0.0 } else { 1.0 };
        self.planned(Stage::Shade, open, seconds, why)
    }

    fn solve(&mut self, shade: &StagePlan) -> Result<StagePlan, PipelineError> {
        let study = self.study;
        let stored = self.store.grid()?;
        let mut why = Vec::new();
        let same = stored.same_designs(&study.design_rows);
        for (row, same) in study.design_rows.iter().zip(&same) {
            match same {
                None if stored.designs.iter().any(|d| d.name == row.name) => {
                    why.push(format!("the design {} has changed", row.name));
                }
                None => why.push(format!("the design {} is new", row.name)),
                Some(i) if stored.designs[*i].name != row.name => {
                    why.push(format!("the design {} was called {}", row.name, stored.designs[*i].name));
                }
                Some(_) => {}
            }
        }
        let gone = (0..stored.designs.len()).filter(|i| !same.contains(&Some(*i)));
        let gone = gone.map(|i| &stored.designs[i].name).filter(|n| study.design_rows.iter().all(|d| d.name != **n));
        why.extend(gone.map(|name| format!("the design {name} is no longer in the study")));
        let windows = study.grid.windows();
        let new_windows = windows.iter().filter(|w| !stored.windows.contains(w)).count();
        if new_windows > 0 {
            why.push(format!("{new_windows} comfort windows are new"));
        }
        let points = study.grid.points() as u64;
        let mut missing = self.new_samples * points;
        let (of_stored, samples) = self.missing(&stored, &same)?;
        missing += of_stored;
        if samples > 0 {
            why.push(format!("{samples} samples lack optima"));
        }
        if !shade.why.is_empty() {
            why.push("samples are made before: those that are new or change are computed".to_owned());
        }
        self.planned(Stage::Solve, missing, missing as f64 / POINTS_A_SECOND, why)
    }

    /// The points that stored samples lack of the study's grid, and how many samples lack stored ones.
    fn missing(&mut self, stored: &StoredGrid, same: &[Option<usize>]) -> Result<(u64, u64), PipelineError> {
        let samples: u64 = self.store.months()?.iter().map(|m| m.sample_count).sum();
        let place = |window| stored.windows.iter().position(|w| w == window);
        let kept: BTreeSet<(usize, usize)> = same
            .iter()
            .flatten()
            .flat_map(|&design| self.study.grid.windows().iter().filter_map(place).map(move |window| (design, window)))
            .collect();
        let mut missing = samples * (self.study.grid.points() - kept.len()) as u64;
        let mut lacking = 0;
        for gap in self.store.missing_optima(stored)? {
            let points = gap.points.iter().filter(|point| kept.contains(point)).count();
            missing += (points * gap.samples.len()) as u64;
            lacking += if points > 0 { gap.samples.len() as u64 } else { 0 };
        }
        Ok((missing, lacking))
    }

    fn simulate(&mut self, shade: &StagePlan, solve: &StagePlan) -> Result<StagePlan, PipelineError> {
        let study = self.study;
        let mut why = Vec::new();
        if !solve.why.is_empty() {
            why.push("optima are computed or withdrawn before".to_owned());
        }
        let ways = (study.grid.designs().len() * study.simulated_windows.len() * Replay::ALL.len()) as u64;
        let mut to_simulate = self.new_samples.div_ceil(SAMPLES_A_MISSION) * ways;
        if shade.why.is_empty() {
            let key = freshness::simulate_key(study, &self.inputs, self.store)?;
            if self.store.stage(RecordedStage::Simulate)?.is_none_or(|record| record.key != key) {
                let missing = self.unsimulated()?;
                to_simulate += missing * Replay::ALL.len() as u64;
                if missing > 0 {
                    let ways = Replay::ALL.len();
                    why.push(format!("{missing} missions (mission × design × window) lack their {ways} simulations"));
                }
            }
        } else {
            to_simulate += self.of_changed_designs()?;
        }
        let seconds = to_simulate as f64 * MISSION_S / SIMULATED_A_SECOND;
        self.planned(Stage::Simulate, to_simulate, seconds, why)
    }

    /// How many simulations the designs need that have changed, of missions that stay.
    fn of_changed_designs(&mut self) -> Result<u64, PipelineError> {
        let stored = self.store.grid()?;
        let changed = stored.same_designs(&self.study.design_rows).iter().filter(|same| same.is_none()).count();
        let missions = missions(self.store.samples()?).len();
        Ok((missions * changed * self.study.simulated_windows.len() * Replay::ALL.len()) as u64)
    }

    /// How many simulations the study asks for that are not stored with the key that they would have now.
    fn unsimulated(&mut self) -> Result<u64, PipelineError> {
        let stored = self.store.grid()?;
        let same = stored.same_designs(&self.study.design_rows);
        let basis = SimulationBasis {
            study: self.study,
            grid: stored.clone(),
            views: cabin::PassengerViews::new(&self.study.vehicle),
            surroundings: WeatherAndShade::of(&self.inputs)?,
            missions: missions(self.store.samples()?),
        };
        let known = self.store.simulation_keys(&stored)?;
        let is_known = |id: &SimulationId, key: &String| {
            let window = stored.windows.iter().position(|w| *w == self.study.grid.windows()[id.window]);
            let (Some(design), Some(window)) = (same[id.design], window) else { return false };
            known.get(&SimulationId { design, window, ..id.clone() }) == Some(key)
        };
        Ok(basis.keys().iter().filter(|(id, key)| !is_known(id, key)).count() as u64)
    }

    /// Whatever changes an optimum changes the profiles, and with them all missions.
    fn control(&mut self, shade: &StagePlan, solve: &StagePlan) -> Result<StagePlan, PipelineError> {
        let study = self.study;
        let mut why = Vec::new();
        if !solve.why.is_empty() {
            why.push("optima are computed or withdrawn before, from which the setpoints are".to_owned());
        } else if shade.why.is_empty() {
            let key = freshness::control_key(study, &self.inputs, self.store)?;
            if self.store.stage(RecordedStage::Control)?.is_none_or(|record| record.key != key) {
                why.push("the setpoints are not of these optima and this study".to_owned());
            }
        }
        let mut to_drive = 0;
        if !why.is_empty() && !study.control.windows.is_empty() {
            let missions = missions(self.store.samples()?).len() as u64 + self.new_samples.div_ceil(SAMPLES_A_MISSION);
            to_drive = missions * study.control.designs.len() as u64;
        }
        let seconds = to_drive as f64 * controllers(study) as f64 * MISSION_S / SIMULATED_A_SECOND;
        self.planned(Stage::Control, to_drive, seconds, why)
    }

    fn report(&mut self, simulate: &StagePlan, control: &StagePlan) -> Result<StagePlan, PipelineError> {
        let mut why = Vec::new();
        if !simulate.why.is_empty() || !control.why.is_empty() {
            why.push("what it shows is computed before".to_owned());
        } else if let Some(reason) = report::why_renewed(self.study, &self.inputs, self.store)? {
            why.push(reason.to_owned());
        }
        let files = if why.is_empty() { 0 } else { ::report::FILES.len() as u64 };
        self.planned(Stage::Report, files, if why.is_empty() { 0.0 } else { 1.0 }, why)
    }
}

/// What is to be done about a mission; nothing where it is as it was.
fn words(standing: Standing) -> Option<&'static str> {
    match standing {
        Standing::New => Some("new"),
        Standing::OtherSettings => Some("to be read with other settings"),
        Standing::Unsure => Some("to be hashed, for size, time or inode are not as they were"),
        Standing::Moved => Some("known from another place"),
        Standing::Same => None,
    }
}

/// A usual mission of ZTBus: its whole hours, and their seconds.
const SAMPLES_A_MISSION: u64 = 9;
const MISSION_S: f64 = 3600.0 * SAMPLES_A_MISSION as f64;
