//! SIA 4028 reference years of MeteoSwiss: typical months of several years, put together.

use chrono::NaiveDate;

use super::format::{Column, Encoding, Format, Layout, RowOrder};
use super::values::PerQuantity;

/// From this year on the months of a file are stamped at the end of the hour.
const END_STAMPS_FROM: i32 = 2018;

/// The name in study files.
pub(crate) const NAME: &str = "sia4028";

/// Files such as `sia4028_sma_dry_….csv`.
pub(crate) struct Sia4028;

impl Format for Sia4028 {
    fn name(&self) -> &'static str {
        NAME
    }

    fn fits(&self, name: &str) -> bool {
        name.starts_with("sia4028") && name.ends_with(".csv")
    }

    fn file_names(&self) -> &'static str {
        "sia4028….csv"
    }

    fn layout(&self, _: &[u8]) -> Layout {
        Layout {
            separator: ',',
            encoding: Encoding::Windows1252,
            time: ["time.yy", "time.mm", "time.dd", "time.hh"].map(str::to_owned).to_vec(),
            station: Some("station"),
            columns: PerQuantity {
                temperature: Column::Needed("temp".to_owned()),
                global: Column::None,
                diffuse: Column::Needed("rad.diffus".to_owned()),
                direct: Column::Needed("rad.direct".to_owned()),
            },
            interval_s: 3600,
            calendar: RowOrder::ReferenceYear,
        }
    }

    fn start_s(&self, fields: &[&str], interval_s: i64) -> Option<i64> {
        let mut numbers = fields.iter().map(|field| field.parse::<i32>().ok());
        let mut number = || numbers.next().flatten();
        let (year, month, day, hour) = (number()?, number()?, number()?, number()?);
        let date = NaiveDate::from_ymd_opt(year, u32::try_from(month).ok()?, u32::try_from(day).ok()?)?;
        let stamp_s = date.and_hms_opt(u32::try_from(hour).ok()?, 0, 0)?.and_utc().timestamp();
        Some(if year >= END_STAMPS_FROM { stamp_s - interval_s } else { stamp_s })
    }

    fn stamp_form(&self) -> &'static str {
        "not a year, month, day and hour"
    }
}
