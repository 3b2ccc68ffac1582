//! Everything that a study file says or leaves to its defaults, one value each: with unit, default and source.

use serde_json::Value;
use std::path::PathBuf;

use crate::Study;
use crate::file::StudyFile;

/// A value of a study.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Setting {
    /// Name as in the study file: section, a dot, key.
    pub name: String,
    /// Its value.
    pub value: String,
    /// Its unit; empty for what has none.
    pub unit: &'static str,
    /// What it is where the study file does not say it; `None` where a study file has to.
    pub default_value: Option<String>,
    /// Where the value comes from.
    pub source: &'static str,
    /// Whether it is not the default.
    pub differs: bool,
    /// The first stage that uses it.
    pub stage: &'static str,
}

/// Keys that a study file has to have.
const REQUIRED: [&str; 7] = [
    "name",
    "location.latitude_deg",
    "location.longitude_deg",
    "missions.path",
    "weather.format",
    "weather.path",
    "shadow.path",
];
const MINIMAL: &str = "schema_version = 1\nname = \"\"\n[location]\nlatitude_deg = 0.0\nlongitude_deg = 0.0\n\
    [missions]\npath = \"\"\n[weather]\nformat = \"meteoswiss-ogd\"\npath = \"\"\n[shadow]\npath = \"\"\n";
/// Constants that the paper does not print.
const SUBSTITUTES: [&str; 13] = [
    "vehicle.other_heat_w",
    "vehicle.clothing_floor_clo",
    "vehicle.passenger_placements",
    "vehicle.passenger_seed",
    "vehicle.panel_rows",
    "vehicle.panel_columns",
    "vehicle.panel_length_m",
    "vehicle.panel_width_m",
    "dynamics.ptc_limit_w",
    "dynamics.cooling_limit_w",
    "dynamics.heater_gain_w_k",
    "dynamics.heater_integral_s",
    "dynamics.heater_limit_w",
];
/// Units by the ends of names, the longer ones first.
const UNITS: [(&str, &str); 20] = [
    ("_w_m2_k4", "W/(m² K⁴)"),
    ("_w_m2_k", "W/(m² K)"),
    ("_j_kg_k", "J/(kg K)"),
    ("_kg_m3", "kg/m³"),
    ("_j_k", "J/K"),
    ("_w_k", "W/K"),
    ("_m_s2", "m/s²"),
    ("_m_s", "m/s"),
    ("_m2", "m²"),
    ("_deg", "°"),
    ("_met", "met"),
    ("_clo", "clo"),
    ("_m", "m"),
    ("_w", "W"),
    ("_k", "K"),
    ("_s", "s"),
    ("_share", "1"),
    ("_fraction", "1"),
    ("pmv_limits", "PMV"),
    ("comfort.windows", "PMV"),
];

/// All settings of a study, by section and key; designs in the order of the study file.
///
/// # Panics
/// Never: the study file without anything that can be left out is one.
#[must_use]
pub fn settings(study: &Study) -> Vec<Setting> {
    let bare = StudyFile::parse(MINIMAL, "").expect("the smallest study file is one");
    let default = Study::new(&bare, PathBuf::new(), None).expect("the smallest study file is a study");
    let defaults = values(&default);
    let setting = |(name, value): (String, String)| {
        let known = defaults.iter().find(|(other, _)| *other == name).map(|(_, value)| value.clone());
        let default_value = known.filter(|_| !REQUIRED.contains(&name.as_str()));
        let required = REQUIRED.contains(&name.as_str());
        let differs = !required && default_value.as_ref() != Some(&value);
        let stage = stage(&name);
        let unit = UNITS.iter().find(|(end, _)| name.ends_with(end)).map_or("", |(_, unit)| unit);
        Setting { source: source(&name, differs || required), name, value, unit, default_value, differs, stage }
    };
    values(study).into_iter().map(setting).collect()
}

fn source(name: &str, typed: bool) -> &'static str {
    if typed {
        "the study file"
    } else if SUBSTITUTES.contains(&name) {
        "a substitute: the paper does not print it"
    } else if name.starts_with("vehicle.") || name.starts_with("dynamics.") {
        "paper, section Model Constants"
    } else if name.ends_with("_cop") {
        "a substitute: the paper prints no curve; docs/model.md"
    } else {
        "the program's default"
    }
}

