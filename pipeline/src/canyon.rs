//! The shadow file of a study, computed for street canyons.

use shading::{Streets, canyon_year, even_azimuths_rad, in_directions};
use std::path::PathBuf;
use study::Study;

use crate::{PipelineError, write_whole};

/// Writes the shadow file that the study names, for streets of the given directions in degrees from north and heights over
/// widths; without directions evenly spread ones, without heights those of `streets`. Returns the file and how many kinds of
/// streets.
///
/// # Errors
/// [`PipelineError::Request`] where a value is out of range or the file is there already; [`PipelineError::Write`].
pub fn write_canyon(
    study: &Study,
    azimuths_deg: &[f64],
    heights_to_width: &[f64],
    streets: Streets,
) -> Result<(PathBuf, usize), PipelineError> {
    let request = |message: String| Err(PipelineError::Request(message));
    if let Some(h) = heights_to_width.iter().find(|h| !(0.0..=20.0).contains(*h)) {
        return request(format!("--height-to-width {h} must lie between 0 and 20"));
    }
    if let Some(a) = azimuths_deg.iter().find(|a| !a.is_finite()) {
        return request(format!("--street-azimuth-deg {a} must be a number of degrees"));
    }
    let path = study.base.join(&study.shadow_path);
    if path.exists() {
        return request(format!("{} is there already; it is left as it is", path.display()));
    }
    let given: Vec<f64> = azimuths_deg.iter().map(|a| a.to_radians()).collect();
    let azimuths = if given.is_empty() { even_azimuths_rad() } else { given };
    let given: Vec<(f64, f64)> = heights_to_width.iter().map(|&h| (h, 1.0)).collect();
    let kinds = if given.is_empty() { streets.kinds() } else { &given };
    let streets = in_directions(&azimuths, kinds);
    write_whole(&path, canyon_year(&study.site, &streets).to_csv().as_bytes())?;
    Ok((path, streets.len()))
}

/// What the shade of a study is, where its file is that of named streets at its place.
pub(crate) fn shade_in_words(study: &Study, blake3: &str) -> Option<&'static str> {
    let is_of = |streets: &Streets| {
        let text = canyon_year(&study.site, &streets.evenly_spread()).to_csv();
        blake3::hash(text.as_bytes()).to_hex().as_str() == blake3
    };
    Streets::ALL.into_iter().find(is_of).map(Streets::words)
}
