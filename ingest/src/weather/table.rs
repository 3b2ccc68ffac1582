//! The rows of a weather file of any format, with what is wrong in them.

use chrono::DateTime;
use std::path::Path;

use super::format::{Column, Encoding, Format, Interval, Layout, RowOrder};
use super::values::{MISSING, PerQuantity, Quantity, Values};
use crate::files::{Content, check_lines, check_text, find_columns};
use crate::{FileKind, FileRecord, Finding, FindingKind};

/// Sixty years of intervals of ten minutes.
const MOST_ROWS: usize = 60 * 366 * 144;
/// Air temperatures on Earth, in °C.
const TEMPERATURE_RANGE: (f64, f64) = (-60.0, 60.0);
/// Above this a value in a temperature column is one in K.
const HOTTEST_C: f64 = 100.0;
/// A pyranometer may read this much below zero at night, in W/m².
const NIGHT_OFFSET: f64 = -10.0;
/// No more arrives at the ground, in W/m².
const MAX_IRRADIANCE: f64 = 1500.0;

/// The usable rows of a file.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Table {
    /// Abbreviation of the station in lower case, where the file has one.
    pub station: Option<String>,
    /// Length of an interval in s.
    pub interval_s: i64,
    /// How its rows make a series.
    pub calendar: RowOrder,
    /// Which quantities it has.
    pub used: PerQuantity<bool>,
    /// Its rows.
    pub rows: Vec<Interval>,
}

pub(crate) fn read_file(label: &str, path: &Path, format: &dyn Format) -> (Option<Table>, FileRecord) {
    let content = match Content::read(path) {
        Ok(content) => content,
        Err(finding) => return (None, FileRecord::refused(label, FileKind::Weather, "", 0, finding)),
    };
    let bytes = content.bytes.len() as u64;
    match parse(&content.bytes, format) {
        Ok(Parsed { table, rows, findings }) => {
            let time = |s: Option<i64>| s.and_then(|s| DateTime::from_timestamp(s, 0));
            let record = FileRecord {
                path: label.to_owned(),
                kind: FileKind::Weather,
                blake3: content.blake3,
                bytes,
                rows,
                first: time(table.rows.iter().map(|r| r.start_s).min()),
                last: time(table.rows.iter().map(|r| r.start_s + table.interval_s).max()),
                stamp: content.stamp,
                accepted: true,
                findings,
            };
            (Some(table), record)
        }
        Err(finding) => {
            let record = FileRecord::refused(label, FileKind::Weather, &content.blake3, bytes, finding);
            (None, record.stamped(content.stamp))
        }
    }
}

struct Parsed {
    table: Table,
    rows: u64,
    findings: Vec<Finding>,
}

fn parse(bytes: &[u8], format: &dyn Format) -> Result<Parsed, Finding> {
    let header = bytes.split(|&b| b == b'\n').next().unwrap_or_default();
    let layout = format.layout(header);
    check_text(bytes, layout.encoding == Encoding::Utf8)?;
    check_lines(bytes, layout.separator as u8, MOST_ROWS)?;
    let utf8 = layout.encoding == Encoding::Utf8 || bytes.starts_with(b"\xef\xbb\xbf");
    let (text, ..) = if utf8 { encoding_rs::UTF_8.decode(bytes) } else { encoding_rs::WINDOWS_1252.decode(bytes) };
    let mut reader = csv::ReaderBuilder::new()
        .delimiter(layout.separator as u8)
        .flexible(true)
        // Lines end at \n, so that they count right in files with \r\n; trimming removes the \r.
        .terminator(csv::Terminator::Any(b'\n'))
        .trim(csv::Trim::All)
        .from_reader(text.as_bytes());
    let header = reader.headers().map_err(|e| not_csv(&e))?.clone();
    let places = Places::find(&layout, &header)?;

    let mut notes = Notes::default();
    let mut rows: Vec<Interval> = Vec::new();
    let mut station_name: Option<String> = None;
    let mut records = 0;
    let mut last_s = i64::MIN;
    let mut record = csv::StringRecord::new();
    while reader.read_record(&mut record).map_err(|e| not_csv(&e))? {
        let line = record.position().map_or(0, csv::Position::line);
        records += 1;
        let field = |position: usize| record.get(position).unwrap_or("");
        let stamp: Vec<&str> = places.time.iter().map(|&p| field(p)).collect();
        let Some(start_s) = format.start_s(&stamp, layout.interval_s) else {
            let message = || format!("{:?}: {}", stamp.join(","), format.stamp_form());
            notes.add(FindingKind::RefusedRow, &layout.time[0], line, message);
            continue;
        };
        if start_s.rem_euclid(layout.interval_s) != 0 {
            let form = format!("the stamp is no multiple of {} s; check interval and file", layout.interval_s);
            notes.add(FindingKind::RefusedRow, &layout.time[0], line, || form);
            continue;
        }
        if layout.calendar == RowOrder::Series && start_s <= last_s {
            let (kind, message) = if start_s == last_s {
                (FindingKind::DuplicateRow, "the same interval again; the first row counts")
            } else {
                (FindingKind::RefusedRow, "time runs backwards; sort the file by time")
            };
            notes.add(kind, &layout.time[0], line, || message.to_owned());
            continue;
        }
        if let Some(position) = places.station {
            let name = field(position).to_lowercase();
            match &station_name {
                Some(first) if *first != name => {
                    let message = format!("the station changes from {first:?} to {name:?}; one file, one station");
                    let finding = Finding::whole(FindingKind::RefusedRow, message).at_line(line);
                    return Err(finding.in_column(layout.station.unwrap_or_default()));
                }
                Some(_) => {}
                None => station_name = Some(name),
            }
        }
        last_s = start_s;
        let mut values: Values = MISSING;
        for quantity in Quantity::ALL {
            if let Some((name, position)) = places.columns.get(quantity) {
                *values.get_mut(quantity) = notes.value(field(*position), quantity, name, line);
            }
        }
        rows.push(Interval { start_s, values });
    }
    if rows.is_empty() {
        let message = "there are no usable rows below the header";
        return Err(notes.first().unwrap_or_else(|| Finding::whole(FindingKind::Empty, message).at_line(2)));
    }
    if notes.hot * 2 > rows.len() as u64 {
        let message = "the temperatures are above 100, probably in K; the column must be in °C: convert it";
        let name = layout.columns.temperature.name().unwrap_or_default();
        return Err(Finding::whole(FindingKind::WrongUnit, message).in_column(name).at_line(notes.hot_line));
    }
    let mut used = places.columns.map(Option::is_some);
    for quantity in Quantity::ALL {
        let Column::Optional(name) = layout.columns.get(quantity) else { continue };
        // A column without a single value is one that the station does not measure.
        if rows.iter().all(|r| r.values.get(quantity).is_nan()) {
            *used.get_mut(quantity) = false;
            let of_column = |f: &Finding| f.kind == FindingKind::MissingValue && f.column.as_ref() == Some(name);
            notes.list.retain(|f| !of_column(f));
        }
    }
    let (interval_s, calendar) = (layout.interval_s, layout.calendar);
    let table = Table { station: station_name, interval_s, calendar, used, rows };
    Ok(Parsed { table, rows: records, findings: notes.list })
}

