//! Tables of data as CSV.

use csv::Writer;

use crate::ReportError;
use crate::document::DataTable;

/// The table with a header.
pub(crate) fn csv(table: &DataTable) -> Result<Vec<u8>, ReportError> {
    let mut writer = Writer::from_writer(Vec::new());
    writer.write_record(&table.columns)?;
    for row in &table.rows {
        writer.write_record(row)?;
    }
    Ok(writer.into_inner().map_err(|e| csv::Error::from(e.into_error()))?)
}
