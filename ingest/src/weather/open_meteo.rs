//! Open-Meteo's downloads as they come: place and clock in two lines, an empty line, then hours. Radiation is the mean of
//! the hour before the stamp.

use super::format::{Column, Extent, Format, Layout};
use super::units::{IrradianceUnit, TemperatureUnit, Units};
use super::values::PerQuantity;
use crate::stamp::{Clock, Stamp};
use crate::{Finding, FindingKind};

/// The name in study files.
pub(crate) const NAME: &str = "open-meteo";

/// Files such as `open-meteo-47.38N8.55E450m.csv`.
pub(crate) struct OpenMeteo;

impl Format for OpenMeteo {
    fn name(&self) -> &'static str {
        NAME
    }

    fn layout(&self, text: &str) -> Result<Option<Layout>, Finding> {
        let mut lines = text.lines();
        let names: Vec<&str> = lines.next().unwrap_or_default().split(',').map(str::trim).collect();
        if !names.contains(&"utc_offset_seconds") {
            return Ok(None);
        }
        let said: Vec<&str> = lines.next().unwrap_or_default().split(',').map(str::trim).collect();
        let of =
            |name: &str| names.iter().position(|n| *n == name).and_then(|place| said.get(place)?.parse::<f64>().ok());
        let refused = |kind, message: &str, line| Err(Finding::whole(kind, message).at_line(line));
        let (Some(latitude), Some(longitude), Some(offset_s)) =
            (of("latitude"), of("longitude"), of("utc_offset_seconds"))
        else {
            return refused(FindingKind::RefusedRow, "latitude, longitude and utc_offset_seconds are not numbers", 2);
        };
        if names.contains(&"location_id") && lines.next().is_some_and(|line| !line.trim().is_empty()) {
            return refused(FindingKind::RefusedRow, "the file holds several places; fetch one place a file", 3);
        }
        let header = text.lines().position(|line| line.starts_with("time,"));
        let Some((line, header)) = header.and_then(|n| Some((n, text.lines().nth(n)?))) else {
            return refused(
                FindingKind::MissingColumn,
                "no line with the names of the columns, `time,…`; fetch hourly values",
                1,
            );
        };
        // Names carry their unit: `temperature_2m (°C)`.
        let named = |name: &str| header.split(',').map(str::trim).find(|c| c.split(" (").next() == Some(name));
        let unit =
            |name: &str| named(name).and_then(|c| c.split_once(" (")).map(|(_, unit)| unit.trim_end_matches(')'));
        let temperature = match unit("temperature_2m") {
            Some("°C") | None => TemperatureUnit::Celsius,
            Some("°F") => TemperatureUnit::Fahrenheit,
            Some(other) => {
                let message = format!("the temperature is in {other:?}; fetch it in °C");
                return Err(Finding::whole(FindingKind::WrongUnit, message).at_line(line as u64 + 1));
            }
        };
        let needed = |name: &str| Column::Needed(named(name).unwrap_or(name).to_owned());
        let optional = |name: &str| named(name).map_or(Column::None, Column::optional);
        let columns = PerQuantity {
            temperature: needed("temperature_2m"),
            global: needed("shortwave_radiation"),
            diffuse: optional("diffuse_radiation"),
            direct: optional("direct_normal_irradiance"),
        };
        Ok(Some(Layout {
            units: Units { temperature, irradiance: IrradianceUnit::WattPerM2 },
            clock: Clock::Offset(offset_s as i32),
            place: Some([latitude, longitude]),
            ..Layout::new(Extent::from_line(text, line), &["time"], columns, 3600)
        }))
    }

    fn known_by(&self) -> &'static str {
        "a first line with utc_offset_seconds"
    }

    fn stamp(&self, fields: &[&str]) -> Option<Stamp> {
        Stamp::parse(fields.first()?)
    }

    fn stamp_form(&self) -> &'static str {
        "not a stamp like 2022-12-31T23:00"
    }
}
