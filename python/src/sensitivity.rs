//! What the year of a bus depends on.

use ::sensitivity::{Analysis, AnalysisError, Input, Quantified, RESAMPLES, Resamples, Saltelli, Swing};
use arrow_array::{ArrayRef, Float64Array, Int64Array, StringArray};
use pyo3::prelude::*;
use pyo3::types::PyAny;
use pyo3_arrow::PyTable;
use pyo3_arrow::input::AnyRecordBatch;
use solve::Grid;
use std::sync::Arc;
use store::DesignRow;
use study::Study;
use toml::{Table, Value};

use crate::arrow::table;
use crate::errors::{argument, data};
use crate::parameters::year;
use crate::settings;

/// What the annual figures depend on: each input at its low and its high value, and Sobol' indices of all together.
///
/// Parameters
/// ----------
/// samples : Arrow table
///     The columns of `optimize`, and month (1 … 12).
/// inputs : dict, optional
///     Names of inputs with [low, high], {"mean": …, "sd": …} or {"low": …, "mode": …, "high": …}, as in the section
///     `[sensitivity.inputs]` of a study file: keys of `[vehicle]`, heating_cop_scale, heating_cop_shift, cooling_cop_scale,
///     cooling_cop_shift, ambient_offset_k, shade_scale, passengers_scale, door_open_scale. Without: fourteen of them within ±20 %.
/// designs, vehicle :
///     As in `optimize`.
/// pmv_limit : float
///     The comfort window is ± this vote.
/// points : int
///     Base points of Saltelli's design; points × (inputs + 2) years are solved.
/// seed : int
///     Seed of points and intervals.
///
/// Returns
/// -------
/// tuple of Table
///     Swings: design, quantity, input, input_low, input_high, base_value, low_value, high_value. Indices: design, quantity, input,
///     first_order, total_order, each with _low and _high (90 %). Sets: set_id, a column for each input, then one for each
///     design and quantity, in the order of SALib. Powers are in W, reduction is the fraction saved against the first plain
///     design with resistive heating.
///
/// Raises
/// ------
/// InputError
///     A column is missing, or a value is missing or no number.
/// StudyError
///     A design or an input is wrong, or a set has no result.
#[pyfunction]
#[pyo3(signature = (samples, inputs=None, designs=None, *, pmv_limit=1.0, points=256, seed=1, vehicle=None))]
#[expect(clippy::too_many_arguments, reason = "they are those of Python")]
pub fn sensitivity(
    py: Python<'_>,
    samples: AnyRecordBatch,
    inputs: Option<&Bound<'_, PyAny>>,
    designs: Option<&Bound<'_, PyAny>>,
    pmv_limit: f64,
    points: u32,
    seed: u32,
    vehicle: Option<&Bound<'_, PyAny>>,
) -> PyResult<(PyTable, PyTable, PyTable)> {
    let mut file = settings::file(designs, None, &[("vehicle", vehicle), ("inputs", inputs)])?;
    let mut asked = Table::from_iter([
        ("pmv_limit".to_owned(), Value::Float(pmv_limit)),
        ("points".to_owned(), Value::Integer(points.into())),
        ("seed".to_owned(), Value::Integer(seed.into())),
    ]);
    asked.extend(file.remove("inputs").map(|inputs| ("inputs".to_owned(), inputs)));
    file.insert("sensitivity".to_owned(), Value::Table(asked));
    let study = settings::parse(&file)?;
    let year = year(samples)?;
    py.detach(|| {
        let asked = &study.sensitivity;
        let grid = Grid::new(study.grid.designs().to_vec(), vec![asked.window]).map_err(|e| argument("designs", e))?;
        let reference = study.design_rows.iter().position(DesignRow::is_plain_resistive);
        let analysis = Analysis::new(&year, &study.vehicle, &grid, reference);
        let failed = |error: AnalysisError| argument("inputs", error);
        let (base, swings) = analysis.one_at_a_time(&asked.inputs).map_err(failed)?;
        if base.iter().all(Option::is_none) {
            return Err(data("samples", "no sample has an operation"));
        }
        let design = Saltelli { points: asked.points, inputs: asked.inputs.len(), seed: asked.seed };
        let solved = analysis.solve(&asked.inputs, &design, |_| true).map_err(failed)?;
        let resamples = Resamples::new(asked.points, RESAMPLES, asked.seed.into());
        let names = Names { study: &study, results: analysis.results(), inputs: &asked.inputs };
        let indices = analysis.spreadings(&design, &solved, &resamples);
        let of_indices = indices.iter().flat_map(|s| {
            let of = s.indices.iter().flatten().enumerate();
            of.map(|(input, index)| {
                let [first, total] = [(index.first, index.first_ends), (index.total, index.total_ends)];
                (s.result, input, [first.0, first.1[0], first.1[1], total.0, total.1[0], total.1[1]])
            })
        });
        Ok((names.swings(&base, &swings)?, names.indices(of_indices.collect())?, names.sets(&design, &solved.values)?))
    })
}

