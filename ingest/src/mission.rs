//! ZTBus missions: where they are found, and what their telemetry says of each segment.

use cabin::LoadChange;
use chrono::{DateTime, NaiveDateTime, TimeDelta, Utc};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use crate::files::{extension, label, list, open_archive};
use crate::segments::{Adder, Clock, Sums};
use crate::telemetry::{AMBIENT, DOOR, PASSENGERS, Row, TIME, Telemetry};
use crate::{Content, ExcludedSegment, ExclusionReason, FileKind, FileRecord, Finding, FindingKind, IngestError};

/// Share of a segment's seconds that may be without telemetry.
const MAX_MISSING_SHARE: f64 = 0.01;
/// Largest believable number of passengers: an articulated bus holds about 150.
const MAX_PASSENGERS: f64 = 250.0;
/// No mission is longer; a name that says so is a misprint.
const MAX_DURATION: TimeDelta = TimeDelta::days(7);
/// Below this a temperature in K is one in °C.
const COLDEST_K: f64 = 150.0;

/// A mission file that was found.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MissionSource {
    /// Name of the mission: the file's name without its extension.
    pub name: String,
    /// Path as the study names it; the entry of an archive follows a `!`.
    pub path: String,
    /// Number of the bus.
    pub bus: u32,
    /// First second, from the name.
    pub start: DateTime<Utc>,
    /// Last second, from the name.
    pub end: DateTime<Utc>,
    place: Place,
}

#[derive(Debug, Clone, PartialEq, Eq)]
enum Place {
    File(PathBuf),
    Entry { archive: PathBuf, index: usize },
}

/// What was found where the study says that missions are.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Discovery {
    /// The missions of the wanted buses, by name.
    pub missions: Vec<MissionSource>,
    /// Files that look like missions and cannot be used, by path.
    pub refused: Vec<FileRecord>,
}

/// How missions become segments.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MissionOptions {
    /// Length of a segment in s, counted from the start of each mission; 3600 in the paper.
    pub segment_s: u32,
    /// Share of the doors that open when "a door is open": 0.6 in the paper (section 2.1).
    pub door_open_share: f64,
    /// Whether a last part that is shorter than a segment makes a segment of its own.
    pub keep_partial: bool,
}

/// What the telemetry says of a part of a mission.
#[derive(Debug, Clone, PartialEq)]
pub struct Segment {
    /// Name of the mission.
    pub mission: String,
    /// Path of its file, as the study names it.
    pub source_path: String,
    /// Number of the bus.
    pub bus: u32,
    /// Number of the segment, from 0.
    pub segment: u32,
    /// Its start.
    pub start: DateTime<Utc>,
    /// Its length in s.
    pub duration_s: u32,
    /// Mean number of passengers.
    pub passengers: f64,
    /// Mean fraction of the doors that is open.
    pub door_open_fraction: f64,
    /// First line of the mission file that belongs to it; the header is line 1.
    pub first_line: u64,
    /// Last line.
    pub last_line: u64,
}

/// A mission that was read.
#[derive(Debug, Clone, PartialEq)]
pub struct MissionReading {
    /// What is known of its file.
    pub file: FileRecord,
    /// Its segments, in order.
    pub segments: Vec<Segment>,
    /// Segments that its telemetry cannot fill.
    pub excluded: Vec<ExcludedSegment>,
    /// How passengers and doors change, in the order of time; before the first the bus is empty and closed.
    pub loads: Vec<LoadChange>,
}

