//! A seeded synthetic data set in the formats of the real one: ZTBus missions, MeteoSwiss weather, shadow fractions.
//!
//! All of it is made up. Durations, loads, dwell and door times follow the statistics of the ZTBus data set, the weather
//! the climate of Zürich, the shade a street canyon; what a study finds in it shows how the program works and is no
//! statement about Zürich.
//!
//! The bytes depend on the options alone: every mission has its own stream of random numbers, taken from the seed and
//! its index. Files are written beside their place and renamed, so that a file that is there is whole.

mod files;
mod plan;
mod random;
mod telemetry;
mod weather;

pub use plan::{MissionPlan, PlanError, default_plan, read_meta_data};
pub use weather::SyntheticWeather;

use rayon::prelude::*;
use shading::{Site, Streets, canyon_year};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

/// Where the demo's bus runs.
pub const LATITUDE_DEG: f64 = 47.3779;
/// Where the demo's bus runs.
pub const LONGITUDE_DEG: f64 = 8.5657;
/// Folder of the missions.
pub const MISSIONS: &str = "ztbus";
/// Folder of the weather.
pub const WEATHER: &str = "weather";
/// File of the shadow fractions.
pub const SHADOW: &str = "shadow.csv";

/// What was written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Summary {
    /// Missions.
    pub missions: u64,
    /// Rows of telemetry.
    pub rows: u64,
    /// Bytes of telemetry.
    pub bytes: u64,
}

/// The data set could not be written.
#[derive(Debug, thiserror::Error)]
pub enum DemoError {
    /// A file or folder cannot be written.
    #[error("cannot write {path}: {source}; check permissions and free space")]
    Write {
        /// The file or folder.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// There is nothing to write.
    #[error("no missions; ask for at least one, and for a bus that the metadata has")]
    NoMissions,
    /// The plan cannot be made.
    #[error(transparent)]
    Plan(#[from] PlanError),
}

/// Writes missions, `metaData.csv`, weather and shadow fractions for these plans under `folder`, on rayon's current
/// pool. `weather` is a file of real weather, name and content, that takes the place of the synthetic one. `progress` is
/// told how many of how many missions stand.
///
/// # Errors
/// [`DemoError`] where nothing is planned or a file cannot be written.
pub fn write(
    folder: &Path,
    seed: u64,
    plans: &[MissionPlan],
    weather: Option<(&str, &[u8])>,
    progress: &(dyn Fn(u64, u64) + Sync),
) -> Result<Summary, DemoError> {
    let (Some(first), Some(last)) = (plans.iter().map(|p| p.start).min(), plans.iter().map(|p| p.end).max()) else {
        return Err(DemoError::NoMissions);
    };
    let missions = folder.join(MISSIONS);
    files::folder(&missions)?;
    files::folder(&folder.join(WEATHER))?;

    let done = AtomicU64::new(0);
    let written: Vec<telemetry::Written> = plans
        .par_iter()
        .enumerate()
        .map(|(index, plan)| {
            let mut bytes = Vec::new();
            let written = telemetry::generate(plan, seed, index as u64, &mut bytes);
            files::write(&missions.join(format!("{}.csv", plan.name())), &bytes)?;
            progress(done.fetch_add(1, Ordering::Relaxed) + 1, plans.len() as u64);
            Ok(written)
        })
        .collect::<Result<_, DemoError>>()?;
    files::write(&missions.join("metaData.csv"), &telemetry::meta_data(plans, &written))?;

    match weather {
        Some((name, bytes)) => files::write(&folder.join(WEATHER).join(name), bytes)?,
        None => {
            for (name, bytes) in SyntheticWeather::new(seed, first, last).files() {
                files::write(&folder.join(WEATHER).join(name), &bytes)?;
            }
        }
    }
    let site = Site::new(LATITUDE_DEG, LONGITUDE_DEG).expect("the demo's place lies on the globe");
    let shadow = canyon_year(&site, &Streets::default().evenly_spread()).to_csv();
    files::write(&folder.join(SHADOW), shadow.as_bytes())?;
    Ok(Summary {
        missions: plans.len() as u64,
        rows: written.iter().map(|w| w.rows).sum(),
        bytes: written.iter().map(|w| w.bytes).sum(),
    })
}
