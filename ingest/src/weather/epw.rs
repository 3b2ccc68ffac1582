//! EnergyPlus weather files (EPW): eight lines of description, then the hours of a year in local standard time, without a
//! header. Columns as in EnergyPlus' "Auxiliary Programs", EPW data dictionary.

use chrono::NaiveDate;

use super::format::{Column, Extent, Format, Layout, RowOrder};
use super::values::PerQuantity;
use crate::stamp::{Clock, Stamp};
use crate::{Finding, FindingKind};

/// The name in study files.
pub(crate) const NAME: &str = "epw";
/// Lines above the hours.
const LINES_ABOVE: usize = 8;
/// Missing temperature, missing irradiance.
const MISSING: [f64; 2] = [99.9, 9999.0];

const NAMES: [&str; 16] = [
    "year",
    "month",
    "day",
    "hour",
    "minute",
    "data source",
    "dry bulb temperature",
    "dew point temperature",
    "relative humidity",
    "atmospheric pressure",
    "extraterrestrial horizontal radiation",
    "extraterrestrial direct normal radiation",
    "horizontal infrared radiation",
    "global horizontal radiation",
    "direct normal radiation",
    "diffuse horizontal radiation",
];

/// Files such as `CHE_Zurich.066600_IWEC.epw`.
pub(crate) struct Epw;

impl Format for Epw {
    fn name(&self) -> &'static str {
        NAME
    }

    fn layout(&self, text: &str) -> Result<Option<Layout>, Finding> {
        let mut above = text.lines().take(LINES_ABOVE);
        let first = above.next().unwrap_or_default();
        if !first.starts_with("LOCATION,") {
            return Ok(None);
        }
        // LOCATION, city, region, country, source, WMO number, latitude, longitude, hours from UTC, altitude.
        let fields: Vec<&str> = first.split(',').map(str::trim).collect();
        let number = |place: usize| fields.get(place).and_then(|field| field.parse::<f64>().ok());
        let (Some(latitude), Some(longitude), Some(zone_h)) = (number(6), number(7), number(8)) else {
            let message = "latitude, longitude and time zone of the line LOCATION are not numbers; correct the line";
            return Err(Finding::whole(FindingKind::RefusedRow, message).at_line(1));
        };
        let is_hourly = |line: &str| line.split(',').nth(2).is_some_and(|n| n.trim() == "1");
        if let Some(periods) = text.lines().take(LINES_ABOVE).find(|line| line.starts_with("DATA PERIODS"))
            && !is_hourly(periods)
        {
            let message = format!("{periods:?}: only files of one row an hour are read");
            return Err(Finding::whole(FindingKind::RefusedRow, message).at_line(LINES_ABOVE as u64));
        }
        let mut clock = Clock::Offset((3600.0 * zone_h).round() as i32);
        let mut notes = Vec::new();
        // The typical years of PVGIS keep the hours of UTC, whatever time zone their first line says.
        if zone_h != 0.0 && above.any(|line| line.contains("Irradiance Time Offset")) {
            clock = Clock::Utc;
            let message =
                format!("a typical year of PVGIS: its hours are UTC, not {zone_h} h ahead of it as LOCATION says");
            notes.push(Finding::whole(FindingKind::OtherClock, message).at_line(1));
        }
        let columns = PerQuantity {
            temperature: Column::needed(NAMES[6]),
            global: Column::needed(NAMES[13]),
            diffuse: Column::needed(NAMES[15]),
            direct: Column::needed(NAMES[14]),
        };
        let table = Extent { names: Some(&NAMES), ..Extent::from_line(text, LINES_ABOVE) };
        Ok(Some(Layout {
            missing: &MISSING,
            clock,
            order: RowOrder::ReferenceYear,
            place: Some([latitude, longitude]),
            notes,
            ..Layout::new(table, &NAMES[..4], columns, 3600)
        }))
    }

    fn known_by(&self) -> &'static str {
        "a first line LOCATION,…"
    }

    /// Hours count from 1 to 24, each named by its end.
    fn stamp(&self, fields: &[&str]) -> Option<Stamp> {
        let mut numbers = fields.iter().map(|field| field.parse::<u32>().ok());
        let mut number = || numbers.next().flatten();
        let (year, month, day, hour) = (number()?, number()?, number()?, number()?);
        let date = NaiveDate::from_ymd_opt(i32::try_from(year).ok()?, month, day)?;
        if !(1..=24).contains(&hour) {
            return None;
        }
        Stamp::bare(date.and_hms_opt(0, 0, 0)?).later(3600 * i64::from(hour))
    }

    fn stamp_form(&self) -> &'static str {
        "not a year, month, day and hour from 1 to 24"
    }
}
