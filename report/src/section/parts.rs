//! Heating and cooling apart, in one window.

use super::weights_note;
use crate::StudyReport;
use crate::document::{Block, Section, Table};
use crate::numbers::{watts, window};

pub(super) fn section(study: &StudyReport) -> Option<Section> {
    let shown = study.shown_window()?;
    let rows = study.design_names().into_iter().filter_map(|d| study.annual_row(d, shown));
    let rows =
        rows.map(|r| vec![r.design.clone(), watts(r.heating_power_w), watts(r.cooling_power_w), watts(r.hvac_power_w)]);
    let table = Table::new(&["design"], &["heating", "cooling", "total"], rows.collect());
    Some(
        Section::new(format!("Heating and cooling at PMV {} in W", window(shown)))
            .with(Block::words("Radiant heaters and air curtains count to the side on which the air unit works."))
            .with(Block::Table(table))
            .with(weights_note(study)),
    )
}
