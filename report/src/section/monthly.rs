//! Mean power by month, in one window.

use super::weights_note;
use crate::StudyReport;
use crate::document::{Block, DataTable, Section, Table};
use crate::numbers::{month, optional, text, watts, window};

pub(super) fn section(study: &StudyReport) -> Option<Section> {
    let shown = study.shown_window()?;
    let designs = study.design_names();
    let row = |m: &store::MonthRow| {
        let power = |design: &&str| {
            let of = |r: &&store::MonthlyRow| r.design == *design && r.month == m.month && r.window == shown;
            watts(study.monthly.iter().find(of).and_then(|r| r.hvac_power_w))
        };
        let head = [month(m.month).to_owned(), m.sample_count.to_string(), format!("{:.3e}", m.sample_weight)];
        head.into_iter().chain(designs.iter().map(power)).collect()
    };
    let rows = study.months.iter().map(row).collect();
    let columns: Vec<&str> = ["samples", "weight of a sample"].into_iter().chain(designs.iter().copied()).collect();
    let title = format!("Monthly mean HVAC power at PMV {} in W", window(shown));
    let section = Section::new(title).with(Block::Table(Table::new(&["month"], &columns, rows)));
    Some(Section { tables: vec![data(study)], ..section }.with(weights_note(study)))
}

fn data(study: &StudyReport) -> DataTable {
    DataTable::of(
        "monthly_average.csv",
        &study.monthly,
        &[
            ("design", &|r| text(&r.design)),
            ("pmv_limit", &|r| r.window.pmv_limit().to_string()),
            ("pmv_min", &|r| r.window.pmv_min().to_string()),
            ("pmv_max", &|r| r.window.pmv_max().to_string()),
            ("month", &|r| r.month.to_string()),
            ("hvac_power_w", &|r| optional(r.hvac_power_w)),
            ("sample_count", &|r| r.sample_count.to_string()),
        ],
    )
}
