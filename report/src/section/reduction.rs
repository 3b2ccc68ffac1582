//! What designs save against resistive heating.

use super::annual::interval_note;
use super::over_windows::{OverWindows, over_windows};
use super::{value, weights_note};
use crate::StudyReport;
use crate::document::{Block, Section, Table};
use crate::figure::{Axis, Chart};
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
    let section = Section::new("Reduction against ptc")
        .asking("What share of the power of resistive heating does each design save?")
        .with(chart(study).map(|chart| Block::chart("reduction", "What designs save against ptc", chart)))
        .with(Block::Table(Table::new("annual_average.csv", &["PMV"], &designs, rows)));
    Some(
        section
            .with(study.has_intervals().then(interval_note))
            .with(weights_note(study))
            .with(meaning(study))
            .with(Block::limits(
                "Designs are compared in the same hours, so that a cold winter moves a saving less than the powers: its interval is narrower.\n\
                 It holds for the climate of these hours and for the coefficients of performance under Designs.",
            )),
    )
}

/// What most of the power can be saved by, in the window that is shown.
fn meaning(study: &StudyReport) -> Option<Block> {
    let shown = study.shown_window()?;
    let saving = |d| Some((study.annual_row(d, shown)?.reduction_vs_ptc?, d));
    let (share, name) = study.design_names().into_iter().filter_map(saving).max_by(|a, b| a.0.total_cmp(&b.0))?;
    let ends = study.interval(name, shown).and_then(|r| r.reduction_vs_ptc);
    Some(Block::Means(value(format!(
        "At PMV {} the most that a design saves is {}, with {name}: of 100 kWh that resistive heating takes in service, it takes {:.0}.",
        window(shown),
        percent_within(share, ends),
        100.0 * (1.0 - share)
    ))))
}

fn chart(study: &StudyReport) -> Option<Chart> {
    let chart = OverWindows {
        title: "What designs save against resistive heating".to_owned(),
        told: "Share of the annual mean HVAC power of ptc in the same comfort window; bands: 90 % intervals."
            .to_owned(),
        quantity: Axis::new("saving in %").from(0.0),
        height: 120.0,
    };
    over_windows(study, chart, |design, w| {
        let share = study.annual_row(design, w)?.reduction_vs_ptc.filter(|_| design != "ptc")?;
        let ends = study.interval(design, w).and_then(|r| r.reduction_vs_ptc);
        Some((100.0 * share, ends.map(|ends| ends.map(|end| 100.0 * end))))
    })
}
