//! The study file as it was typed: plain data that mirrors the TOML. Nothing is looked up here, no file is touched;
//! [`crate::Study`] is what becomes of it.

use cabin::Vehicle;
use ingest::weather::WeatherFormat;
use schemars::JsonSchema;
use serde::de::{Error as _, MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};
use simulate::Dynamics;
use std::collections::BTreeMap;
use std::fmt;
use std::marker::PhantomData;
use std::path::Path;

use crate::place;

/// The version of the study file's format that this program reads.
pub const SCHEMA_VERSION: u32 = 1;

#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StudyFile {
    pub schema_version: u32,
    pub name: String,
    pub note: Option<String>,
    // Where results lie does not change them: the study's hash leaves both out.
    #[serde(default = "default_database", skip_serializing)]
    pub database: String,
    #[serde(default = "default_report_dir", skip_serializing)]
    pub report_dir: String,
    pub location: Location,
    pub missions: Missions,
    pub weather: Weather,
    pub shadow: Shadow,
    // Where files were fetched from does not change what is in them.
    #[serde(default, skip_serializing)]
    pub fetch: Fetch,
    #[serde(default)]
    pub comfort: Comfort,
    #[serde(default)]
    #[schemars(schema_with = "crate::schema::numbers_of::<Vehicle>")]
    pub vehicle: Vehicle,
    #[serde(default)]
    pub simulation: Simulation,
    #[serde(default)]
    pub control: Control,
    #[serde(default)]
    #[schemars(schema_with = "crate::schema::numbers_of::<Dynamics>")]
    pub dynamics: Dynamics,
    #[serde(default = "default_designs", deserialize_with = "in_file_order")]
    #[schemars(schema_with = "crate::schema::tables_of::<Design>")]
    pub designs: Vec<(String, Design)>,
    #[serde(default, deserialize_with = "in_file_order", skip_serializing_if = "Vec::is_empty")]
    #[schemars(schema_with = "crate::schema::variants")]
    pub variants: Vec<(String, BTreeMap<String, Override>)>,
    #[serde(default, skip_serializing_if = "Sensitivity::is_default")]
    pub sensitivity: Sensitivity,
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Economics")]
    pub economics: Option<Economics>,
}

#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Location {
    pub latitude_deg: f64,
    pub longitude_deg: f64,
    // Of no effect on the results: the sun's position does not depend on it at this accuracy.
    pub altitude_m: Option<f64>,
    #[serde(default = "default_time_zone")]
    pub time_zone: String,
}

#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Missions {
    #[serde(default, skip_serializing_if = "Telemetry::is_ztbus")]
    pub format: Telemetry,
    pub path: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time_column: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time_zone: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub utc_offset: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub vehicle_column: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub vehicle: Option<u32>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub passengers_column: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub door_column: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub door_share_column: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed_column: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed_unit: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub power_column: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub power_unit: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub route_column: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hold_s: Option<u32>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cut_gap_s: Option<u32>,
    #[serde(default)]
    pub buses: Vec<u32>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub routes: Vec<String>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub without_routes: Vec<String>,
    #[serde(default = "default_segment_s")]
    pub segment_s: u32,
    #[serde(default = "default_door_open_share")]
    pub door_open_share: f64,
    #[serde(default)]
    pub keep_partial: bool,
    // Whether what came from a mission that is gone stays is a matter of the job, not of the study.
    #[serde(default, skip_serializing)]
    pub forget_missing: bool,
    // What is expected of the data concerns whoever watches over a job, not the results.
    #[serde(default, skip_serializing)]
    pub expect_newest_within_hours: Option<f64>,
}

/// How mission files look.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Telemetry {
    #[default]
    ZtBus,
    Csv,
}

impl Telemetry {
    // serde asks by reference.
    #[expect(clippy::trivially_copy_pass_by_ref, reason = "the signature is serde's")]
    fn is_ztbus(&self) -> bool {
        *self == Self::ZtBus
    }
}

