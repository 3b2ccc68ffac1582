//! Tables as Parquet or CSV: a folder a table, within it one a design, one schema whatever the rows.

use polars::io::csv::write::BatchedWriter as CsvBatches;
use polars::io::parquet::write::BatchedWriter as ParquetBatches;
use polars::prelude::{
    Column, CompatLevel, CsvWriter, DataFrame, DataType, Field, KeyValueMetadata, NamedFrom, ParquetWriter,
    PolarsResult, Schema, SerWriter, Series,
};
use polars_arrow::datatypes::{ArrowSchema, Metadata};
use polars_parquet::write::schema_to_metadata_key;
use std::fs::File;
use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;
use store::{ColumnKind, Relation, Store, Values};

use crate::{ExportError, Format, PACKAGE, Provenance, make_folder_of, package, words, write_synced};

/// Rows of a portion, and of a row group.
const PORTION: usize = 65_536;
/// The column that becomes a folder.
const DESIGN: &str = "design";

/// A file of an export, as its package names it.
pub(crate) struct Written {
    pub relation: usize,
    pub path: String,
}

/// Writes all tables and views that others build on into an empty folder, and `datapackage.json`, which describes them.
///
/// # Errors
/// [`ExportError`].
pub fn tables(
    store: &mut Store,
    relations: &[Relation],
    format: Format,
    provenance: &Provenance,
    folder: &Path,
) -> Result<(), ExportError> {
    let designs: Vec<String> = store.grid()?.designs.into_iter().map(|d| d.name).collect();
    let mut written = Vec::new();
    for (n, relation) in relations.iter().enumerate().filter(|(_, r)| !r.internal) {
        let by_design = relation.columns.iter().any(|c| c.name == DESIGN);
        let parts: Vec<Option<&str>> =
            if by_design { designs.iter().map(|d| Some(d.as_str())).collect() } else { vec![None] };
        for design in parts {
            let within = design.map_or(String::new(), |d| format!("/{DESIGN}={}", encoded(d)));
            let path = format!("{}{within}/part-0.{}", relation.name, format.extension());
            let file = folder.join(&path);
            make_folder_of(&file)?;
            part(store, relation, design, format, provenance, &file)?;
            written.push(Written { relation: n, path });
        }
    }
    write_synced(&folder.join(PACKAGE), &package::text(relations, &written, format, provenance))
}

fn part(
    store: &mut Store,
    relation: &Relation,
    design: Option<&str>,
    format: Format,
    provenance: &Provenance,
    path: &Path,
) -> Result<(), ExportError> {
    let file = File::create(path).map_err(|e| ExportError::Write(path.to_owned(), e))?;
    // What the folder's name says is not in its files.
    let is_kept = |c: &&store::Column| design.is_none() || c.name != DESIGN;
    let columns: Vec<&store::Column> = relation.columns.iter().filter(is_kept).collect();
    let schema: Schema = columns.iter().map(|c| Field::new(c.name.as_str().into(), kind(c.kind))).collect();
    let mut sink = match format {
        Format::Parquet => Sink::parquet(file, &schema, relation, &columns, provenance),
        Format::Csv => Sink::csv(file, &schema),
    }
    .map_err(|e| ExportError::Polars(path.to_owned(), e))?;
    let mut outcome = Ok(());
    store.portions(relation, design, PORTION, &mut |values| {
        outcome = frame(relation, &columns, values).and_then(|frame| sink.write(&frame));
        if outcome.is_err() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    })?;
    let file = outcome.and_then(|()| sink.finish()).map_err(|e| ExportError::Polars(path.to_owned(), e))?;
    file.sync_all().map_err(|e| ExportError::Write(path.to_owned(), e))
}

/// Where portions go.
enum Sink {
    Parquet(Box<ParquetBatches<File>>, File),
    Csv(Box<CsvBatches<File>>, File),
}

