//! A mission second by second, with the operation that the optima prescribe.

use ::simulate::{Mission, Replay, Segment, Summary, Variant, simulate_distinct};
use arrow_array::{ArrayRef, Float64Array, Int64Array, StringArray};
use cabin::{Cabin, Disturbances, LoadChange, Operation, Optimum, PassengerViews};
use pyo3::prelude::*;
use pyo3::types::PyAny;
use pyo3_arrow::PyTable;
use pyo3_arrow::input::AnyRecordBatch;
use rayon::prelude::*;
use solve::SampleSolver;
use std::sync::Arc;
use study::Study;

use crate::arrow::table;
use crate::errors::{InputError, argument, data};
use crate::samples::{column, disturbances};
use crate::settings;

/// Simulates a mission second by second in every design, comfort window and way to drive: the kernel of `busclimate simulate`.
///
/// The optima of `samples` prescribe what the air unit does; each of the four ways ("paper", "warm-start", "unlimited",
/// "free-mode") takes one habit of the paper's validation away.
///
/// Parameters
/// ----------
/// samples : Arrow table
///     The mean disturbances of each segment of the mission, in their order, with the columns of `optimize`.
/// minutes : Arrow table
///     Weather and shade in the middle of each minute, up to the end of the last segment: the same columns, but for passengers and
///     door_open_fraction.
/// loads : Arrow table
///     What changes from a second on: second (from the start of the first segment, rising), passengers, door_open (1 while a door is
///     open, 0 while none is).
/// designs, windows, vehicle :
///     As in `optimize`.
/// dynamics : dict, optional
///     Heat capacities, controllers and power limits as in `[dynamics]` of a study file; those of the paper where nothing is given.
/// segment_s : length of a segment in s; a multiple of 60 where there is more than one
/// door_open_share : share of the doors that open when a door is open, 0 … 1
///
/// Returns
/// -------
/// Table
///     A row for each design, window and way to drive with the columns of the view `simulation`, and `status`: "simulated", or which
///     segment has no optimum and why; the numbers are then null.
///
/// Raises
/// ------
/// InputError
///     A column or value is missing or outside its range, or the minutes end too early.
/// StudyError
///     A design, window or constant is wrong.
#[pyfunction]
#[pyo3(signature = (samples, minutes, loads, designs=None, windows=None, *, segment_s=3600, door_open_share=0.6, vehicle=None, dynamics=None))]
#[expect(clippy::too_many_arguments, reason = "Python names them")]
pub fn simulate(
    py: Python<'_>,
    samples: AnyRecordBatch,
    minutes: AnyRecordBatch,
    loads: AnyRecordBatch,
    designs: Option<&Bound<'_, PyAny>>,
    windows: Option<&Bound<'_, PyAny>>,
    segment_s: u32,
    door_open_share: f64,
    vehicle: Option<&Bound<'_, PyAny>>,
    dynamics: Option<&Bound<'_, PyAny>>,
) -> PyResult<PyTable> {
    let study = settings::study(designs, windows, &[("vehicle", vehicle), ("dynamics", dynamics)])?;
    let samples = rows("samples", samples, true)?;
    let minutes = rows("minutes", minutes, false)?;
    let loads = load_changes(loads)?;
    if samples.is_empty() {
        return Err(data("samples", "there is none; give a row for each segment"));
    }
    if segment_s == 0 || samples.len() > 1 && !segment_s.is_multiple_of(60) {
        return Err(argument("segment_s", format!("is {segment_s}; give a multiple of 60")));
    }
    if !(0.0..=1.0).contains(&door_open_share) {
        return Err(argument("door_open_share", format!("is {door_open_share}, outside 0 … 1")));
    }
    let needed = (samples.len() * segment_s as usize).div_ceil(60);
    if minutes.len() < needed {
        return Err(data("minutes", format!("there are {}, and {needed} minutes of mission", minutes.len())));
    }
    py.detach(|| {
        let views = PassengerViews::new(&study.vehicle);
        let cabin = |d: &Disturbances| Cabin::new(&study.vehicle, &views, d);
        let minutes: Vec<Cabin<'_>> = minutes.iter().map(cabin).collect();
        let segments: Vec<Cabin<'_>> = samples.iter().map(cabin).collect();
        let mission = Mission { loads: &loads, minutes: &minutes, segments: samples.len(), segment_s, door_open_share };
        driven(&study, &mission, &segments, &optima(&study, &views, &samples))
    })
}

fn rows(argument: &str, table: AnyRecordBatch, loads: bool) -> PyResult<Vec<Disturbances>> {
    let mut all = Vec::new();
    for batch in table.into_table()?.into_inner().0 {
        all.extend(disturbances(argument, &batch, all.len(), loads)?);
    }
    Ok(all)
}

fn load_changes(table: AnyRecordBatch) -> PyResult<Vec<LoadChange>> {
    let mut all: Vec<LoadChange> = Vec::new();
    for batch in table.into_table()?.into_inner().0 {
        let [seconds, passengers, doors] =
            ["second", "passengers", "door_open"].map(|name| column("loads", &batch, name));
        let (seconds, passengers, doors) = (seconds?, passengers?, doors?);
        for i in 0..batch.num_rows() {
            let (second, on_board, door_open) = (seconds.value(i), passengers.value(i), doors.value(i));
            let whole = second.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(&second);
            let rises = all.last().is_none_or(|last| second > f64::from(last.second));
            if !(whole && rises && (0.0..=1.0).contains(&door_open) && (0.0..=f64::MAX).contains(&on_board)) {
                let what = "second is whole and rises, passengers are 0 or more, door_open is 0 … 1";
                return Err(data("loads", format!("row {}: {second}, {on_board}, {door_open}; {what}", all.len())));
            }
            all.push(LoadChange { second: second as u32, passengers: on_board, door_open });
        }
    }
    Ok(all)
}