#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Weather {
    #[serde(deserialize_with = "format_name")]
    #[schemars(schema_with = "crate::schema::weather_format")]
    pub format: String,
    pub path: String,
    pub station: Option<String>,
    #[serde(default = "default_max_gap_s")]
    pub max_gap_s: u32,
    #[serde(default)]
    pub split: Split,
    pub time_column: Option<String>,
    pub time_label: Option<TimeLabel>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time_zone: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub utc_offset: Option<String>,
    pub interval_s: Option<u32>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reference_year: Option<bool>,
    pub temperature_column: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub temperature_unit: Option<String>,
    pub ghi_column: Option<String>,
    pub dhi_column: Option<String>,
    pub dni_column: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub irradiance_unit: Option<String>,
    #[serde(default, skip_serializing)]
    pub expect_newest_within_hours: Option<f64>,
}

/// Which of the study's windows are simulated.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Simulation {
    pub pmv_limits: Vec<f64>,
}

impl Default for Simulation {
    /// The five levels of the paper's validation.
    fn default() -> Self {
        Self { pmv_limits: vec![0.0, 0.5, 1.0, 1.5, 2.0] }
    }
}

/// Which controllers drive every mission, and how they are judged.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Control {
    pub pmv_limits: Vec<f64>,
    pub designs: Option<Vec<String>>,
    pub coverage: f64,
    #[serde(deserialize_with = "in_file_order")]
    #[schemars(schema_with = "crate::schema::tables_of::<String>")]
    pub profiles: Vec<(String, String)>,
}

impl Default for Control {
    /// From nearly neutral to the widest of the paper's windows.
    fn default() -> Self {
        Self {
            pmv_limits: vec![0.25, 0.5, 0.625, 0.75, 1.0, 1.25, 1.5, 2.0],
            designs: None,
            coverage: 0.98,
            profiles: Vec::new(),
        }
    }
}

#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Split {
    #[default]
    Erbs,
}

#[derive(Debug, Clone, Copy, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum TimeLabel {
    Start,
    Middle,
    End,
}

#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Shadow {
    pub path: String,
}

/// Addresses that `busclimate fetch` downloads.
#[derive(Debug, Clone, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Fetch {
    pub missions: Option<String>,
    pub missions_bytes: Option<u64>,
    pub missions_checksum: Option<String>,
    pub weather: Option<Vec<String>>,
}

#[derive(Debug, Clone, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Comfort {
    pub pmv_limits: Option<Limits>,
    pub windows: Option<Vec<Pair>>,
}

/// Two numbers in brackets, and no more than two.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
#[schemars(with = "[f64; 2]")]
pub struct Pair(pub f64, pub f64);

/// `{ from = 0.0, to = 2.0, step = 0.125 }` or `[0.25, 1.0]`.
#[derive(Debug, Clone, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum Limits {
    Steps(Steps),
    List(Vec<f64>),
}

#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Steps {
    pub from: f64,
    pub to: f64,
    pub step: f64,
}

#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Design {
    pub heating: Heating,
    #[serde(default)]
    pub radiant_heaters: bool,
    #[serde(default)]
    pub air_curtain: bool,
    pub heating_cop: Option<Cop>,
    pub cooling_cop: Option<Cop>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub heating_limit_w: Option<Limit>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cooling_limit_w: Option<Limit>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub limits_are: Option<LimitOf>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub backup_heater_w: Option<f64>,
}

/// What the limits of a design are limits of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum LimitOf {
    Electric,
    Thermal,
}

/// A number in W, or a table of `[ambient temperature in °C, W]`.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum Limit {
    Constant(f64),
    Table(Vec<Pair>),
}

/// What a variant says: the value of an input, or under `designs` the names of those that it is for.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Override {
    Value(f64),
    Designs(Vec<String>),
}

/// Which inputs vary, and how the year is looked at.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Sensitivity {
    pub pmv_limit: Option<f64>,
    pub points: u32,
    pub seed: u32,
    #[serde(deserialize_with = "in_file_order")]
    #[schemars(schema_with = "crate::schema::inputs_of::<Spread>")]
    pub inputs: Vec<(String, Spread)>,
}

