//! The sections of the report, a file each: title, prose, tables and figures as data. A new one is a file beside these and a
//! line in [`all`].

mod annual;
mod assumptions;
mod control;
mod control_classes;
mod control_front;
mod control_mission;
mod designs;
mod economics;
mod findings;
mod front;
mod inputs;
mod limits;
mod mission_day;
mod mission_front;
mod mission_hour;
mod missions;
mod model;
mod monthly;
mod over_windows;
mod paper_numbers;
mod pareto;
mod quality;
mod reduction;
mod repeat;
mod scenarios;
mod sensitivity;
mod setpoints;
mod simulation;
mod simulation_classes;
mod sureness;
mod variants;

pub use findings::{PaperFinding, Verdict, paper_findings};
pub use setpoints::nearest_windows;

use crate::StudyReport;
use cabin::ComfortWindow;

use crate::document::{Block, Choice, Prose, Section, Span};
use crate::numbers::{month, window};

/// All sections that a study gives, in the order of the report.
pub(crate) fn all(study: &StudyReport) -> Vec<Section> {
    let sections = [
        Some(front::section(study)),
        Some(annual::section(study)),
        reduction::section(study),
        sureness::section(study),
        monthly::section(study),
        limits::section(study),
        economics::section(study),
        variants::section(study),
        sensitivity::section(study),
        scenarios::section(study),
        simulation::section(study),
        missions::section(study),
        simulation_classes::section(study),
        setpoints::section(study),
        control::section(study),
        control_mission::section(study),
        control_classes::section(study),
        Some(findings::section(study)),
        paper_numbers::section(study),
        Some(designs::section(study)),
        model::section(study),
        Some(inputs::section(study)),
        Some(quality::section(study)),
        Some(assumptions::section(study)),
        Some(repeat::section(study)),
    ];
    sections.into_iter().flatten().collect()
}

/// What weighted means stand for where months are missing.
fn weights_note(study: &StudyReport) -> Option<Block> {
    let missing = missing_names(study);
    let text = vec![
        Span::Text("Months without samples: "),
        Span::Value(missing.clone()),
        Span::Text(". The weights are spread over the other months."),
    ];
    (!missing.is_empty()).then_some(Block::Note(text))
}

/// The same for every comfort window that a reader can choose; of many, some at equal distances.
fn by_window(study: &StudyReport, of: impl Fn(ComfortWindow) -> Vec<Block>) -> Option<Block> {
    const MOST: usize = 25;
    let windows = study.windows();
    let shown_window = study.shown_window()?;
    let step = windows.len().div_ceil(MOST).max(1);
    let chosen = windows.iter().enumerate().filter(|(i, w)| i % step == 0 || **w == shown_window);
    let chosen: Vec<ComfortWindow> = chosen.map(|(_, w)| *w).collect();
    let shown = chosen.iter().position(|w| *w == shown_window)?;
    let options = chosen.into_iter().map(|w| (window(w), of(w))).collect();
    Some(Block::Choice(Choice { of: "Comfort window, PMV", options, shown }))
}

/// The words of a paragraph that are made of values.
fn value(text: String) -> Prose {
    vec![Span::Value(text)]
}

fn missing_names(study: &StudyReport) -> String {
    study.missing_months().iter().map(|m| month(*m)).collect::<Vec<_>>().join(", ")
}

fn yes(is: bool) -> String {
    if is { "yes" } else { "no" }.to_owned()
}
