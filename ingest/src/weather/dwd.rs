//! Hourly values of the German weather service (DWD): air temperature and radiation in files of their own. Radiation is
//! summed over hours of true solar time, whose ends `MESS_DATUM` gives in UTC.

use chrono::{NaiveDate, NaiveTime};

use super::format::{Column, Extent, Format, IntervalGrid, Layout};
use super::units::{IrradianceUnit, TemperatureUnit, Units};
use super::values::PerQuantity;
use crate::stamp::Stamp;
use crate::{Finding, FindingKind};

/// The name in study files.
pub(crate) const NAME: &str = "dwd";
/// What stands where there is no value.
const MISSING: [f64; 1] = [-999.0];

/// Files such as `produkt_tu_stunde_….txt` and `produkt_st_stunde_….txt`.
pub(crate) struct Dwd;

impl Format for Dwd {
    fn name(&self) -> &'static str {
        NAME
    }

    fn layout(&self, text: &str) -> Result<Option<Layout>, Finding> {
        let header = text.lines().next().unwrap_or_default();
        let has = |name: &str| header.split(';').any(|column| column.trim() == name);
        if !has("STATIONS_ID") || !has("MESS_DATUM") {
            return Ok(None);
        }
        let (columns, grid) = if has("FG_LBERG") {
            let columns = PerQuantity {
                global: Column::needed("FG_LBERG"),
                diffuse: Column::optional("FD_LBERG"),
                ..PerQuantity::default()
            };
            (columns, IntervalGrid::Free)
        } else if has("TT_TU") {
            (PerQuantity { temperature: Column::needed("TT_TU"), ..PerQuantity::default() }, IntervalGrid::Clock)
        } else {
            let message = "neither hourly air temperature (TT_TU) nor hourly radiation (FG_LBERG); remove the file";
            return Err(Finding::whole(FindingKind::MissingColumn, message).at_line(1));
        };
        Ok(Some(Layout {
            separator: ';',
            station: Some("STATIONS_ID".to_owned()),
            units: Units { temperature: TemperatureUnit::Celsius, irradiance: IrradianceUnit::JoulePerCm2 },
            missing: &MISSING,
            grid,
            ..Layout::new(Extent::whole(text), &["MESS_DATUM"], columns, 3600)
        }))
    }

    fn known_by(&self) -> &'static str {
        "the columns STATIONS_ID and MESS_DATUM"
    }

    /// `2021021001` and `2021021000:33`.
    fn stamp(&self, fields: &[&str]) -> Option<Stamp> {
        let text = fields.first()?;
        let date = NaiveDate::parse_from_str(text.get(..8)?, "%Y%m%d").ok()?;
        let time = match text.get(8..)? {
            hour if hour.len() == 2 => NaiveTime::from_hms_opt(hour.parse().ok()?, 0, 0)?,
            time => NaiveTime::parse_from_str(time, "%H:%M").ok()?,
        };
        Some(Stamp::utc(date.and_time(time)))
    }

    fn stamp_form(&self) -> &'static str {
        "not a stamp like 2022123123 or 2022123122:33"
    }

    /// What was checked last is best.
    fn rank(&self, label: &str) -> u8 {
        u8::from(!label.to_lowercase().contains("hist"))
    }
}