impl Default for Sensitivity {
    fn default() -> Self {
        Self { pmv_limit: None, points: 256, seed: 1, inputs: Vec::new() }
    }
}

impl Sensitivity {
    fn is_default(&self) -> bool {
        *self == Self::default()
    }
}

/// What electricity and designs cost.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Economics {
    pub currency: String,
    pub price_per_kwh: f64,
    pub carbon_kg_per_kwh: Option<f64>,
    pub interest: f64,
    pub life_years: f64,
    #[serde(deserialize_with = "in_file_order")]
    #[schemars(schema_with = "crate::schema::tables_of::<DesignCost>")]
    pub designs: Vec<(String, DesignCost)>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DesignCost {
    pub investment: f64,
    #[serde(default)]
    pub maintenance_per_year: f64,
    pub life_years: Option<f64>,
}

/// `[low, high]`, `{ mean = 1.0, sd = 0.1 }` or `{ low = 0.8, mode = 1.0, high = 1.1 }`.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum Spread {
    Ends(Pair),
    Named(NamedSpread),
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct NamedSpread {
    pub mean: Option<f64>,
    pub sd: Option<f64>,
    pub low: Option<f64>,
    pub mode: Option<f64>,
    pub high: Option<f64>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Heating {
    Ptc,
    Hp,
}

/// The name of a curve, or a table of `[lift in K, COP]`.
#[derive(Debug, Clone, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum Cop {
    Name(String),
    Table(Vec<Pair>),
}

fn default_database() -> String {
    "study.db".to_owned()
}

fn default_report_dir() -> String {
    "report".to_owned()
}

fn default_time_zone() -> String {
    "Europe/Zurich".to_owned()
}

fn default_segment_s() -> u32 {
    3600
}

fn default_door_open_share() -> f64 {
    0.6
}

fn default_max_gap_s() -> u32 {
    10_800
}

fn default_designs() -> Vec<(String, Design)> {
    let design = |heating, radiant_heaters, air_curtain| Design {
        heating,
        radiant_heaters,
        air_curtain,
        heating_cop: None,
        cooling_cop: None,
        heating_limit_w: None,
        cooling_limit_w: None,
        limits_are: None,
        backup_heater_w: None,
    };
    [
        ("ptc", design(Heating::Ptc, false, false)),
        ("ptc+rh", design(Heating::Ptc, true, false)),
        ("hp", design(Heating::Hp, false, false)),
        ("hp+rh", design(Heating::Hp, true, false)),
        ("hp+curtain", design(Heating::Hp, false, true)),
    ]
    .map(|(name, design)| (name.to_owned(), design))
    .into()
}

/// The name of a weather format.
fn format_name<'de, D: Deserializer<'de>>(source: D) -> Result<String, D::Error> {
    let name = String::deserialize(source)?;
    if WeatherFormat::NAMES.contains(&name.as_str()) {
        Ok(name)
    } else {
        Err(D::Error::unknown_variant(&name, &WeatherFormat::NAMES))
    }
}

/// The tables of a table, in the order of the file.
fn in_file_order<'de, D: Deserializer<'de>, T: Deserialize<'de>>(source: D) -> Result<Vec<(String, T)>, D::Error> {
    struct InOrder<T>(PhantomData<T>);
    impl<'de, T: Deserialize<'de>> Visitor<'de> for InOrder<T> {
        type Value = Vec<(String, T)>;

        fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
            f.write_str("a table of names")
        }

        fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
            let mut entries = Vec::new();
            while let Some(entry) = map.next_entry()? {
                entries.push(entry);
            }
            Ok(entries)
        }
    }
    source.deserialize_map(InOrder(PhantomData))
}