/// The first stage that uses a setting.
fn stage(name: &str) -> &'static str {
    match name.split('.').next().unwrap_or_default() {
        "location" | "weather" | "shadow" => "shade",
        "comfort" | "vehicle" | "designs" | "variants" | "economics" => "solve",
        "simulation" | "dynamics" => "simulate",
        "control" => "control",
        "sensitivity" => "sensitivity",
        _ => "ingest",
    }
}

/// Names and values by section and key, with what names stand for.
fn values(study: &Study) -> Vec<(String, String)> {
    let mut values = Vec::new();
    let Value::Object(sections) = &study.typed else { return values };
    for (section, value) in sections {
        match section.as_str() {
            "schema_version" | "note" => {}
            "comfort" => {
                let windows = study.grid.windows().iter().map(|w| format!("{} … {}", w.pmv_min(), w.pmv_max()));
                values.push(("comfort.windows".to_owned(), windows.collect::<Vec<_>>().join(", ")));
            }
            "designs" => {
                for row in &study.design_rows {
                    let mut of =
                        |key: &str, value: String| values.push((format!("designs.{:?}.{key}", row.name), value));
                    of("heating", row.heating.name().to_owned());
                    of("heating_cop", row.heating_cop.clone());
                    of("cooling_cop", row.cooling_cop.clone());
                    of("radiant_heaters", row.devices.radiant_heaters.to_string());
                    of("air_curtain", row.devices.air_curtain.to_string());
                    let mut pairs = value.as_array().into_iter().flatten();
                    let typed = pairs.find(|pair| pair[0] == row.name.as_str()).map(|pair| &pair[1]);
                    for key in ["heating_limit_w", "cooling_limit_w", "limits_are", "backup_heater_w"] {
                        match typed.map_or(&Value::Null, |typed| &typed[key]) {
                            Value::Null => {}
                            Value::String(text) => of(key, text.clone()),
                            other => of(key, other.to_string()),
                        }
                    }
                }
            }
            _ => flatten(section.clone(), value, &mut values),
        }
    }
    values
}

/// The leaves of a value by their path; lists stay whole, what is not there is left out.
fn flatten(name: String, value: &Value, into: &mut Vec<(String, String)>) {
    match value {
        Value::Null => {}
        Value::Object(fields) => {
            for (field, value) in fields {
                flatten(format!("{name}.{field}"), value, into);
            }
        }
        Value::String(text) => into.push((name, text.clone())),
        other => into.push((name, other.to_string())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn study(more: &str) -> Study {
        Study::parse(&format!("{MINIMAL}{more}"), Path::new("study.toml")).unwrap()
    }

    fn differing(study: &Study) -> Vec<(String, String, Option<String>)> {
        let all = settings(study).into_iter().filter(|s| s.differs);
        all.map(|s| (s.name, s.value, s.default_value)).collect()
    }

    #[test]
    fn prop_only_what_was_typed_otherwise_differs() {
        assert_eq!(differing(&study("")), []);
        let typed = study("[vehicle]\nmetabolic_rate_met = 1.4\n[comfort]\npmv_limits = [0.5]\n");
        let differing = differing(&typed);
        assert_eq!(differing.len(), 2);
        assert!(differing.contains(&("vehicle.metabolic_rate_met".into(), "1.4".into(), Some("1.2".into()))));
        assert!(differing.iter().any(|(name, value, _)| name == "comfort.windows" && value == "-0.5 … 0.5"));
    }

    #[test]
    fn prop_every_constant_has_a_source_and_those_that_stand_in_are_constants() {
        let all = settings(&study(""));
        for name in SUBSTITUTES.iter().chain(&REQUIRED) {
            assert!(all.iter().any(|s| s.name == *name), "{name} is no setting");
        }
        // Names without a unit are counts, shares of a name of their own and factors.
        let bare: Vec<&str> = all
            .iter()
            .filter(|s| s.unit.is_empty() && (s.name.starts_with("vehicle.") || s.name.starts_with("dynamics.")))
            .map(|s| s.name.as_str())
            .collect();
        let known = ["view_factor", "coefficient", "loss_reduction", "absorptivity", "transmissivity", "humidity"];
        let counted = ["placements", "seed", "panel_rows", "panel_columns"];
        let is_known = |name: &&str| known.iter().chain(&counted).any(|part| name.contains(part));
        assert!(bare.iter().all(is_known), "{bare:?}");
    }
}
