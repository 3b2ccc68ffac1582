//! Columns in, tables out.

use arrow_array::{Array, ArrayRef, Float64Array, Int64Array, RecordBatch};
use arrow_cast::cast;
use arrow_schema::{DataType, Field, Schema};
use pyo3::PyResult;
use pyo3_arrow::PyTable;
use std::sync::Arc;

use crate::errors::data;

/// A column of numbers; every value must be there. `None` where the data has no such column.
pub fn numbers(argument: &str, batch: &RecordBatch, column: &str) -> PyResult<Option<Float64Array>> {
    batch.column_by_name(column).map(|values| floats(&format!("{argument}: column {column}"), values)).transpose()
}

/// Numbers of any kind as floating ones; those that already are come without a copy.
pub fn floats(what: &str, values: &ArrayRef) -> PyResult<Float64Array> {
    if let Some(row) = (0..values.len()).find(|row| values.is_null(*row)) {
        return Err(data(what, format!("row {row} has no value; fill it or leave the row out")));
    }
    let values = cast(values, &DataType::Float64).map_err(|e| data(what, format!("these are no numbers: {e}")))?;
    let floats = values.as_any().downcast_ref::<Float64Array>();
    floats.cloned().ok_or_else(|| data(what, "these are no numbers"))
}

/// A column of whole numbers, such as ids; every value must be there. `None` where the data has no such column.
pub fn whole_numbers(argument: &str, batch: &RecordBatch, column: &str) -> PyResult<Option<Int64Array>> {
    /// Up to here every whole number has a floating one of its own.
    const LARGEST: f64 = (1_u64 << 53) as f64;
    let Some(values) = batch.column_by_name(column) else { return Ok(None) };
    let what = format!("{argument}: column {column}");
    if values.data_type().is_integer() && values.null_count() == 0 {
        let whole = cast(values, &DataType::Int64).map_err(|e| data(&what, e))?;
        if let Some(whole) = whole.as_any().downcast_ref::<Int64Array>().filter(|whole| whole.null_count() == 0) {
            return Ok(Some(whole.clone()));
        }
    }
    let values = floats(&what, values)?;
    let whole = |(row, value): (usize, &f64)| match value.fract() == 0.0 && value.abs() <= LARGEST {
        true => Ok(*value as i64),
        false => Err(data(&what, format!("row {row}: {value} is no whole number"))),
    };
    values.values().iter().enumerate().map(whole).collect::<PyResult<Vec<i64>>>().map(|ids| Some(ids.into()))
}

/// A table of columns with their names.
pub fn table(columns: Vec<(String, ArrayRef)>) -> PyResult<PyTable> {
    let batch = batch(columns)?;
    let schema = batch.schema();
    PyTable::try_new(vec![batch], schema)
}

/// Some rows of a table.
pub fn batch(columns: Vec<(String, ArrayRef)>) -> PyResult<RecordBatch> {
    let field = |(name, values): &(String, ArrayRef)| Field::new(name, values.data_type().clone(), true);
    let schema = Arc::new(Schema::new(columns.iter().map(field).collect::<Vec<_>>()));
    let values = columns.into_iter().map(|(_, values)| values).collect();
    RecordBatch::try_new(schema, values).map_err(|e| data("table", e))
}
