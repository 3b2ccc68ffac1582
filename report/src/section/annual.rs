//! Annual mean power by design and window.

use super::weights_note;
use crate::StudyReport;
use crate::document::{Block, DataTable, Section, Table};
use crate::numbers::{optional, text, watts, window};

pub(super) fn section(study: &StudyReport) -> Section {
    let designs = study.design_names();
    let row = |w| {
        let cells = designs.iter().map(|d| watts(study.annual_power_w(d, w)));
        [window(w)].into_iter().chain(cells).collect()
    };
    let rows = study.windows().into_iter().map(row).collect();
    Section { tables: vec![data(study)], ..Section::new("Annual mean HVAC power in W") }
        .with(Block::Table(Table::new(&["PMV"], &designs, rows)))
        .with(weights_note(study))
}

fn data(study: &StudyReport) -> DataTable {
    let missing = study.missing_months().iter().map(u8::to_string).collect::<Vec<_>>().join(" ");
    DataTable::of(
        "annual_average.csv",
        &study.annual,
        &[
            ("design", &|r| text(&r.design)),
            ("pmv_limit", &|r| r.window.pmv_limit().to_string()),
            ("pmv_min", &|r| r.window.pmv_min().to_string()),
            ("pmv_max", &|r| r.window.pmv_max().to_string()),
            ("hvac_power_w", &|r| optional(r.hvac_power_w)),
            ("heating_power_w", &|r| optional(r.heating_power_w)),
            ("cooling_power_w", &|r| optional(r.cooling_power_w)),
            ("sample_count", &|r| r.sample_count.to_string()),
            ("unsolved_count", &|r| r.unsolved_count.to_string()),
            ("unsolved_weight", &|r| r.unsolved_weight.to_string()),
            ("reduction_vs_ptc", &|r| optional(r.reduction_vs_ptc)),
            ("missing_months", &|_| missing.clone()),
        ],
    )
}
