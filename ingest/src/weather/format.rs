//! What a format of weather files has to say of itself.

use std::ops::Range;

use super::units::Units;
use super::values::{PerQuantity, Quantity};
use crate::Finding;
use crate::stamp::{Clock, Stamp};

/// A format: how its files are known, how they are laid out, and what their stamps mean.
pub(crate) trait Format {
    /// The name in study files.
    fn name(&self) -> &'static str;

    /// How a file is laid out; nothing where it is none of this format.
    ///
    /// # Errors
    /// Why a file of this format cannot be used.
    fn layout(&self, text: &str) -> Result<Option<Layout>, Finding>;

    /// Whether a file is of this format, from its text or the beginning of it.
    fn fits(&self, text: &str) -> bool {
        !matches!(self.layout(text), Ok(None))
    }

    /// What its files are known by, for messages.
    fn known_by(&self) -> &'static str;

    /// A stamp from the fields of its columns.
    fn stamp(&self, fields: &[&str]) -> Option<Stamp>;

    /// What a stamp that cannot be read is not.
    fn stamp_form(&self) -> &'static str;

    /// Which of two files counts where both have a value: the lower rank, then the first by name.
    fn rank(&self, _label: &str) -> u8 {
        0
    }

    /// Whether text that is not UTF-8 is Windows-1252.
    fn may_be_windows_1252(&self) -> bool {
        true
    }
}

/// How a file is laid out.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Layout {
    /// The table in the text.
    pub table: Extent,
    /// What stands between two columns.
    pub separator: char,
    /// The columns of a stamp.
    pub time: Vec<String>,
    /// The column that tells stations apart.
    pub station: Option<String>,
    /// The columns of the quantities, as far as the format has them.
    pub columns: PerQuantity<Column>,
    /// Where one column holds all quantities.
    pub long: Option<Long>,
    /// Whether the column of the global irradiance holds the beam on the ground alone, without the diffuse irradiance.
    pub global_lacks_diffuse: bool,
    pub units: Units,
    /// Numbers that stand for a missing value.
    pub missing: &'static [f64],
    pub interval_s: i64,
    pub label: TimeLabel,
    pub clock: Clock,
    /// How the file's rows make a series.
    pub order: RowOrder,
    /// Where its intervals begin.
    pub grid: IntervalGrid,
    /// Latitude and longitude in degrees, where the file says them.
    pub place: Option<[f64; 2]>,
    /// What is to be recorded of the file.
    pub notes: Vec<Finding>,
}

impl Layout {
    /// A table of commas in UTC, °C and W/m², stamped at the end of each interval.
    pub fn new(table: Extent, time: &[&str], columns: PerQuantity<Column>, interval_s: i64) -> Self {
        Self {
            table,
            separator: ',',
            time: time.iter().map(|name| (*name).to_owned()).collect(),
            station: None,
            columns,
            long: None,
            global_lacks_diffuse: false,
            units: Units::default(),
            missing: &[],
            interval_s,
            label: TimeLabel::End,
            clock: Clock::Utc,
            order: RowOrder::Series,
            grid: IntervalGrid::Clock,
            place: None,
            notes: Vec::new(),
        }
    }
}

impl Layout {
    /// The column of a quantity, for messages.
    pub fn column(&self, quantity: Quantity) -> &str {
        match &self.long {
            Some(long) => long.value,
            None => self.columns.get(quantity).name().unwrap_or_default(),
        }
    }
}

/// Where the table stands in a text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Extent {
    /// Its bytes, header included.
    pub bytes: Range<usize>,
    /// Its first line, from 1.
    pub first_line: u64,
    /// The names of the columns, where no header says them.
    pub names: Option<&'static [&'static str]>,
}

impl Extent {
    /// The whole text.
    pub fn whole(text: &str) -> Self {
        Self { bytes: 0..text.len(), first_line: 1, names: None }
    }

    /// From the line of that number, from 0, to the first empty line below it.
    pub fn from_line(text: &str, line: usize) -> Self {
        let start =
            if line == 0 { 0 } else { text.match_indices('\n').nth(line - 1).map_or(text.len(), |(at, _)| at + 1) };
        let mut end = start;
        for row in text[start..].split_inclusive('\n') {
            if row.trim().is_empty() {
                break;
            }
            end += row.len();
        }
        Self { bytes: start..end, first_line: line as u64 + 1, names: None }
    }
}

/// Names and values in two columns, a row for each quantity.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Long {
    /// The column of the names that [`Layout::columns`] gives.
    pub name: &'static str,
    /// The column of the values.
    pub value: &'static str,
    /// A column and the text that it must hold; other rows are left alone.
    pub only: (&'static str, &'static str),
}

/// A column of a quantity.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) enum Column {
    /// The format has none.
    #[default]
    None,
    /// It must be there.
    Needed(String),
    /// It may lack, or be empty: the station does not measure it.
    Optional(String),
}

impl Column {
    pub fn needed(name: &str) -> Self {
        Self::Needed(name.to_owned())
    }

    pub fn optional(name: &str) -> Self {
        Self::Optional(name.to_owned())
    }

    pub fn name(&self) -> Option<&str> {
        match self {
            Self::None => None,
            Self::Needed(name) | Self::Optional(name) => Some(name),
        }
    }
}

/// Which part of its interval a stamp names.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TimeLabel {
    /// The start.
    Start,
    /// The middle.
    Middle,
    /// The end.
    End,
}

impl TimeLabel {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Start, Self::Middle, Self::End];

    /// The name in study files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Start => "start",
            Self::Middle => "middle",
            Self::End => "end",
        }
    }

    /// Seconds from the start of an interval to its stamp.
    pub(crate) fn shift_s(self, interval_s: i64) -> i64 {
        match self {
            Self::Start => 0,
            Self::Middle => interval_s / 2,
            Self::End => interval_s,
        }
    }
}

/// How rows make a series.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum RowOrder {
    /// Rows in rising time.
    Series,
    /// Hours of one reference year, in any order, repeated by calendar date.
    ReferenceYear,
    /// One of both: months of other years one after the other are a reference year.
    AsFound,
}

/// Where intervals begin.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum IntervalGrid {
    /// At full intervals of the clock that the stamps show.
    Clock,
    /// Anywhere, as by true solar time: they are spread over full hours by their overlap.
    Free,
}