/// Finds missions in a folder, a glob, one file or a `.zip`, relative to `base`. No `buses` means all of them.
///
/// The path must be there and hold at least one mission of the wanted buses. Files with the extension `csv` that are
/// no mission, other than `metaData.csv`, are refused with a finding.
///
/// # Errors
/// [`IngestError`] where the path does not exist or holds no mission.
pub fn discover(base: &Path, pattern: &str, buses: &[u32]) -> Result<Discovery, IngestError> {
    let mut found = Discovery::default();
    for path in list(base, pattern)? {
        match extension(&path).as_str() {
            "csv" => found.take(&label(base, &path), &path, Place::File(path.clone())),
            "zip" => found.take_archive(base, &path),
            _ => {}
        }
    }
    let mut others: Vec<u32> = found.missions.iter().map(|m| m.bus).collect();
    found.missions.retain(|m| buses.is_empty() || buses.contains(&m.bus));
    found.missions.sort_by(|a, b| (&a.name, &a.path).cmp(&(&b.name, &b.path)));
    found.refuse_twins();
    found.refused.sort_by(|a, b| a.path.cmp(&b.path));
    if found.missions.is_empty() {
        others.sort_unstable();
        others.dedup();
        let detail = match (others.is_empty(), found.refused.first()) {
            (false, _) => format!("of the buses {buses:?}, but of {others:?}; change `buses`"),
            (true, Some(file)) => format!("that can be used; {}: {}", file.path, file.findings[0]),
            (true, None) => {
                "(files named B183_2021-07-26_03-53-27_2021-07-26_07-18-47.csv, or a .zip of them)".to_owned()
            }
        };
        return Err(IngestError::NoMissions { path: base.join(pattern), detail });
    }
    Ok(found)
}

impl Discovery {
    fn take(&mut self, label: &str, file: &Path, place: Place) {
        let stem = file.file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
        if stem.eq_ignore_ascii_case("metaData") {
            return;
        }
        match parse_name(&stem) {
            Ok((bus, start, end)) => {
                self.missions.push(MissionSource { name: stem, path: label.to_owned(), bus, start, end, place });
            }
            Err(reason) => self.refuse(label, Finding::whole(FindingKind::NotAMission, reason)),
        }
    }

    fn take_archive(&mut self, base: &Path, path: &Path) {
        let label = label(base, path);
        let mut archive = match open_archive(path) {
            Ok(archive) => archive,
            Err(error) => {
                let message = format!("not a readable zip archive: {error}; fetch it again");
                return self.refuse(&label, Finding::whole(FindingKind::Unreadable, message));
            }
        };
        for index in 0..archive.len() {
            let (entry_label, inside) = match archive.by_index_raw(index) {
                Ok(entry) if entry.is_dir() => continue,
                Ok(entry) => {
                    let name = String::from_utf8_lossy(entry.name_raw()).into_owned();
                    (format!("{label}!{name}"), entry.enclosed_name())
                }
                Err(error) => {
                    let message = format!("the entry cannot be read: {error}; fetch the archive again");
                    self.refuse(&format!("{label}!{index}"), Finding::whole(FindingKind::Unreadable, message));
                    continue;
                }
            };
            match inside {
                Some(file) if extension(&file) == "csv" => {
                    self.take(&entry_label, &file, Place::Entry { archive: path.to_owned(), index });
                }
                Some(_) => {}
                None => {
                    let message =
                        "its path leads out of the archive; such an archive is broken or hostile: fetch it again";
                    self.refuse(&entry_label, Finding::whole(FindingKind::UnsafePath, message));
                }
            }
        }
    }

    /// The same mission twice would count twice: the first path is kept.
    fn refuse_twins(&mut self) {
        let mut kept: BTreeMap<String, String> = BTreeMap::new();
        for mission in std::mem::take(&mut self.missions) {
            if let Some(first) = kept.get(&mission.name) {
                let message = format!("the mission is there already as {first}; remove one of them");
                self.refuse(&mission.path, Finding::whole(FindingKind::Overlap, message));
                continue;
            }
            kept.insert(mission.name.clone(), mission.path.clone());
            self.missions.push(mission);
        }
    }

    fn refuse(&mut self, path: &str, finding: Finding) {
        self.refused.push(FileRecord::refused(path, FileKind::Mission, "", 0, finding));
    }
}

