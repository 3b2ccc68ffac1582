//! Any CSV file with one row per interval, its columns named by the study.

use super::format::{Column, Extent, Format, Layout, RowOrder, TimeLabel};
use super::units::{IrradianceUnit, TemperatureUnit, Units};
use super::values::PerQuantity;
use crate::Finding;
use crate::stamp::{Clock, Stamp};

/// The name in study files.
pub(crate) const NAME: &str = "csv";
/// Lines above the header that are looked through for it.
const MOST_LINES_ABOVE: usize = 100;

/// Which column of a weather file is what.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ColumnMap {
    /// Stamps such as `2022-12-31T23:00:00Z`.
    pub time_column: String,
    /// Which part of its interval a stamp names.
    pub time_label: TimeLabel,
    /// What stamps without an offset mean.
    pub clock: Clock,
    /// Length of an interval in s.
    pub interval_s: u32,
    /// Whether the rows are hours of a reference year; `None` to tell it from the stamps.
    pub reference_year: Option<bool>,
    /// Ambient temperature.
    pub temperature_column: String,
    /// Unit of the temperature.
    pub temperature_unit: TemperatureUnit,
    /// Global horizontal irradiance.
    pub ghi_column: Option<String>,
    /// Diffuse horizontal irradiance.
    pub dhi_column: Option<String>,
    /// Direct normal irradiance.
    pub dni_column: Option<String>,
    /// Unit of the irradiances.
    pub irradiance_unit: IrradianceUnit,
}

impl ColumnMap {
    /// A map for hourly rows in UTC, °C and W/m².
    #[must_use]
    pub fn hourly(time: &str, label: TimeLabel, temperature: &str, ghi: &str) -> Self {
        Self {
            time_column: time.to_owned(),
            time_label: label,
            clock: Clock::Utc,
            interval_s: 3600,
            reference_year: None,
            temperature_column: temperature.to_owned(),
            temperature_unit: TemperatureUnit::default(),
            ghi_column: Some(ghi.to_owned()),
            dhi_column: None,
            dni_column: None,
            irradiance_unit: IrradianceUnit::default(),
        }
    }
}

impl ColumnMap {
    /// The line that names all columns, from 0.
    fn header(&self, text: &str) -> Option<usize> {
        let optional = [&self.ghi_column, &self.dhi_column, &self.dni_column];
        let wanted = || [&self.time_column, &self.temperature_column].into_iter().chain(optional.into_iter().flatten());
        text.lines().take(MOST_LINES_ABOVE).position(|line| {
            let named = |name: &String| line.split(',').any(|field| field.trim().trim_matches('"') == name);
            wanted().all(named)
        })
    }
}

impl Format for ColumnMap {
    fn name(&self) -> &'static str {
        NAME
    }

    fn layout(&self, text: &str) -> Result<Option<Layout>, Finding> {
        let optional = |name: &Option<String>| name.clone().map_or(Column::None, Column::Needed);
        let columns = PerQuantity {
            temperature: Column::Needed(self.temperature_column.clone()),
            global: optional(&self.ghi_column),
            diffuse: optional(&self.dhi_column),
            direct: optional(&self.dni_column),
        };
        // Tools write lines of their own above the table: the header is the first line with all columns.
        let above = self.header(text);
        let table = above.filter(|&n| n > 0).map_or_else(|| Extent::whole(text), |line| Extent::from_line(text, line));
        Ok(Some(Layout {
            units: Units { temperature: self.temperature_unit, irradiance: self.irradiance_unit },
            label: self.time_label,
            clock: self.clock,
            order: match self.reference_year {
                Some(true) => RowOrder::ReferenceYear,
                Some(false) => RowOrder::Series,
                None => RowOrder::AsFound,
            },
            ..Layout::new(table, &[&self.time_column], columns, i64::from(self.interval_s))
        }))
    }

    fn fits(&self, text: &str) -> bool {
        self.header(text).is_some()
    }

    fn known_by(&self) -> &'static str {
        "the columns that the study names"
    }

    fn stamp(&self, fields: &[&str]) -> Option<Stamp> {
        Stamp::parse(fields.first()?)
    }

    fn stamp_form(&self) -> &'static str {
        "not a stamp like 2022-12-31T23:00:00Z"
    }

    fn may_be_windows_1252(&self) -> bool {
        false
    }
}
