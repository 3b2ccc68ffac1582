//! Simulated missions by month, temperature and length.

use store::SimulatedClass;

use crate::StudyReport;
use crate::document::{Block, DataTable, Section, Table};
use crate::numbers::{optional, percent, signed_percent, text, watts, window};

/// The classes of one design in the window that stands for the study.
pub(super) fn section(study: &StudyReport) -> Option<Section> {
    let shown = study.shown_window()?;
    if study.simulated_classes.is_empty() {
        return None;
    }
    let in_window = |c: &&SimulatedClass| c.window == shown;
    let tables = vec![data(study)];
    let Some(design) = study.simulated_classes.iter().rev().find(in_window).map(|c| &c.design) else {
        // All of them are of other windows: they are in the table only.
        let title = "Simulated missions by class";
        let text = "All designs and windows are in simulation_classes.csv.";
        return Some(Section { level: 3, tables, ..Section::new(title) }.with(Block::words(text)));
    };
    let rows = study.simulated_classes.iter().filter(in_window).filter(|c| c.design == *design).map(row);
    let columns = [
        "missions",
        "steady state W",
        "simulated W",
        "difference",
        "without start-up",
        "largest PMV",
        "time at the limit",
    ];
    let title = format!("{design} at PMV {}, by class of mission", window(shown));
    Some(
        Section { level: 3, tables, ..Section::new(title) }
            .with(Block::words(
                "Means over all seconds of a class. The PMV is the mean over the missions of the largest 15-minute vote, up or down, while somebody is on board.\n\
                 All designs and windows are in simulation_classes.csv.",
            ))
            .with(Block::Table(Table::new("simulation_classes.csv", &["by", "class"], &columns, rows.collect()))),
    )
}

fn row(c: &SimulatedClass) -> Vec<String> {
    let static_w = c.static_mean_hvac_power_w;
    vec![
        c.sorted_by.clone(),
        c.class.clone(),
        c.mission_count.to_string(),
        watts(Some(static_w)),
        watts(Some(c.mean_hvac_power_w)),
        signed_percent(c.mean_hvac_power_w - static_w, static_w),
        signed_percent(c.warm_start_power_w - static_w, static_w),
        c.mean_max_abs_pmv.map_or_else(|| "–".to_owned(), |v| format!("{v:.2}")),
        percent(Some(c.saturated_fraction)),
    ]
}

fn data(study: &StudyReport) -> DataTable {
    DataTable::of(
        "simulation_classes.csv",
        &study.simulated_classes,
        &[
            ("design", &|c| text(&c.design)),
            ("pmv_min", &|c| c.window.pmv_min().to_string()),
            ("pmv_max", &|c| c.window.pmv_max().to_string()),
            ("sorted_by", &|c| c.sorted_by.clone()),
            ("class", &|c| c.class.clone()),
            ("mission_count", &|c| c.mission_count.to_string()),
            ("mean_hvac_power_w", &|c| c.mean_hvac_power_w.to_string()),
            ("static_mean_hvac_power_w", &|c| c.static_mean_hvac_power_w.to_string()),
            ("warm_start_power_w", &|c| c.warm_start_power_w.to_string()),
            ("mean_max_abs_pmv_15min", &|c| optional(c.mean_max_abs_pmv)),
            ("saturated_fraction", &|c| c.saturated_fraction.to_string()),
        ],
    )
}
