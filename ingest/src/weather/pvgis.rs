//! PVGIS of the European Commission: typical years and hourly series as CSV. Each row is the moment near the start of its
//! hour, in UTC; it counts for that hour.

use chrono::{NaiveDateTime, Timelike};

use super::format::{Column, Extent, Format, Layout, RowOrder, TimeLabel};
use super::values::PerQuantity;
use crate::stamp::Stamp;
use crate::{Finding, FindingKind};

/// The name in study files.
pub(crate) const NAME: &str = "pvgis";
/// Lines above the header that are looked through for it.
const MOST_LINES_ABOVE: usize = 60;

/// Files such as `tmy_45.000_8.000_2005_2023.csv` and `Timeseries_45.000_8.000_SA3_0deg_0deg_2020_2023.csv`.
pub(crate) struct Pvgis;

impl Format for Pvgis {
    fn name(&self) -> &'static str {
        NAME
    }

    fn layout(&self, text: &str) -> Result<Option<Layout>, Finding> {
        if !text.starts_with("Latitude (decimal degrees)") {
            return Ok(None);
        }
        let above = |name: &str| text.lines().take(MOST_LINES_ABOVE).find_map(|line| line.strip_prefix(name));
        let degrees = |name: &str| above(name).and_then(|rest| rest.trim_start_matches(':').trim().parse::<f64>().ok());
        let place = degrees("Latitude (decimal degrees)").zip(degrees("Longitude (decimal degrees)"));
        let header = text.lines().take(MOST_LINES_ABOVE).position(|line| line.starts_with("time"));
        let Some((line, header)) = header.and_then(|n| Some((n, text.lines().nth(n)?))) else {
            let message = "no line with the names of the columns, `time…`; fetch the file again";
            return Err(Finding::whole(FindingKind::MissingColumn, message));
        };
        let has = |name: &str| header.split(',').any(|column| column.trim() == name);
        let (time, order, columns) = if has("time(UTC)") {
            let columns = PerQuantity {
                temperature: Column::needed("T2m"),
                global: Column::needed("G(h)"),
                diffuse: Column::needed("Gd(h)"),
                direct: Column::needed("Gb(n)"),
            };
            ("time(UTC)", RowOrder::ReferenceYear, columns)
        } else {
            // Irradiances of a plane: only of a horizontal one are they those of the ground.
            let slope =
                above("Slope").map(|rest| rest.trim_start_matches(':').trim().trim_end_matches(" deg.").to_owned());
            let slope = slope.as_deref().and_then(|s| s.split_whitespace().next()).and_then(|s| s.parse::<f64>().ok());
            if slope != Some(0.0) {
                let message = "the irradiances are those of a sloped plane; fetch the series with slope 0";
                return Err(Finding::whole(FindingKind::WrongUnit, message).at_line(1));
            }
            // With components the beam on the plane is `Gb(i)`, the rest diffuse; without them there is the sum only.
            let columns = PerQuantity {
                temperature: Column::needed("T2m"),
                global: Column::needed(if has("G(i)") { "G(i)" } else { "Gb(i)" }),
                diffuse: if has("G(i)") { Column::None } else { Column::needed("Gd(i)") },
                direct: Column::None,
            };
            ("time", RowOrder::Series, columns)
        };
        Ok(Some(Layout {
            label: TimeLabel::Start,
            order,
            global_lacks_diffuse: order == RowOrder::Series && !has("G(i)"),
            place: place.map(|(latitude, longitude)| [latitude, longitude]),
            ..Layout::new(Extent::from_line(text, line), &[time], columns, 3600)
        }))
    }

    fn known_by(&self) -> &'static str {
        "a first line Latitude (decimal degrees)"
    }

    fn stamp(&self, fields: &[&str]) -> Option<Stamp> {
        let moment = NaiveDateTime::parse_from_str(fields.first()?, "%Y%m%d:%H%M").ok()?;
        Some(Stamp::utc(moment.with_minute(0)?))
    }

    fn stamp_form(&self) -> &'static str {
        "not a stamp like 20180101:0000"
    }
}
