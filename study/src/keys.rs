//! Keys: what a stored thing was made from, as BLAKE3 hashes that do not depend on place, time or layout of a file.

use cabin::{ComfortWindow, Design, Vehicle};
use ingest::mission::RouteChoice;
use simulate::SIMULATION_VERSION;
use solve::Method;
use std::collections::BTreeMap;
use store::DesignRow;

use crate::Study;
use crate::file::StudyFile;

/// Version of the readers: it changes whenever a file would be read differently.
pub const READER_VERSION: u32 = 5;

/// BLAKE3 over parts, each with its length, so that no two lists of parts give the same bytes.
#[must_use]
pub fn hash(parts: &[&str]) -> String {
    let mut hasher = blake3::Hasher::new();
    for part in parts {
        hasher.update(&(part.len() as u64).to_le_bytes());
        hasher.update(part.as_bytes());
    }
    hasher.finalize().to_hex().to_string()
}

/// A canonical form: fields in the order of the struct, numbers in their shortest form.
pub(crate) fn canonical(value: &impl serde::Serialize) -> String {
    serde_json::to_string(value).expect("plain structs with string keys become JSON")
}

/// Key of a study with all defaults, without the places of its results.
pub(crate) fn study_hash(file: &StudyFile) -> String {
    hash(&[&canonical(file)])
}

/// Key of the optima of a design, besides sample and window: equipment, constants of the bus, method. A window of the
/// nonlinear programs starts from the one before it, so that all of them belong to the key there.
pub(crate) fn design_key(
    row: &DesignRow,
    design: &Design,
    vehicle: &Vehicle,
    method: Method,
    windows: &[ComfortWindow],
) -> String {
    let devices = row.devices;
    let rest = format!("{} {} {} {}", devices.radiant_heaters, devices.air_curtain, method.name(), method.version());
    let vehicle = canonical(vehicle);
    let mut parts = vec![row.heating.name(), &row.heating_cop, &row.cooling_cop, &rest, &vehicle];
    // One without limits is what it was before there were any.
    let limits = format!("{:?} {:?} {}", design.heating_limit, design.cooling_limit, design.backup_heater_w);
    if design.is_limited() {
        parts.push(&limits);
    }
    let neighbours: Vec<String> = windows.iter().map(|w| format!("{} {}", w.pmv_min(), w.pmv_max())).collect();
    if method != Method::Fast {
        parts.extend(neighbours.iter().map(String::as_str));
    }
    hash(&parts)
}

/// Key of the reading of a mission: its content, and how segments are made of it.
#[must_use]
pub fn mission_key(study: &Study, blake3: &str) -> String {
    hash(&[blake3, &values(&mission_settings(study)), &READER_VERSION.to_string()])
}

/// Key of the reading of a weather or shadow file: its content, and what samples are made with besides.
#[must_use]
pub fn surroundings_key(study: &Study, blake3: &str) -> String {
    hash(&[blake3, &values(&surroundings_settings(study)), &READER_VERSION.to_string()])
}