/// A study file that cannot be used; says file, line, column and what to do.
#[derive(Debug, thiserror::Error)]
pub enum StudyFileError {
    /// The file cannot be read.
    #[error("cannot read the study file {path}: {source}; `busclimate init DIR` writes one")]
    Read {
        /// The file.
        path: String,
        /// What the system says.
        source: std::io::Error,
    },
    /// It is no TOML, holds keys that a study does not have, or values that do not make one.
    #[error("{path}:{line}:{column}: {message}")]
    AtPlace {
        /// The file.
        path: String,
        /// Line, from 1.
        line: usize,
        /// Column, from 1.
        column: usize,
        /// What is wrong, and what to do.
        message: String,
    },
    /// It does not make a study as a whole.
    #[error("{path}: {message}")]
    Whole {
        /// The file.
        path: String,
        /// What is wrong, and what to do.
        message: String,
    },
}

/// Largest study file in bytes.
const LARGEST: u64 = 4 << 20;

impl StudyFile {
    /// Reads the text of a study file.
    pub fn read(path: &Path) -> Result<String, StudyFileError> {
        let shown = path.display().to_string();
        if std::fs::metadata(path).is_ok_and(|m| !m.is_file()) {
            let message = "not a regular file; give a file".to_owned();
            return Err(StudyFileError::Whole { path: shown, message });
        }
        if std::fs::metadata(path).is_ok_and(|m| m.len() > LARGEST) {
            let message = format!("more than {} MiB; no study file is that large", LARGEST >> 20);
            return Err(StudyFileError::Whole { path: shown, message });
        }
        std::fs::read_to_string(path).map_err(|source| StudyFileError::Read { path: shown, source })
    }

    pub fn parse(text: &str, path: &str) -> Result<Self, StudyFileError> {
        let file: Self = toml::from_str(text).map_err(|error| {
            let at = error.span().map_or(0, |s| s.start);
            StudyFileError::at(text, at, path, explain(error.message()))
        })?;
        if file.schema_version != SCHEMA_VERSION {
            let message = format!(
                "schema_version = {}, but this program reads {SCHEMA_VERSION}; update the file or the program",
                file.schema_version
            );
            return Err(StudyFileError::about(text, path, message));
        }
        Ok(file)
    }
}

impl StudyFileError {
    /// Of what stands at a byte of a text.
    fn at(text: &str, at: usize, path: &str, message: String) -> Self {
        let before = &text[..at.min(text.len())];
        let line = before.matches('\n').count() + 1;
        let column = before.rsplit('\n').next().map_or(0, |l| l.chars().count()) + 1;
        Self::AtPlace { path: path.to_owned(), line, column, message }
    }

    /// Of what a message says, with its place in the text where it has one.
    pub(crate) fn about(text: &str, path: &str, message: String) -> Self {
        match place::find(text, &message) {
            Some(at) => Self::at(text, at, path, message),
            None => Self::Whole { path: path.to_owned(), message },
        }
    }
}

