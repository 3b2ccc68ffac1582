//! Any CSV file with one row per interval, its columns named by the study.

use chrono::{DateTime, NaiveDateTime};

use super::format::{Column, Encoding, Format, Layout, RowOrder};
use super::values::PerQuantity;

/// The name in study files.
pub(crate) const NAME: &str = "csv";

/// Which column of a weather file is what.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ColumnMap {
    /// Stamps in RFC 3339; without an offset they are UTC.
    pub time_column: String,
    /// Which end of its interval a stamp names.
    pub time_label: TimeLabel,
    /// Length of an interval in s.
    pub interval_s: u32,
    /// Ambient temperature in °C.
    pub temperature_column: String,
    /// Global horizontal irradiance in W/m².
    pub ghi_column: Option<String>,
    /// Diffuse horizontal irradiance in W/m².
    pub dhi_column: Option<String>,
    /// Direct normal irradiance in W/m².
    pub dni_column: Option<String>,
}

/// Which end of its interval a stamp names.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TimeLabel {
    /// The start.
    Start,
    /// The end.
    End,
}

impl Format for ColumnMap {
    fn name(&self) -> &'static str {
        NAME
    }

    fn fits(&self, name: &str) -> bool {
        name.ends_with(".csv")
    }

    fn file_names(&self) -> &'static str {
        "….csv"
    }

    fn layout(&self, _: &[u8]) -> Layout {
        let optional = |name: &Option<String>| name.clone().map_or(Column::None, Column::Needed);
        Layout {
            separator: ',',
            encoding: Encoding::Utf8,
            time: vec![self.time_column.clone()],
            station: None,
            columns: PerQuantity {
                temperature: Column::Needed(self.temperature_column.clone()),
                global: optional(&self.ghi_column),
                diffuse: optional(&self.dhi_column),
                direct: optional(&self.dni_column),
            },
            interval_s: i64::from(self.interval_s),
            calendar: RowOrder::Series,
        }
    }

    fn start_s(&self, fields: &[&str], interval_s: i64) -> Option<i64> {
        let stamp_s = parse_rfc3339(fields.first()?)?;
        Some(if self.time_label == TimeLabel::Start { stamp_s } else { stamp_s - interval_s })
    }

    fn stamp_form(&self) -> &'static str {
        "not a stamp like 2022-12-31T23:00:00Z"
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
            return Some(stamp.and_utc().timestamp());
        }
    }
    None
}
