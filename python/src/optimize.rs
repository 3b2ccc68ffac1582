//! The cheapest steady-state operation of every sample, design and comfort window.

use ::study::keys;
use arrow_array::{ArrayRef, BooleanArray, Float64Array, Int8Array, Int64Array, RecordBatch, StringArray};
use cabin::{Disturbances, Operation, Optimum, celsius};
use pyo3::prelude::*;
use pyo3::types::PyAny;
use pyo3_arrow::PyTable;
use pyo3_arrow::input::AnyRecordBatch;
use solve::{Grid, solve_blocks};
use std::sync::Arc;

use crate::arrow::{table, whole_numbers};
use crate::samples::disturbances;
use crate::settings::study;

const ARGUMENT: &str = "samples";

/// Samples of a batch, and what they are known by.
struct Samples {
    ids: Option<Int64Array>,
    disturbances: Vec<Disturbances>,
}

/// The cheapest steady-state operation of every sample, design and comfort window: the kernel of `busclimate solve`.
///
/// Parameters
/// ----------
/// samples : Arrow table or batch (pyarrow, polars, pandas, busclimate)
///     Columns ambient_temperature_c (or ambient_temperature_k), dni_w_m2, dhi_w_m2, solar_altitude_deg (or solar_altitude_rad),
///     shadow_fraction (0 sun … 1 shade), passengers, door_open_fraction (0 … 1); sample_id comes along where it is there.
/// designs : dict of dicts, optional
///     The tables `[designs."name"]` of a study file: heating ("ptc" or "hp"), radiant_heaters, air_curtain, heating_cop,
///     cooling_cop, heating_limit_w, cooling_limit_w, limits_are, backup_heater_w. The five of the paper where nothing is given.
/// windows : list, optional
///     Limits of the predicted mean vote, each L the window -L … L, or pairs of a lower and an upper limit. 0 … 2 in steps of
///     0.125 where nothing is given.
/// vehicle : dict, optional
///     Constants of the bus as in `[vehicle]` of a study file; those of the paper where nothing is given.
///
/// Returns
/// -------
/// Table
///     A row for each sample, design and window, in this order, with the columns of the view `optimum` (W, °C) and `sample`, the
///     place of the sample. Where there is no operation, `status` says why and the numbers are null; `limited` is the nearest one
///     that the limits of the design allow.
///
/// Raises
/// ------
/// InputError
///     A column is missing, or a value is missing or outside its range; column, row and range are named.
/// StudyError
///     A design, window or constant is wrong.
#[pyfunction]
#[pyo3(signature = (samples, designs=None, windows=None, *, vehicle=None))]
pub fn optimize(
    py: Python<'_>,
    samples: AnyRecordBatch,
    designs: Option<&Bound<'_, PyAny>>,
    windows: Option<&Bound<'_, PyAny>>,
    vehicle: Option<&Bound<'_, PyAny>>,
) -> PyResult<PyTable> {
    let study = study(designs, windows, &[("vehicle", vehicle)])?;
    let (batches, schema) = samples.into_table()?.into_inner();
    py.detach(|| {
        let mut rows = Rows { has_ids: schema.column_with_name("sample_id").is_some(), ..Rows::default() };
        for batch in &batches {
            let samples = Samples::of(batch, rows.samples)?;
            solve_blocks(&study.vehicle, &study.grid, &samples.disturbances, |first, optima| {
                rows.add(&samples, first, optima, &study.grid);
                true
            });
            rows.samples += samples.disturbances.len();
        }
        rows.table(&study.grid)
    })
}

/// What `optimize` computes with these designs, windows and constants, as a hash: equal keys give equal rows, whatever the machine.
///
/// It holds the version of the method. A cluster compares it, lest workers of another version compute a part.
#[pyfunction]
#[pyo3(signature = (designs=None, windows=None, *, vehicle=None))]
pub fn model_key(
    designs: Option<&Bound<'_, PyAny>>,
    windows: Option<&Bound<'_, PyAny>>,
    vehicle: Option<&Bound<'_, PyAny>>,
) -> PyResult<String> {
    let study = study(designs, windows, &[("vehicle", vehicle)])?;
    let windows = study.grid.windows().iter().map(|w| format!("{} {}", w.pmv_min(), w.pmv_max()));
    let parts: Vec<String> = study.design_rows.iter().map(|row| row.design_key.clone()).chain(windows).collect();
    Ok(keys::hash(&parts.iter().map(String::as_str).collect::<Vec<_>>()))
}

