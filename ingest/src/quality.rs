//! The record of data quality.

use chrono::{DateTime, Utc};
use std::fmt;

use crate::FileStamp;

/// What a file holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum FileKind {
    /// Telemetry of one mission.
    Mission,
    /// Weather.
    Weather,
    /// Shadow fractions.
    Shadow,
}

impl FileKind {
    /// The kind of a name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        [Self::Mission, Self::Weather, Self::Shadow].into_iter().find(|kind| kind.name() == name)
    }

    /// The name in the database.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Mission => "mission",
            Self::Weather => "weather",
            Self::Shadow => "shadow",
        }
    }
}

/// Sorts of findings.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum FindingKind {
    /// The file or archive entry cannot be read.
    Unreadable,
    /// No content, or a header only.
    Empty,
    /// Not the encoding that belongs there.
    WrongEncoding,
    /// Columns separated by something else.
    WrongDelimiter,
    /// A needed column is missing.
    MissingColumn,
    /// A file of another format, or of none that is known.
    OtherFormat,
    /// Stamps that contradict the layout, or the sun.
    WrongStamps,
    /// Stamps close to the interval that they mean.
    MovedStamp,
    /// Stamps of another clock than the file says.
    OtherClock,
    /// A file of another place than the study's.
    OtherPlace,
    /// Months of several years that make one reference year.
    ReferenceYear,
    /// A mission that was not there when it was last looked for; what came from it is kept.
    MissingFile,
    /// The file's name is not one of a mission.
    NotAMission,
    /// An archive entry whose path leaves the archive.
    UnsafePath,
    /// A mission that is there already, or runs while the bus is on another one.
    Overlap,
    /// Rows that cannot be used.
    RefusedRow,
    /// Values that cannot be read.
    RefusedValue,
    /// Values that cannot be, in a column that no result is computed from.
    UnusedValue,
    /// Values outside the physical range, taken as missing.
    OutOfRange,
    /// Values in another unit than the column's.
    WrongUnit,
    /// Values that are missing where there should be some.
    MissingValue,
    /// Small negative irradiances, taken as 0.
    NegativeOffset,
    /// The same time again; the first row counts.
    DuplicateRow,
    /// Steps of time without a row.
    TimeGap,
    /// Intervals that were interpolated.
    Interpolated,
    /// The file ends before its name says.
    Truncated,
}

impl FindingKind {
    /// All of them.
    pub const ALL: [Self; 26] = [
        Self::Unreadable,
        Self::Empty,
        Self::WrongEncoding,
        Self::WrongDelimiter,
        Self::MissingColumn,
        Self::OtherFormat,
        Self::WrongStamps,
        Self::MovedStamp,
        Self::OtherClock,
        Self::OtherPlace,
        Self::ReferenceYear,
        Self::MissingFile,
        Self::NotAMission,
        Self::UnsafePath,
        Self::Overlap,
        Self::RefusedRow,
        Self::RefusedValue,
        Self::UnusedValue,
        Self::OutOfRange,
        Self::WrongUnit,
        Self::MissingValue,
        Self::NegativeOffset,
        Self::DuplicateRow,
        Self::TimeGap,
        Self::Interpolated,
        Self::Truncated,
    ];

    /// The kind of a name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.name() == name)
    }

    /// The name in the database.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Unreadable => "unreadable",
            Self::Empty => "empty",
            Self::WrongEncoding => "wrong_encoding",
            Self::WrongDelimiter => "wrong_delimiter",
            Self::MissingColumn => "missing_column",
            Self::OtherFormat => "other_format",
            Self::WrongStamps => "wrong_stamps",
            Self::MovedStamp => "moved_stamp",
            Self::OtherClock => "other_clock",
            Self::OtherPlace => "other_place",
            Self::ReferenceYear => "reference_year",
            Self::MissingFile => "missing_file",
            Self::NotAMission => "not_a_mission",
            Self::UnsafePath => "unsafe_path",
            Self::Overlap => "overlap",
            Self::RefusedRow => "refused_row",
            Self::RefusedValue => "refused_value",
            Self::UnusedValue => "unused_value",
            Self::OutOfRange => "out_of_range",
            Self::WrongUnit => "wrong_unit",
            Self::MissingValue => "missing_value",
            Self::NegativeOffset => "negative_offset",
            Self::DuplicateRow => "duplicate_row",
            Self::TimeGap => "time_gap",
            Self::Interpolated => "interpolated",
            Self::Truncated => "truncated",
        }
    }
}

/// Something noticed in a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Finding {
    /// What sort.
    pub kind: FindingKind,
    /// How often.
    pub count: u64,
    /// First line concerned; the header is line 1.
    pub line: Option<u64>,
    /// Column concerned.
    pub column: Option<String>,
    /// What it is and what to do.
    pub message: String,
}

impl Finding {
    /// A finding about a whole file.
    #[must_use]
    pub fn whole(kind: FindingKind, message: impl Into<String>) -> Self {
        Self { kind, count: 1, line: None, column: None, message: message.into() }
    }