/// What results and inputs are called.
struct Names<'n> {
    study: &'n Study,
    results: &'n [Quantified],
    inputs: &'n [Input],
}

impl Names<'_> {
    fn design(&self, result: usize) -> &str {
        &self.study.design_rows[self.results[result].design].name
    }

    /// The columns that say of what a row is.
    fn of(&self, rows: &[(usize, usize)]) -> Vec<(String, ArrayRef)> {
        let words = |word: &dyn Fn(&(usize, usize)) -> String| -> ArrayRef {
            Arc::new(StringArray::from_iter_values(rows.iter().map(word)))
        };
        vec![
            ("design".to_owned(), words(&|row| self.design(row.0).to_owned())),
            ("quantity".to_owned(), words(&|row| self.results[row.0].quantity.name().to_owned())),
            ("input".to_owned(), words(&|row| self.inputs[row.1].name.clone())),
        ]
    }

    fn swings(&self, base: &[Option<f64>], swings: &[Swing]) -> PyResult<PyTable> {
        let mut columns = self.of(&swings.iter().map(|s| (s.result, s.input)).collect::<Vec<_>>());
        let mut add = |name: &str, of: &dyn Fn(&Swing) -> Option<f64>| {
            columns.push((name.to_owned(), Arc::new(swings.iter().map(of).collect::<Float64Array>())));
        };
        add("input_low", &|s| Some(s.values[0]));
        add("input_high", &|s| Some(s.values[1]));
        add("base_value", &|s| base[s.result]);
        add("low_value", &|s| s.results[0]);
        add("high_value", &|s| s.results[1]);
        table(columns)
    }

    fn indices(&self, rows: Vec<(usize, usize, [f64; 6])>) -> PyResult<PyTable> {
        let mut columns = self.of(&rows.iter().map(|row| (row.0, row.1)).collect::<Vec<_>>());
        let names = [
            "first_order",
            "first_order_low",
            "first_order_high",
            "total_order",
            "total_order_low",
            "total_order_high",
        ];
        for (place, name) in names.into_iter().enumerate() {
            let values = rows.iter().map(|row| row.2[place]);
            columns.push((name.to_owned(), Arc::new(Float64Array::from_iter_values(values))));
        }
        table(columns)
    }

    fn sets(&self, design: &Saltelli, values: &[Vec<f64>]) -> PyResult<PyTable> {
        let ids = (0..).take(values.len());
        let mut columns: Vec<(String, ArrayRef)> =
            vec![("set_id".to_owned(), Arc::new(Int64Array::from_iter_values(ids)))];
        let inputs: Vec<Vec<f64>> = (0..design.sets())
            .map(|set| self.inputs.iter().zip(design.set(set)).map(|(i, share)| i.spread.quantile(share)).collect())
            .collect();
        for (place, input) in self.inputs.iter().enumerate() {
            let values = inputs.iter().map(|of_set| of_set[place]);
            columns.push((input.name.clone(), Arc::new(Float64Array::from_iter_values(values))));
        }
        for (place, result) in self.results.iter().enumerate() {
            let name = format!("{} {}", self.design(place), result.quantity.name());
            let values = values.iter().map(|of_set| of_set[place]);
            columns.push((name, Arc::new(Float64Array::from_iter_values(values))));
        }
        table(columns)
    }
}
