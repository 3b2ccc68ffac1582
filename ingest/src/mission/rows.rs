//! The rows of a mission, taken in one by one, with what is wrong in them.

use cabin::LoadChange;

use crate::parse::likely_cause;
use crate::segments::{Adder, Clock, Drive};
use crate::telemetry::{Row, Table};
use crate::{Finding, FindingKind};

/// Largest believable number of passengers: an articulated bus holds about 150.
const MAX_PASSENGERS: f64 = 250.0;
/// How far below zero a counter of passengers may drift.
const MAX_DRIFT: f64 = 10.0;
/// Share of a needed column's values above which a file with unusable ones is refused.
const MAX_UNUSABLE_SHARE: f64 = 0.1;
/// So few say nothing of the column, where others can be used.
const FEW_UNUSABLE: u64 = 5;
/// Believable speeds, of a bus that rolls back as well, and powers of one that drives or brakes.
const SPEEDS_M_S: (f64, f64) = (-5.0, 50.0);
const POWERS_W: (f64, f64) = (-2e6, 2e6);
/// A route's name in characters.
const LONGEST_ROUTE: usize = 40;
/// Below this a temperature in K is one in °C.
const COLDEST_K: f64 = 150.0;

/// Something that happened in rows: how often, and where first.
#[derive(Debug, Clone, Copy, Default)]
struct Note {
    count: u64,
    line: Option<u64>,
}

impl Note {
    fn at(&mut self, line: u64) {
        self.count += 1;
        self.line.get_or_insert(line);
    }
}

/// What was noticed while reading rows.
#[derive(Debug, Default)]
pub(super) struct Notes {
    unreadable_time: Note,
    outside: Note,
    backwards: Note,
    duplicate: Note,
    gaps: Note,
    gap_seconds: i64,
    unreadable_passengers: Note,
    impossible_passengers: Note,
    drifted_passengers: Note,
    missing_passengers: u64,
    unreadable_door: Note,
    impossible_door: Note,
    missing_door: Note,
    last_missing_door_s: i64,
    unreadable_ambient: Note,
    celsius: Note,
    unreadable_speed: Note,
    impossible_speed: Note,
    unreadable_power: Note,
    impossible_power: Note,
}

/// A value that lies where it can; NaN for others, which are noted.
fn known(value: Option<f64>, range: (f64, f64), line: u64, unreadable: &mut Note, impossible: &mut Note) -> f64 {
    match value {
        Some(value) if value.is_nan() || (range.0..=range.1).contains(&value) => value,
        Some(_) => {
            impossible.at(line);
            f64::NAN
        }
        None => {
            unreadable.at(line);
            f64::NAN
        }
    }
}

/// How many seconds of each segment the bus is on which route.
#[derive(Debug, Default)]
pub(super) struct Routes<'b> {
    /// Runs of rows: segment, route, how many.
    runs: Vec<(usize, &'b [u8], u64)>,
}

impl<'b> Routes<'b> {
    fn add(&mut self, segment: usize, route: &'b [u8]) {
        match self.runs.last_mut() {
            // Byte by byte: there are two or three.
            Some((last, same, count)) if *last == segment && same.iter().eq(route) => *count += 1,
            _ => self.runs.push((segment, route, 1)),
        }
    }

    /// The route of most seconds of a segment, the first of equals; `None` where no second has one.
    pub fn of(&self, segment: usize) -> Option<String> {
        self.most(|s| s == segment)
    }

    /// The same of the whole mission.
    pub fn of_mission(&self) -> Option<String> {
        self.most(|_| true)
    }

    fn most(&self, wanted: impl Fn(usize) -> bool) -> Option<String> {
        let mut seconds: Vec<(&[u8], u64)> = Vec::new();
        for (_, route, count) in self.runs.iter().filter(|(s, route, _)| wanted(*s) && !route.is_empty()) {
            match seconds.iter_mut().find(|(same, _)| same == route) {
                Some((_, sum)) => *sum += count,
                None => seconds.push((route, *count)),
            }
        }
        let most = seconds.iter().map(|(_, sum)| *sum).max()?;
        let (route, _) = seconds.iter().find(|(_, sum)| *sum == most)?;
        Some(String::from_utf8_lossy(route).trim().chars().take(LONGEST_ROUTE).collect())
    }
}

