//! What designs save against resistive heating.

use super::weights_note;
use crate::StudyReport;
use crate::document::{Block, Section, Table};
use crate::numbers::{percent, window};

pub(super) fn section(study: &StudyReport) -> Option<Section> {
    let designs = study.design_names();
    if !designs.contains(&"ptc") {
        return None;
    }
    let row = |w| {
        let cell = |d: &&str| percent(study.annual_row(d, w).and_then(|r| r.reduction_vs_ptc));
        [window(w)].into_iter().chain(designs.iter().map(cell)).collect()
    };
    let rows = study.windows().into_iter().map(row).collect();
    let section = Section::new("Reduction against ptc").with(Block::Table(Table::new(&["PMV"], &designs, rows)));
    Some(section.with(weights_note(study)))
}
