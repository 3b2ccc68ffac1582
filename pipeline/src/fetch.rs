//! Inputs from the places that publish them.

use fetch::{Download, FetchError, Fetched, Patience, download};
use ingest::weather::looks_like;
use std::path::Path;
use study::{Source, Study};

use crate::{PipelineError, Progress};

/// Which inputs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Wanted {
    /// Missions and weather.
    All,
    /// Missions.
    Missions,
    /// Weather.
    Weather,
}

/// What came of one file.
#[derive(Debug)]
pub struct FetchedFile {
    /// Where it came from, and where it belongs.
    pub source: Source,
    /// What came of it; nothing where nothing was asked for.
    pub outcome: Option<Result<Fetched, FetchError>>,
}

/// Fetches the inputs of a study; with `offline`, only says which there are. What one file ends with stops no other.
///
/// # Errors
/// [`PipelineError::Interrupted`].
pub fn fetch(
    study: &Study,
    wanted: Wanted,
    patience: Patience,
    offline: bool,
    progress: &dyn Progress,
) -> Result<Vec<FetchedFile>, PipelineError> {
    let missions = study.mission_sources.iter().filter(|_| wanted != Wanted::Weather).map(|source| (source, true));
    let weather = study.weather_sources.iter().filter(|_| wanted != Wanted::Missions).map(|source| (source, false));
    let mut files = Vec::new();
    for (source, is_missions) in missions.chain(weather) {
        let outcome = if offline { None } else { Some(one(study, source, is_missions, patience, progress)) };
        if matches!(outcome, Some(Err(FetchError::Interrupted))) {
            return Err(PipelineError::Interrupted);
        }
        files.push(FetchedFile { source: source.clone(), outcome });
    }
    Ok(files)
}

fn one(
    study: &Study,
    source: &Source,
    is_missions: bool,
    patience: Patience,
    progress: &dyn Progress,
) -> Result<Fetched, FetchError> {
    let check = |path: &Path| if is_missions { is_archive(path) } else { looks_like(path, &study.weather.format) };
    let file = Download {
        url: &source.url,
        to: &source.to,
        bytes: source.bytes,
        checksum: source.checksum.as_ref(),
        check: &check,
    };
    let (mut shown, mut begun) = (0, false);
    let fetched = download(&file, patience, &mut |bytes, total| {
        if !begun {
            progress.begin("kB", total.unwrap_or(0) / 1000);
            begun = true;
        }
        progress.advance((bytes / 1000).saturating_sub(shown));
        shown = shown.max(bytes / 1000);
        !progress.stop()
    });
    if begun {
        progress.end();
    }
    fetched
}

/// Missions are published as an archive.
fn is_archive(path: &Path) -> Result<(), String> {
    ingest::check_archive(path).map_err(|reason| format!("it is no zip archive, or not all of it: {reason}"))
}
