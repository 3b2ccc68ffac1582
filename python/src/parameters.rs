//! Many buses with other constants, of which only the year is kept.

use arrow_array::{ArrayRef, Float64Array, Int64Array, RecordBatch, StringArray};
use pyo3::prelude::*;
use pyo3::types::PyAny;
use pyo3_arrow::PyTable;
use pyo3_arrow::input::AnyRecordBatch;
use rayon::prelude::*;
use solve::{AnnualMean, YearSamples};
use std::sync::Arc;
use study::Study;
use toml::{Table, Value};

use crate::arrow::{table, whole_numbers};
use crate::errors::{argument, data};
use crate::samples::{column, disturbances};
use crate::settings;

/// Column by which sets are known.
const ID: &str = "set_id";

/// A set of constants, with what it is known by.
struct Set {
    id: i64,
    file: Table,
}

/// Annual means of buses with other constants: a parameter study that keeps nothing but the year of each set.
///
/// Every set solves all samples in every design and window and adds up the year (months by their days, within one all solved samples
/// alike). A set depends on its own constants alone: neither threads nor other sets change a bit of it.
///
/// Parameters
/// ----------
/// sets : Arrow table
///     A row for each set: set_id (whole numbers) and columns named like keys of `[vehicle]` in a study file, such as
///     shell_area_m2; what has no column is as in `vehicle`.
/// samples : Arrow table
///     The columns of `optimize`, and month (1 … 12).
/// designs, windows, vehicle :
///     As in `optimize`.
///
/// Returns
/// -------
/// Table
///     A row for each set, design and window: set_id, design, pmv_limit, pmv_min, pmv_max, status, hvac_power_w, heating_power_w,
///     cooling_power_w (annual means in W), sample_count, unsolved_count, limited_count (samples that miss
///     the window for want of power). A set with a constant outside its range gives rows without
///     numbers, whose status says what is wrong.
///
/// Raises
/// ------
/// InputError
///     A column is missing, or a value is missing or no number.
/// StudyError
///     A design or window is wrong, or a column of `sets` is no constant of the bus.
#[pyfunction]
#[pyo3(signature = (sets, samples, designs=None, windows=None, *, vehicle=None))]
pub fn parameter_study(
    py: Python<'_>,
    sets: AnyRecordBatch,
    samples: AnyRecordBatch,
    designs: Option<&Bound<'_, PyAny>>,
    windows: Option<&Bound<'_, PyAny>>,
    vehicle: Option<&Bound<'_, PyAny>>,
) -> PyResult<PyTable> {
    let file = settings::file(designs, windows, &[("vehicle", vehicle)])?;
    let base = settings::parse(&file)?;
    let year = year(samples)?;
    let constants = Table::try_from(&base.vehicle).map_err(|e| argument("vehicle", e))?;
    let sets = read(sets, &file, &constants.keys().map(String::as_str).collect::<Vec<_>>())?;
    py.detach(|| {
        let run = |set: &Set| match settings::parse(&set.file) {
            Ok(study) => Ok(year.means(&study.vehicle, &study.grid)),
            Err(error) => Err(error.to_string()),
        };
        let results: Vec<Result<Vec<AnnualMean>, String>> = sets.par_iter().map(run).collect();
        means(&base, &sets, &results)
    })
}

pub fn year(samples: AnyRecordBatch) -> PyResult<YearSamples> {
    let (mut year, mut before) = (YearSamples::default(), 0);
    for batch in samples.into_table()?.into_inner().0 {
        let months = column("samples", &batch, "month")?;
        let all = disturbances("samples", &batch, before, true)?;
        for (i, (sample, month)) in all.iter().zip(months.values()).enumerate() {
            // What is no month is 0, which is none either.
            if !year.add(*month as u8, *sample) || month.fract() != 0.0 {
                return Err(data("samples", format!("row {}: month is {month}, outside 1 … 12", before + i)));
            }
        }
        before += all.len();
    }
    Ok(year)
}

