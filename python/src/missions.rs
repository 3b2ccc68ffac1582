//! Mission files as the program reads them.

use arrow_array::{ArrayRef, Float64Array, Int32Array, Int64Array, StringArray};
use chrono::{DateTime, SecondsFormat, Utc};
use ingest::FileReader;
use ingest::mission::{MissionOptions, MissionReading, MissionSource, RouteChoice, Segment, read};
use ingest::sample::sample_id;
use pyo3::prelude::*;
use pyo3_arrow::PyTable;
use std::path::PathBuf;
use std::sync::Arc;

use crate::arrow::table;
use crate::errors::{argument, data};

/// The segments of a mission file in ZTBus format, by the reading code of `busclimate ingest`.
///
/// Parameters
/// ----------
/// path : a file named like a mission, such as B183_2021-07-26_03-53-27_2021-07-26_07-18-47.csv
/// segment_s : length of a segment in s, from the start of the mission
/// door_open_share : share of the doors that open when a door is open, 0 … 1
/// keep_partial : whether a shorter last part makes a segment of its own
///
/// Returns
/// -------
/// Table
///     A row a segment: sample_id, mission, bus, segment, start_utc, duration_s, passengers, door_open_fraction, distance_m,
///     vehicle_power_w, route, first_line, last_line (of the file, the header is line 1).
///
/// Raises
/// ------
/// InputError
///     The file is refused, with line and column of what is wrong.
#[pyfunction]
#[pyo3(signature = (path, *, segment_s=3600, door_open_share=0.6, keep_partial=false))]
pub fn read_mission(
    py: Python<'_>,
    path: PathBuf,
    segment_s: u32,
    door_open_share: f64,
    keep_partial: bool,
) -> PyResult<PyTable> {
    if segment_s == 0 {
        return Err(argument("segment_s", "is 0; give the length of a segment in seconds, such as 3600"));
    }
    if !(0.0..=1.0).contains(&door_open_share) {
        return Err(argument("door_open_share", format!("is {door_open_share}, outside 0 … 1")));
    }
    let options = MissionOptions { segment_s, door_open_share, keep_partial, routes: RouteChoice::default() };
    let reading = py.detach(|| {
        let source = MissionSource::at(&path).ok_or_else(|| {
            let form =
                "B<bus>_<first second>_<last second>.csv, such as B183_2021-07-26_03-53-27_2021-07-26_07-18-47.csv";
            data("path", format!("{} is not named like a mission: {form}", path.display()))
        })?;
        PyResult::Ok(match source.load(&mut FileReader::default()) {
            Ok(content) => read(&source, &content, &options),
            Err(record) => MissionReading::refused(*record),
        })
    })?;
    if !reading.file.accepted {
        let why: Vec<String> = reading.file.findings.iter().map(ToString::to_string).collect();
        return Err(data("path", format!("{} is refused: {}", path.display(), why.join("; "))));
    }
    segments(&reading.segments)
}

/// A time as the database has it.
pub fn time(time: DateTime<Utc>) -> String {
    time.to_rfc3339_opts(SecondsFormat::Secs, true)
}

fn segments(all: &[Segment]) -> PyResult<PyTable> {
    let real = |of: fn(&Segment) -> Option<f64>| -> ArrayRef { Arc::new(all.iter().map(of).collect::<Float64Array>()) };
    let whole = |of: fn(&Segment) -> i64| -> ArrayRef { Arc::new(Int64Array::from_iter_values(all.iter().map(of))) };
    let small = |of: fn(&Segment) -> u32| -> ArrayRef {
        Arc::new(Int32Array::from_iter_values(all.iter().map(|s| of(s) as i32)))
    };
    let columns: Vec<(&str, ArrayRef)> = vec![
        ("sample_id", whole(|s| sample_id(s.bus, s.start))),
        ("mission", Arc::new(StringArray::from_iter_values(all.iter().map(|s| s.mission.as_str())))),
        ("bus", small(|s| s.bus)),
        ("segment", small(|s| s.segment)),
        ("start_utc", Arc::new(StringArray::from_iter_values(all.iter().map(|s| time(s.start))))),
        ("duration_s", small(|s| s.duration_s)),
        ("passengers", real(|s| Some(s.passengers))),
        ("door_open_fraction", real(|s| Some(s.door_open_fraction))),
        ("distance_m", real(|s| s.distance_m)),
        ("vehicle_power_w", real(|s| s.vehicle_power_w)),
        ("route", Arc::new(all.iter().map(|s| s.route.as_deref()).collect::<StringArray>())),
        ("first_line", whole(|s| s.first_line.cast_signed())),
        ("last_line", whole(|s| s.last_line.cast_signed())),
    ];
    table(columns.into_iter().map(|(name, values)| (name.to_owned(), values)).collect())
}
