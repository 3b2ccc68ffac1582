//! The study, ready to run: defaults filled, names looked up, the grid expanded, hashes computed.

pub mod file;
pub mod template;

use cabin::{ComfortWindow, Cop, Design, Heating, Vehicle, named_cooling_cops, named_heating_cops};
use chrono_tz::Tz;
use ingest::mission::MissionOptions;
use ingest::weather::{ColumnMap, IrradianceSplit, TimeLabel, WeatherFormat, WeatherOptions};
use shading::Site;
use simulate::Dynamics;
use solve::nlp::{NLP_VERSION, SURROGATE_VERSION};
use solve::{Grid, METHOD_VERSION, certify};
use std::path::{Path, PathBuf};
use store::{DesignRow, WindowRow};

use crate::args::Method;
use file::{StudyFile, StudyFileError};

/// Version of the readers: it changes whenever a file would be read differently.
pub const READER_VERSION: u32 = 2;
/// More limits than this are a slip of the step.
const MOST_LIMITS: f64 = 1000.0;

/// A study with everything that its stages need.
pub struct Study {
    pub name: String,
    pub note: Option<String>,
    /// Folder of the study file; all paths of the study are relative to it.
    pub base: PathBuf,
    pub database: PathBuf,
    pub report_dir: PathBuf,
    pub site: Site,
    pub zone: Tz,
    pub missions_path: String,
    pub buses: Vec<u32>,
    pub missions: MissionOptions,
    pub weather_path: String,
    pub weather: WeatherOptions,
    pub shadow_path: String,
    pub vehicle: Vehicle,
    pub dynamics: Dynamics,
    /// Indices of the windows in the grid that are simulated.
    pub simulated_windows: Vec<usize>,
    pub grid: Grid,
    /// The grid's designs and windows as the database keeps them.
    pub design_rows: Vec<DesignRow>,
    pub window_rows: Vec<WindowRow>,
    pub method: Method,
    /// BLAKE3 of the study with all defaults, without the places of its results.
    pub hash: String,
}

impl Study {
    /// Reads a study file and makes it ready. `database` overrides where the database lies.
    pub fn open(path: &Path, database: Option<&Path>) -> Result<Self, StudyFileError> {
        let file = StudyFile::read(path)?;
        let base = path.parent().map(Path::to_owned).unwrap_or_default();
        Self::new(&file, base, database)
            .map_err(|message| StudyFileError::Content { path: path.display().to_string(), message })
    }

    fn new(file: &StudyFile, base: PathBuf, database: Option<&Path>) -> Result<Self, String> {
        let site = Site::new(file.location.latitude_deg, file.location.longitude_deg)
            .map_err(|e| format!("[location] {e}"))?;
        let zone: Tz = file.location.time_zone.parse().map_err(|_| {
            format!(
                "[location] time_zone = {:?} is not known; take one such as \"Europe/Zurich\"",
                file.location.time_zone
            )
        })?;
        let missions = mission_options(&file.missions)?;
        let weather = WeatherOptions {
            format: weather_format(&file.weather)?,
            station: file.weather.station.clone(),
            max_gap_s: file.weather.max_gap_s,
            split: match file.weather.split {
                file::Split::Erbs => IrradianceSplit::Erbs,
            },
            site,
        };
        let (designs, design_rows): (Vec<Design>, Vec<DesignRow>) =
            file.designs.iter().map(design).collect::<Result<Vec<_>, _>>()?.into_iter().unzip();
        let windows = windows(&file.comfort)?;
        let grid = Grid::new(designs, windows).map_err(|e| e.to_string())?;
        file.vehicle.check().map_err(|e| format!("[vehicle] {e}"))?;
        certify(&file.vehicle, grid.designs()).map_err(|e| e.to_string())?;

        file.dynamics.check().map_err(|e| format!("[dynamics] {e}"))?;
        let simulated = |w: &ComfortWindow| file.simulation.pmv_limits.contains(&w.pmv_limit());
        let simulated_windows = (0..grid.windows().len()).filter(|&i| simulated(&grid.windows()[i])).collect();

        let window_rows = grid
            .windows()
            .iter()
            .map(|w| WindowRow { pmv_min: w.pmv_min(), pmv_max: w.pmv_max(), pmv_limit: w.pmv_limit() })
            .collect();
        let study = Self {
            name: file.name.clone(),
            note: file.note.clone(),
            database: database.map_or_else(|| base.join(&file.database), Path::to_owned),
            report_dir: base.join(&file.report_dir),
            base,
            site,
            zone,
            missions_path: file.missions.path.clone(),
            buses: file.missions.buses.clone(),
            missions,
            weather_path: file.weather.path.clone(),
            weather,
            shadow_path: file.shadow.path.clone(),
            vehicle: file.vehicle.clone(),
            dynamics: file.dynamics,
            simulated_windows,
            grid,
            design_rows,
            window_rows,
            hash: hash(&[&canonical(file)]),
            method: Method::Fast,
        };
        Ok(study.solved_by(Method::Fast))
    }

