//! The formats of weather files: rows of intervals, with what is wrong in them.

use chrono::{DateTime, NaiveDate, NaiveDateTime, Utc};
use std::path::Path;

use crate::files::{Content, check_text, find_columns};
use crate::weather::{ColumnMap, TimeLabel, WeatherFormat};
use crate::{FileKind, FileRecord, Finding, FindingKind};

/// Air temperatures on Earth, in °C.
const TEMPERATURE_RANGE: (f64, f64) = (-60.0, 60.0);
/// Above this a value in a temperature column is one in K.
const HOTTEST_C: f64 = 100.0;
/// A pyranometer may read this much below zero at night, in W/m².
const NIGHT_OFFSET: f64 = -10.0;
/// No more arrives at the ground, in W/m².
const MAX_IRRADIANCE: f64 = 1500.0;
/// From this year on the months of a SIA 4028 file are stamped at the end of the hour.
const SIA_END_STAMPS_FROM: i32 = 2018;

/// The usable rows of a file.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Quantities {
    /// Abbreviation of the station in lower case, where the file has one.
    pub station: Option<String>,
    /// Length of an interval in s.
    pub interval_s: i64,
    /// Whether it is a reference year, repeated by calendar date.
    pub year: bool,
    /// Which of temperature, global, diffuse and direct irradiance the file has.
    pub used: [bool; 4],
    /// Its rows.
    pub rows: Vec<Interval>,
}

/// One interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Interval {
    /// Its start in s since 1970.
    pub start_s: i64,
    /// Temperature in °C; global, diffuse, direct irradiance in W/m²; NaN where missing.
    pub values: [f64; 4],
}

/// How a file of a format is laid out.
struct Layout {
    separator: char,
    utf8: bool,
    time: Vec<String>,
    station: Option<&'static str>,
    /// Columns of temperature, global, diffuse, direct.
    values: [Option<String>; 4],
    interval_s: i64,
    kind: Kind,
}

#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Ogd,
    Sia,
    Csv(TimeLabel),
}

pub(crate) fn read_file(label: &str, path: &Path, format: &WeatherFormat) -> (Option<Quantities>, FileRecord) {
    let content = match Content::read(path) {
        Ok(content) => content,
        Err(finding) => return (None, FileRecord::refused(label, FileKind::Weather, "", 0, finding)),
    };
    let bytes = content.bytes.len() as u64;
    match parse(&content.bytes, format) {
        Ok(Parsed { quantities, rows, findings }) => {
            let time = |s: Option<i64>| s.and_then(|s| DateTime::from_timestamp(s, 0));
            let record = FileRecord {
                path: label.to_owned(),
                kind: FileKind::Weather,
                blake3: content.blake3,
                bytes,
                rows,
                first: time(quantities.rows.iter().map(|r| r.start_s).min()),
                last: time(quantities.rows.iter().map(|r| r.start_s + quantities.interval_s).max()),
                accepted: true,
                findings,
            };
            (Some(quantities), record)
        }
        Err(finding) => (None, FileRecord::refused(label, FileKind::Weather, &content.blake3, bytes, finding)),
    }
}

struct Parsed {
    quantities: Quantities,
    rows: u64,
    findings: Vec<Finding>,
}

