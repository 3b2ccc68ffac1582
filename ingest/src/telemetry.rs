//! The columns of a ZTBus mission file that are read, row by row.

use crate::files::{check_lines, check_text, find_columns};
use crate::parse;
use crate::scan::Scanner;
use crate::{Finding, FindingKind};

pub(crate) const TIME: &str = "time_unix";
pub(crate) const PASSENGERS: &str = "itcs_numberOfPassengers";
pub(crate) const DOOR: &str = "status_doorIsOpen";
pub(crate) const AMBIENT: &str = "temperature_ambient";
pub(crate) const SPEED: &str = "odometry_vehicleSpeed";
pub(crate) const POWER: &str = "electric_powerDemand";
pub(crate) const ROUTE: &str = "itcs_busRoute";
/// Without these there is no sample.
const NEEDED: [&str; 4] = [TIME, PASSENGERS, DOOR, AMBIENT];
/// In the order of [`Row`].
const COLUMNS: [&str; 7] = [TIME, PASSENGERS, DOOR, AMBIENT, SPEED, POWER, ROUTE];
/// Three rows a second of the longest mission.
const MOST_ROWS: usize = 3 * 7 * 86_400;

/// One row of telemetry. `None` is what cannot be read, NaN what is missing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Row<'b> {
    /// Where it stands in the file; the header is line 1.
    pub line: u64,
    /// Seconds since 1970.
    pub time_s: Option<i64>,
    /// Passengers on board, known when leaving a stop.
    pub passengers: Option<f64>,
    /// 1 while at least one door is open, else 0.
    pub door: Option<f64>,
    /// Ambient temperature in K.
    pub ambient_k: Option<f64>,
    /// Speed of the bus in m/s.
    pub speed_m_s: Option<f64>,
    /// Electric power that the bus takes from its supplies in W.
    pub power_w: Option<f64>,
    /// Route; empty where there is none.
    pub route: &'b [u8],
}

/// A table of telemetry, for what is said of it: the names of its columns, and where its lines stand in the file.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Table<'b> {
    pub bytes: &'b [u8],
    pub separator: u8,
    /// Lines of the file that stand before the second line of the bytes, the first being the header.
    pub lines_before: u64,
    pub time: &'b str,
    pub passengers: &'b str,
    pub door: &'b str,
    pub ambient: &'b str,
    pub speed: &'b str,
    pub power: &'b str,
}

impl<'b> Table<'b> {
    /// The table of a ZTBus file.
    pub fn ztbus(bytes: &'b [u8]) -> Self {
        Self {
            bytes,
            separator: b',',
            lines_before: 1,
            time: TIME,
            passengers: PASSENGERS,
            door: DOOR,
            ambient: AMBIENT,
            speed: SPEED,
            power: POWER,
        }
    }

    /// The text of a field on a line of the file, cut to a length that fits a message.
    pub fn text_at(&self, line: u64, column: &str) -> Option<String> {
        let bytes = self.bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(self.bytes);
        let mut builder = csv::ReaderBuilder::new();
        builder.delimiter(self.separator).flexible(true);
        let position = builder.from_reader(bytes).headers().ok()?.iter().position(|h| h.trim() == column)?;
        let before = usize::try_from(line.checked_sub(self.lines_before + 1)?).ok()?;
        let start = memchr::memchr_iter(b'\n', bytes).nth(before)? + 1;
        let end = memchr::memchr(b'\n', &bytes[start..]).map_or(bytes.len(), |n| start + n);
        let mut reader = builder.has_headers(false).from_reader(&bytes[start..end]);
        let record = reader.byte_records().next()?.ok()?;
        Some(String::from_utf8_lossy(record.get(position)?).chars().take(40).collect())
    }
}

/// The telemetry of one mission.
pub(crate) struct Telemetry<'b> {
    bytes: &'b [u8],
    places: [Option<usize>; COLUMNS.len()],
}

impl<'b> Telemetry<'b> {
    /// Reads the header of a mission file.
    pub fn read(bytes: &'b [u8]) -> Result<Self, Finding> {
        check_text(bytes, true)?;
        check_lines(bytes, b',', MOST_ROWS)?;
        let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        let mut reader = csv::ReaderBuilder::new().flexible(true).from_reader(bytes);
        let header = reader.headers().map_err(|e| not_csv(&e))?;
        find_columns(header, &NEEDED, ',')?;
        let places = COLUMNS.map(|name| header.iter().position(|column| column.trim() == name));
        Ok(Self { bytes, places })
    }

    /// Calls `row` with every row, in order, and says how many there are.
    ///
    /// # Errors
    /// A file without rows, or with a quote that never closes.
    pub fn for_each(&self, mut row: impl FnMut(Row<'b>)) -> Result<u64, Finding> {
        let mut scanner = Scanner::new(self.bytes, b',', &self.places);
        let mut count = 0;
        let [mut ambient, mut speed, mut power] = [const { Last::NONE }; 3];
        for record in &mut scanner {
            let [time, passengers, door, ambient_k, speed_m_s, power_w, route] = record.fields;
            count += 1;
            row(Row {
                line: record.line,
                time_s: second(time),
                passengers: if passengers == b"NaN" {
                    Some(f64::NAN)
                } else {
                    text(passengers).and_then(parse::number)
                },
                door: match door {
                    b"0" => Some(0.0),
                    b"1" => Some(1.0),
                    other => text(other).and_then(parse::flag),
                },
                ambient_k: ambient.number(ambient_k),
                speed_m_s: speed.number(speed_m_s),
                power_w: power.number(power_w),
                route: if matches!(route, b"-" | b"NaN") { b"" } else { route },
            });
        }
        scanner.check(count)?;
        Ok(count)
    }
}

/// The last number of a column: many stay for seconds.
pub(crate) struct Last<'b> {
    text: &'b [u8],
    number: Option<f64>,
}

impl<'b> Last<'b> {
    pub const NONE: Self = Self { text: b"", number: Some(f64::NAN) };

    pub fn number(&mut self, text: &'b [u8]) -> Option<f64> {
        if self.text != text {
            *self = Self { text, number: self::text(text).and_then(parse::number) };
        }
        self.number
    }
}

/// Ten digits, as nearly all are; else as [`parse::second`] reads them.
fn second(field: &[u8]) -> Option<i64> {
    let digit = |sum: Option<i64>, byte: &u8| match byte {
        b'0'..=b'9' => sum.map(|sum| 10 * sum + i64::from(byte - b'0')),
        _ => None,
    };
    let plain = if field.len() == 10 { field.iter().fold(Some(0), digit) } else { None };
    plain.or_else(|| parse::second(text(field)?))
}

pub(crate) fn text(field: &[u8]) -> Option<&str> {
    std::str::from_utf8(field).ok().map(str::trim)
}

fn not_csv(error: &dyn std::error::Error) -> Finding {
    let message = format!("the file cannot be read as comma-separated values: {error}; export it again");
    Finding::whole(FindingKind::Unreadable, message)
}