    /// The same study, its optima found by a given method: the keys of the designs tell the methods apart.
    pub fn solved_by(mut self, method: Method) -> Self {
        let (name, version) = match method {
            Method::Fast => ("fast", METHOD_VERSION.to_string()),
            Method::Nlp => ("nlp", NLP_VERSION.to_string()),
            Method::NlpSurrogate => ("nlp-surrogate", format!("{NLP_VERSION} {SURROGATE_VERSION}")),
        };
        let vehicle = canonical(&self.vehicle);
        for row in &mut self.design_rows {
            let parts = [
                row.heating.as_str(),
                &row.heating_cop,
                &row.cooling_cop,
                &format!("{} {} {name} {version}", row.radiant_heaters, row.air_curtain),
                &vehicle,
            ];
            row.design_key = hash(&parts);
            name.clone_into(&mut row.method);
        }
        self.method = method;
        self
    }

    /// Key of a file's reading: its content and the settings that it is read with.
    pub fn reading_key(&self, content_hash: &str, settings: &str) -> String {
        hash(&[content_hash, settings, &READER_VERSION.to_string()])
    }
}

/// BLAKE3 over parts, each with its length, so that no two lists of parts give the same bytes.
pub fn hash(parts: &[&str]) -> String {
    let mut hasher = blake3::Hasher::new();
    for part in parts {
        hasher.update(&(part.len() as u64).to_le_bytes());
        hasher.update(part.as_bytes());
    }
    hasher.finalize().to_hex().to_string()
}

/// A canonical form: fields in the order of the struct, numbers in their shortest form.
fn canonical(value: &impl serde::Serialize) -> String {
    serde_json::to_string(value).expect("plain structs with string keys become JSON")
}

fn mission_options(missions: &file::Missions) -> Result<MissionOptions, String> {
    if !(60..=86_400).contains(&missions.segment_s) {
        return Err(format!("[missions] segment_s = {} must lie between 60 and 86400", missions.segment_s));
    }
    if !(0.0..=1.0).contains(&missions.door_open_share) {
        return Err(format!("[missions] door_open_share = {} must lie between 0 and 1", missions.door_open_share));
    }
    Ok(MissionOptions {
        segment_s: missions.segment_s,
        door_open_share: missions.door_open_share,
        keep_partial: missions.keep_partial,
    })
}

fn weather_format(weather: &file::Weather) -> Result<WeatherFormat, String> {
    let columns = [
        ("time_column", weather.time_column.is_some()),
        ("time_label", weather.time_label.is_some()),
        ("interval_s", weather.interval_s.is_some()),
        ("temperature_column", weather.temperature_column.is_some()),
        ("ghi_column", weather.ghi_column.is_some()),
        ("dhi_column", weather.dhi_column.is_some()),
        ("dni_column", weather.dni_column.is_some()),
    ];
    let known = match weather.format {
        file::WeatherFormat::MeteoSwissOgd => WeatherFormat::MeteoSwissOgd,
        file::WeatherFormat::Sia4028 => WeatherFormat::Sia4028,
        file::WeatherFormat::Csv => {
            let needed = |name: &str| format!("[weather] format = \"csv\" needs {name}");
            let interval_s = weather.interval_s.ok_or_else(|| needed("interval_s"))?;
            if !(60..=86_400).contains(&interval_s) {
                return Err(format!("[weather] interval_s = {interval_s} must lie between 60 and 86400"));
            }
            if weather.ghi_column.is_none() && (weather.dhi_column.is_none() || weather.dni_column.is_none()) {
                return Err(needed("ghi_column, or dhi_column and dni_column"));
            }
            return Ok(WeatherFormat::Csv(ColumnMap {
                time_column: weather.time_column.clone().ok_or_else(|| needed("time_column"))?,
                time_label: match weather.time_label.ok_or_else(|| needed("time_label = \"start\" or \"end\""))? {
                    file::TimeLabel::Start => TimeLabel::Start,
                    file::TimeLabel::End => TimeLabel::End,
                },
                interval_s,
                temperature_column: weather.temperature_column.clone().ok_or_else(|| needed("temperature_column"))?,
                ghi_column: weather.ghi_column.clone(),
                dhi_column: weather.dhi_column.clone(),
                dni_column: weather.dni_column.clone(),
            }));
        }
    };
    match columns.iter().find(|(_, given)| *given) {
        Some((name, _)) => Err(format!("[weather] {name} belongs to format = \"csv\" only; remove it")),
        None => Ok(known),
    }
}