fn read(sets: AnyRecordBatch, file: &Table, known: &[&str]) -> PyResult<Vec<Set>> {
    let mut all = Vec::new();
    for batch in sets.into_table()?.into_inner().0 {
        let missing = || data("sets", format!("column {ID} is missing"));
        let ids = whole_numbers("sets", &batch, ID)?.ok_or_else(missing)?;
        let constants = constants(&batch, known)?;
        for row in 0..batch.num_rows() {
            let mut file = file.clone();
            let vehicle = file.entry("vehicle").or_insert_with(|| Value::Table(Table::new()));
            let Value::Table(vehicle) = vehicle else {
                return Err(argument("vehicle", "give a dict, as in a study file"));
            };
            for (name, values) in &constants {
                vehicle.insert(name.clone(), Value::Float(values.value(row)));
            }
            all.push(Set { id: ids.value(row), file });
        }
    }
    Ok(all)
}

/// The columns of a batch that are constants of the bus.
fn constants(batch: &RecordBatch, known: &[&str]) -> PyResult<Vec<(String, Float64Array)>> {
    let schema = batch.schema();
    let names = schema.fields().iter().map(|field| field.name().clone()).filter(|name| name != ID);
    let constant = |name: String| {
        if !known.contains(&name.as_str()) {
            let what = format!("{name} is no constant of the bus; there are {}", known.join(", "));
            return Err(argument("sets", what));
        }
        column("sets", batch, &name).map(|values| (name, values))
    };
    names.map(constant).collect()
}

fn means(base: &Study, sets: &[Set], results: &[Result<Vec<AnnualMean>, String>]) -> PyResult<PyTable> {
    let (grid, points) = (&base.grid, base.grid.points());
    let windows = grid.windows();
    let rows: Vec<(&Set, usize, Result<AnnualMean, &str>)> = sets
        .iter()
        .zip(results)
        .flat_map(|(set, result)| {
            (0..points).map(move |point| (set, point, result.as_ref().map(|of| of[point]).map_err(String::as_str)))
        })
        .collect();
    let window = |of: fn(&cabin::ComfortWindow) -> f64| -> ArrayRef {
        Arc::new(Float64Array::from_iter_values(rows.iter().map(|row| of(&windows[row.1 % windows.len()]))))
    };
    let real = |of: fn(&AnnualMean) -> Option<f64>| -> ArrayRef {
        Arc::new(rows.iter().map(|row| row.2.as_ref().ok().and_then(of)).collect::<Float64Array>())
    };
    let whole = |of: fn(&AnnualMean) -> u64| -> ArrayRef {
        Arc::new(rows.iter().map(|row| row.2.as_ref().ok().map(|m| of(m).cast_signed())).collect::<Int64Array>())
    };
    let designs = rows.iter().map(|row| grid.designs()[row.1 / windows.len()].name.as_str());
    let columns: Vec<(&str, ArrayRef)> = vec![
        (ID, Arc::new(Int64Array::from_iter_values(rows.iter().map(|row| row.0.id)))),
        ("design", Arc::new(StringArray::from_iter_values(designs))),
        ("pmv_limit", window(|w| w.pmv_limit())),
        ("pmv_min", window(|w| w.pmv_min())),
        ("pmv_max", window(|w| w.pmv_max())),
        (
            "status",
            Arc::new(StringArray::from_iter_values(
                rows.iter().map(|row| row.2.as_ref().map_or_else(|e| *e, |_| "computed")),
            )),
        ),
        ("hvac_power_w", real(|m| m.hvac_power_w)),
        ("heating_power_w", real(|m| m.heating_power_w)),
        ("cooling_power_w", real(|m| m.cooling_power_w)),
        ("sample_count", whole(|m| m.samples)),
        ("unsolved_count", whole(|m| m.unsolved)),
        ("limited_count", whole(|m| m.limited)),
    ];
    table(columns.into_iter().map(|(name, values)| (name.to_owned(), values)).collect())
}