pub(super) struct Reader<'b> {
    clock: Clock,
    pub adder: Adder,
    pub notes: Notes,
    /// First and last second that has a row, and the line of the last row at all.
    pub span: Option<(i64, i64)>,
    pub last_line: u64,
    pub loads: Vec<LoadChange>,
    pub routes: Routes<'b>,
    /// How the rows are to be understood.
    rules: Rules,
    /// What the last row says of how the bus drives: line, second, drive, route.
    last: Option<(u64, i64, Drive, &'b [u8])>,
}

/// How rows are to be understood.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rules {
    /// Whether they say a share of the doors instead of whether one is open.
    pub doors_are_shares: bool,
    /// How long a row holds when none follows, in s.
    pub hold_s: u32,
}

impl Rules {
    /// One row a second, and flags.
    pub const ZTBUS: Self = Self { doors_are_shares: false, hold_s: 1 };
}

impl<'b> Reader<'b> {
    pub fn new(clock: Clock, rules: Rules) -> Self {
        Self {
            clock,
            rules,
            last: None,
            adder: Adder::new(clock),
            notes: Notes::default(),
            span: None,
            last_line: 1,
            loads: Vec::new(),
            routes: Routes::default(),
        }
    }

    pub fn take(&mut self, row: Row<'b>) {
        let (i, notes) = (row.line, &mut self.notes);
        self.last_line = i;
        let Some(time_s) = row.time_s else { return notes.unreadable_time.at(i) };
        if time_s < self.clock.start_s || time_s >= self.clock.end_s {
            return notes.outside.at(i);
        }
        if let Some((_, last_s)) = self.span
            && time_s <= last_s
        {
            let note = if time_s == last_s { &mut notes.duplicate } else { &mut notes.backwards };
            return note.at(i);
        }
        if let Some((line, last_s, drive, route)) = self.last {
            for second in last_s + 1..time_s.min(last_s + i64::from(self.rules.hold_s)) {
                let segment = self.adder.add(line, second, self.adder.state(), drive);
                self.routes.add(segment, route);
            }
        }
        let next_s = self.adder.next_s();
        if time_s > next_s {
            notes.gaps.at(i);
            notes.gap_seconds += time_s - next_s;
        }
        let mut state = self.adder.state();
        match row.passengers {
            Some(count) if (0.0..=MAX_PASSENGERS).contains(&count) => state.passengers = count,
            Some(count) if count.is_nan() => notes.missing_passengers += 1,
            // Counters drift: what is a little below none is none.
            Some(count) if (-MAX_DRIFT..0.0).contains(&count) => {
                state.passengers = 0.0;
                notes.drifted_passengers.at(i);
            }
            Some(_) => notes.impossible_passengers.at(i),
            None => notes.unreadable_passengers.at(i),
        }
        match row.door {
            Some(open @ (0.0 | 1.0)) => state.door_open = open,
            Some(share) if self.rules.doors_are_shares && (0.0..=1.0).contains(&share) => state.door_open = share,
            Some(flag) if flag.is_nan() => {
                notes.missing_door.at(i);
                notes.last_missing_door_s = time_s;
            }
            Some(_) => notes.impossible_door.at(i),
            None => notes.unreadable_door.at(i),
        }
        match row.ambient_k {
            Some(kelvin) if kelvin < COLDEST_K => notes.celsius.at(i),
            Some(_) => {}
            None => notes.unreadable_ambient.at(i),
        }
        if state != self.adder.state() {
            let second = (time_s - self.clock.start_s) as u32;
            self.loads.push(LoadChange { second, passengers: state.passengers, door_open: state.door_open });
        }
        let drive = Drive {
            speed_m_s: known(row.speed_m_s, SPEEDS_M_S, i, &mut notes.unreadable_speed, &mut notes.impossible_speed),
            power_w: known(row.power_w, POWERS_W, i, &mut notes.unreadable_power, &mut notes.impossible_power),
        };
        let segment = self.adder.add(i, time_s, state, drive);
        self.routes.add(segment, row.route);
        self.last = Some((i, time_s, drive, row.route));
        self.span = Some((self.span.map_or(time_s, |(first, _)| first), time_s));
    }
}

