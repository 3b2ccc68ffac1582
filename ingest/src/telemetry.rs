//! The columns of a ZTBus mission file that are read, row by row.

use crate::files::{check_header, check_text, find_columns};
use crate::parse::{self, text};
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
        check_header(bytes, b',')?;
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
    /// A file without rows, with too many or too long ones, or with a quote that never closes.
    pub fn for_each(&self, mut row: impl FnMut(Row<'b>)) -> Result<u64, Finding> {
        let mut scanner = Scanner::new(self.bytes, b',', &self.places);
        let mut count = 0;
        let (mut last_time, mut last_passengers, mut last_ambient_k) =
            (Second::default(), Number::default(), Number::default());
        for record in scanner.by_ref().take(MOST_ROWS + 2) {
            let [time, passengers, door, ambient_k, speed_m_s, power_w, route] = record.fields;
            count += 1;
            row(Row {
                line: record.line,
                time_s: last_time.or_of(time),
                passengers: last_passengers.or_of(passengers),
                door: match door {
                    b"0" => Some(0.0),
                    b"1" => Some(1.0),
                    other => text(other).and_then(parse::flag),
                },
                ambient_k: last_ambient_k.or_of(ambient_k),
                speed_m_s: parse::number_of(speed_m_s),
                power_w: parse::number_of(power_w),
                route: if matches!(route, b"-" | b"NaN") { b"" } else { route },
            });
        }
        scanner.check(count, MOST_ROWS)?;
        Ok(count as u64)
    }
}

/// A number that stays for many rows, and the field that it was read from.
#[derive(Debug, Default)]
struct Number<'b> {
    field: &'b [u8],
    value: Option<f64>,
}

impl<'b> Number<'b> {
    /// The number of a field, which is the last one where both are the same.
    #[inline]
    fn or_of(&mut self, field: &'b [u8]) -> Option<f64> {
        // Byte by byte: there are few.
        if field.is_empty() || !field.iter().eq(self.field) {
            *self = Self { field, value: parse::number_of(field) };
        }
        self.value
    }
}

/// The first eight of ten digits of a second, which stay for up to a hundred rows.
#[derive(Debug, Default)]
struct Second {
    digits: [u8; 8],
    hundreds: i64,
}

impl Second {
    /// The second of a field: ten digits, as nearly all are, or as [`parse::second`] reads others.
    #[inline]
    fn or_of(&mut self, field: &[u8]) -> Option<i64> {
        let value = |digit: u8| i64::from(digit - b'0');
        let other = || parse::second(text(field)?);
        let Some((digits, &[tens @ b'0'..=b'9', ones @ b'0'..=b'9'])) = field.split_first_chunk() else {
            return other();
        };
        if *digits != self.digits {
            if !digits.iter().all(u8::is_ascii_digit) {
                return other();
            }
            *self = Self { digits: *digits, hundreds: digits.iter().fold(0, |sum, digit| 10 * sum + value(*digit)) };
        }
        Some(100 * self.hundreds + 10 * value(tens) + value(ones))
    }
}

fn not_csv(error: &dyn std::error::Error) -> Finding {
    let message = format!("the file cannot be read as comma-separated values: {error}; export it again");
    Finding::whole(FindingKind::Unreadable, message)
}