/// A part of a key: its name as in the study file, and its value.
type Setting = (&'static str, String);

fn mission_settings(study: &Study) -> Vec<Setting> {
    let options = &study.missions;
    let mut settings = vec![
        ("missions.format", format!("{:?}", study.mission_format)),
        ("missions.segment_s", options.segment_s.to_string()),
        ("missions.door_open_share", options.door_open_share.to_string()),
        ("missions.keep_partial", options.keep_partial.to_string()),
    ];
    match &options.routes {
        RouteChoice::All => {}
        RouteChoice::Only(routes) => settings.push(("missions.routes", format!("{routes:?}"))),
        RouteChoice::Without(routes) => settings.push(("missions.without_routes", format!("{routes:?}"))),
    }
    settings
}

fn surroundings_settings(study: &Study) -> [Setting; 6] {
    let w = &study.weather;
    [
        ("weather.format", format!("{:?}", w.format)),
        ("weather.max_gap_s", w.max_gap_s.to_string()),
        ("weather.split", format!("{:?}", w.split)),
        ("weather.station", format!("{:?}", w.station)),
        ("location", format!("{:?}", study.site)),
        ("location.time_zone", study.zone.to_string()),
    ]
}

fn values(settings: &[Setting]) -> String {
    settings.iter().map(|(_, value)| value.as_str()).collect::<Vec<_>>().join(" ")
}

/// What study file and program say that enters the keys of a stage (`ingest`, `shade`, `solve`, `simulate`, `control`), by name: two of
/// them tell what has changed. Nothing for another stage.
#[must_use]
pub fn settings(study: &Study, stage: &str) -> BTreeMap<String, String> {
    let named = |settings: &[Setting]| settings.iter().map(|(n, v)| ((*n).to_owned(), v.clone())).collect();
    let windows = |places: &mut dyn Iterator<Item = usize>| {
        let windows = places.map(|i| study.grid.windows()[i]);
        windows.map(|w| format!("{} … {}", w.pmv_min(), w.pmv_max())).collect::<Vec<_>>().join(", ")
    };
    let mut settings: BTreeMap<String, String> = match stage {
        "ingest" => named(&mission_settings(study)),
        "shade" => named(&surroundings_settings(study)),
        "solve" => {
            let mut settings = flattened("vehicle", &study.vehicle);
            for (row, design) in study.design_rows.iter().zip(study.grid.designs()) {
                let mut of_design =
                    |key: &str, value: String| settings.insert(format!("designs.{:?}.{key}", row.name), value);
                if design.is_limited() {
                    let limits = [&design.heating_limit, &design.cooling_limit].map(|limit| format!("{limit:?}"));
                    of_design("limits", format!("{}, back-up heater {} W", limits.join(", "), design.backup_heater_w));
                }
                of_design("heating", row.heating.name().to_owned());
                of_design("heating_cop", row.heating_cop.clone());
                of_design("cooling_cop", row.cooling_cop.clone());
                of_design("radiant_heaters", row.devices.radiant_heaters.to_string());
                of_design("air_curtain", row.devices.air_curtain.to_string());
            }
            settings.insert("comfort".to_owned(), windows(&mut (0..study.grid.windows().len())));
            settings.insert("method".to_owned(), study.method.name().to_owned());
            if let Some(economics) = &study.economics {
                settings.insert("economics".to_owned(), format!("{economics:?}"));
            }
            for variant in &study.variants {
                let of_variant = |key: &str| format!("variants.{:?}.{key}", variant.name);
                let designs: Vec<&str> = variant.designs.iter().map(|d| study.design_rows[*d].name.as_str()).collect();
                settings.insert(of_variant("designs"), designs.join(", "));
                settings.extend(variant.overrides.iter().map(|(key, value)| (of_variant(key), value.to_string())));
            }
            settings
        }
        "simulate" => {
            let mut settings = flattened("dynamics", &study.dynamics);
            settings.insert("simulation".to_owned(), windows(&mut study.simulated_windows.iter().copied()));
            settings
        }
        "control" => {
            let control = &study.control;
            let designs: Vec<&str> = control.designs.iter().map(|d| study.design_rows[*d].name.as_str()).collect();
            let profiles: Vec<String> = control.profiles.iter().map(|(name, path)| format!("{name}: {path}")).collect();
            let mut settings = flattened("dynamics", &study.dynamics);
            settings.insert("control.pmv_limits".to_owned(), windows(&mut control.windows.iter().copied()));
            settings.insert("control.designs".to_owned(), designs.join(", "));
            settings.insert("control.coverage".to_owned(), control.coverage.to_string());
            settings.insert("control.profiles".to_owned(), profiles.join(", "));
            settings
        }
        _ => return BTreeMap::new(),
    };
    let version = match stage {
        "ingest" | "shade" => READER_VERSION.to_string(),
        "solve" => study.method.version(),
        _ => SIMULATION_VERSION.to_string(),
    };
    settings.insert("the program's version of it".to_owned(), version);
    settings
}

/// The fields of a plain struct by name.
fn flattened(section: &str, value: &impl serde::Serialize) -> BTreeMap<String, String> {
    let fields = match serde_json::to_value(value) {
        Ok(serde_json::Value::Object(fields)) => fields,
        _ => serde_json::Map::new(),
    };
    fields.into_iter().map(|(name, value)| (format!("{section}.{name}"), value.to_string())).collect()
}

/// Key of a file that was never read: known again by its reason.
#[must_use]
pub fn refusal_key(path: &str, reason: &str) -> String {
    hash(&["refused", path, reason])
}
