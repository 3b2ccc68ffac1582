//! Setpoints as files: a TOML and a CSV for each design and window.

use cabin::OperatingMode;
use serde::Serialize;
use setpoints::{CurtainThreshold, HeaterThreshold, Profile, Shape, published};
use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::path::Path;
use store::SetpointRow;
use study::Study;

use crate::record::input_hash;
use crate::{PROGRAM_VERSION, PipelineError, open, write_whole};

/// A file of setpoints, as it stands in TOML.
#[derive(Serialize)]
struct Setup<'s> {
    design: &'s str,
    pmv_min: f64,
    pmv_max: f64,
    program_version: &'s str,
    study_hash: &'s str,
    input_hash: &'s str,
    asked_coverage: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    heating: Option<Curve>,
    #[serde(skip_serializing_if = "Option::is_none")]
    cooling: Option<Curve>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    air_curtain: Vec<Curtain>,
    #[serde(skip_serializing_if = "Option::is_none")]
    radiant_heaters: Option<Heaters>,
}

#[derive(Serialize)]
struct Curve {
    kind: &'static str,
    valid_from_ambient_c: f64,
    valid_to_ambient_c: f64,
    coverage: f64,
    hours: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    coefficients_c: Option<[f64; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    ambient_and_cabin_c: Option<Vec<(f64, f64)>>,
}

#[derive(Serialize)]
struct Curtain {
    mode: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    on_above_difference_k: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    misclassified: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    analytic_difference_k: Option<f64>,
}

#[derive(Serialize)]
struct Heaters {
    on_below_ambient_c: f64,
    misclassified: f64,
    temperature_c: f64,
}

/// Writes setpoints that the database holds to a folder, a TOML and a CSV for each design and window, and what others have
/// published beside them; files of the same names are replaced.
///
/// # Errors
/// [`PipelineError::Request`] where two designs would have the same files; [`PipelineError::Write`], [`PipelineError::Store`].
pub fn write_setpoints(study: &Study, all: &[SetpointRow], folder: &Path) -> Result<(), PipelineError> {
    let mut store = open::for_reading(study)?;
    let inputs = input_hash(&mut store)?;
    store.close()?;
    let failed = |source| PipelineError::Write { path: folder.to_owned(), source };
    std::fs::create_dir_all(folder).map_err(failed)?;
    let mut names = BTreeSet::new();
    for SetpointRow { design, window, setpoints } in all {
        let name = format!("{}_pmv_{}_{}", file_name(design), window.pmv_min(), window.pmv_max());
        if !names.insert(name.clone()) {
            let twice = format!("two designs would both write {name}.toml; name them apart by letters or digits");
            return Err(PipelineError::Request(twice));
        }
        let setup = Setup {
            design,
            pmv_min: window.pmv_min(),
            pmv_max: window.pmv_max(),
            program_version: PROGRAM_VERSION,
            study_hash: &study.hash,
            input_hash: &inputs,
            asked_coverage: study.control.coverage,
            heating: setpoints.heating.as_ref().ok().map(curve),
            cooling: setpoints.cooling.as_ref().ok().map(curve),
            air_curtain: setpoints.curtains.iter().map(curtain).collect(),
            radiant_heaters: setpoints.heaters.map(heaters),
        };
        let text = toml::to_string(&setup).map_err(|e| failed(std::io::Error::other(e)))?;
        write_whole(&folder.join(format!("{name}.toml")), format!("{HEAD}{text}").as_bytes())?;
        write_whole(&folder.join(format!("{name}.csv")), table(setpoints).as_bytes())?;
    }
    write_whole(&folder.join(PUBLISHED), published_table().as_bytes())
}

/// The file of what others have published.
const PUBLISHED: &str = "published.csv";

/// Published setpoints from −25 to 40 °C; that of cooling is empty below where its source begins.
fn published_table() -> String {
    let mut text = "profile,ambient_temperature_c,heating_setpoint_c,cooling_setpoint_c,source\n".to_owned();
    for of in published() {
        for ambient_c in (-25..=40).map(f64::from) {
            let cools = of.is_single() || ambient_c >= of.cooling.valid_c[0];
            let cooling = if cools { format!("{:.2}", of.cooling.at(ambient_c)) } else { String::new() };
            let heating_c = of.heating.at(ambient_c);
            let _ = writeln!(text, "{},{ambient_c},{heating_c:.2},{cooling},\"{}\"", of.name, of.source);
        }
    }
    text
}

const HEAD: &str = "\
# Setpoints of the cabin over the ambient temperature, in degrees Celsius, from the optima of a study. Outside the range of\n\
# validity a setpoint stays as it is at its end. quadratic: coefficients_c = [c0, c1, c2], setpoint = c0 + c1 t + c2 t^2;\n\
# piecewise-linear: pairs of ambient and cabin temperature. coverage is the share of the year's hours in the mode whose\n\
# optimum lies on the safe side. Air curtains run above a difference: of cabin over ambient temperature\n\
# while heating, of ambient over cabin temperature while cooling.\n\n";

fn curve(profile: &Profile) -> Curve {
    let (coefficients_c, ambient_and_cabin_c) = match &profile.curve.shape {
        Shape::Quadratic(coefficients) => (Some(*coefficients), None),
        Shape::PiecewiseLinear(pairs) => (None, Some(pairs.clone())),
    };
    Curve {
        kind: profile.curve.shape.kind(),
        valid_from_ambient_c: profile.curve.valid_c[0],
        valid_to_ambient_c: profile.curve.valid_c[1],
        coverage: profile.coverage,
        hours: profile.points,
        coefficients_c,
        ambient_and_cabin_c,
    }
}

fn curtain(of: &CurtainThreshold) -> Curtain {
    Curtain {
        mode: if of.mode == OperatingMode::Cooling { "cooling" } else { "heating" },
        on_above_difference_k: of.of_optima.map(|t| t.value),
        misclassified: of.of_optima.map(|t| t.misclassified),
        analytic_difference_k: of.analytic_k,
    }
}

fn heaters(threshold: HeaterThreshold) -> Heaters {
    let HeaterThreshold { below_c, misclassified, temperature_c } = threshold;
    Heaters { on_below_ambient_c: below_c, misclassified, temperature_c }
}

/// The setpoints of every full degree within the validity of either profile; empty where a mode has none.
fn table(of: &setpoints::Setpoints) -> String {
    let profiles = [&of.heating, &of.cooling].map(|p| p.as_ref().ok());
    let ends = || profiles.iter().flatten().flat_map(|p| p.curve.valid_c);
    let (from, to) = (ends().fold(f64::INFINITY, f64::min).floor(), ends().fold(f64::NEG_INFINITY, f64::max).ceil());
    let mut text = "ambient_temperature_c,heating_setpoint_c,cooling_setpoint_c\n".to_owned();
    let mut ambient_c = from;
    while ambient_c <= to {
        let cell = |p: Option<&Profile>| p.map_or_else(String::new, |p| format!("{:.2}", p.curve.at(ambient_c)));
        let _ = writeln!(text, "{ambient_c},{},{}", cell(profiles[0]), cell(profiles[1]));
        ambient_c += 1.0;
    }
    text
}

/// A name that every system takes as one of a file.
fn file_name(design: &str) -> String {
    design.chars().map(|c| if c.is_alphanumeric() || "+-".contains(c) { c } else { '_' }).collect()
}
