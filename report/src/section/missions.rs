//! Two missions in time, an hour of each, and what they come to with every window.

use super::mission_day::{data_sample, mission};
use super::mission_front::fronts;
use super::mission_hour::heat_flows;
use crate::document::Section;
use crate::figure::chart_svg;
use crate::{ReportError, StudyReport};

/// A part of the section before it, without a title of its own.
pub(super) fn section(study: &StudyReport) -> Result<Option<Section>, ReportError> {
    if study.traces.is_empty() {
        return Ok(None);
    }
    let mut section = Section { level: 0, ..Section::default() };
    for trace in &study.traces {
        let cold = trace.label == "cold";
        let (file, caption) =
            if cold { ("mission_cold.svg", "A cold mission") } else { ("mission_hot.svg", "A hot mission") };
        section = section.with_figure(file, caption, chart_svg(&mission(trace, study.note.as_deref(), study.zone))?);
        if let Some(sample) = data_sample(trace, study.zone).filter(|_| !cold) {
            let caption = "The disturbances of the hot mission, and of its shaded hour";
            section = section.with_figure("data_sample.svg", caption, chart_svg(&sample)?);
        }
        if let Some(svg) = heat_flows(trace, study)? {
            let (file, caption) = if cold {
                ("heat_flow_cold.svg", "Heat flows of the shaded hour of the cold mission")
            } else {
                ("heat_flow_hot.svg", "Heat flows of the shaded hour of the hot mission")
            };
            section = section.with_figure(file, caption, svg);
        }
    }
    if !study.trace_windows.is_empty() {
        let svg = chart_svg(&fronts(&study.trace_windows))?;
        section = section.with_figure("simulated_pareto.svg", "Simulated missions beside their optima", svg);
    }
    Ok(Some(section))
}