/// Bus, first and last second from `B183_2021-07-26_03-53-27_2021-07-26_07-18-47`.
fn parse_name(stem: &str) -> Result<(u32, DateTime<Utc>, DateTime<Utc>), String> {
    let parsed = || {
        let (bus, times) = stem.strip_prefix('B')?.split_once('_')?;
        let (start, end) = (times.get(..19)?, times.get(20..)?);
        let time = |text| NaiveDateTime::parse_from_str(text, "%Y-%m-%d_%H-%M-%S").ok().map(|t| t.and_utc());
        Some((bus.parse().ok()?, time(start)?, time(end)?))
    };
    let form = "B<bus>_<first second>_<last second>.csv, such as B183_2021-07-26_03-53-27_2021-07-26_07-18-47.csv";
    let (bus, start, end) = parsed().ok_or_else(|| format!("the name is not that of a mission: {form}"))?;
    if end < start || end - start > MAX_DURATION {
        return Err(format!("the name says a mission from {start} to {end}; it must last from 1 s to 7 days"));
    }
    Ok((bus, start, end))
}

impl MissionSource {
    /// Reads the bytes into a buffer, which may be that of a mission that is done with.
    ///
    /// # Errors
    /// The record of a refused file.
    pub fn load(&self, buffer: Vec<u8>) -> Result<Content, FileRecord> {
        let content = match &self.place {
            Place::File(path) => Content::read_into(path, buffer),
            Place::Entry { archive, index } => Content::read_entry(archive, *index, buffer),
        };
        content.map_err(|finding| FileRecord::refused(&self.path, FileKind::Mission, "", 0, finding))
    }
}

/// What the telemetry of a mission says of each of its segments.
///
/// A row at `t` stands for `[t, t + 1)`. The last passenger count holds until the next, and before the first the bus is
/// empty; a door flag that is missing holds the last one.
#[must_use]
pub fn read(source: &MissionSource, content: &Content, options: &MissionOptions) -> MissionReading {
    let bytes = content.bytes.len() as u64;
    let refused = |finding| MissionReading {
        file: FileRecord::refused(&source.path, FileKind::Mission, &content.blake3, bytes, finding),
        segments: Vec::new(),
        excluded: Vec::new(),
        loads: Vec::new(),
    };
    let telemetry = match Telemetry::read(&content.bytes) {
        Ok(telemetry) => telemetry,
        Err(finding) => return refused(finding),
    };
    let clock = Clock {
        start_s: source.start.timestamp(),
        end_s: source.end.timestamp() + 1,
        segment_s: i64::from(options.segment_s),
    };
    let mut reader = Reader::new(clock);
    telemetry.for_each(|i, row| reader.take(i, row));
    let Reader { adder, notes, span, loads, .. } = reader;
    let Some((first_s, last_s)) = span else {
        let (start, end) = (source.start, source.end);
        let message = format!("no row lies between {start} and {end}, as the file's name says; check name and {TIME}");
        return refused(Finding::whole(FindingKind::RefusedRow, message).in_column(TIME));
    };

    let mut findings = notes.findings(&telemetry, &content.bytes, last_s);
    if last_s + 1 < clock.end_s {
        let message = format!(
            "the telemetry ends {} s before the file's name says; whole segments are kept: fetch the file again",
            clock.end_s - 1 - last_s
        );
        let line = telemetry.line(telemetry.len() - 1);
        findings.push(Finding::whole(FindingKind::Truncated, message).at_line(line));
    }
    let (segments, excluded) = segments(source, clock, options, &adder.finish(), &telemetry);
    let time = |seconds| DateTime::from_timestamp(seconds, 0);
    let file = FileRecord {
        path: source.path.clone(),
        kind: FileKind::Mission,
        blake3: content.blake3.clone(),
        bytes,
        rows: telemetry.len() as u64,
        first: time(first_s),
        last: time(last_s),
        accepted: true,
        findings,
    };
    MissionReading { file, segments, excluded, loads }
}

