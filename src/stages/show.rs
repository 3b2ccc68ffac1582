//! One optimum, from its four binary choices down to the rows it came from.

use anyhow::anyhow;
use cabin::{Cabin, PassengerViews, celsius};
use report::{HeatFlowFigure, heat_flow_svg};
use solve::{Operation, SampleSolver};
use std::path::Path;
use store::Store;

use super::report::write_beside;
use super::shade::disturbances;
use crate::args::PointArgs;
use crate::console::say;
use crate::failure::{Ending, Failure};
use crate::study::Study;

pub fn show(study: &Study, point: &PointArgs) -> Result<Ending, Failure> {
    let usage = |message: String| Failure::Usage(anyhow!(message));
    let names: Vec<&str> = study.grid.designs().iter().map(|d| d.name.as_str()).collect();
    let design = names
        .iter()
        .position(|n| *n == point.design)
        .ok_or_else(|| usage(format!("the study has no design {:?}; it has: {}", point.design, names.join(", "))))?;
    let window = study.grid.windows().iter().position(|w| w.pmv_limit() == point.pmv_limit).ok_or_else(|| {
        let limits: Vec<String> = study.grid.windows().iter().map(|w| w.pmv_limit().to_string()).collect();
        usage(format!("the study has no limit {}; it has: {}", point.pmv_limit, limits.join(", ")))
    })?;
    let comfort = study.grid.windows()[window];
    let mut store = Store::open_read_only(&study.database)?;
    let sample = store
        .samples()?
        .into_iter()
        .find(|s| s.sample_id == point.sample)
        .ok_or_else(|| usage(format!("the database has no sample {}; see the view `sample`", point.sample)))?;
    let weight = store.sample_source(point.sample)?.map_or(0.0, |s| s.weight);
    let stored = store.optimum(point.sample, &point.design, comfort.pmv_min(), comfort.pmv_max())?;
    store.close()?;

    say(format_args!(
        "sample {}  design {}  PMV {} … {}",
        point.sample,
        point.design,
        comfort.pmv_min(),
        comfort.pmv_max()
    ))?;
    say(format_args!(
        "from {} lines {}–{}: mission {}, segment {}, {} for {} s",
        sample.source_path,
        sample.first_line,
        sample.last_line,
        sample.mission,
        sample.segment,
        sample.start_utc,
        sample.duration_s
    ))?;
    say(format_args!("weight in the year {weight:.4e}, month {}", sample.month))?;
    say(format_args!(
        "ambient {:.2} °C, DNI {:.1} W/m², DHI {:.1} W/m², solar altitude {:.2}°, shade {:.3}, passengers {:.2}, doors {:.4}",
        celsius(sample.ambient_temperature_k),
        sample.dni_w_m2,
        sample.dhi_w_m2,
        sample.solar_altitude_rad.to_degrees(),
        sample.shadow_fraction,
        sample.passengers,
        sample.door_open_fraction
    ))?;
    match stored {
        Some(row) => say(format_args!(
            "stored: {}, {} W, next choice {} W more",
            row.status,
            row.hvac_power_w.map_or_else(|| "–".to_owned(), |p| format!("{p:.3}")),
            row.runner_up_excess_w.map_or_else(|| "–".to_owned(), |p| format!("{p:.3}"))
        ))?,
        None => say(format_args!("stored: nothing yet; `busclimate run` computes it"))?,
    }

    let views = PassengerViews::new(&study.vehicle);
    let inputs = disturbances(&sample);
    let candidates = SampleSolver::new(&study.vehicle, &views, &study.grid).candidates(&inputs, design, window);
    say(format_args!("\nchoices           power W  air unit W  heaters W  curtain W   cabin °C      PMV"))?;
    let mut best: Option<Operation> = None;
    for candidate in candidates {
        let name = match (candidate.radiant_heaters_on, candidate.air_curtain_on) {
            (false, false) => "neither",
            (false, true) => "curtain",
            (true, false) => "heaters",
            (true, true) => "both",
        };
        let Some(o) = candidate.operation else {
            say(format_args!("{name:<10} no operation meets the window"))?;
            continue;
        };
        let note = if candidate.available { "" } else { "  (not on board)" };
        say(format_args!(
            "{name:<12} {:>12.1} {:>11.1} {:>10.1} {:>10.1} {:>10.3} {:>8.4}{note}",
            o.hvac_power_w(),
            o.air_unit_power_w,
            o.radiant_heater_power_w,
            o.air_curtain_power_w,
            celsius(o.temperatures.cabin_k),
            o.pmv
        ))?;
        if candidate.available && best.is_none_or(|b| o.hvac_power_w() < b.hvac_power_w()) {
            best = Some(o);
        }
    }
    match best {
        Some(operation) => {
            flows(study, &views, &sample, &operation)?;
            if let Some(path) = &point.figure {
                let title = format!("{} at PMV {} … {}", point.design, comfort.pmv_min(), comfort.pmv_max());
                figure(study, &views, &sample, &operation, title, path)?;
            }
        }
        None => say(format_args!("\nno operation of this design meets the window"))?,
    }
    Ok(Ending::Done)
}

/// Temperatures and heat flows of the optimum.
fn flows(
    study: &Study,
    views: &PassengerViews,
    sample: &store::SampleRow,
    operation: &Operation,
) -> Result<(), Failure> {
    let t = operation.temperatures;
    let cabin = Cabin::new(&study.vehicle, views, &disturbances(sample));
    let flows = cabin.flows(&t, operation.air_curtain_on, operation.air_unit_heat_w, operation.radiant_heater_power_w);
    say(format_args!(
        "\ntemperatures in °C: cabin {:.2}, interior {:.2}, shell inside {:.2}, shell outside {:.2}, radiant heaters {:.2}, \
         mean radiant {:.2}",
        celsius(t.cabin_k),
        celsius(t.interior_k),
        celsius(t.shell_inside_k),
        celsius(t.shell_outside_k),
        celsius(t.radiant_heater_k),
        celsius(operation.mean_radiant_temperature_k)
    ))?;
    say(format_args!("heat flows in W:"))?;
    for (name, watt) in flows.named_w() {
        say(format_args!("  {name:<36} {watt:>10.1}"))?;
    }
    let residual = flows.net_w().into_iter().map(f64::abs).fold(0.0, f64::max);
    say(format_args!("largest residual of the five balances: {residual:.1e} W"))
}

/// The same as a diagram.
fn figure(
    study: &Study,
    views: &PassengerViews,
    sample: &store::SampleRow,
    operation: &Operation,
    title: String,
    path: &Path,
) -> Result<(), Failure> {
    let o = operation;
    let cabin = Cabin::new(&study.vehicle, views, &disturbances(sample));
    let content = HeatFlowFigure {
        title: format!("Heat flows, {title}"),
        description: format!(
            "Sample {} ({}): {:.0} W HVAC power, {:.1} passengers, {:.1} % of the doors open, PMV {:.2}",
            sample.sample_id,
            sample.start_utc,
            o.hvac_power_w(),
            sample.passengers,
            100.0 * sample.door_open_fraction,
            o.pmv
        ),
        ambient_k: sample.ambient_temperature_k,
        temperatures: o.temperatures,
        flows: cabin.flows(&o.temperatures, o.air_curtain_on, o.air_unit_heat_w, o.radiant_heater_power_w),
        air_unit_power_w: o.air_unit_power_w,
    };
    let svg = heat_flow_svg(&content).map_err(|e| Failure::Inputs(e.into()))?;
    write_beside(path, svg.as_bytes()).map_err(Failure::Inputs)?;
    say(format_args!("\nfigure: {}", path.display()))
}
