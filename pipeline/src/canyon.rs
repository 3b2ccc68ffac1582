//! The shadow file of a study, computed for street canyons.

use shading::{Street, canyon_year, even_azimuths_rad, town_streets};
use std::path::PathBuf;
use study::Study;

use crate::{PipelineError, write_whole};

/// Writes the shadow file that the study names, for streets of the given directions in degrees from north and heights over
/// widths; without any, evenly spread directions and the mixture of a town. Returns the file and how many kinds of streets.
///
/// # Errors
/// [`PipelineError::Request`] where a value is out of range or the file is there already; [`PipelineError::Write`].
pub fn write_canyon(
    study: &Study,
    azimuths_deg: &[f64],
    heights_to_width: &[f64],
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
    let kinds: Vec<(f64, f64)> = if heights_to_width.is_empty() {
        let first = town_streets()[0].azimuth_rad;
        let mixture = town_streets().into_iter().filter(|s| s.azimuth_rad == first);
        mixture.map(|s| (s.height_to_width, s.share)).collect()
    } else {
        heights_to_width.iter().map(|&h| (h, 1.0)).collect()
    };
    let street = |&azimuth_rad: &f64| {
        kinds.iter().map(move |&(height_to_width, share)| Street { azimuth_rad, height_to_width, share })
    };
    let streets: Vec<Street> = azimuths.iter().flat_map(street).collect();
    write_whole(&path, canyon_year(&study.site, &streets).to_csv().as_bytes())?;
    Ok((path, streets.len()))
}
