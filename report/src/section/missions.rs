//! Two missions in time, an hour of each, and what they come to with every window.

use super::mission_day::{data_sample, mission};
use super::mission_front::fronts;
use super::mission_hour::heat_flows;
use crate::StudyReport;
use crate::document::{Block, Figure, Picture, Section};

/// A part of the section before it, without a title of its own.
pub(super) fn section(study: &StudyReport) -> Option<Section> {
    if study.traces.is_empty() {
        return None;
    }
    let mut section = Section { level: 0, ..Section::default() };
    for trace in &study.traces {
        let cold = trace.label == "cold";
        let (file, caption) = if cold { ("mission_cold", "A cold mission") } else { ("mission_hot", "A hot mission") };
        section = section.with_chart(file, caption, mission(trace, study.note.as_deref(), study.zone));
        if let Some(sample) = data_sample(trace, study.zone).filter(|_| !cold) {
            let caption = "The disturbances of the hot mission, and of its shaded hour";
            section = section.with_chart("data_sample", caption, sample);
        }
        if let Some(figure) = heat_flows(trace, study) {
            let (file, caption) = if cold {
                ("heat_flow_cold", "Heat flows of the shaded hour of the cold mission")
            } else {
                ("heat_flow_hot", "Heat flows of the shaded hour of the hot mission")
            };
            let picture = Picture::HeatFlow(Box::new(figure));
            section = section.with(Block::Figure(Figure { file, caption: caption.to_owned(), picture }));
        }
    }
    if !study.trace_windows.is_empty() {
        let caption = "Simulated missions beside their optima";
        section = section.with_chart("simulated_pareto", caption, fronts(&study.trace_windows));
    }
    Some(section)
}
