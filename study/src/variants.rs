//! What else than the study itself is asked for: buses that differ, and inputs that vary.

use cabin::{ComfortWindow, Vehicle};
use sensitivity::{Input, MOST_INPUTS, MOST_POINTS, Passengers, Spread, Variation};
use solve::Grid;

use crate::file::{self, Override};

/// A bus that stands beside the one of the study.
#[derive(Debug, Clone, PartialEq)]
pub struct Variant {
    /// Name.
    pub name: String,
    /// The bus, and what acts on it.
    pub variation: Variation,
    /// What the study file overrides, by name.
    pub overrides: Vec<(String, f64)>,
    /// Places of the designs that it is for.
    pub designs: Vec<usize>,
}

/// Which inputs vary, and how the year is looked at.
#[derive(Debug, Clone, PartialEq)]
pub struct SensitivityStudy {
    /// The window of the study, or one of its own.
    pub window: ComfortWindow,
    /// Base points of the design.
    pub points: u32,
    /// Seed of the points and of the intervals.
    pub seed: u32,
    /// The inputs.
    pub inputs: Vec<Input>,
}

/// Inputs that vary where a study names none: what a bus is bought with and what it meets, each within a fifth of its value.
const USUAL: [&str; 14] = [
    "heating_cop_scale",
    "cooling_cop_scale",
    "conduction_shell_w_m2_k",
    "convection_inside_w_m2_k",
    "convection_outside_w_m2_k",
    "window_transmissivity",
    "shell_absorptivity",
    "air_curtain_loss_reduction",
    "door_width_m",
    "door_open_scale",
    "passengers_scale",
    "shade_scale",
    "other_heat_w",
    "relative_humidity",
];

/// How far they vary.
pub const USUAL_SHARE: f64 = 0.2;

/// Variants are a table each in database and report.
const MOST_VARIANTS: usize = 100;

pub(crate) fn variants(typed: &file::StudyFile, grid: &Grid) -> Result<Vec<Variant>, String> {
    if typed.variants.len() > MOST_VARIANTS {
        return Err(format!("[variants] has {} tables; {MOST_VARIANTS} are the most", typed.variants.len()));
    }
    let passengers = Passengers::new(&typed.vehicle);
    let variant = |(name, typed_variant): &(String, _)| {
        variant(name, typed_variant, &typed.vehicle, grid, &passengers).map_err(|e| format!("[variants.{name:?}] {e}"))
    };
    typed.variants.iter().map(variant).collect()
}

fn variant(
    name: &str,
    typed: &std::collections::BTreeMap<String, Override>,
    vehicle: &Vehicle,
    grid: &Grid,
    passengers: &Passengers,
) -> Result<Variant, String> {
    if name.is_empty() {
        return Err("give it a name".to_owned());
    }
    let (mut overrides, mut designs) = (Vec::new(), (0..grid.designs().len()).collect());
    for (key, value) in typed {
        match (key.as_str(), value) {
            ("designs", Override::Designs(names)) => designs = places(grid, names)?,
            ("designs", Override::Value(_)) => return Err("designs is a list of names".to_owned()),
            (_, Override::Value(value)) => overrides.push((key.clone(), *value)),
            (_, Override::Designs(_)) => return Err(format!("{key} is a number")),
        }
    }
    let named = overrides.iter().map(|(name, value)| (name.as_str(), *value));
    let variation = Variation::none(vehicle).with(named).map_err(|e| e.to_string())?;
    variation.bus(grid.designs(), passengers).map_err(|e| e.to_string())?;
    Ok(Variant { name: name.to_owned(), variation, overrides, designs })
}

fn places(grid: &Grid, names: &[String]) -> Result<Vec<usize>, String> {
    let known = || grid.designs().iter().map(|d| d.name.as_str()).collect::<Vec<_>>().join(", ");
    let place = |name: &String| {
        let found = grid.designs().iter().position(|design| design.name == *name);
        found.ok_or_else(|| format!("designs: {name:?} is not one of the study's: {}", known()))
    };
    let mut places: Vec<usize> = names.iter().map(place).collect::<Result<_, _>>()?;
    places.sort_unstable();
    places.dedup();
    if places.is_empty() { Err("designs is empty; leave it out for all".to_owned()) } else { Ok(places) }
}

pub(crate) fn sensitivity(typed: &file::StudyFile, grid: &Grid) -> Result<SensitivityStudy, String> {
    let of = &typed.sensitivity;
    let wrong = |e: String| format!("[sensitivity] {e}");
    let windows = grid.windows();
    let window = match of.pmv_limit {
        Some(limit) => ComfortWindow::symmetric(limit).map_err(|e| wrong(e.to_string()))?,
        None => ComfortWindow::shown(windows).expect("a grid has a window"),
    };
    let base = Variation::none(&typed.vehicle);
    let inputs: Vec<Input> = if of.inputs.is_empty() {
        let usual = |name: &&str| Some(Input::around(name, base.get(name).filter(|v| *v != 0.0)?, USUAL_SHARE));
        USUAL.iter().filter_map(usual).collect()
    } else {
        let input = |(name, spread): &(String, file::Spread)| {
            let spread = spread_of(spread)?;
            let input = Input { name: name.clone(), spread };
            input.check().map_err(|e| e.to_string())?;
            // Both ends are values that the input can have.
            for value in input.spread.ends() {
                base.with([(name.as_str(), value)]).map_err(|e| e.to_string())?;
            }
            Ok(input)
        };
        of.inputs.iter().map(input).collect::<Result<_, String>>().map_err(|e| format!("[sensitivity.inputs] {e}"))?
    };
    if inputs.len() > MOST_INPUTS {
        return Err(format!("[sensitivity.inputs] has {} inputs; {MOST_INPUTS} are the most", inputs.len()));
    }
    if !(2..=MOST_POINTS).contains(&of.points) {
        return Err(wrong(format!("points = {} must lie between 2 and {MOST_POINTS}", of.points)));
    }
    Ok(SensitivityStudy { window, points: of.points, seed: of.seed, inputs })
}

fn spread_of(typed: &file::Spread) -> Result<Spread, String> {
    match typed {
        file::Spread::Ends(file::Pair(low, high)) => Ok(Spread::Uniform { low: *low, high: *high }),
        file::Spread::Named(named) => match (named.mean, named.sd, named.low, named.mode, named.high) {
            (Some(mean), Some(sd), None, None, None) => Ok(Spread::Normal { mean, sd }),
            (None, None, Some(low), Some(mode), Some(high)) => Ok(Spread::Triangular { low, mode, high }),
            _ => Err("a spread is [low, high], { mean, sd } or { low, mode, high }".to_owned()),
        },
    }
}
