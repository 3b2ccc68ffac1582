//! The study: `file` is what was typed, [`Study`] what it means, ready to run: defaults filled, names looked up, the grid
//! expanded, [`keys`] computed.
//!
//! Nothing here reads missions or weather, nothing below knows of TOML.

pub mod assumptions;
mod economics;
mod file;
pub mod keys;
mod place;
mod ready;
mod schema;
pub mod settings;
mod shapes;
mod sources;
pub mod template;
mod variants;

use cabin::{ComfortWindow, Vehicle};
use chrono_tz::Tz;
use ingest::mission::{MissionFormat, MissionOptions};
use ingest::weather::{IrradianceSplit, WeatherOptions};
use shading::Site;
use simulate::Dynamics;
use solve::{Grid, Method, certify};
use std::path::{Path, PathBuf};
use store::DesignRow;

pub use economics::{DesignCost, Economics};
pub use file::StudyFileError;
pub use schema::{SCHEMA_FILE, schema};
pub use sources::Source;
pub use variants::{SensitivityStudy, USUAL_SHARE, Variant};

use file::StudyFile;

/// A study with everything that its stages need.
#[derive(Debug, Clone)]
pub struct Study {
    /// Name.
    pub name: String,
    /// A line of the author, shown at the top of the report.
    pub note: Option<String>,
    /// Folder of the study file; all paths of the study are relative to it.
    pub base: PathBuf,
    /// Where the experiment database lies.
    pub database: PathBuf,
    /// Where the report goes.
    pub report_dir: PathBuf,
    /// Place of the bus.
    pub site: Site,
    /// Its time zone: months are local.
    pub zone: Tz,
    /// Where the missions are: a folder, a glob or an archive.
    pub missions_path: String,
    /// How mission files look.
    pub mission_format: MissionFormat,
    /// Buses that count; none means all.
    pub buses: Vec<u32>,
    /// How missions become segments.
    pub missions: MissionOptions,
    /// Whether what came from missions that are no longer there goes; otherwise it stays, and that is said.
    pub forget_missing: bool,
    /// Where the weather is.
    pub weather_path: String,
    /// How it is read.
    pub weather: WeatherOptions,
    /// How old the end of the newest mission may be in hours before it is news; `None` where nothing is expected.
    pub expect_missions_within_h: Option<f64>,
    /// The same of the weather.
    pub expect_weather_within_h: Option<f64>,
    /// Where the shadow fractions are.
    pub shadow_path: String,
    /// Where missions can be fetched from.
    pub mission_sources: Vec<Source>,
    /// Where weather can be fetched from.
    pub weather_sources: Vec<Source>,
    /// Constants of the bus.
    pub vehicle: Vehicle,
    /// Constants of the simulation.
    pub dynamics: Dynamics,
    /// Indices of the windows in the grid that are simulated.
    pub simulated_windows: Vec<usize>,
    /// Which controllers drive every mission.
    pub control: Control,
    /// Designs and comfort windows.
    pub grid: Grid,
    /// The grid's designs as the database keeps them.
    pub design_rows: Vec<DesignRow>,
    /// Buses that stand beside this one.
    pub variants: Vec<Variant>,
    /// What electricity and designs cost; `None` where the study does not ask.
    pub economics: Option<Economics>,
    /// What `sensitivity` varies.
    pub sensitivity: SensitivityStudy,
    /// How optima are found.
    pub method: Method,
    /// BLAKE3 of the study with all defaults, without the places of its results.
    pub hash: String,
    /// The text of the study file.
    pub text: String,
    /// What the study file says, with all defaults.
    typed: serde_json::Value,
}

/// Which controllers drive every mission, and how they are judged.
#[derive(Debug, Clone, PartialEq)]
pub struct Control {
    /// Indices of the windows in the grid whose profiles are driven, and by which every controller is judged.
    pub windows: Vec<usize>,
    /// Indices of the designs in the grid that are driven.
    pub designs: Vec<usize>,
    /// Share of the hours in a mode whose comfort a profile keeps, 0.5 … 1.
    pub coverage: f64,
    /// Setpoints of one's own: name and file.
    pub profiles: Vec<(String, String)>,
}

