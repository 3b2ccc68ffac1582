//! What designs save against resistive heating.

use super::annual::interval_note;
use super::weights_note;
use crate::StudyReport;
use crate::document::{Block, Section, Table};
use crate::numbers::{percent, percent_within, window};

pub(super) fn section(study: &StudyReport) -> Option<Section> {
    let designs = study.design_names();
    if !designs.contains(&"ptc") {
        return None;
    }
    let row = |w| {
        let cell = |d: &&str| {
            let share = study.annual_row(d, w).and_then(|r| r.reduction_vs_ptc);
            let ends = study.interval(d, w).and_then(|r| r.reduction_vs_ptc);
            share.map_or_else(|| percent(None), |share| percent_within(share, ends))
        };
        [window(w)].into_iter().chain(designs.iter().map(cell)).collect()
    };
    let rows = study.windows().into_iter().map(row).collect();
    let section = Section::new("Reduction against ptc").with(Block::Table(Table::new(&["PMV"], &designs, rows)));
    Some(section.with(study.has_intervals().then(interval_note)).with(weights_note(study)))
}