/// The optima of all segments, by design and window, or which segment has none.
fn optima(study: &Study, views: &PassengerViews, samples: &[Disturbances]) -> Vec<Result<Vec<Operation>, String>> {
    let grid = &study.grid;
    let mut solver = SampleSolver::new(&study.vehicle, views, grid);
    let mut found: Vec<Result<Vec<Operation>, String>> = vec![Ok(Vec::new()); grid.points()];
    let mut of_sample = vec![Optimum::UNSOLVED; grid.points()];
    for (segment, sample) in samples.iter().enumerate() {
        solver.solve(sample, &mut of_sample);
        for (found, optimum) in found.iter_mut().zip(&of_sample) {
            match (&mut *found, optimum.outcome.operation()) {
                (Ok(operations), Some(operation)) => operations.push(*operation),
                (Ok(_), None) => *found = Err(format!("segment {segment} has no optimum: {}", optimum.outcome.words())),
                (Err(_), _) => {}
            }
        }
    }
    found
}

fn driven(
    study: &Study,
    mission: &Mission<'_, '_>,
    cabins: &[Cabin<'_>],
    optima: &[Result<Vec<Operation>, String>],
) -> PyResult<PyTable> {
    let windows = study.grid.windows();
    let of_point = |(point, optima): (usize, &Result<Vec<Operation>, String>)| -> Option<Vec<Segment>> {
        let segment = |(cabin, optimum)| Segment::new(cabin, optimum, windows[point % windows.len()]);
        Some(cabins.iter().zip(optima.as_ref().ok()?).map(segment).collect())
    };
    let segments: Vec<Option<Vec<Segment>>> = optima.par_iter().enumerate().map(of_point).collect();
    let mut variants: Vec<Variant<'_>> = Vec::new();
    for (point, segments) in segments.iter().enumerate() {
        let design = &study.grid.designs()[point / windows.len()];
        variants.extend(segments.iter().flat_map(|segments| Replay::ALL.map(|replay| replay.of(design, segments))));
    }
    let summaries = simulate_distinct(mission, &study.dynamics, &variants);
    let summaries = summaries.ok_or_else(|| InputError::new_err("minutes: they end before the last segment"))?;
    let mut summaries = summaries.into_iter();
    let mut rows: Vec<(usize, Replay, Result<Summary, &String>)> = Vec::new();
    for (point, optima) in optima.iter().enumerate() {
        for replay in Replay::ALL {
            let result = match optima {
                Ok(_) => Ok(summaries.next().ok_or_else(|| InputError::new_err("a variant was not simulated"))?),
                Err(reason) => Err(reason),
            };
            rows.push((point, replay, result));
        }
    }
    summary_table(study, &rows)
}

fn summary_table(study: &Study, rows: &[(usize, Replay, Result<Summary, &String>)]) -> PyResult<PyTable> {
    let windows = study.grid.windows();
    let designs = rows.iter().map(|(point, ..)| study.grid.designs()[point / windows.len()].name.as_str());
    let window = |of: fn(&cabin::ComfortWindow) -> f64| -> ArrayRef {
        Arc::new(Float64Array::from_iter_values(rows.iter().map(|(point, ..)| of(&windows[point % windows.len()]))))
    };
    let real = |of: fn(&Summary) -> Option<f64>| -> ArrayRef {
        Arc::new(rows.iter().map(|row| row.2.as_ref().ok().and_then(of)).collect::<Float64Array>())
    };
    let status = rows.iter().map(|row| row.2.as_ref().map_or_else(|reason| reason.as_str(), |_| "simulated"));
    let seconds = rows.iter().map(|row| row.2.as_ref().ok().map(|s| i64::from(s.seconds)));
    let columns: Vec<(&str, ArrayRef)> = vec![
        ("design", Arc::new(StringArray::from_iter_values(designs))),
        ("pmv_limit", window(|w| w.pmv_limit())),
        ("pmv_min", window(|w| w.pmv_min())),
        ("pmv_max", window(|w| w.pmv_max())),
        ("controller", Arc::new(StringArray::from_iter_values(rows.iter().map(|row| row.1.name)))),
        ("status", Arc::new(StringArray::from_iter_values(status))),
        ("mean_hvac_power_w", real(|s| Some(s.mean_hvac_power_w))),
        ("static_mean_hvac_power_w", real(|s| Some(s.static_mean_hvac_power_w))),
        ("max_abs_pmv_15min", real(|s| s.max_abs_pmv_15min)),
        ("static_max_abs_pmv", real(|s| Some(s.static_max_abs_pmv))),
        ("saturated_fraction", real(|s| Some(s.saturated_fraction))),
        ("tracking_error_k", real(|s| Some(s.tracking_error_k))),
        ("seconds", Arc::new(seconds.collect::<Int64Array>())),
    ];
    table(columns.into_iter().map(|(name, values)| (name.to_owned(), values)).collect())
}
