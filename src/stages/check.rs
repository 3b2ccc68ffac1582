//! Validation without a run.

use ingest::{mission, weather};
use simulate::Conduct;

use super::shade::read_shadow;
use crate::console::say;
use crate::failure::{Ending, Failure};
use crate::study::Study;

/// Measured on two cores of a plain machine; good for an order of magnitude.
const ROWS_A_SECOND: f64 = 2.8e6;
const POINTS_A_SECOND: f64 = 3.0e5;
const SIMULATED_A_SECOND: f64 = 9.0e6;
const BYTES_A_POINT: f64 = 125.0;

pub fn check(study: &Study) -> Result<Ending, Failure> {
    let found = mission::discover(&study.base, &study.missions_path, &study.buses)?;
    let overlapping = mission::overlaps(&found.missions);
    let refused = found.refused.iter().chain(overlapping.iter().map(|(_, record)| record));
    let files = weather::discover(&study.base, &study.weather_path, &study.weather.format)?;
    let (_, weather_records) = weather::read(&files, &study.weather)?;
    read_shadow(&study.base, &study.shadow_path)?;

    let used = found.missions.iter().enumerate().filter(|(i, _)| !overlapping.iter().any(|(o, _)| o == i));
    let (mut rows, mut samples, mut missions) = (0_i64, 0_i64, 0);
    for (_, source) in used {
        let seconds = (source.end - source.start).num_seconds() + 1;
        rows += seconds;
        samples += seconds / i64::from(study.missions.segment_s);
        missions += 1;
    }
    let points = samples as f64 * study.grid.points() as f64;
    let ways = study.grid.designs().len() * study.simulated_windows.len() * Conduct::ALL.len();
    let simulated_s = samples as f64 * f64::from(study.missions.segment_s) * ways as f64;
    let seconds = rows as f64 / ROWS_A_SECOND + points / POINTS_A_SECOND + simulated_s / SIMULATED_A_SECOND;
    say(format_args!(
        "{}: {} designs × {} comfort windows = {} points a sample",
        study.name,
        study.grid.designs().len(),
        study.grid.windows().len(),
        study.grid.points()
    ))?;
    say(format_args!("{missions} missions, {rows} rows, at most {samples} samples and {points} points"))?;
    say(format_args!(
        "simulated: {} designs × {} windows × {} ways to run the bus, at most {:.0} million seconds",
        study.grid.designs().len(),
        study.simulated_windows.len(),
        Conduct::ALL.len(),
        simulated_s / 1e6
    ))?;
    say(format_args!("about {seconds:.0} s on two cores, {:.0} MB of database", points * BYTES_A_POINT / 1e6))?;
    let mut ending = Ending::Done;
    let refused_weather = weather_records.iter().filter(|r| !r.accepted);
    for record in refused.chain(refused_weather) {
        ending = Ending::Losses;
        for finding in &record.findings {
            say(format_args!("refused: {}: {finding}", record.path))?;
        }
    }
    for record in weather_records.iter().filter(|r| r.accepted) {
        for finding in &record.findings {
            say(format_args!("note: {}: {finding} ({})", record.path, finding.count))?;
        }
    }
    Ok(ending)
}