fn design((name, typed): &(String, file::Design)) -> Result<(Design, DesignRow), String> {
    let error = |e: String| format!("[designs.{name:?}] {e}");
    let (heating, heating_name) = match typed.heating {
        file::Heating::Ptc => (Heating::Ptc, "ptc"),
        file::Heating::Hp => (Heating::HeatPump, "hp"),
    };
    let (heating_cop, heating_text) = match (typed.heating, &typed.heating_cop) {
        (file::Heating::Ptc, None) => (Cop::Constant(1.0), "1".to_owned()),
        (_, given) => cop("heating_cop", given.as_ref(), named_heating_cops()).map_err(error)?,
    };
    let (cooling_cop, cooling_text) =
        cop("cooling_cop", typed.cooling_cop.as_ref(), named_cooling_cops()).map_err(error)?;
    let row = DesignRow {
        name: name.clone(),
        heating: heating_name.to_owned(),
        heating_cop: heating_text,
        cooling_cop: cooling_text,
        radiant_heaters: typed.radiant_heaters,
        air_curtain: typed.air_curtain,
        method: String::new(),
        design_key: String::new(),
    };
    let design = Design {
        name: name.clone(),
        heating,
        heating_cop,
        cooling_cop,
        radiant_heaters: typed.radiant_heaters,
        air_curtain: typed.air_curtain,
    };
    Ok((design, row))
}

/// A curve with its name or table as text; without one, the first of the named.
fn cop(
    key: &str,
    given: Option<&file::Cop>,
    named: Vec<(&'static str, Cop, &'static str)>,
) -> Result<(Cop, String), String> {
    match given {
        Some(file::Cop::Table(rows)) => {
            let pairs = rows.iter().map(|[lift, cop]| (*lift, *cop)).collect();
            let curve = Cop::table(pairs).map_err(|e| format!("{key}: {e}"))?;
            Ok((curve, canonical(rows)))
        }
        Some(file::Cop::Name(name)) => {
            let known: Vec<&str> = named.iter().map(|n| n.0).collect();
            let error = || format!("{key} = {name:?} is not known; known are: {}", known.join(", "));
            let (name, curve, _) = named.iter().find(|n| n.0 == name).ok_or_else(error)?;
            Ok((curve.clone(), (*name).to_owned()))
        }
        None => {
            let (name, curve, _) = named.into_iter().next().ok_or("there are no named curves")?;
            Ok((curve, name.to_owned()))
        }
    }
}

/// The windows of the study; without any, the paper's seventeen.
fn windows(comfort: &file::Comfort) -> Result<Vec<ComfortWindow>, String> {
    let default = file::Steps { from: 0.0, to: 2.0, step: 0.125 };
    let limits = match (&comfort.pmv_limits, &comfort.windows) {
        (Some(file::Limits::List(list)), _) => list.clone(),
        (Some(file::Limits::Steps(steps)), _) => expand(steps)?,
        (None, None) => expand(&default)?,
        (None, Some(_)) => Vec::new(),
    };
    let symmetric = limits.iter().map(|&limit| ComfortWindow::symmetric(limit));
    let unequal = comfort.windows.iter().flatten().map(|&[low, high]| ComfortWindow::new(low, high));
    symmetric.chain(unequal).collect::<Result<_, _>>().map_err(|e| format!("[comfort] {e}"))
}

fn expand(steps: &file::Steps) -> Result<Vec<f64>, String> {
    let file::Steps { from, to, step } = *steps;
    let count = (to - from) / step;
    if !(step > 0.0 && (0.0..=MOST_LIMITS).contains(&count)) {
        return Err(format!(
            "[comfort] pmv_limits from {from} to {to} by {step}: step must be above 0 and lead from `from` to `to` in at \
             most {MOST_LIMITS} steps"
        ));
    }
    // A rounding error of the division must not lose the last limit.
    Ok((0..=(count + 1e-9).floor() as u32).map(|i| from + f64::from(i) * step).collect())
}