impl Samples {
    fn of(batch: &RecordBatch, before: usize) -> PyResult<Self> {
        let disturbances = disturbances(ARGUMENT, batch, before, true)?;
        Ok(Self { ids: whole_numbers(ARGUMENT, batch, "sample_id")?, disturbances })
    }
}

/// The rows of the result, a column each.
#[derive(Default)]
struct Rows {
    samples: usize,
    has_ids: bool,
    sample: Vec<i64>,
    ids: Vec<Option<i64>>,
    optima: Vec<Optimum>,
}

impl Rows {
    fn add(&mut self, of: &Samples, first: usize, optima: &[Optimum], grid: &Grid) {
        for (n, _) in optima.iter().enumerate() {
            let sample = first + n / grid.points();
            self.sample.push((self.samples + sample) as i64);
            self.ids.push(of.ids.as_ref().map(|ids| ids.value(sample)));
        }
        self.optima.extend_from_slice(optima);
    }

    fn table(&self, grid: &Grid) -> PyResult<PyTable> {
        let optima = || self.optima.iter();
        let windows = || optima().map(|o| grid.windows()[o.window]);
        let operations = || optima().map(|o| o.outcome.operation());
        let real = |of: fn(&Operation) -> f64| -> ArrayRef {
            Arc::new(operations().map(|o| o.map(of)).collect::<Float64Array>())
        };
        let flag = |of: fn(&Operation) -> bool| -> ArrayRef {
            Arc::new(operations().map(|o| o.map(of)).collect::<BooleanArray>())
        };
        let mut columns: Vec<(&str, ArrayRef)> = vec![("sample", Arc::new(Int64Array::from(self.sample.clone())))];
        if self.has_ids {
            columns.push(("sample_id", Arc::new(Int64Array::from(self.ids.clone()))));
        }
        let names = optima().map(|o| grid.designs()[o.design].name.as_str());
        let runner_up = |o: &Optimum| match o.outcome {
            cabin::Outcome::Solved(_, excess_w) => excess_w,
            cabin::Outcome::Infeasible(_) | cabin::Outcome::NotConverged => None,
        };
        columns.extend([
            ("design", Arc::new(StringArray::from_iter_values(names)) as ArrayRef),
            ("pmv_limit", Arc::new(Float64Array::from_iter_values(windows().map(|w| w.pmv_limit())))),
            ("pmv_min", Arc::new(Float64Array::from_iter_values(windows().map(|w| w.pmv_min())))),
            ("pmv_max", Arc::new(Float64Array::from_iter_values(windows().map(|w| w.pmv_max())))),
            ("status", Arc::new(StringArray::from_iter_values(optima().map(|o| o.outcome.words())))),
            ("hvac_power_w", real(Operation::hvac_power_w)),
            ("air_unit_power_w", real(|o| o.air_unit_power_w)),
            ("radiant_heater_power_w", real(|o| o.radiant_heater_power_w)),
            ("air_curtain_power_w", real(|o| o.air_curtain_power_w)),
            ("backup_heater_power_w", real(|o| o.backup_heater_power_w)),
            ("unmet_heat_w", real(|o| o.unmet_heat_w)),
            ("operating_mode", Arc::new(operations().map(|o| o.map(|o| o.mode.number())).collect::<Int8Array>())),
            ("air_curtain_on", flag(|o| o.devices.air_curtain)),
            ("radiant_heaters_on", flag(|o| o.devices.radiant_heaters)),
            ("air_unit_heat_w", real(|o| o.air_unit_heat_w)),
            ("cabin_temperature_c", real(|o| celsius(o.temperatures.cabin_k))),
            ("interior_temperature_c", real(|o| celsius(o.temperatures.interior_k))),
            ("shell_inside_temperature_c", real(|o| celsius(o.temperatures.shell_inside_k))),
            ("shell_outside_temperature_c", real(|o| celsius(o.temperatures.shell_outside_k))),
            ("radiant_heater_temperature_c", real(|o| celsius(o.temperatures.radiant_heater_k))),
            ("mean_radiant_temperature_c", real(|o| celsius(o.mean_radiant_temperature_k))),
            ("pmv", real(|o| o.pmv)),
            ("runner_up_excess_w", Arc::new(optima().map(runner_up).collect::<Float64Array>())),
        ]);
        table(columns.into_iter().map(|(name, values)| (name.to_owned(), values)).collect())
    }
}
