//! What a controller on board can learn from the optima: setpoint profiles and thresholds, as files that it can load.

mod files;

use cabin::{ComfortWindow, OperatingMode, celsius};
use ingest::sample::Sample;
use rayon::prelude::*;
use setpoints::{Edge, FitError, Point, Profile, Switch, Threshold, curtain_threshold_k, fit, threshold};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use store::Store;
use study::Study;

use crate::record::input_hash;
use crate::{PipelineError, freshness, open};

/// Samples whose optima are read at a time.
const BLOCK: usize = 1024;

/// Setpoints of a design in a comfort window.
#[derive(Debug, Clone, PartialEq)]
pub struct Setpoints {
    /// Name of the design.
    pub design: String,
    /// The comfort window.
    pub window: ComfortWindow,
    /// Setpoint while heating, or why there is none.
    pub heating: Result<Profile, FitError>,
    /// Setpoint while cooling, or why there is none.
    pub cooling: Result<Profile, FitError>,
    /// From which difference on the air curtains run, of the cabin over ambient temperature while heating, of the ambient over
    /// the cabin temperature while cooling; nothing for a design without them.
    pub curtains: Vec<CurtainThreshold>,
    /// Below which ambient temperature in °C the radiant heaters run; `None` for a design without them, and where they always or
    /// never do.
    pub heaters_below_c: Option<Threshold>,
}

/// From where on air curtains run in a mode.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurtainThreshold {
    /// Heating or cooling.
    pub mode: OperatingMode,
    /// That of the optima, in K; `None` where they always or never run.
    pub of_optima: Option<Threshold>,
    /// That of the model at the mean ambient temperature of the mode, in K; `None` where curtains never pay.
    pub analytic_k: Option<f64>,
}

/// An optimum as a profile sees it.
#[derive(Debug, Clone, Copy)]
struct Hour {
    mode: OperatingMode,
    ambient_k: f64,
    cabin_k: f64,
    curtain: bool,
    heaters: bool,
    weight: f64,
}

/// Extracts the setpoints of every design and window of a study from its optima, writes them as TOML and CSV to a folder, and
/// gives them in the order of the study.
///
/// # Errors
/// [`PipelineError::Stale`] where the optima are; [`PipelineError::Request`] for a coverage that is no share;
/// [`PipelineError::Write`], [`PipelineError::Store`].
pub fn control(study: &Study, coverage: f64, to: &Path) -> Result<(PathBuf, Vec<Setpoints>), PipelineError> {
    if !(0.5..=1.0).contains(&coverage) {
        return Err(PipelineError::Request(format!("--coverage {coverage} must lie between 0.5 and 1")));
    }
    let mut store = open::for_reading(study)?;
    if let Some(stale) = freshness::optima(study, &mut store)? {
        return Err(stale.into());
    }
    let clouds = clouds(&mut store)?;
    let inputs = input_hash(&mut store)?;
    store.close()?;
    let windows = study.grid.windows();
    let found: Vec<Setpoints> = clouds
        .par_iter()
        .enumerate()
        .map(|(n, hours)| setpoints(study, n / windows.len(), windows[n % windows.len()], hours, coverage))
        .collect();
    let folder = study.base.join(to);
    files::write(study, &inputs, coverage, &found, &folder)?;
    Ok((folder, found))
}

/// The solved hours of every design and window, in the order of the study.
fn clouds(store: &mut Store) -> Result<Vec<Vec<Hour>>, PipelineError> {
    let grid = store.grid()?;
    let weights: BTreeMap<u8, f64> = store.months()?.into_iter().map(|m| (m.month, m.sample_weight)).collect();
    let mut samples: Vec<Sample> = store.samples()?;
    samples.sort_by_key(|s| s.id);
    let mut clouds = vec![Vec::new(); grid.designs.len() * grid.windows.len()];
    for block in samples.chunks(BLOCK) {
        let of_id: BTreeMap<i64, &Sample> = block.iter().map(|s| (s.id, s)).collect();
        for row in store.optima(&grid, block[0].id, block[block.len() - 1].id)? {
            let operation = row.outcome.as_ref().and_then(|outcome| outcome.operation());
            let (Some(o), Some(sample)) = (operation, of_id.get(&row.sample_id)) else { continue };
            clouds[row.design * grid.windows.len() + row.window].push(Hour {
                mode: o.mode,
                ambient_k: sample.disturbances.ambient_temperature_k,
                cabin_k: o.temperatures.cabin_k,
                curtain: o.devices.air_curtain,
                heaters: o.devices.radiant_heaters,
                weight: weights.get(&sample.month).copied().unwrap_or(0.0),
            });
        }
    }
    Ok(clouds)
}

fn setpoints(study: &Study, design: usize, window: ComfortWindow, hours: &[Hour], coverage: f64) -> Setpoints {
    let row = &study.design_rows[design];
    let in_mode = |mode| hours.iter().filter(move |h| h.mode == mode && h.weight > 0.0);
    let profile = |mode, edge| {
        let point = |h: &Hour| Point { ambient_c: celsius(h.ambient_k), cabin_c: celsius(h.cabin_k), weight: h.weight };
        fit(&in_mode(mode).map(point).collect::<Vec<_>>(), edge, coverage)
    };
    let curtain = |mode| {
        // A cabin that is cooled while it is colder outside is better off with open doors.
        let sign = if mode == OperatingMode::Cooling { -1.0 } else { 1.0 };
        let switch = |h: &Hour| Switch { value: sign * (h.cabin_k - h.ambient_k), is_on: h.curtain, weight: h.weight };
        let switches: Vec<Switch> = in_mode(mode).map(switch).collect();
        let (sum_k, weight) = in_mode(mode).fold((0.0, 0.0), |(s, w), h| (s + h.weight * h.ambient_k, w + h.weight));
        let kind = &study.grid.designs()[design];
        let cop = if mode == OperatingMode::Cooling { &kind.cooling_cop } else { &kind.heating_cop };
        let analytic_k = if weight > 0.0 { curtain_threshold_k(&study.vehicle, cop, sum_k / weight) } else { None };
        CurtainThreshold { mode, of_optima: threshold(&switches), analytic_k }
    };
    // Heaters run where it is cold: the threshold is one of the negative temperature.
    let heater = |h: &Hour| Switch { value: -celsius(h.ambient_k), is_on: h.heaters, weight: h.weight };
    let heaters = || threshold(&hours.iter().filter(|h| h.weight > 0.0).map(heater).collect::<Vec<_>>());
    let modes = [OperatingMode::Heating, OperatingMode::Cooling];
    Setpoints {
        design: row.name.clone(),
        window,
        heating: profile(OperatingMode::Heating, Edge::Upper),
        cooling: profile(OperatingMode::Cooling, Edge::Lower),
        curtains: if row.devices.air_curtain { modes.map(curtain).to_vec() } else { Vec::new() },
        heaters_below_c: if row.devices.radiant_heaters {
            heaters().map(|t| Threshold { value: -t.value, ..t })
        } else {
            None
        },
    }
}
