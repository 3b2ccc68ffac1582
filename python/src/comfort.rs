//! Thermal comfort after ISO 7730.

use arrow_array::Float64Array;
use cabin::PmvModel;
use pyo3::prelude::*;
use pyo3::types::PyAny;
use pyo3_arrow::PyArray;
use rayon::prelude::*;
use std::sync::Arc;

use crate::arrow::floats;
use crate::errors::data;

/// Votes that one task computes.
const BLOCK: usize = 4096;

/// Values of an argument: one for all, or one for each vote.
enum Values {
    One(f64),
    Each(Float64Array),
}

impl Values {
    fn of(name: &str, given: &Bound<'_, PyAny>) -> PyResult<Self> {
        if let Ok(one) = given.extract::<f64>() {
            return Ok(Self::One(one));
        }
        let array: PyArray = given
            .extract()
            .map_err(|e| data(name, format!("give a number or an Arrow array such as pyarrow.array(values): {e}")))?;
        floats(name, array.array()).map(Self::Each)
    }

    fn len(&self) -> Option<usize> {
        match self {
            Self::One(_) => None,
            Self::Each(values) => Some(values.len()),
        }
    }

    fn at(&self, place: usize) -> f64 {
        match self {
            Self::One(one) => *one,
            Self::Each(values) => values.value(place),
        }
    }
}

/// Predicted mean vote of ISO 7730, from -3 (cold) to 3 (hot).
///
/// Every argument is a number, which holds for all votes, or an Arrow array with a value for each.
///
/// Parameters
/// ----------
/// air_temperature_c, mean_radiant_temperature_c : °C
/// clothing_clo : clo, 0 … 5
/// metabolic_met : met, 0.5 … 6
/// relative_humidity : 0 … 1
/// air_velocity_m_s : m/s relative to the body, 0 … 5
///
/// Returns
/// -------
/// Arrow array of the votes; one where all arguments are numbers.
///
/// Raises
/// ------
/// InputError
///     A value is missing or outside its range, or arrays have different lengths.
#[pyfunction]
#[pyo3(signature = (air_temperature_c, mean_radiant_temperature_c, *, clothing_clo, metabolic_met, relative_humidity, air_velocity_m_s))]
pub fn pmv(
    py: Python<'_>,
    air_temperature_c: &Bound<'_, PyAny>,
    mean_radiant_temperature_c: &Bound<'_, PyAny>,
    clothing_clo: &Bound<'_, PyAny>,
    metabolic_met: &Bound<'_, PyAny>,
    relative_humidity: &Bound<'_, PyAny>,
    air_velocity_m_s: &Bound<'_, PyAny>,
) -> PyResult<PyArray> {
    let named = [
        ("air_temperature_c", air_temperature_c, -50.0..=80.0),
        ("mean_radiant_temperature_c", mean_radiant_temperature_c, -100.0..=200.0),
        ("clothing_clo", clothing_clo, 0.0..=5.0),
        ("metabolic_met", metabolic_met, 0.5..=6.0),
        ("relative_humidity", relative_humidity, 0.0..=1.0),
        ("air_velocity_m_s", air_velocity_m_s, 0.0..=5.0),
    ];
    let mut values = Vec::with_capacity(named.len());
    for (name, given, range) in named {
        let of = Values::of(name, given)?;
        let wrong = (0..of.len().unwrap_or(1)).find(|i| !range.contains(&of.at(*i)));
        if let Some(i) = wrong {
            let (low, high) = (range.start(), range.end());
            return Err(data(name, format!("value {i} is {}, outside {low} … {high}", of.at(i))));
        }
        values.push((name, of));
    }
    let lengths = || values.iter().filter_map(|(name, of)| Some((*name, of.len()?)));
    let count = lengths().map(|(_, n)| n).max().unwrap_or(1);
    if let Some((name, n)) = lengths().find(|(_, n)| *n != count) {
        return Err(data(name, format!("has {n} values where another argument has {count}")));
    }
    let at = |i: usize| {
        let [air, radiant, clo, met, humidity, speed] = [0, 1, 2, 3, 4, 5].map(|k| values[k].1.at(i));
        PmvModel::new(clo, met, humidity, speed).at(air, radiant).pmv
    };
    let votes: Vec<f64> = py.detach(|| (0..count).into_par_iter().with_min_len(BLOCK).map(at).collect());
    Ok(PyArray::from_array_ref(Arc::new(Float64Array::from(votes))))
}