/// Where the columns of a layout stand in a file.
struct Places {
    time: Vec<usize>,
    station: Option<usize>,
    columns: PerQuantity<Option<(String, usize)>>,
}

impl Places {
    fn find(layout: &Layout, header: &csv::StringRecord) -> Result<Self, Finding> {
        let mut columns = layout.columns.clone();
        for quantity in Quantity::ALL {
            let column = columns.get_mut(quantity);
            if matches!(column, Column::Optional(name) if !header.iter().any(|h| h == name)) {
                *column = Column::None;
            }
        }
        let named: Vec<(Quantity, &str)> =
            Quantity::ALL.into_iter().filter_map(|q| Some((q, columns.get(q).name()?))).collect();
        let mut wanted: Vec<&str> = layout.time.iter().map(String::as_str).collect();
        wanted.extend(layout.station);
        wanted.extend(named.iter().map(|(_, name)| *name));
        let positions = find_columns(header, &wanted, layout.separator)?;
        let (time, rest) = positions.split_at(layout.time.len());
        let (station, rest) = rest.split_at(usize::from(layout.station.is_some()));
        let mut places =
            Self { time: time.to_vec(), station: station.first().copied(), columns: PerQuantity::default() };
        for ((quantity, name), &position) in named.into_iter().zip(rest) {
            *places.columns.get_mut(quantity) = Some((name.to_owned(), position));
        }
        Ok(places)
    }
}

fn not_csv(error: &csv::Error) -> Finding {
    Finding::whole(FindingKind::Unreadable, format!("the file cannot be read as a table: {error}; fetch it again"))
}

/// What was noticed, one finding per kind and column.
#[derive(Default)]
struct Notes {
    list: Vec<Finding>,
    /// Temperatures that must be in K, and where the first stands.
    hot: u64,
    hot_line: u64,
}

impl Notes {
    fn add(&mut self, kind: FindingKind, column: &str, line: u64, message: impl FnOnce() -> String) {
        match self.list.iter_mut().find(|f| f.kind == kind && f.column.as_deref() == Some(column)) {
            Some(finding) => finding.count += 1,
            None => self.list.push(Finding::whole(kind, message()).in_column(column).at_line(line)),
        }
    }

    fn first(&self) -> Option<Finding> {
        self.list.first().cloned()
    }

    /// A value within its physical range, else NaN and a note.
    fn value(&mut self, text: &str, quantity: Quantity, column: &str, line: u64) -> f64 {
        if matches!(text, "" | "-" | "NaN" | "NA") {
            self.add(FindingKind::MissingValue, column, line, || "no value".to_owned());
            return f64::NAN;
        }
        let Some(value) = text.parse::<f64>().ok().filter(|v| v.is_finite()) else {
            self.add(FindingKind::RefusedValue, column, line, || format!("{text:?}: not a number; taken as missing"));
            return f64::NAN;
        };
        if quantity == Quantity::Temperature {
            if value > HOTTEST_C {
                self.hot += 1;
                self.hot_line = if self.hot == 1 { line } else { self.hot_line };
            }
            let (low, high) = TEMPERATURE_RANGE;
            if !(low..=high).contains(&value) {
                let message = || format!("{text}: outside {low} … {high} °C; taken as missing");
                self.add(FindingKind::OutOfRange, column, line, message);
                return f64::NAN;
            }
            return value;
        }
        if !(NIGHT_OFFSET..=MAX_IRRADIANCE).contains(&value) {
            let message = || format!("{text}: irradiance outside 0 … {MAX_IRRADIANCE} W/m²; taken as missing");
            self.add(FindingKind::OutOfRange, column, line, message);
            return f64::NAN;
        }
        if value < 0.0 {
            let message = || format!("{text}: small negative irradiance of a sensor at night; taken as 0");
            self.add(FindingKind::NegativeOffset, column, line, message);
            return 0.0;
        }
        value
    }
}
