//! What a format of weather files has to say of itself.

use super::values::{PerQuantity, Values};

/// A format: how its files are called, how they are laid out, and what their stamps mean.
pub(crate) trait Format {
    /// The name in study files.
    fn name(&self) -> &'static str;

    /// Whether a file's name, in lower case, is one of this format.
    fn fits(&self, name: &str) -> bool;

    /// What its files are called, for messages.
    fn file_names(&self) -> &'static str;

    /// How a file is laid out. `header` is its first line.
    fn layout(&self, header: &[u8]) -> Layout;

    /// Start of the interval that the fields of a stamp name, in s since 1970.
    fn start_s(&self, fields: &[&str], interval_s: i64) -> Option<i64>;

    /// What a stamp that cannot be read is not.
    fn stamp_form(&self) -> &'static str;
}

/// How a file is laid out.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Layout {
    /// What stands between two columns.
    pub separator: char,
    pub encoding: Encoding,
    /// The columns of a stamp.
    pub time: Vec<String>,
    pub station: Option<&'static str>,
    /// The columns of the quantities, as far as the format has them.
    pub columns: PerQuantity<Column>,
    pub interval_s: i64,
    /// How the file's rows make a series.
    pub calendar: RowOrder,
}

/// The bytes of a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Encoding {
    /// Anything else is refused.
    Utf8,
    /// Windows-1252, unless a byte order mark says UTF-8.
    Windows1252,
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
    pub fn name(&self) -> Option<&str> {
        match self {
            Self::None => None,
            Self::Needed(name) | Self::Optional(name) => Some(name),
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
}

/// One interval of a file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Interval {
    /// Its start in s since 1970.
    pub start_s: i64,
    /// What was measured in it.
    pub values: Values,
}