impl Study {
    /// Reads a study file and makes it ready. `database` overrides where the database lies.
    ///
    /// # Errors
    /// [`StudyFileError`] names file, line and column, or what does not fit.
    pub fn open(path: &Path, database: Option<&Path>) -> Result<Self, StudyFileError> {
        Self::of(StudyFile::read(path)?, path, database)
    }

    /// The study of a text, as if it stood in a file of that path.
    ///
    /// # Errors
    /// As [`Study::open`].
    pub fn parse(text: &str, path: &Path) -> Result<Self, StudyFileError> {
        Self::of(text.to_owned(), path, None)
    }

    fn of(text: String, path: &Path, database: Option<&Path>) -> Result<Self, StudyFileError> {
        let shown = path.display().to_string();
        let file = StudyFile::parse(&text, &shown)?;
        let base = path.parent().map(Path::to_owned).unwrap_or_default();
        match Self::new(&file, base, database) {
            Ok(study) => Ok(Self { text, ..study }),
            Err(message) => Err(StudyFileError::about(&text, &shown, message)),
        }
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
        let missions = ready::mission_options(&file.missions)?;
        let weather = WeatherOptions {
            format: ready::weather_format(&file.weather)?,
            station: file.weather.station.clone(),
            max_gap_s: file.weather.max_gap_s,
            split: match file.weather.split {
                file::Split::Erbs => IrradianceSplit::Erbs,
            },
            site,
            zone,
        };
        let (designs, design_rows): (Vec<_>, Vec<_>) =
            file.designs.iter().map(ready::design).collect::<Result<Vec<_>, _>>()?.into_iter().unzip();
        let windows = ready::windows(&file.comfort)?;
        let grid = Grid::new(designs, windows).map_err(|e| e.to_string())?;
        file.vehicle.check().map_err(|e| format!("[vehicle] {e}"))?;
        certify(&file.vehicle, grid.designs()).map_err(|e| e.to_string())?;

        file.dynamics.check().map_err(|e| format!("[dynamics] {e}"))?;
        let simulated = |w: &ComfortWindow| file.simulation.pmv_limits.contains(&w.pmv_limit());
        let simulated_windows = (0..grid.windows().len()).filter(|&i| simulated(&grid.windows()[i])).collect();

        let control = ready::control(&file.control, &grid)?;
        let [mission_sources, weather_sources] = sources::sources(file, &base)?;
        let study = Self {
            name: file.name.clone(),
            note: file.note.clone(),
            database: database.map_or_else(|| base.join(&file.database), Path::to_owned),
            report_dir: base.join(&file.report_dir),
            base,
            site,
            zone,
            missions_path: file.missions.path.clone(),
            mission_format: ready::mission_format(&file.missions)?,
            buses: file.missions.buses.clone(),
            missions,
            forget_missing: file.missions.forget_missing,
            weather_path: file.weather.path.clone(),
            weather,
            expect_missions_within_h: ready::expected_h("[missions]", file.missions.expect_newest_within_hours)?,
            expect_weather_within_h: ready::expected_h("[weather]", file.weather.expect_newest_within_hours)?,
            shadow_path: file.shadow.path.clone(),
            mission_sources,
            weather_sources,
            vehicle: file.vehicle.clone(),
            dynamics: file.dynamics,
            simulated_windows,
            control,
            variants: variants::variants(file, &grid)?,
            sensitivity: variants::sensitivity(file, &grid)?,
            economics: file.economics.as_ref().map(|typed| economics::economics(typed, &grid)).transpose()?,
            grid,
            design_rows,
            hash: keys::study_hash(file),
            text: String::new(),
            typed: serde_json::to_value(file).map_err(|e| e.to_string())?,
            method: Method::Fast,
        };
        Ok(study.solved_by(Method::Fast))
    }

    /// The same study, its optima found by a given method: the keys of the designs tell the methods apart.
    #[must_use]
    pub fn solved_by(mut self, method: Method) -> Self {
        for (row, design) in self.design_rows.iter_mut().zip(self.grid.designs()) {
            row.design_key = keys::design_key(row, design, &self.vehicle, method, self.grid.windows());
            row.method = method;
        }
        self.method = method;
        self
    }
}
