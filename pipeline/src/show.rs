//! One optimum, from its four binary choices down to the rows it came from.

use cabin::{Cabin, Candidate, ComfortWindow, HeatFlows, Operation, PassengerViews};
use ingest::sample::Sample;
use report::{HeatFlowFigure, heat_flow_svg};
use solve::SampleSolver;
use store::OptimumRow;
use study::Study;

use crate::{PipelineError, open};

/// Which optimum.
#[derive(Debug, Clone, PartialEq)]
pub struct Point {
    /// Sample, as in the view `sample`.
    pub sample: i64,
    /// Design, as in the study file.
    pub design: String,
    /// The larger limit of the comfort window.
    pub pmv_limit: f64,
}

/// An optimum with all that leads to it.
#[derive(Debug, Clone, PartialEq)]
pub struct Shown {
    /// Its sample.
    pub sample: Sample,
    /// Weight of the sample in the year.
    pub weight: f64,
    /// Its comfort window.
    pub window: ComfortWindow,
    /// What the database holds; nothing before `solve`.
    pub stored: Option<OptimumRow>,
    /// The four choices of heaters and curtain.
    pub candidates: [Candidate; 4],
    /// The cheapest of those that the design has, with its heat flows; none where no choice meets the window.
    pub best: Option<(Operation, HeatFlows)>,
}

/// Looks up an optimum and computes it again.
///
/// # Errors
/// [`PipelineError::Request`] where study or database have no such point; [`PipelineError::Store`].
pub fn show(study: &Study, point: &Point) -> Result<Shown, PipelineError> {
    let names: Vec<&str> = study.grid.designs().iter().map(|d| d.name.as_str()).collect();
    let design = names.iter().position(|n| *n == point.design).ok_or_else(|| {
        let all = names.join(", ");
        PipelineError::Request(format!("the study has no design {:?}; it has: {all}", point.design))
    })?;
    let place = study.grid.windows().iter().position(|w| w.pmv_limit() == point.pmv_limit).ok_or_else(|| {
        let limits: Vec<String> = study.grid.windows().iter().map(|w| w.pmv_limit().to_string()).collect();
        PipelineError::Request(format!("the study has no limit {}; it has: {}", point.pmv_limit, limits.join(", ")))
    })?;
    let window = study.grid.windows()[place];
    let mut store = open::for_reading(study)?;
    let sample = store.samples()?.into_iter().find(|s| s.id == point.sample).ok_or_else(|| {
        PipelineError::Request(format!("the database has no sample {}; see the view `sample`", point.sample))
    })?;
    let weight = store.sample_weight(point.sample)?.unwrap_or(0.0);
    let stored = store.optimum(point.sample, &point.design, window)?;
    store.close()?;

    let views = PassengerViews::new(&study.vehicle);
    let mut solver = SampleSolver::new(&study.vehicle, &views, &study.grid);
    let candidates = solver.candidates(&sample.disturbances, design, place);
    let mut best: Option<Operation> = None;
    for candidate in candidates.iter().filter(|c| c.available) {
        if let Some(o) = candidate.operation
            && best.is_none_or(|b| o.hvac_power_w() < b.hvac_power_w())
        {
            best = Some(o);
        }
    }
    let cabin = Cabin::new(&study.vehicle, &views, &sample.disturbances);
    let with_flows = |o: Operation| {
        let flows = cabin.flows(&o.temperatures, o.devices.air_curtain, o.air_unit_heat_w, o.radiant_heater_power_w);
        (o, flows)
    };
    Ok(Shown { sample, weight, window, stored, candidates, best: best.map(with_flows) })
}

impl Shown {
    /// The heat flows of the optimum as a diagram; `None` where there is no optimum.
    ///
    /// # Errors
    /// [`PipelineError::Report`].
    pub fn figure(&self, design: &str) -> Result<Option<String>, PipelineError> {
        let Some((o, flows)) = &self.best else { return Ok(None) };
        let d = &self.sample.disturbances;
        let content = HeatFlowFigure {
            title: format!("Heat flows, {design} at PMV {} … {}", self.window.pmv_min(), self.window.pmv_max()),
            description: format!(
                "Sample {} ({}): {:.0} W HVAC power, {:.1} passengers, {:.1} % of the doors open, PMV {:.2}",
                self.sample.id,
                self.sample.segment.start.format("%Y-%m-%dT%H:%M:%SZ"),
                o.hvac_power_w(),
                d.passengers,
                100.0 * d.door_open_fraction,
                o.pmv
            ),
            ambient_k: d.ambient_temperature_k,
            temperatures: o.temperatures,
            flows: *flows,
            air_unit_power_w: o.air_unit_power_w,
        };
        Ok(Some(heat_flow_svg(&content)?))
    }
}
