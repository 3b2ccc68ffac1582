//! Open data of the automatic stations of MeteoSwiss: 10-minute values stamped at the end, hourly ones at the end too.

use chrono::NaiveDateTime;

use super::format::{Column, Extent, Format, Layout};
use super::values::PerQuantity;
use crate::Finding;
use crate::stamp::Stamp;

/// The name in study files.
pub(crate) const NAME: &str = "meteoswiss-ogd";

/// Files such as `ogd-smn_sma_h_historical_2020-2029.csv`.
pub(crate) struct MeteoSwissOgd;

impl Format for MeteoSwissOgd {
    fn name(&self) -> &'static str {
        NAME
    }

    fn layout(&self, text: &str) -> Result<Option<Layout>, Finding> {
        let header = text.lines().next().unwrap_or_default();
        if !header.contains("station_abbr") || !header.contains("reference_timestamp") {
            return Ok(None);
        }
        // Ten-minute columns end in s0 or z0, hourly ones in h0.
        let hourly = ["tre200h0", "gre000h0"].iter().any(|name| header.contains(name));
        let (temperature, global, diffuse, interval_s) =
            if hourly { ("tre200h0", "gre000h0", "ods000h0", 3600) } else { ("tre200s0", "gre000z0", "ods000z0", 600) };
        let columns = PerQuantity {
            temperature: Column::needed(temperature),
            global: Column::needed(global),
            // A column of every file, empty at most stations.
            diffuse: Column::optional(diffuse),
            direct: Column::None,
        };
        Ok(Some(Layout {
            separator: ';',
            station: Some("station_abbr".to_owned()),
            ..Layout::new(Extent::whole(text), &["reference_timestamp"], columns, interval_s)
        }))
    }

    fn known_by(&self) -> &'static str {
        "the columns station_abbr and reference_timestamp"
    }

    fn stamp(&self, fields: &[&str]) -> Option<Stamp> {
        Some(Stamp::utc(NaiveDateTime::parse_from_str(fields.first()?, "%d.%m.%Y %H:%M").ok()?))
    }

    fn stamp_form(&self) -> &'static str {
        "not a stamp like 31.12.2022 23:00"
    }

    /// What was checked last is best: the historical files, the recent ones, those of now.
    fn rank(&self, label: &str) -> u8 {
        let name = label.rsplit('/').next().unwrap_or(label).to_lowercase();
        match ["_historical", "_recent", "_now"].iter().position(|part| name.contains(part)) {
            Some(place) => place as u8,
            None => 3,
        }
    }
}
