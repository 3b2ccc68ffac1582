//! The same bus and timetable under other weather: the recorded segments, joined with the weather file of another place or of a
//! reference year, solved without storing anything.

use ::report::{Climate, Climates};
use cabin::ComfortWindow;
use chrono::TimeDelta;
use ingest::Content;
use ingest::mission::Segment;
use ingest::sample::Surroundings;
use ingest::weather::{self, Weather, WeatherFormat, WeatherOptions};
use shading::Site;
use solve::{DAYS_OF_MONTH, YearSamples};
use std::path::{Path, PathBuf};
use store::StoredSegment;
use study::Study;

use crate::files::{make_folder, write_whole};
use crate::{Inputs, PipelineError, open};

/// Text at the beginning of a weather file that tells its format and its place.
const HEAD_BYTES: usize = 64 << 10;

/// The year of a study under its own weather, and under each of the given files. Only the database's segments are read.
///
/// # Errors
/// [`PipelineError`] where a file cannot be used or nothing is ingested.
pub fn climates(study: &Study, files: &[PathBuf]) -> Result<Climates, PipelineError> {
    let mut store = open::for_reading(study)?;
    let segments = store.segments()?;
    store.close()?;
    let inputs = Inputs::new(study, false);
    let (own, _) = inputs.weather()?;
    let (shadow, _) = inputs.shadow()?;
    let under = |name: &str, weather: &Weather, site: &Site| {
        let surroundings = Surroundings { weather, shadow, site, zone: study.zone };
        climate(study, &segments, name, &surroundings)
    };
    let mut all = vec![under(&study.name, own, &study.site)?];
    for path in files {
        let (weather, site) = read(study, path)?;
        let name = path.file_stem().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        all.push(under(&name, &weather, &site)?);
    }
    let windows = study.grid.windows();
    let shown = ComfortWindow::shown(windows);
    Ok(Climates {
        designs: study.grid.designs().iter().map(|d| d.name.clone()).collect(),
        windows: windows.to_vec(),
        shown: windows.iter().position(|w| Some(*w) == shown).unwrap_or_default(),
        all,
    })
}

/// Writes table and figure into a folder, which is made where it is not there.
///
/// # Errors
/// [`PipelineError::Write`].
pub fn write_climates(climates: &Climates, folder: &Path) -> Result<(), PipelineError> {
    make_folder(folder)?;
    for file in climates.files()? {
        write_whole(&folder.join(&file.name), &file.bytes)?;
    }
    Ok(())
}

/// A weather file of a format that tells itself, or of the study's own format, and the place that it is of.
fn read(study: &Study, path: &Path) -> Result<(Weather, Site), PipelineError> {
    let content = Content::read(path).map_err(|finding| PipelineError::InputFile { path: path.to_owned(), finding })?;
    let head = String::from_utf8_lossy(&content.bytes[..content.bytes.len().min(HEAD_BYTES)]);
    let format = WeatherFormat::of_text(&head).unwrap_or_else(|| study.weather.format.clone());
    let place = weather::place_of(&head, &format);
    let site = match place {
        Some([latitude_deg, longitude_deg]) => Site::new(latitude_deg, longitude_deg)
            .map_err(|e| PipelineError::Request(format!("{}: {e}", path.display())))?,
        None => study.site,
    };
    let options = WeatherOptions { format, station: None, site, ..study.weather.clone() };
    let (weather, _) = weather::read_one(&path.display().to_string(), &content, &options)?;
    Ok((weather, site))
}

fn climate(
    study: &Study,
    segments: &[StoredSegment],
    name: &str,
    surroundings: &Surroundings<'_>,
) -> Result<Climate, PipelineError> {
    let site = surroundings.site;
    // Hours keep their place in the day by the sun, to half an hour.
    let hours = ((study.site.longitude_deg() - site.longitude_deg()) / 15.0).round();
    let later = TimeDelta::hours(hours as i64);
    let (mut year, mut excluded, mut exclusion) = (YearSamples::default(), 0_u64, None);
    let mut ambient = [[0.0; 2]; 12];
    for (_, segment) in segments {
        let Ok(segment) = segment else { continue };
        let moved = Segment { start: segment.start + later, ..segment.clone() };
        match surroundings.sample(moved, "") {
            Ok(sample) => {
                let month = ingest::sample::month(segment.start, study.zone);
                year.add(month, sample.disturbances);
                let [count, sum] = &mut ambient[usize::from(month) - 1];
                (*count, *sum) = (*count + 1.0, *sum + sample.disturbances.ambient_temperature_k);
            }
            Err(why) => {
                excluded += 1;
                exclusion.get_or_insert(why.reason);
            }
        }
    }
    let months = ambient.iter().zip(DAYS_OF_MONTH).filter(|([count, _], _)| *count > 0.0);
    let (days, sum) = months
        .fold((0.0, 0.0), |(days, sum), ([count, of_month], length)| (days + length, sum + length * of_month / count));
    if days == 0.0 {
        let reason = exclusion.unwrap_or_else(|| "there are no segments; run `busclimate ingest` first".to_owned());
        return Err(PipelineError::NoSamples { excluded: excluded as usize, reason });
    }
    Ok(Climate {
        name: name.to_owned(),
        place_deg: [site.latitude_deg(), site.longitude_deg()],
        excluded,
        exclusion,
        ambient_temperature_c: cabin::celsius(sum / days),
        years: year.means(&study.vehicle, &study.grid),
    })
}
