//! The stations of the City of Zürich (UGZ) as they are published: a row for each station, quantity and hour, stamped at
//! its start.

use super::format::{Column, Extent, Format, Layout, Long, TimeLabel};
use super::values::PerQuantity;
use crate::stamp::Stamp;
use crate::{Finding, FindingKind};

/// The name in study files.
pub(crate) const NAME: &str = "ugz";
const COLUMNS: [&str; 6] = ["Datum", "Standort", "Parameter", "Intervall", "Einheit", "Wert"];

/// Files such as `ugz_ogd_meteo_h1_2021.csv`.
pub(crate) struct Ugz;

impl Format for Ugz {
    fn name(&self) -> &'static str {
        NAME
    }

    fn layout(&self, text: &str) -> Result<Option<Layout>, Finding> {
        let header = text.lines().next().unwrap_or_default();
        let has = |name: &str| header.split(',').any(|column| column.trim().trim_matches('"') == name);
        if !COLUMNS.iter().all(|name| has(name)) {
            return Ok(None);
        }
        if !text.contains("\"h1\"") && !text.contains(",h1,") {
            let message = "the file holds no hourly values, \"h1\"; fetch ugz_ogd_meteo_h1_<year>.csv";
            return Err(Finding::whole(FindingKind::WrongUnit, message).in_column("Intervall").at_line(2));
        }
        let columns = PerQuantity {
            temperature: Column::optional("T"),
            global: Column::optional("StrGlo"),
            diffuse: Column::None,
            direct: Column::None,
        };
        Ok(Some(Layout {
            label: TimeLabel::Start,
            station: Some("Standort".to_owned()),
            long: Some(Long { name: "Parameter", value: "Wert", only: ("Intervall", "h1") }),
            ..Layout::new(Extent::whole(text), &["Datum"], columns, 3600)
        }))
    }

    fn known_by(&self) -> &'static str {
        "the columns Datum, Standort, Parameter, Intervall, Einheit and Wert"
    }

    fn stamp(&self, fields: &[&str]) -> Option<Stamp> {
        Stamp::parse(fields.first()?)
    }

    fn stamp_form(&self) -> &'static str {
        "not a stamp like 2022-12-31T23:00+0100"
    }
}
