//! Missions: where they are found, and what their telemetry says of each segment. ZTBus has a file for each; the tables of
//! other operators (`table`) have one or many.

mod choice;
mod discover;
mod rows;
mod table;

use cabin::LoadChange;
use chrono::{DateTime, TimeDelta, Utc};

use crate::segments::{Clock, Sums};
use crate::telemetry::{Table, Telemetry};
use crate::{Content, ExcludedSegment, ExclusionReason, FileKind, FileRecord, Finding, FindingKind};
use rows::{Reader, Routes, Rules};

pub use choice::{NO_ROUTE, RouteChoice};
pub use discover::{Discovery, MissionFormat, MissionSource, discover, mission_name, overlaps, span_of_name};
pub use table::{Door, TelemetryMap, Vehicle};

/// Share of a segment's seconds that may be without telemetry.
const MAX_MISSING_SHARE: f64 = 0.01;

/// How missions become segments.
#[derive(Debug, Clone, PartialEq)]
pub struct MissionOptions {
    /// Length of a segment in s, counted from the start of each mission; 3600 in the paper.
    pub segment_s: u32,
    /// Share of the doors that open when "a door is open": 0.6 in the paper (section 2.1).
    pub door_open_share: f64,
    /// Whether a last part that is shorter than a segment makes a segment of its own.
    pub keep_partial: bool,
    /// Whose missions make samples.
    pub routes: RouteChoice,
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
    /// Distance in m; `None` where more than 1 % of the seconds have no speed.
    pub distance_m: Option<f64>,
    /// Mean electric power that the bus takes from its supplies in W; `None` where more than 1 % of the seconds have none.
    pub vehicle_power_w: Option<f64>,
    /// The route of most seconds; `None` where the bus is on none.
    pub route: Option<String>,
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

impl MissionReading {
    /// The reading of a file that cannot be used.
    #[must_use]
    pub fn refused(file: FileRecord) -> Self {
        Self { file, segments: Vec::new(), excluded: Vec::new(), loads: Vec::new() }
    }
}

/// What the telemetry of a mission says of each of its segments.
///
/// A row at `t` stands for `[t, t + 1)`. The last passenger count holds until the next, and before the first the bus is
/// empty; a door flag that is missing holds the last one.
#[must_use]
pub fn read(source: &MissionSource, content: &Content, options: &MissionOptions) -> MissionReading {
    let bytes = content.bytes.len() as u64;
    let refused = |finding| {
        let file = FileRecord::refused(&source.path, FileKind::Mission, &content.blake3, bytes, finding);
        MissionReading::refused(file.stamped(content.stamp))
    };
    let clock = Clock {
        start_s: source.start.timestamp(),
        end_s: source.end.timestamp() + 1,
        segment_s: i64::from(options.segment_s),
    };
    let part = source.part();
    let rules =
        part.map_or(Rules::ZTBUS, |part| Rules { doors_are_shares: part.map.door.is_share(), hold_s: part.map.hold_s });
    let mut reader = Reader::new(clock, rules);
    let table = part.map_or_else(|| Table::ztbus(&content.bytes), |part| part.table(&content.bytes));
    let read = match part {
        Some(part) => part.read(&content.bytes, &mut reader),
        None => Telemetry::read(&content.bytes).and_then(|telemetry| telemetry.for_each(|row| reader.take(row))),
    };
    let rows = match read {
        Ok(rows) => rows,
        Err(finding) => return refused(finding),
    };
    let Reader { adder, notes, span, last_line, loads, routes, .. } = reader;
    if let Some(finding) = notes.refusal(rows, &table) {
        return refused(finding);
    }
    let Some((first_s, last_s)) = span else {
        let (start, end) = (source.start, source.end);
        let message =
            format!("no row lies between {start} and {end}, as the file's name says; check name and {}", table.time);
        return refused(Finding::whole(FindingKind::RefusedRow, message).in_column(table.time));
    };

    let mut findings = notes.findings(last_s, &table);
    if last_s + 1 < clock.end_s {
        let message = format!(
            "the telemetry ends {} s before the file's name says; whole segments are kept: fetch the file again",
            clock.end_s - 1 - last_s
        );
        findings.push(Finding::whole(FindingKind::Truncated, message).at_line(last_line));
    }
    let (segments, excluded) = segments(source, clock, options, &adder.finish(), &routes);
    let time = |seconds| DateTime::from_timestamp(seconds, 0);
    let file = FileRecord {
        path: source.path.clone(),
        kind: FileKind::Mission,
        blake3: content.blake3.clone(),
        bytes,
        rows,
        first: time(first_s),
        last: time(last_s),
        stamp: content.stamp,
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
    routes: &Routes<'_>,
) -> (Vec<Segment>, Vec<ExcludedSegment>) {
    let (mut kept, mut excluded) = (Vec::new(), Vec::new());
    let route = routes.of_mission();
    let left_out = !options.routes.takes(route.as_deref());
    for (number, sums) in sums.iter().enumerate() {
        let start_s = clock.start_s + number as i64 * clock.segment_s;
        let duration_s = clock.segment_s.min(clock.end_s - start_s);
        let start = source.start + TimeDelta::seconds(start_s - clock.start_s);
        let missing = (duration_s - sums.observed_s) as f64;
        let reason = if left_out {
            Some(ExclusionReason::Route { route: route.clone() })
        } else if duration_s < clock.segment_s && !options.keep_partial {
            Some(ExclusionReason::Partial { segment_s: options.segment_s })
        } else if missing > MAX_MISSING_SHARE * duration_s as f64 {
            Some(ExclusionReason::TelemetryGap)
        } else {
            None
        };
        // Of the sum, where nearly all seconds have a value.
        let mean = |(sum, seconds): (f64, i64)| {
            let missing = (duration_s - seconds) as f64;
            (seconds > 0 && missing <= MAX_MISSING_SHARE * duration_s as f64).then(|| sum / seconds as f64)
        };
        match (reason, sums.lines) {
            (None, Some((first, last))) => kept.push(Segment {
                mission: source.name.clone(),
                source_path: source.path.clone(),
                bus: source.bus,
                segment: number as u32,
                start,
                duration_s: duration_s as u32,
                passengers: sums.passenger_seconds / duration_s as f64,
                door_open_fraction: sums.door_seconds / duration_s as f64 * options.door_open_share,
                distance_m: mean(sums.speed).map(|speed_m_s| speed_m_s * duration_s as f64),
                vehicle_power_w: mean(sums.power),
                route: routes.of(number),
                first_line: first,
                last_line: last,
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
