//! Missions in tables of any operator: columns named by the study, one vehicle and day a file or many in one, cut at gaps.

use cabin::LoadChange;
use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

use super::rows::Reader;
use crate::files::{check_header, check_text, find_columns};
use crate::parse::{self, text};
use crate::scan::Scanner;
use crate::stamp::{Clock, Stamp};
use crate::telemetry::{Row, Table};
use crate::{Finding, FindingKind};

/// Rows of a file at most.
const MOST_ROWS: usize = 8_000_000;
/// A mission is cut when it lasts this long, in s: that of a bus whose telemetry never ends.
const LONGEST_S: i64 = 7 * 86_400;
/// Share of unreadable stamps and vehicles above which a file is refused.
const MAX_UNUSABLE_SHARE: f64 = 0.1;

/// Which column of a table of telemetry is what.
#[derive(Debug, Clone, PartialEq)]
pub struct TelemetryMap {
    /// Stamps such as `2022-12-31T23:00:00Z`, or seconds since 1970.
    pub time_column: String,
    /// What stamps without an offset mean.
    pub clock: Clock,
    /// Whose telemetry it is.
    pub vehicle: Vehicle,
    /// Passengers on board.
    pub passengers_column: String,
    /// Whether doors are open.
    pub door: Door,
    /// Speed.
    pub speed_column: Option<String>,
    /// One of the speed in m/s.
    pub speed_unit_m_s: f64,
    /// Electric power that the bus takes from its supplies.
    pub power_column: Option<String>,
    /// One of the power in W.
    pub power_unit_w: f64,
    /// Route.
    pub route_column: Option<String>,
    /// How long a row holds when none follows, in s.
    pub hold_s: u32,
    /// A gap that is longer than this ends a mission, in s.
    pub cut_gap_s: u32,
}

/// Whose telemetry a table is.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Vehicle {
    /// That of the number in a column.
    Column(String),
    /// That of one bus.
    Number(u32),
}

/// What a table says of doors.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Door {
    /// 1 or true while at least one is open.
    Flag(String),
    /// The share of the doors that is open, 0 … 1.
    Share(String),
}

impl Door {
    fn column(&self) -> &str {
        match self {
            Self::Flag(name) | Self::Share(name) => name,
        }
    }

    pub(super) fn is_share(&self) -> bool {
        matches!(self, Self::Share(_))
    }
}

/// A mission in a table.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Part {
    pub map: Arc<TelemetryMap>,
    pub separator: u8,
    /// The vehicle as its column says it; empty where there is none.
    pub vehicle: Vec<u8>,
    pub bus: u32,
    /// First and last second.
    pub span: (i64, i64),
    /// Where the header is, and the records from the first to the last of the mission, among them those of others.
    pub pieces: [Range<usize>; 2],
    /// The line of the first record.
    pub first_line: u64,
}

/// What an index of a table has found.
pub(super) struct Index {
    pub parts: Vec<Part>,
    /// Rows that belong to no mission.
    pub note: Option<Finding>,
}

impl TelemetryMap {
    fn vehicle_column(&self) -> Option<&str> {
        match &self.vehicle {
            Vehicle::Column(name) => Some(name),
            Vehicle::Number(_) => None,
        }
    }

    /// Positions of time, vehicle, passengers, doors, speed, power and route in a header, and the separator.
    fn places(&self, bytes: &[u8]) -> Result<([Option<usize>; 7], u8), Finding> {
        let first = bytes.split(|&b| b == b'\n').next().unwrap_or_default();
        let separator = if first.contains(&b';') { b';' } else { b',' };
        let mut reader = csv::ReaderBuilder::new().delimiter(separator).flexible(true).from_reader(first);
        let header = reader.headers().map_err(|e| {
            Finding::whole(FindingKind::Unreadable, format!("the header cannot be read: {e}")).at_line(1)
        })?;
        let optional = [
            self.vehicle_column(),
            self.speed_column.as_deref(),
            self.power_column.as_deref(),
            self.route_column.as_deref(),
        ];
        let needed = [Some(self.time_column.as_str()), Some(self.passengers_column.as_str()), Some(self.door.column())];
        let wanted: Vec<&str> = needed.into_iter().chain(optional).flatten().collect();
        find_columns(header, &wanted, char::from(separator))?;
        let place = |name: Option<&str>| name.and_then(|name| header.iter().position(|h| h.trim() == name));
        let [vehicle, speed, power, route] = optional.map(place);
        let [time, passengers, door] = needed.map(place);
        Ok(([time, vehicle, passengers, door, speed, power, route], separator))
    }

    /// The number of a vehicle: all digits of its name.
    fn bus(&self, name: &str) -> Option<u32> {
        match &self.vehicle {
            Vehicle::Number(number) => Some(*number),
            Vehicle::Column(_) => {
                let digits: String = name.chars().filter(char::is_ascii_digit).collect();
                digits.parse().ok()
            }
        }
    }
}

