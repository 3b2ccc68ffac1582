//! Designs, comfort windows and constants as Python says them, by the rules of a study file.

use pyo3::prelude::*;
use pyo3::types::{PyAny, PyBool, PyDict, PyFloat, PyInt, PyString};
use std::path::Path;
use study::template::{Template, WeatherKeys, render};
use study::{Study, StudyFileError};
use toml::{Table, Value};

use crate::errors::{StudyError, argument};

/// The study of what is given; all else is that of a new study file. `constants` are its tables of numbers, such as `vehicle`.
pub fn study(
    designs: Option<&Bound<'_, PyAny>>,
    windows: Option<&Bound<'_, PyAny>>,
    constants: &[(&str, Option<&Bound<'_, PyAny>>)],
) -> PyResult<Study> {
    parse(&file(designs, windows, constants)?)
}

/// The study file of what is given.
pub fn file(
    designs: Option<&Bound<'_, PyAny>>,
    windows: Option<&Bound<'_, PyAny>>,
    constants: &[(&str, Option<&Bound<'_, PyAny>>)],
) -> PyResult<Table> {
    let new = render(&Template { name: "arguments", note: None, buses: &[], weather: WeatherKeys::MeteoSwissOgd });
    let mut file: Table = new.parse().map_err(|e| argument("designs", e))?;
    for (key, given) in [("designs", designs)].iter().chain(constants) {
        if let Some(given) = given {
            let given = given.cast::<PyDict>().map_err(|_| argument(key, "give a dict, as in a study file"))?;
            file.insert((*key).to_owned(), value(key, given)?);
        }
    }
    if let Some(windows) = windows {
        let given = value("windows", windows)?;
        let Value::Array(list) = &given else {
            return Err(argument(
                "windows",
                "give a list of limits such as [0.5, 1.0], or of pairs such as [[-0.5, 0.7]]",
            ));
        };
        let key = if list.iter().any(Value::is_array) { "windows" } else { "pmv_limits" };
        file.insert("comfort".to_owned(), Value::Table(Table::from_iter([(key.to_owned(), given.clone())])));
    }
    Ok(file)
}

/// The study of a file.
pub fn parse(file: &Table) -> PyResult<Study> {
    let text = toml::to_string(file).map_err(|e| argument("designs", e))?;
    Study::parse(&text, Path::new("arguments")).map_err(|error| {
        // Nobody has written the text, so that a line in it says nothing.
        let message = match error {
            StudyFileError::AtPlace { message, .. } | StudyFileError::Whole { message, .. } => message,
            other => other.to_string(),
        };
        StudyError::new_err(format!("arguments: {message}"))
    })
}

/// A value of Python as one of a study file.
fn value(name: &str, given: &Bound<'_, PyAny>) -> PyResult<Value> {
    if given.is_instance_of::<PyBool>() {
        return Ok(Value::Boolean(given.extract()?));
    }
    if given.is_instance_of::<PyInt>() {
        return Ok(Value::Integer(given.extract()?));
    }
    if given.is_instance_of::<PyFloat>() {
        return Ok(Value::Float(given.extract()?));
    }
    if given.is_instance_of::<PyString>() {
        return Ok(Value::String(given.extract()?));
    }
    if let Ok(table) = given.cast::<PyDict>() {
        let entry = |(key, of): (Bound<'_, PyAny>, Bound<'_, PyAny>)| {
            let key: String = key.extract().map_err(|_| argument(name, "keys are strings"))?;
            let of = value(&format!("{name}.{key}"), &of)?;
            Ok((key, of))
        };
        return table.iter().map(entry).collect::<PyResult<Table>>().map(Value::Table);
    }
    let items = given.try_iter().map_err(|_| argument(name, "give a number, a string, a list or a dict"))?;
    items.map(|item| value(name, &item?)).collect::<PyResult<Vec<Value>>>().map(Value::Array)
}
