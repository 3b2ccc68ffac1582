//! The columns of a mission file that the samples need, read with polars.

use polars::prelude::{
    ChunkedArray, CsvEncoding, CsvParseOptions, CsvReadOptions, DataFrame, DataType, Field, Float64Chunked,
    Int64Chunked, IntoColumn, NewChunkedArray, PlSmallStr, PolarsNumericType, PolarsResult, Schema, SerReader,
};
use std::io::Cursor;
use std::sync::Arc;

use crate::files::{check_lines, check_text, find_columns};
use crate::parse;
use crate::{Finding, FindingKind};

pub(crate) const TIME: &str = "time_unix";
pub(crate) const PASSENGERS: &str = "itcs_numberOfPassengers";
pub(crate) const DOOR: &str = "status_doorIsOpen";
pub(crate) const AMBIENT: &str = "temperature_ambient";
/// Three rows a second of the longest mission.
const MOST_ROWS: usize = 3 * 7 * 86_400;
const COLUMNS: [&str; 4] = [TIME, PASSENGERS, DOOR, AMBIENT];

/// One row of telemetry. `None` is what cannot be read, NaN what is missing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Row {
    /// Seconds since 1970.
    pub time_s: Option<i64>,
    /// Passengers on board, known when leaving a stop.
    pub passengers: Option<f64>,
    /// 1 while at least one door is open, else 0.
    pub door: Option<f64>,
    /// Ambient temperature in K.
    pub ambient_k: Option<f64>,
}

/// The telemetry of one mission.
pub(crate) struct Telemetry {
    frame: DataFrame,
    lines: Lines,
}

/// Where rows stand in the file.
enum Lines {
    /// Row `i` stands on line `i + 2`.
    Plain,
    /// Line breaks in quotes: the line of every row.
    Listed(Vec<u64>),
}

impl Telemetry {
    /// Reads the content of a mission file.
    pub fn read(bytes: &[u8]) -> Result<Self, Finding> {
        check_text(bytes, true)?;
        check_lines(bytes, b',', MOST_ROWS)?;
        let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        let mut reader = csv::ReaderBuilder::new().flexible(true).from_reader(bytes);
        let header = reader.headers().map_err(|e| not_csv(&e))?;
        find_columns(header, &COLUMNS, ',')?;

        let mut frame = scan(bytes).map_err(|e| not_csv(&e))?;
        read_as_text(&mut frame, bytes).map_err(|e| not_csv(&e))?;
        if frame.height() == 0 {
            return Err(Finding::whole(FindingKind::Empty, "there are no rows below the header").at_line(2));
        }
        let newlines = memchr::memchr_iter(b'\n', bytes).count() - usize::from(bytes.ends_with(b"\n"));
        let lines = if newlines == frame.height() { Lines::Plain } else { Lines::Listed(list_lines(bytes)) };
        Ok(Self { frame, lines })
    }

    /// How many rows there are.
    pub fn len(&self) -> usize {
        self.frame.height()
    }

    /// Calls `row` with every row, in order.
    pub fn for_each(&self, mut row: impl FnMut(usize, Row)) {
        let [time, passengers, door, ambient] = COLUMNS.map(|name| {
            let column = self.frame.column(name).expect("the columns were asked for by name");
            column.as_materialized_series()
        });
        let time = time.i64().expect("the schema sets the type");
        let [passengers, door, ambient] =
            [passengers, door, ambient].map(|s| s.f64().expect("the schema sets the type"));
        let columns = values(time).zip(values(passengers)).zip(values(door)).zip(values(ambient));
        for (i, (((time_s, passengers), door), ambient_k)) in columns.enumerate() {
            row(i, Row { time_s, passengers, door, ambient_k });
        }
    }

    /// Line of a row in the file.
    pub fn line(&self, row: usize) -> u64 {
        match &self.lines {
            Lines::Plain => row as u64 + 2,
            Lines::Listed(lines) => lines.get(row).copied().unwrap_or(row as u64 + 2),
        }
    }
}

fn values<T: PolarsNumericType>(column: &ChunkedArray<T>) -> impl Iterator<Item = Option<T::Native>> + '_ {
    column.downcast_iter().flat_map(|chunk| chunk.iter().map(|v| v.copied()))
}

fn scan(bytes: &[u8]) -> PolarsResult<DataFrame> {
    let types = [
        (TIME, DataType::Int64),
        (PASSENGERS, DataType::Float64),
        (DOOR, DataType::Float64),
        (AMBIENT, DataType::Float64),
    ];
    scan_columns(bytes, &types)
}

/// Reads columns with values that are no plain numbers once more, as text: empty fields are missing, and numbers and flags may
/// be written as other tools write them.
fn read_as_text(frame: &mut DataFrame, bytes: &[u8]) -> PolarsResult<()> {
    let odd = |name: &&str| frame.column(name).is_ok_and(|column| column.null_count() > 0);
    let odd: Vec<&'static str> = COLUMNS.into_iter().filter(odd).collect();
    if odd.is_empty() {
        return Ok(());
    }
    let types: Vec<(&'static str, DataType)> = odd.iter().map(|name| (*name, DataType::String)).collect();
    let text = scan_columns(bytes, &types)?;
    for name in odd {
        let texts = text.column(name)?.as_materialized_series().str()?.iter().map(|t| t.map_or("", str::trim));
        let column = match name {
            TIME => Int64Chunked::from_iter_options(name.into(), texts.map(parse::second)).into_column(),
            DOOR => Float64Chunked::from_iter_options(name.into(), texts.map(parse::flag)).into_column(),
            _ => Float64Chunked::from_iter_options(name.into(), texts.map(parse::number)).into_column(),
        };
        frame.with_column(column)?;
    }
    Ok(())
}

fn scan_columns(bytes: &[u8], types: &[(&'static str, DataType)]) -> PolarsResult<DataFrame> {
    let types = types.iter().cloned();
    let columns: Arc<[PlSmallStr]> = types.clone().map(|(name, _)| PlSmallStr::from_static(name)).collect();
    let schema = Schema::from_iter(types.map(|(name, dtype)| Field::new(name.into(), dtype)));
    // Missions are read side by side, so one of them takes one thread.
    CsvReadOptions::default()
        .with_columns(Some(columns))
        .with_schema_overwrite(Some(Arc::new(schema)))
        .with_infer_schema_length(Some(0))
        .with_n_threads(Some(1))
        .with_rechunk(false)
        .with_ignore_errors(true)
        .with_raise_if_empty(false)
        .with_parse_options(
            CsvParseOptions::default().with_truncate_ragged_lines(true).with_encoding(CsvEncoding::LossyUtf8),
        )
        .into_reader_with_file_handle(Cursor::new(bytes))
        .finish()
}

/// The line on which every record begins, the header's left out. A line break in quotes belongs to its record; a blank
/// line is a record without values, as polars takes it.
fn list_lines(bytes: &[u8]) -> Vec<u64> {
    let (mut lines, mut line, mut quoted) = (Vec::new(), 1, false);
    for byte in bytes {
        match byte {
            b'"' => quoted = !quoted,
            b'\n' => {
                line += 1;
                if !quoted {
                    lines.push(line);
                }
            }
            _ => {}
        }
    }
    lines
}

fn not_csv(error: &dyn std::error::Error) -> Finding {
    let message = format!("the file cannot be read as comma-separated values: {error}; export it again");
    Finding::whole(FindingKind::Unreadable, message)
}
