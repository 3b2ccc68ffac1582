//! Columns in, tables out.

use arrow_array::{Array, ArrayRef, Float64Array, RecordBatch};
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
