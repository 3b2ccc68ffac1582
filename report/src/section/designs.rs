//! The equipment that is compared.

use super::yes;
use crate::StudyReport;
use crate::document::{Block, Section, Table};

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
    Section::new("Designs").with(Block::Table(Table::new(&columns, &[], rows.collect())))
}