/// Adds the nearest known name to a message about an unknown one.
fn explain(message: &str) -> String {
    let quoted: Vec<&str> = message.split('`').skip(1).step_by(2).collect();
    let unknown = ["unknown field", "unknown variant"].iter().any(|m| message.starts_with(m));
    let (true, Some((wrong, known))) = (unknown, quoted.split_first()) else {
        return message.trim().to_owned();
    };
    let what = if message.starts_with("unknown field") { "key" } else { "value" };
    let nearest = known.iter().max_by(|a, b| strsim::jaro_winkler(wrong, a).total_cmp(&strsim::jaro_winkler(wrong, b)));
    match nearest {
        Some(nearest) => format!("unknown {what} `{wrong}`; did you mean `{nearest}`? Known are: {}", known.join(", ")),
        None => format!("unknown {what} `{wrong}`"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SHORT: &str = "schema_version = 1\nname = \"n\"\n[location]\nlatitude_deg = 47.0\nlongitude_deg = 8.0\n\
        [missions]\npath = \"m\"\n[weather]\nformat = \"sia4028\"\npath = \"w\"\n[shadow]\npath = \"s.csv\"\n";

    fn error(text: &str) -> String {
        StudyFile::parse(text, "study.toml").unwrap_err().to_string()
    }

    #[test]
    fn prop_defaults_are_those_of_the_paper() {
        let file = StudyFile::parse(SHORT, "study.toml").unwrap();
        assert_eq!((file.missions.segment_s, file.missions.door_open_share), (3600, 0.6));
        assert_eq!(file.designs.len(), 5);
        assert_eq!(file.vehicle, Vehicle::default());
    }

    #[test]
    fn prop_a_misspelt_key_is_named_with_line_column_and_the_nearest_one() {
        let text = SHORT.replace("longitude_deg", "longtude_deg");
        let message = error(&text);
        assert!(
            message.starts_with("study.toml:5:1: unknown key `longtude_deg`; did you mean `longitude_deg`?"),
            "{message}"
        );
        let message = error(&format!("{SHORT}[vehicle]\nroof_area = 3.0\n"));
        assert!(
            message.starts_with("study.toml:14:1: unknown key `roof_area`; did you mean `roof_area_m2`?"),
            "{message}"
        );
        let message = error(&format!("{SHORT}[designs.x]\nheating = \"heatpump\"\n"));
        assert!(message.starts_with("study.toml:14:11: unknown value `heatpump`; did you mean `hp`?"), "{message}");
    }

    #[test]
    fn prop_designs_keep_the_order_of_the_file_and_white_space_changes_nothing() {
        let text = format!("{SHORT}[designs.zebra]\nheating = \"hp\"\n[designs.ant]\nheating = \"ptc\"\n");
        let file = StudyFile::parse(&text, "study.toml").unwrap();
        assert_eq!(file.designs.iter().map(|d| d.0.as_str()).collect::<Vec<_>>(), ["zebra", "ant"]);
        let spaced = StudyFile::parse(&text.replace('=', "   =  ").replace('[', "\n["), "x").unwrap();
        assert_eq!(serde_json::to_string(&file).unwrap(), serde_json::to_string(&spaced).unwrap());
    }

    #[test]
    fn prop_limits_and_tables_say_what_they_expect() {
        let message = error(&format!("{SHORT}[comfort]\npmv_limits = 3\n"));
        assert!(message.contains("{ from = 0.0, to = 2.0, step = 0.125 } or a list"), "{message}");
        let message = error(&format!("{SHORT}[designs.x]\nheating = \"hp\"\nheating_cop = [1.0]\n"));
        assert!(message.contains("[lift in K, COP]"), "{message}");
        for (text, place, words) in [
            ("[comfort]\npmv_limits = { from = 0.0, too = 2.0 }\n", "14:28", "did you mean `to`?"),
            ("[comfort]\npmv_limits = [0.5, \"x\"]\n", "14:20", "expected f64"),
            ("[comfort]\nwindows = [[-1.0, 1.0, 2.0]]\n", "14:12", "expected two numbers"),
            ("[designs.x]\nheating = \"hp\"\nheating_cop = [[0.0, 4.0, 1.0]]\n", "15:16", "invalid length 3"),
            ("[designs.x]\nheating = \"hp\"\nheating_limit_w = [[0.0]]\n", "15:20", "invalid length 1"),
            ("[designs.x]\nheating = \"hp\"\nheating_limit_w = \"much\"\n", "15:19", "a number of W, or a table"),
            ("[variants.x]\nroof_area_m2 = \"big\"\n", "14:16", "a number, or under `designs`"),
            ("[variants.x]\ndesigns = [1]\n", "14:12", "expected a string"),
            ("[sensitivity.inputs]\nroof_area_m2 = { mean = 1.0, sdd = 0.1 }\n", "14:30", "did you mean `sd`?"),
            ("[sensitivity.inputs]\nroof_area_m2 = [1.0, 2.0, 3.0]\n", "14:16", "expected two numbers"),
            ("[sensitivity.inputs]\nroof_area_m2 = 4\n", "14:16", "expected [low, high]"),
        ] {
            let message = error(&format!("{SHORT}{text}"));
            assert!(message.starts_with(&format!("study.toml:{place}: ")) && message.contains(words), "{message}");
        }
        assert!(error(&SHORT.replace("schema_version = 1", "schema_version = 9")).contains("this program reads 1"));
        assert!(error("schema_version = 1\nname = \"n\"\n").contains("location"));
    }
}
