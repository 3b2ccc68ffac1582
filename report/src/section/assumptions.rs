//! What the numbers rest on.

use super::yes;
use crate::StudyReport;
use crate::document::{Block, Section, Table};

pub(super) fn section(study: &StudyReport) -> Section {
    let rows =
        study.assumptions.iter().map(|a| vec![a.what.clone(), a.value.clone(), a.source.clone(), yes(a.substitute)]);
    let table = Table::new(&["what", "value", "source", "substitute"], &[], rows.collect());
    Section::new("Assumptions").with(Block::Table(table))
}
