//! What the numbers rest on.

use super::yes;
use crate::StudyReport;
use crate::document::{Block, DataTable, Section, Table};
use crate::numbers::text;

pub(super) fn section(study: &StudyReport) -> Section {
    let rows =
        study.assumptions.iter().map(|a| vec![a.what.clone(), a.value.clone(), a.source.clone(), yes(a.substitute)]);
    let table = Table::new("assumptions.csv", &["what", "value", "source", "substitute"], &[], rows.collect());
    let data = DataTable::of(
        "assumptions.csv",
        &study.assumptions,
        &[
            ("what", &|a| text(&a.what)),
            ("value", &|a| text(&a.value)),
            ("source", &|a| text(&a.source)),
            ("substitute", &|a| yes(a.substitute)),
        ],
    );
    Section { tables: vec![data], ..Section::new("Assumptions") }
        .asking("What do the numbers rest on besides the inputs?")
        .with(Block::Table(table))
}