fn segments(
    source: &MissionSource,
    clock: Clock,
    options: &MissionOptions,
    sums: &[Sums],
    telemetry: &Telemetry,
) -> (Vec<Segment>, Vec<ExcludedSegment>) {
    let (mut kept, mut excluded) = (Vec::new(), Vec::new());
    for (number, sums) in sums.iter().enumerate() {
        let start_s = clock.start_s + number as i64 * clock.segment_s;
        let duration_s = clock.segment_s.min(clock.end_s - start_s);
        let start = source.start + TimeDelta::seconds(start_s - clock.start_s);
        let missing = (duration_s - sums.observed_s) as f64;
        let reason = if duration_s < clock.segment_s && !options.keep_partial {
            Some(ExclusionReason::Partial { segment_s: options.segment_s })
        } else if missing > MAX_MISSING_SHARE * duration_s as f64 {
            Some(ExclusionReason::TelemetryGap)
        } else {
            None
        };
        match (reason, sums.rows) {
            (None, Some((first, last))) => kept.push(Segment {
                mission: source.name.clone(),
                source_path: source.path.clone(),
                bus: source.bus,
                segment: number as u32,
                start,
                duration_s: duration_s as u32,
                passengers: sums.passenger_seconds / duration_s as f64,
                door_open_fraction: sums.door_seconds as f64 / duration_s as f64 * options.door_open_share,
                first_line: telemetry.line(first),
                last_line: telemetry.line(last),
            }),
            (reason, _) => excluded.push(ExcludedSegment {
                mission: source.name.clone(),
                bus: source.bus,
                segment: number as u32,
                start,
                duration_s: duration_s as u32,
                reason: reason.unwrap_or(ExclusionReason::TelemetryGap).to_string(),
            }),
        }
    }
    (kept, excluded)
}

/// Something that happened in rows: how often, and where first.
#[derive(Debug, Clone, Copy, Default)]
struct Note {
    count: u64,
    row: Option<usize>,
}

impl Note {
    fn at(&mut self, row: usize) {
        self.count += 1;
        self.row.get_or_insert(row);
    }
}

/// What was noticed while reading rows.
#[derive(Debug, Default)]
struct Notes {
    unreadable_time: Note,
    outside: Note,
    backwards: Note,
    duplicate: Note,
    gaps: Note,
    gap_seconds: i64,
    unreadable_passengers: Note,
    impossible_passengers: Note,
    unreadable_door: Note,
    impossible_door: Note,
    missing_door: Note,
    last_missing_door_s: i64,
    unreadable_ambient: Note,
    celsius: Note,
}

struct Reader {
    clock: Clock,
    adder: Adder,
    notes: Notes,
    /// First and last second that has a row.
    span: Option<(i64, i64)>,
    loads: Vec<LoadChange>,
}

impl Reader {
    fn new(clock: Clock) -> Self {
        Self { clock, adder: Adder::new(clock), notes: Notes::default(), span: None, loads: Vec::new() }
    }

