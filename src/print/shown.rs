//! One optimum.

use anyhow::anyhow;
use cabin::celsius;
use pipeline::{Point, Shown, write_whole};
use std::path::Path;

use crate::console::say;
use crate::failure::{Ending, Failure};

pub fn shown(point: &Point, shown: &Shown, figure: Option<&Path>, json: bool) -> Result<Ending, Failure> {
    if json {
        draw(point, shown, figure)?;
        say(format_args!("{}", shown.json(&point.design)))?;
        return Ok(Ending::Done);
    }
    let (sample, segment, d) = (&shown.sample, &shown.sample.segment, &shown.sample.disturbances);
    say(format_args!(
        "sample {}  design {}  PMV {} … {}",
        point.sample,
        point.design,
        shown.window.pmv_min(),
        shown.window.pmv_max()
    ))?;
    say(format_args!(
        "from {} lines {}–{}: mission {}, segment {}, {} for {} s",
        segment.source_path,
        segment.first_line,
        segment.last_line,
        segment.mission,
        segment.segment,
        segment.start.format("%Y-%m-%dT%H:%M:%SZ"),
        segment.duration_s
    ))?;
    say(format_args!("weight in the year {:.4e}, month {}", shown.weight, sample.month))?;
    say(format_args!(
        "ambient {:.2} °C, DNI {:.1} W/m², DHI {:.1} W/m², solar altitude {:.2}°, shade {:.3}, passengers {:.2}, doors {:.4}",
        celsius(d.ambient_temperature_k),
        d.dni_w_m2,
        d.dhi_w_m2,
        d.solar_altitude_rad.to_degrees(),
        d.shadow_fraction,
        d.passengers,
        d.door_open_fraction
    ))?;
    let watts = |p: Option<f64>| p.map_or_else(|| "–".to_owned(), |p| format!("{p:.3}"));
    match &shown.stored {
        Some(row) => say(format_args!(
            "stored: {}, {} W, next choice {} W more",
            row.status,
            watts(row.hvac_power_w),
            watts(row.runner_up_excess_w)
        ))?,
        None => say(format_args!("stored: nothing yet; `busclimate run` computes it"))?,
    }
    candidates(shown)?;
    if shown.best.is_none() {
        say(format_args!("\nno operation of this design meets the window"))?;
        return Ok(Ending::Done);
    }
    flows(shown)?;
    if let Some(path) = draw(point, shown, figure)? {
        say(format_args!("\nfigure: {}", path.display()))?;
    }
    Ok(Ending::Done)
}

/// Writes the figure that is asked for.
fn draw<'p>(point: &Point, shown: &Shown, figure: Option<&'p Path>) -> Result<Option<&'p Path>, Failure> {
    let Some(path) = figure else { return Ok(None) };
    let svg = shown.figure(&point.design)?.ok_or_else(|| Failure::Inputs(anyhow!("there is nothing to draw")))?;
    write_whole(path, svg.as_bytes())?;
    Ok(Some(path))
}

fn candidates(shown: &Shown) -> Result<(), Failure> {
    say(format_args!("\nchoices           power W  air unit W  heaters W  curtain W   cabin °C      PMV"))?;
    for candidate in &shown.candidates {
        let name = match (candidate.devices.radiant_heaters, candidate.devices.air_curtain) {
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
    }
    Ok(())
}

/// Temperatures and heat flows of the optimum.
fn flows(shown: &Shown) -> Result<(), Failure> {
    let Some((operation, flows)) = &shown.best else { return Ok(()) };
    let t = operation.temperatures;
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
    for (_, name, watt) in flows.named_w() {
        say(format_args!("  {name:<36} {watt:>10.1}"))?;
    }
    let residual = flows.net_w().into_iter().map(f64::abs).fold(0.0, f64::max);
    say(format_args!("largest residual of the five balances: {residual:.1e} W"))
}
