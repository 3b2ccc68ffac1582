//! Open data of the automatic stations of MeteoSwiss: 10-minute values stamped at the end, hourly ones at the end too.

use chrono::NaiveDateTime;

use super::format::{Column, Encoding, Format, Layout, RowOrder};
use super::values::PerQuantity;

/// The name in study files.
pub(crate) const NAME: &str = "meteoswiss-ogd";

/// Files such as `ogd-smn_sma_h_historical_2020-2029.csv`.
pub(crate) struct MeteoSwissOgd;

impl Format for MeteoSwissOgd {
    fn name(&self) -> &'static str {
        NAME
    }

    fn fits(&self, name: &str) -> bool {
        name.starts_with("ogd-smn_") && !name.starts_with("ogd-smn_meta_") && name.ends_with(".csv")
    }

    fn file_names(&self) -> &'static str {
        "ogd-smn_<station>_t_….csv or ogd-smn_<station>_h_….csv"
    }

    fn layout(&self, header: &[u8]) -> Layout {
        // Ten-minute columns end in s0 or z0, hourly ones in h0.
        let hourly = header.windows(8).any(|w| w == b"tre200h0" || w == b"gre000h0");
        let (temperature, global, diffuse, interval_s) =
            if hourly { ("tre200h0", "gre000h0", "ods000h0", 3600) } else { ("tre200s0", "gre000z0", "ods000z0", 600) };
        Layout {
            separator: ';',
            encoding: Encoding::Windows1252,
            time: vec!["reference_timestamp".to_owned()],
            station: Some("station_abbr"),
            columns: PerQuantity {
                temperature: Column::Needed(temperature.to_owned()),
                global: Column::Needed(global.to_owned()),
                // A column of every file, empty at most stations.
                diffuse: Column::Optional(diffuse.to_owned()),
                direct: Column::None,
            },
            interval_s,
            calendar: RowOrder::Series,
        }
    }

    fn start_s(&self, fields: &[&str], interval_s: i64) -> Option<i64> {
        let stamp = NaiveDateTime::parse_from_str(fields.first()?, "%d.%m.%Y %H:%M").ok()?;
        Some(stamp.and_utc().timestamp() - interval_s)
    }

    fn stamp_form(&self) -> &'static str {
        "not a stamp like 31.12.2022 23:00"
    }
}
