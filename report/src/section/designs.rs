//! The equipment that is compared.

use super::yes;
use crate::StudyReport;
use crate::document::{Block, DataTable, Section, Table};
use crate::numbers::text;

pub(super) fn section(study: &StudyReport) -> Section {
    let rows = study.designs.iter().map(|d| {
        vec![
            d.name.clone(),
            d.heating.name().to_owned(),
            d.heating_cop.clone(),
            d.cooling_cop.clone(),
            yes(d.devices.radiant_heaters),
            yes(d.devices.air_curtain),
        ]
    });
    let columns = ["design", "heating", "COP heating", "COP cooling", "radiant heaters", "air curtain"];
    Section { tables: vec![data(study)], ..Section::new("Designs") }
        .asking("Which equipment is compared?")
        .with(Block::Table(Table::new("designs.csv", &columns, &[], rows.collect())))
}

fn data(study: &StudyReport) -> DataTable {
    DataTable::of(
        "designs.csv",
        &study.designs,
        &[
            ("design", &|d| text(&d.name)),
            ("heating", &|d| d.heating.name().to_owned()),
            ("heating_cop", &|d| text(&d.heating_cop)),
            ("cooling_cop", &|d| text(&d.cooling_cop)),
            ("radiant_heaters", &|d| yes(d.devices.radiant_heaters)),
            ("air_curtain", &|d| yes(d.devices.air_curtain)),
        ],
    )
}