fn parse(bytes: &[u8], format: &WeatherFormat) -> Result<Parsed, Finding> {
    check_text(bytes, matches!(format, WeatherFormat::Csv(_)))?;
    let mut layout = layout(format, bytes);
    // The files of MeteoSwiss are Windows-1252; a byte order mark says otherwise.
    let (text, ..) =
        if layout.utf8 { encoding_rs::UTF_8.decode(bytes) } else { encoding_rs::WINDOWS_1252.decode(bytes) };
    let mut reader = csv::ReaderBuilder::new()
        .delimiter(layout.separator as u8)
        .flexible(true)
        // Lines end at \n, so that they count right in files with \r\n; trimming removes the \r.
        .terminator(csv::Terminator::Any(b'\n'))
        .trim(csv::Trim::All)
        .from_reader(text.as_bytes());
    let header = reader.headers().map_err(|e| not_csv(&e))?.clone();
    // Diffuse irradiance is a column of every file of MeteoSwiss, empty at most stations.
    if layout.kind == Kind::Ogd && !header.iter().any(|h| Some(h) == layout.values[2].as_deref()) {
        layout.values[2] = None;
    }
    let wanted: Vec<&str> = layout
        .time
        .iter()
        .map(String::as_str)
        .chain(layout.station)
        .chain(layout.values.iter().flatten().map(String::as_str))
        .collect();
    let positions = find_columns(&header, &wanted, layout.separator)?;
    let (time, rest) = positions.split_at(layout.time.len());
    let (station, values) = rest.split_at(usize::from(layout.station.is_some()));
    let mut values = values.iter();
    let columns =
        layout.values.clone().map(|name| name.map(|name| (name, *values.next().expect("one position a column"))));

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
        let Some(start_s) = layout.start(time.iter().map(|&p| field(p))) else {
            let text = time.iter().map(|&p| field(p)).collect::<Vec<_>>().join(",");
            notes.add(FindingKind::RefusedRow, &layout.time[0], line, || format!("{text:?}: {}", layout.time_form()));
            continue;
        };
        if start_s.rem_euclid(layout.interval_s) != 0 {
            let form = format!("the stamp is no multiple of {} s; check interval and file", layout.interval_s);
            notes.add(FindingKind::RefusedRow, &layout.time[0], line, || form);
            continue;
        }
        if layout.kind != Kind::Sia && start_s <= last_s {
            let (kind, message) = if start_s == last_s {
                (FindingKind::DuplicateRow, "the same interval again; the first row counts")
            } else {
                (FindingKind::RefusedRow, "time runs backwards; sort the file by time")
            };
            notes.add(kind, &layout.time[0], line, || message.to_owned());
            continue;
        }
        if let Some(&position) = station.first() {
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
        let mut interval = Interval { start_s, values: [f64::NAN; 4] };
        for (quantity, column) in columns.iter().enumerate() {
            if let Some((name, position)) = column {
                interval.values[quantity] = notes.value(field(*position), quantity == 0, name, line);
            }
        }
        rows.push(interval);
    }
    if rows.is_empty() {
        let message = "there are no usable rows below the header";
        return Err(notes.first().unwrap_or_else(|| Finding::whole(FindingKind::Empty, message).at_line(2)));
    }
    if notes.hot * 2 > rows.len() as u64 {
        let message = "the temperatures are above 100, probably in K; the column must be in °C: convert it";
        let name = layout.values[0].clone().unwrap_or_default();
        return Err(Finding::whole(FindingKind::WrongUnit, message).in_column(&name).at_line(notes.hot_line));
    }
    let mut used = layout.values.map(|name| name.is_some());
    // A diffuse column without a single value is a station that does not measure it.
    if layout.kind == Kind::Ogd && rows.iter().all(|r| r.values[2].is_nan()) {
        used[2] = false;
        notes.list.retain(|f| {
            !(f.kind == FindingKind::MissingValue && f.column.as_deref().is_some_and(|c| c.starts_with("ods")))
        });
    }
    let year = layout.kind == Kind::Sia;
    let quantities = Quantities { station: station_name, interval_s: layout.interval_s, year, used, rows };
    Ok(Parsed { quantities, rows: records, findings: notes.list })
}