/// The missions of a table: rows of one vehicle without a gap that ends a mission.
pub(super) fn index(bytes: &[u8], map: &Arc<TelemetryMap>) -> Result<Index, Finding> {
    check_text(bytes, true)?;
    // A mark of the encoding before the header belongs to no piece.
    let mark = if bytes.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
    let bytes = &bytes[mark..];
    let ([time, vehicle, ..], separator) = map.places(bytes)?;
    check_header(bytes, separator)?;
    let header_end = memchr::memchr(b'\n', bytes).map_or(bytes.len(), |n| n + 1);
    let mut open: BTreeMap<&[u8], Part> = BTreeMap::new();
    let mut numbers: BTreeMap<u32, &[u8]> = BTreeMap::new();
    let mut parts = Vec::new();
    let (mut rows, mut unusable, mut first) = (0_usize, 0_u64, None);
    let mut scanner = Scanner::new(bytes, separator, &[time, vehicle]);
    for record in scanner.by_ref().take(MOST_ROWS + 2) {
        let [stamp, vehicle] = record.fields;
        rows += 1;
        let last_s = open.get(vehicle).map_or(i64::MIN, |part| part.span.1);
        let second = text(stamp).and_then(Stamp::parse).and_then(|stamp| map.clock.resolve(stamp, last_s));
        let bus = text(vehicle).and_then(|name| map.bus(name));
        let (Some(second), Some(bus)) = (second, bus) else {
            unusable += 1;
            first.get_or_insert((
                record.line,
                second.is_none(),
                String::from_utf8_lossy(if second.is_none() { stamp } else { vehicle }).into_owned(),
            ));
            continue;
        };
        if let Some(other) = numbers.insert(bus, vehicle).filter(|other| *other != vehicle) {
            let [a, b] = [other, vehicle].map(String::from_utf8_lossy);
            let message = format!("{a:?} and {b:?} are both the vehicle number {bus}; give them numbers of their own");
            let column = map.vehicle_column().unwrap_or_default();
            return Err(Finding::whole(FindingKind::RefusedValue, message).in_column(column).at_line(record.line));
        }
        let first_s = open.get(vehicle).map_or(second, |part| part.span.0);
        let is_cut = second.saturating_sub(last_s) > i64::from(map.cut_gap_s) || second - first_s > LONGEST_S;
        if is_cut && let Some(done) = open.remove(vehicle) {
            parts.push(done);
        }
        let part = || Part {
            map: Arc::clone(map),
            separator,
            vehicle: vehicle.to_vec(),
            bus,
            span: (second, second),
            pieces: [mark..mark + header_end, mark + record.start..mark + record.end],
            first_line: record.line,
        };
        let part = open.entry(vehicle).or_insert_with(part);
        part.span.1 = part.span.1.max(second);
        part.pieces[1].end = mark + record.end;
    }
    scanner.check(rows, MOST_ROWS)?;
    parts.extend(open.into_values());
    let note = first.map(|(line, is_time, text)| {
        let text: String = text.chars().take(40).collect();
        let (column, what) = match (is_time, map.vehicle_column()) {
            (true, _) | (_, None) => (map.time_column.as_str(), "not a time that can be read"),
            (false, Some(column)) => (column, "not the number of a vehicle"),
        };
        let message = format!("{text:?}: {what}; {unusable} of {rows} rows belong to no mission: correct the export");
        Finding::whole(FindingKind::RefusedRow, message).in_column(column).at_line(line).times(unusable)
    });
    match note {
        Some(note) if parts.is_empty() || unusable as f64 > MAX_UNUSABLE_SHARE * rows as f64 => Err(note),
        note => Ok(Index { parts, note }),
    }
}

impl Part {
    pub fn table<'b>(&'b self, bytes: &'b [u8]) -> Table<'b> {
        let name = |name: &'b Option<String>| name.as_deref().unwrap_or_default();
        Table {
            bytes,
            separator: self.separator,
            lines_before: self.first_line - 1,
            time: &self.map.time_column,
            passengers: &self.map.passengers_column,
            door: self.map.door.column(),
            ambient: "",
            speed: name(&self.map.speed_column),
            power: name(&self.map.power_column),
        }
    }

    /// Gives the rows of the mission to a reader, one for each second that they hold, and says how many there are.
    pub fn read<'b>(&self, bytes: &'b [u8], reader: &mut Reader<'b>) -> Result<u64, Finding> {
        let (places, separator) = self.map.places(bytes)?;
        let (mut count, mut last_s) = (0, i64::MIN);
        for record in Scanner::new(bytes, separator, &places) {
            let [time, vehicle, on_board, doors, speed_field, power_field, route] = record.fields;
            if vehicle != self.vehicle {
                continue;
            }
            count += 1;
            let time_s = text(time).and_then(Stamp::parse).and_then(|stamp| self.map.clock.resolve(stamp, last_s));
            let row = Row {
                line: record.line + self.first_line - 2,
                time_s,
                passengers: parse::number_of(on_board),
                door: match &self.map.door {
                    Door::Flag(_) => text(doors).and_then(parse::flag),
                    Door::Share(_) => parse::number_of(doors).map(LoadChange::in_steps),
                },
                ambient_k: Some(f64::NAN),
                speed_m_s: parse::number_of(speed_field).map(|speed| speed * self.map.speed_unit_m_s),
                power_w: parse::number_of(power_field).map(|power| power * self.map.power_unit_w),
                route: if matches!(route, b"-" | b"NaN") { b"" } else { route },
            };
            last_s = last_s.max(row.time_s.unwrap_or(i64::MIN));
            reader.take(row);
        }
        Ok(count)
    }
}