impl Notes {
    /// Why a mission of so many rows is refused: a needed column that is mostly unusable.
    pub fn refusal(&self, rows: u64, table: &Table<'_>) -> Option<Finding> {
        let columns = [
            (table.time, self.unreadable_time, Note::default(), rows),
            (table.passengers, self.unreadable_passengers, self.impossible_passengers, rows - self.missing_passengers),
            (table.door, self.unreadable_door, self.impossible_door, rows - self.missing_door.count),
        ];
        columns.into_iter().find_map(|(column, unreadable, impossible, values)| {
            let unusable = unreadable.count + impossible.count;
            let few = unusable < FEW_UNUSABLE && unusable < values;
            if few || unusable as f64 <= MAX_UNUSABLE_SHARE * values as f64 {
                return None;
            }
            let line = unreadable.line.or(impossible.line)?;
            let text = table.text_at(line, column).unwrap_or_default();
            let message = format!(
                "{text:?}: {unusable} of {values} values cannot be used, more than {:.0} %; probably {}",
                100.0 * MAX_UNUSABLE_SHARE,
                likely_cause(&text)
            );
            Some(Finding::whole(FindingKind::RefusedValue, message).in_column(column).at_line(line).times(unusable))
        })
    }

    pub fn findings(mut self, last_s: i64, table: &Table<'_>) -> Vec<Finding> {
        use FindingKind::{
            DuplicateRow, MissingValue, NegativeOffset, OutOfRange, RefusedRow, RefusedValue, TimeGap, UnusedValue,
            WrongUnit,
        };
        // The last row of a mission may have no flags: nothing follows that would need them.
        if self.missing_door.count == 1 && self.last_missing_door_s == last_s {
            self.missing_door = Note::default();
        }
        let gaps = format!("{} s without a row; the state before holds", self.gap_seconds);
        let notes: [(Note, FindingKind, &str, &str); 17] = [
            (self.unreadable_time, RefusedRow, table.time, "not a time that can be read; correct the rows"),
            (self.outside, RefusedRow, table.time, "outside the span that the file's name says; correct rows or name"),
            (self.backwards, RefusedRow, table.time, "time runs backwards; sort the file by time"),
            (self.duplicate, DuplicateRow, table.time, "the same second again; the first row counts"),
            (self.gaps, TimeGap, table.time, &gaps),
            (self.unreadable_passengers, RefusedValue, table.passengers, "not a number; the last count holds"),
            (
                self.impossible_passengers,
                OutOfRange,
                table.passengers,
                "outside 0 … 250 passengers; the last count holds",
            ),
            (
                self.drifted_passengers,
                NegativeOffset,
                table.passengers,
                "the counter drifts below none; taken as an empty bus",
            ),
            (self.unreadable_door, RefusedValue, table.door, "not 0, 1 or NaN; the last state holds"),
            (self.impossible_door, OutOfRange, table.door, "not 0, 1 or NaN; the last state holds"),
            (self.missing_door, MissingValue, table.door, "no state; the last one holds"),
            (self.unreadable_ambient, UnusedValue, table.ambient, "not a number; the column is checked, not used"),
            (self.unreadable_speed, UnusedValue, table.speed, "not a number; taken as missing"),
            (self.impossible_speed, UnusedValue, table.speed, "outside -5 … 50 m/s; taken as missing"),
            (self.unreadable_power, UnusedValue, table.power, "not a number; taken as missing"),
            (self.impossible_power, UnusedValue, table.power, "outside -2 … 2 MW; taken as missing"),
            (self.celsius, WrongUnit, table.ambient, "below 150 K, probably in °C; the column is checked, not used"),
        ];
        let noticed = notes.into_iter().filter_map(|(note, kind, column, message)| {
            let line = note.line?;
            let text = match kind {
                RefusedRow | RefusedValue | UnusedValue | OutOfRange | WrongUnit | NegativeOffset => {
                    match table.text_at(line, column) {
                        Some(text) => format!("{text:?}: {message}"),
                        None => message.to_owned(),
                    }
                }
                _ => message.to_owned(),
            };
            let finding = Finding::whole(kind, text).in_column(column).at_line(line);
            Some(finding.times(note.count))
        });
        noticed.collect()
    }
}
