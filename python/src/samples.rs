//! Disturbances as columns of Arrow data.

use arrow_array::{Float64Array, RecordBatch};
use cabin::{Disturbances, kelvin};
use pyo3::PyResult;

use crate::arrow::numbers;
use crate::errors::data;

/// The disturbances of a batch of `argument`, which follows so many rows of others. Without `loads` nobody is on board and doors are
/// shut.
pub fn disturbances(argument: &str, batch: &RecordBatch, before: usize, loads: bool) -> PyResult<Vec<Disturbances>> {
    // Either unit; that of the model has its own bits.
    let either = |model: &str, other: &str, convert: fn(f64) -> f64| match numbers(argument, batch, model)? {
        Some(values) => Ok(values),
        None => column(argument, batch, other)
            .map(|values| Float64Array::from_iter_values(values.values().iter().map(|v| convert(*v)))),
    };
    let ambient_k = either("ambient_temperature_k", "ambient_temperature_c", kelvin)?;
    let altitude_rad = either("solar_altitude_rad", "solar_altitude_deg", f64::to_radians)?;
    let column = |name: &str| column(argument, batch, name);
    let (dni, dhi, shadow) = (column("dni_w_m2")?, column("dhi_w_m2")?, column("shadow_fraction")?);
    let load = |name: &str| loads.then(|| column(name)).transpose();
    let (passengers, doors) = (load("passengers")?, load("door_open_fraction")?);
    let of = |i: usize| Disturbances {
        ambient_temperature_k: ambient_k.value(i),
        dni_w_m2: dni.value(i),
        dhi_w_m2: dhi.value(i),
        solar_altitude_rad: altitude_rad.value(i),
        shadow_fraction: shadow.value(i),
        passengers: passengers.as_ref().map_or(0.0, |p| p.value(i)),
        door_open_fraction: doors.as_ref().map_or(0.0, |d| d.value(i)),
    };
    let disturbances: Vec<Disturbances> = (0..batch.num_rows()).map(of).collect();
    for (i, d) in disturbances.iter().enumerate() {
        d.check().map_err(|e| data(argument, format!("row {}: {e}", before + i)))?;
    }
    Ok(disturbances)
}

/// A column of numbers that must be there.
pub fn column(argument: &str, batch: &RecordBatch, name: &str) -> PyResult<Float64Array> {
    let missing = || {
        let has: Vec<String> = batch.schema().fields().iter().map(|field| field.name().clone()).collect();
        data(argument, format!("column {name} is missing; there are {}", has.join(", ")))
    };
    numbers(argument, batch, name)?.ok_or_else(missing)
}
