//! What designs save against resistive heating.

use super::annual::interval_note;
use super::{value, weights_note};
use crate::StudyReport;
use crate::document::{Block, Section, Table};
use crate::figure::palette::of_designs;
use crate::figure::{Axis, Chart, Mark, Panel};
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
    let names = study.design_names();
    let mut marks = Vec::new();
    for (name, style) in names.iter().zip(of_designs(&names)).filter(|(name, _)| **name != "ptc") {
        let mut rows: Vec<_> = study.annual.iter().filter(|r| r.design == **name && r.window.is_symmetric()).collect();
        rows.sort_by(|a, b| a.window.pmv_limit().total_cmp(&b.window.pmv_limit()));
        let points = rows.iter().filter_map(|r| Some((r.window.pmv_limit(), 100.0 * r.reduction_vs_ptc?))).collect();
        let ends = |w| study.interval(name, w)?.reduction_vs_ptc;
        let band = rows.iter().filter_map(|r| Some((r.window.pmv_limit(), ends(r.window)?.map(|end| 100.0 * end))));
        marks.push(Mark::Band { name: (*name).to_owned(), style, points: band.collect() });
        marks.push(Mark::line(*name, style, points));
    }
    marks.iter().any(|m| matches!(m, Mark::Line { points, .. } if !points.is_empty())).then(|| Chart {
        title: "What designs save against resistive heating".to_owned(),
        told: "Share of the annual mean HVAC power of ptc in the same comfort window; bands: 90 % intervals."
            .to_owned(),
        columns: 1,
        panels: vec![Panel {
            x: Axis::new("limit of |PMV|").from(0.0),
            y: Axis::new("saving in %").from(0.0),
            marks,
            ..Panel::default()
        }],
        height: 120.0,
    })
}