    /// The same at a line.
    #[must_use]
    pub fn at_line(mut self, line: u64) -> Self {
        self.line = Some(line);
        self
    }

    /// The same in a column.
    #[must_use]
    pub fn in_column(mut self, column: &str) -> Self {
        self.column = Some(column.to_owned());
        self
    }

    /// The same, seen `count` times.
    #[must_use]
    pub fn times(mut self, count: u64) -> Self {
        self.count = count;
        self
    }
}

/// `line 7, column time_unix: what it is and what to do`
impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.line, &self.column) {
            (Some(line), Some(column)) => write!(f, "line {line}, column {column}: ")?,
            (Some(line), None) => write!(f, "line {line}: ")?,
            (None, Some(column)) => write!(f, "column {column}: ")?,
            (None, None) => {}
        }
        f.write_str(&self.message)
    }
}

/// What is known of an input file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FileRecord {
    /// Path as the study names it; an archive's entry follows a `!`.
    pub path: String,
    /// What it holds.
    pub kind: FileKind,
    /// BLAKE3 of the content, hexadecimal; empty where there is none.
    pub blake3: String,
    /// Size in bytes.
    pub bytes: u64,
    /// Data rows, without the header.
    pub rows: u64,
    /// First time in the file.
    pub first: Option<DateTime<Utc>>,
    /// Last time in the file.
    pub last: Option<DateTime<Utc>>,
    /// The file as it was before it was read; `None` where that vouches for nothing.
    pub stamp: Option<FileStamp>,
    /// Whether the file is used.
    pub accepted: bool,
    /// What was noticed; a refused file has at least one.
    pub findings: Vec<Finding>,
}

impl FileRecord {
    /// The first finding of a value that cannot be used and for which the last one stands; of a mission that is used. A value of
    /// the weather that cannot be used is missing, and its interval interpolated or left out.
    #[must_use]
    pub fn replaced(&self) -> Option<&Finding> {
        let replaced = |f: &&Finding| matches!(f.kind, FindingKind::RefusedValue | FindingKind::OutOfRange);
        let is_used_mission = self.accepted && self.kind == FileKind::Mission;
        self.findings.iter().filter(|_| is_used_mission).find(replaced)
    }

    /// Whether the file was not there when it was last looked for.
    #[must_use]
    pub fn is_missing(&self) -> bool {
        self.findings.iter().any(|finding| finding.kind == FindingKind::MissingFile)
    }

    /// The same record with the stamp of its file.
    #[must_use]
    pub fn stamped(mut self, stamp: Option<FileStamp>) -> Self {
        self.stamp = stamp;
        self
    }

    /// The record of a file that cannot be used.
    #[must_use]
    pub fn refused(path: &str, kind: FileKind, blake3: &str, bytes: u64, finding: Finding) -> Self {
        Self {
            path: path.to_owned(),
            kind,
            blake3: blake3.to_owned(),
            bytes,
            rows: 0,
            first: None,
            last: None,
            stamp: None,
            accepted: false,
            findings: vec![finding],
        }
    }
}

/// Why a segment gives no sample.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub enum ExclusionReason {
    /// The last part of a mission, shorter than a segment.
    Partial {
        /// Length of a segment in s.
        segment_s: u32,
    },
    /// Too many seconds without telemetry.
    TelemetryGap,
    /// The study leaves missions on this route out, or on none.
    Route {
        /// The route of most seconds of the mission.
        route: Option<String>,
    },
    /// The weather record has a gap that is too long to interpolate.
    WeatherGap {
        /// Longest gap that is interpolated, in s.
        max_gap_s: u32,
    },
    /// The weather record does not reach there.
    OutsideWeather,
}

impl fmt::Display for ExclusionReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Partial { segment_s } => write!(f, "last part of the mission, shorter than {segment_s} s"),
            Self::TelemetryGap => f.write_str("more than 1 % of the seconds have no telemetry"),
            Self::Route { route: Some(route) } => write!(f, "mission on route {route}, which the study leaves out"),
            Self::Route { route: None } => f.write_str("mission on no route, which the study leaves out"),
            Self::WeatherGap { max_gap_s } => write!(f, "weather gap longer than {max_gap_s} s"),
            Self::OutsideWeather => f.write_str("outside the weather record"),
        }
    }
}

/// A segment that gives no sample.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ExcludedSegment {
    /// Name of the mission.
    pub mission: String,
    /// Number of the bus.
    pub bus: u32,
    /// Number of the segment, from 0.
    pub segment: u32,
    /// Its start.
    pub start: DateTime<Utc>,
    /// Its length in s.
    pub duration_s: u32,
    /// Why, as an [`ExclusionReason`] or a check of the model says it.
    pub reason: String,
}

impl ExcludedSegment {
    /// Whether it is the weather that it lacks.
    #[must_use]
    pub fn lacks_weather(&self) -> bool {
        self.reason == ExclusionReason::OutsideWeather.to_string() || self.reason.starts_with("weather gap")
    }
}