fn layout(format: &WeatherFormat, bytes: &[u8]) -> Layout {
    let bom = bytes.starts_with(b"\xef\xbb\xbf");
    let some = |name: &str| Some(name.to_owned());
    match format {
        WeatherFormat::MeteoSwissOgd => {
            // Ten-minute columns end in s0 or z0, hourly ones in h0.
            let header = bytes.split(|&b| b == b'\n').next().unwrap_or_default();
            let hourly = header.windows(8).any(|w| w == b"tre200h0" || w == b"gre000h0");
            let (temperature, global, diffuse, interval_s) = if hourly {
                ("tre200h0", "gre000h0", "ods000h0", 3600)
            } else {
                ("tre200s0", "gre000z0", "ods000z0", 600)
            };
            Layout {
                separator: ';',
                utf8: bom,
                time: vec!["reference_timestamp".to_owned()],
                station: Some("station_abbr"),
                values: [some(temperature), some(global), some(diffuse), None],
                interval_s,
                kind: Kind::Ogd,
            }
        }
        WeatherFormat::Sia4028 => Layout {
            separator: ',',
            utf8: bom,
            time: ["time.yy", "time.mm", "time.dd", "time.hh"].map(str::to_owned).to_vec(),
            station: Some("station"),
            values: [some("temp"), None, some("rad.diffus"), some("rad.direct")],
            interval_s: 3600,
            kind: Kind::Sia,
        },
        WeatherFormat::Csv(map) => csv_layout(map),
    }
}

fn csv_layout(map: &ColumnMap) -> Layout {
    Layout {
        separator: ',',
        utf8: true,
        time: vec![map.time_column.clone()],
        station: None,
        values: [
            Some(map.temperature_column.clone()),
            map.ghi_column.clone(),
            map.dhi_column.clone(),
            map.dni_column.clone(),
        ],
        interval_s: i64::from(map.interval_s),
        kind: Kind::Csv(map.time_label),
    }
}

impl Layout {
    /// Start of the interval that a stamp names.
    fn start<'a>(&self, mut fields: impl Iterator<Item = &'a str>) -> Option<i64> {
        let stamp = match self.kind {
            Kind::Ogd => NaiveDateTime::parse_from_str(fields.next()?, "%d.%m.%Y %H:%M").ok()?.and_utc().timestamp(),
            Kind::Csv(_) => parse_rfc3339(fields.next()?)?,
            Kind::Sia => {
                let mut number = || fields.next()?.parse::<i32>().ok();
                let (year, month, day, hour) = (number()?, number()?, number()?, number()?);
                let date = NaiveDate::from_ymd_opt(year, u32::try_from(month).ok()?, u32::try_from(day).ok()?)?;
                let start = date.and_hms_opt(u32::try_from(hour).ok()?, 0, 0)?.and_utc().timestamp();
                return Some(if year >= SIA_END_STAMPS_FROM { start - 3600 } else { start });
            }
        };
        Some(if self.kind == Kind::Csv(TimeLabel::Start) { stamp } else { stamp - self.interval_s })
    }

    fn time_form(&self) -> &'static str {
        match self.kind {
            Kind::Ogd => "not a stamp like 31.12.2022 23:00",
            Kind::Sia => "not a year, month, day and hour",
            Kind::Csv(_) => "not a stamp like 2022-12-31T23:00:00Z",
        }
    }
}

fn parse_rfc3339(text: &str) -> Option<i64> {
    if let Ok(stamp) = DateTime::parse_from_rfc3339(text) {
        return Some(stamp.timestamp());
    }
    for form in ["%Y-%m-%dT%H:%M:%S%z", "%Y-%m-%dT%H:%M%z", "%Y-%m-%d %H:%M:%S%z"] {
        if let Ok(stamp) = DateTime::parse_from_str(text, form) {
            return Some(stamp.timestamp());
        }
    }
    for form in ["%Y-%m-%dT%H:%M:%S", "%Y-%m-%d %H:%M:%S", "%Y-%m-%dT%H:%M", "%Y-%m-%d %H:%M"] {
        if let Ok(stamp) = NaiveDateTime::parse_from_str(text, form) {
            return Some(stamp.and_utc().with_timezone(&Utc).timestamp());
        }
    }
    None
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
    fn value(&mut self, text: &str, temperature: bool, column: &str, line: u64) -> f64 {
        if matches!(text, "" | "-" | "NaN" | "NA") {
            self.add(FindingKind::MissingValue, column, line, || "no value".to_owned());
            return f64::NAN;
        }
        let Some(value) = text.parse::<f64>().ok().filter(|v| v.is_finite()) else {
            self.add(FindingKind::RefusedValue, column, line, || format!("{text:?}: not a number; taken as missing"));
            return f64::NAN;
        };
        if temperature {
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
