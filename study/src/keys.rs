//! Keys: what a stored thing was made from, as BLAKE3 hashes that do not depend on place, time or layout of a file.

use cabin::{ComfortWindow, Vehicle};
use solve::Method;
use store::DesignRow;

use crate::Study;
use crate::file::StudyFile;

/// Version of the readers: it changes whenever a file would be read differently.
pub const READER_VERSION: u32 = 2;

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
pub(crate) fn design_key(row: &DesignRow, vehicle: &Vehicle, method: Method, windows: &[ComfortWindow]) -> String {
    let devices = row.devices;
    let rest = format!("{} {} {} {}", devices.radiant_heaters, devices.air_curtain, method.name(), method.version());
    let vehicle = canonical(vehicle);
    let mut parts = vec![row.heating.name(), &row.heating_cop, &row.cooling_cop, &rest, &vehicle];
    let neighbours: Vec<String> = windows.iter().map(|w| format!("{} {}", w.pmv_min(), w.pmv_max())).collect();
    if method != Method::Fast {
        parts.extend(neighbours.iter().map(String::as_str));
    }
    hash(&parts)
}

/// Key of the reading of a mission: its content, and how segments are made of it.
#[must_use]
pub fn mission_key(study: &Study, blake3: &str) -> String {
    let options = &study.missions;
    let settings = format!("{} {} {}", options.segment_s, options.door_open_share, options.keep_partial);
    hash(&[blake3, &settings, &READER_VERSION.to_string()])
}

/// Key of the reading of a weather or shadow file: its content, and what samples are made with besides.
#[must_use]
pub fn surroundings_key(study: &Study, blake3: &str) -> String {
    let w = &study.weather;
    let settings =
        format!("{:?} {} {:?} {:?} {:?} {}", w.format, w.max_gap_s, w.split, w.station, study.site, study.zone);
    hash(&[blake3, &settings, &READER_VERSION.to_string()])
}

/// Key of a file that was never read: known again by its reason.
#[must_use]
pub fn refusal_key(path: &str, reason: &str) -> String {
    hash(&["refused", path, reason])
}
