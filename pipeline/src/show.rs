//! One optimum, from its four binary choices down to the rows it came from.

use cabin::{Cabin, Candidate, ComfortWindow, HeatFlows, Operation, PassengerViews, celsius};
use chrono::SecondsFormat;
use ingest::sample::Sample;
use report::{HeatFlowFigure, heat_flow_svg};
use serde_json::{Map, Value, json};
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
    /// All of it as JSON, with the names and units of the database.
    #[must_use]
    pub fn json(&self, design: &str) -> Value {
        let (segment, d) = (&self.sample.segment, &self.sample.disturbances);
        let candidate = |c: &Candidate| {
            json!({
                "radiant_heaters_on": c.devices.radiant_heaters, "air_curtain_on": c.devices.air_curtain,
                "available": c.available, "optimum": c.operation.as_ref().map(operation),
            })
        };
        let flows = |flows: &HeatFlows| {
            let named: Map<String, Value> =
                flows.named_w().map(|(column, _, w)| (column.to_owned(), json!(w))).into_iter().collect();
            json!({ "flows_w": named, "net_w": flows.net_w() })
        };
        json!({
            "sample_id": self.sample.id, "design": design, "pmv_min": self.window.pmv_min(), "pmv_max": self.window.pmv_max(),
            "sample": {
                "mission": segment.mission, "segment": segment.segment, "source_path": segment.source_path,
                "first_line": segment.first_line, "last_line": segment.last_line,
                "start_utc": segment.start.to_rfc3339_opts(SecondsFormat::Secs, true), "duration_s": segment.duration_s,
                "month": self.sample.month, "weight": self.weight,
                "ambient_temperature_c": celsius(d.ambient_temperature_k), "dni_w_m2": d.dni_w_m2, "dhi_w_m2": d.dhi_w_m2,
                "solar_altitude_deg": d.solar_altitude_rad.to_degrees(), "shadow_fraction": d.shadow_fraction,
                "passengers": d.passengers, "door_open_fraction": d.door_open_fraction,
            },
            "stored": self.stored.as_ref().map(|row| json!({
                "status": row.status, "hvac_power_w": row.hvac_power_w, "runner_up_excess_w": row.runner_up_excess_w,
            })),
            "candidates": self.candidates.iter().map(candidate).collect::<Vec<_>>(),
            "optimum": self.best.as_ref().map(|(o, _)| operation(o)),
            "heat": self.best.as_ref().map(|(_, f)| flows(f)),
        })
    }

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

fn operation(o: &Operation) -> Value {
    let t = &o.temperatures;
    json!({
        "hvac_power_w": o.hvac_power_w(), "air_unit_power_w": o.air_unit_power_w,
        "radiant_heater_power_w": o.radiant_heater_power_w, "air_curtain_power_w": o.air_curtain_power_w,
        "air_unit_heat_w": o.air_unit_heat_w, "operating_mode": o.mode.number(), "pmv": o.pmv,
        "cabin_temperature_c": celsius(t.cabin_k), "interior_temperature_c": celsius(t.interior_k),
        "shell_inside_temperature_c": celsius(t.shell_inside_k), "shell_outside_temperature_c": celsius(t.shell_outside_k),
        "radiant_heater_temperature_c": celsius(t.radiant_heater_k),
        "mean_radiant_temperature_c": celsius(o.mean_radiant_temperature_k),
    })
}