impl Sink {
    fn parquet(
        file: File,
        schema: &Schema,
        relation: &Relation,
        columns: &[&store::Column],
        provenance: &Provenance,
    ) -> PolarsResult<Self> {
        let mut about = vec![("ARROW:schema".to_owned(), arrow_schema(schema, columns))];
        about.push(("busclimate:table".to_owned(), relation.name.clone()));
        about.push(("busclimate:description".to_owned(), relation.about()));
        let fields: Vec<_> = columns.iter().map(|c| words::field(c)).collect();
        about.push(("busclimate:columns".to_owned(), serde_json::json!(fields).to_string()));
        about.extend(provenance.pairs().map(|(key, value)| (format!("busclimate:{key}"), value)));
        let copy = file.try_clone()?;
        let writer = ParquetWriter::new(file)
            .with_row_group_size(Some(PORTION))
            .with_key_value_metadata(Some(KeyValueMetadata::from_static(about)))
            .batched(schema)?;
        Ok(Self::Parquet(Box::new(writer), copy))
    }

    fn csv(file: File, schema: &Schema) -> PolarsResult<Self> {
        let copy = file.try_clone()?;
        let writer = CsvWriter::new(file)
            .include_header(true)
            .with_batch_size(NonZeroUsize::MIN.saturating_add(PORTION))
            .batched(schema)?;
        Ok(Self::Csv(Box::new(writer), copy))
    }

    fn write(&mut self, frame: &DataFrame) -> PolarsResult<()> {
        match self {
            Self::Parquet(writer, _) => writer.write_batch(frame),
            Self::Csv(writer, _) => writer.write_batch(frame),
        }
    }

    fn finish(self) -> PolarsResult<File> {
        match self {
            Self::Parquet(writer, file) => writer.finish().map(|_| file),
            Self::Csv(mut writer, file) => writer.finish().map(|()| file),
        }
    }
}

fn kind(kind: ColumnKind) -> DataType {
    match kind {
        ColumnKind::Integer => DataType::Int64,
        ColumnKind::Real => DataType::Float64,
        ColumnKind::Text | ColumnKind::Bytes => DataType::String,
    }
}

/// The schema with words at its fields, as readers of Arrow look for them.
fn arrow_schema(schema: &Schema, columns: &[&store::Column]) -> String {
    let mut fields = ArrowSchema::default();
    for ((name, kind), column) in schema.iter().zip(columns) {
        let mut field = kind.to_arrow_field(name.clone(), CompatLevel::newest());
        let about = [("unit", &column.unit), ("description", &column.text), ("source", &column.source)];
        let about: Metadata = about.map(|(key, value)| (key.into(), value.as_str().into())).into_iter().collect();
        field.metadata = Some(Arc::new(about));
        fields.insert(name.clone(), field);
    }
    schema_to_metadata_key(&fields).value.unwrap_or_default()
}

/// The kept columns of a portion, whose values are those of all columns.
fn frame(relation: &Relation, columns: &[&store::Column], values: &[Values]) -> PolarsResult<DataFrame> {
    let is_kept = |(column, _): &(&store::Column, &Values)| columns.iter().any(|kept| kept.name == column.name);
    let series = |(column, values): (&store::Column, &Values)| {
        let name = column.name.as_str().into();
        Column::from(match values {
            Values::Integer(values) => Series::new(name, values),
            Values::Real(values) => Series::new(name, values),
            Values::Text(values) => Series::new(name, values),
        })
    };
    DataFrame::new_infer_height(relation.columns.iter().zip(values).filter(is_kept).map(series).collect())
}

/// A value as the name of a folder, as readers of such folders decode it.
fn encoded(value: &str) -> String {
    let plain = |byte: u8| byte.is_ascii_alphanumeric() || b"-_.+".contains(&byte);
    value.bytes().map(|b| if plain(b) { char::from(b).to_string() } else { format!("%{b:02X}") }).collect()
}
