//! SIA 4028 reference years of MeteoSwiss, typical months of several years put together, and the scenario years that come
//! with them (SIA 2060).

use chrono::NaiveDate;

use super::format::{Column, Extent, Format, Layout, RowOrder, TimeLabel};
use super::values::PerQuantity;
use crate::Finding;
use crate::stamp::Stamp;

/// From this year on the months of a file are stamped at the end of the hour.
const END_STAMPS_FROM: i32 = 2018;

/// The name in study files.
pub(crate) const NAME: &str = "sia4028";

/// Files such as `sia4028_sma_dry_….csv` or `SMA_2060_RCP85_DRY.csv`.
pub(crate) struct Sia4028;

impl Format for Sia4028 {
    fn name(&self) -> &'static str {
        NAME
    }

    fn layout(&self, text: &str) -> Result<Option<Layout>, Finding> {
        let header = text.lines().next().unwrap_or_default();
        let has = |name: &str| header.split(',').any(|column| column.trim().trim_matches('"') == name);
        if !has("time.yy") {
            return Ok(None);
        }
        let columns = if has("gls") {
            // Which plane str.direkt belongs to is not published: what the other two leave is the beam.
            PerQuantity {
                temperature: Column::needed("tre200h0"),
                global: Column::needed("gls"),
                diffuse: Column::needed("str.diffus"),
                direct: Column::None,
            }
        } else {
            PerQuantity {
                temperature: Column::needed("temp"),
                global: Column::None,
                diffuse: Column::needed("rad.diffus"),
                direct: Column::needed("rad.direct"),
            }
        };
        Ok(Some(Layout {
            station: has("station").then(|| "station".to_owned()),
            label: TimeLabel::Start,
            order: RowOrder::ReferenceYear,
            ..Layout::new(Extent::whole(text), &["time.yy", "time.mm", "time.dd", "time.hh"], columns, 3600)
        }))
    }

    fn known_by(&self) -> &'static str {
        "the columns time.yy … time.hh"
    }

    fn stamp(&self, fields: &[&str]) -> Option<Stamp> {
        let mut numbers = fields.iter().map(|field| field.parse::<i32>().ok());
        let mut number = || numbers.next().flatten();
        let (year, month, day, hour) = (number()?, number()?, number()?, number()?);
        let date = NaiveDate::from_ymd_opt(year, u32::try_from(month).ok()?, u32::try_from(day).ok()?)?;
        let stamp = Stamp::utc(date.and_hms_opt(u32::try_from(hour).ok()?, 0, 0)?);
        if year >= END_STAMPS_FROM { stamp.later(-3600) } else { Some(stamp) }
    }

    fn stamp_form(&self) -> &'static str {
        "not a year, month, day and hour"
    }
}