    fn take(&mut self, i: usize, row: Row) {
        let notes = &mut self.notes;
        let Some(time_s) = row.time_s else { return notes.unreadable_time.at(i) };
        if time_s < self.clock.start_s || time_s >= self.clock.end_s {
            return notes.outside.at(i);
        }
        let next_s = self.adder.next_s();
        if let Some((_, last_s)) = self.span
            && time_s <= last_s
        {
            let note = if time_s == last_s { &mut notes.duplicate } else { &mut notes.backwards };
            return note.at(i);
        }
        if time_s > next_s {
            notes.gaps.at(i);
            notes.gap_seconds += time_s - next_s;
        }
        let mut state = self.adder.state();
        match row.passengers {
            Some(count) if (0.0..=MAX_PASSENGERS).contains(&count) => state.passengers = count,
            Some(count) if count.is_nan() => {}
            Some(_) => notes.impossible_passengers.at(i),
            None => notes.unreadable_passengers.at(i),
        }
        match row.door {
            Some(1.0) => state.door_open = true,
            Some(0.0) => state.door_open = false,
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
        self.adder.add(i, time_s, state);
        self.span = Some((self.span.map_or(time_s, |(first, _)| first), time_s));
    }
}

impl Notes {
    fn findings(mut self, telemetry: &Telemetry, bytes: &[u8], last_s: i64) -> Vec<Finding> {
        use FindingKind::{DuplicateRow, MissingValue, OutOfRange, RefusedRow, RefusedValue, TimeGap, WrongUnit};
        // The last row of a mission may have no flags: nothing follows that would need them.
        if self.missing_door.count == 1 && self.last_missing_door_s == last_s {
            self.missing_door = Note::default();
        }
        let gaps = format!("{} s without a row; the state before holds", self.gap_seconds);
        let notes: [(Note, FindingKind, &str, &str); 12] = [
            (self.unreadable_time, RefusedRow, TIME, "not a whole number of seconds since 1970; correct the rows"),
            (self.outside, RefusedRow, TIME, "outside the span that the file's name says; correct rows or name"),
            (self.backwards, RefusedRow, TIME, "time runs backwards; sort the file by time"),
            (self.duplicate, DuplicateRow, TIME, "the same second again; the first row counts"),
            (self.gaps, TimeGap, TIME, &gaps),
            (self.unreadable_passengers, RefusedValue, PASSENGERS, "not a number; the last count holds"),
            (self.impossible_passengers, OutOfRange, PASSENGERS, "outside 0 … 250 passengers; the last count holds"),
            (self.unreadable_door, RefusedValue, DOOR, "not 0, 1 or NaN; the last state holds"),
            (self.impossible_door, OutOfRange, DOOR, "not 0, 1 or NaN; the last state holds"),
            (self.missing_door, MissingValue, DOOR, "no state; the last one holds"),
            (self.unreadable_ambient, RefusedValue, AMBIENT, "not a number; the column is checked, not used"),
            (self.celsius, WrongUnit, AMBIENT, "below 150 K, probably in °C; the column is checked, not used"),
        ];
        let noticed = notes.into_iter().filter_map(|(note, kind, column, message)| {
            let row = note.row?;
            let line = telemetry.line(row);
            let text = match kind {
                RefusedRow | RefusedValue | OutOfRange | WrongUnit => match text_at(bytes, line, column) {
                    Some(text) => format!("{text:?}: {message}"),
                    None => message.to_owned(),
                },
                _ => message.to_owned(),
            };
            let finding = Finding::whole(kind, text).in_column(column).at_line(line);
            Some(finding.times(note.count))
        });
        noticed.collect()
    }
}

/// The text of a field on a line, cut to a length that fits a message.
fn text_at(bytes: &[u8], line: u64, column: &str) -> Option<String> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let position = csv::Reader::from_reader(bytes).headers().ok()?.iter().position(|h| h.trim() == column)?;
    let before = usize::try_from(line).ok()?.checked_sub(2)?;
    let start = bytes.iter().enumerate().filter(|(_, b)| **b == b'\n').nth(before)?.0 + 1;
    let end = bytes[start..].iter().position(|&b| b == b'\n').map_or(bytes.len(), |n| start + n);
    let mut reader = csv::ReaderBuilder::new().has_headers(false).flexible(true).from_reader(&bytes[start..end]);
    let record = reader.byte_records().next()?.ok()?;
    Some(String::from_utf8_lossy(record.get(position)?).chars().take(40).collect())
}

/// Missions during which the bus is on another mission already, as (index, the other's path). Of two that overlap, the
/// one that starts later goes (of two that start together, the later name). `missions` are sorted by name.
#[must_use]
pub fn overlaps(missions: &[MissionSource]) -> Vec<(usize, FileRecord)> {
    let mut order: Vec<usize> = (0..missions.len()).collect();
    order.sort_by_key(|&i| (missions[i].bus, missions[i].start, i));
    let mut refused = Vec::new();
    let mut last: Option<&MissionSource> = None;
    for i in order {
        let mission = &missions[i];
        match last {
            Some(other) if other.bus == mission.bus && mission.start <= other.end => {
                let message = format!(
                    "bus {} is on the mission {} until {}; one of them is wrong: remove it",
                    mission.bus, other.path, other.end
                );
                let finding = Finding::whole(FindingKind::Overlap, message);
                refused.push((i, FileRecord::refused(&mission.path, FileKind::Mission, "", 0, finding)));
            }
            _ => last = Some(mission),
        }
    }
    refused.sort_by_key(|(i, _)| *i);
    refused
}
