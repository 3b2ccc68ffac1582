//! One mission under causal controllers (paper, figures `causal-time-resolved` and `causal-pareto-front`).

use store::ControlTrace;

use crate::document::{Block, Figure, Section};
use crate::figure::{Axes, Curve, Front, Panel, PanelFigure, fronts_svg, panels_svg};
use crate::numbers::window;
use crate::{ReportError, StudyReport};

const COLOURS: [&str; 5] = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#777777"];
const DASH: &str = "4 3";

/// A part of the section before it, without a title of its own.
pub(super) fn section(study: &StudyReport) -> Result<Option<Section>, ReportError> {
    if study.control_traces.is_empty() {
        return Ok(None);
    }
    let mut section = Section { level: 0, ..Section::default() };
    let (file, caption) = ("causal_time_resolved.svg", "A hot mission under causal controllers");
    section.figures.push(Figure { file, svg: panels_svg(&figure(&study.control_traces, study.note.as_deref()))? });
    section = section.with(Block::Figure { file, caption });
    let (file, caption) = ("causal_pareto_front.svg", "The same mission under all controllers");
    section.figures.push(Figure { file, svg: pareto(study) });
    Ok(Some(section.with(Block::Figure { file, caption })))
}

fn name(trace: &ControlTrace) -> String {
    if trace.controller == "extracted" { format!("PMV {}", window(trace.window)) } else { trace.controller.clone() }
}

fn figure(traces: &[ControlTrace], note: Option<&str>) -> PanelFigure {
    let hour = |minute: usize| (minute as f64 + 0.5) / 60.0;
    let longest = traces.iter().map(|t| t.minutes.len()).max().unwrap_or(0);
    let coloured = || traces.iter().enumerate().map(|(i, trace)| (COLOURS[i % COLOURS.len()], trace));
    let curves = |value: fn(&store::ControlMinute) -> f64| -> Vec<Curve> {
        let curve = |(colour, trace): (&'static str, &ControlTrace)| Curve {
            name: name(trace),
            colour,
            dash: "",
            width: 1.2,
            points: trace.minutes.iter().enumerate().map(|(i, m)| (hour(i), value(m))).collect(),
        };
        coloured().map(curve).collect()
    };
    // At rest there is no setpoint: the line breaks.
    let setpoints = coloured().map(|(colour, trace)| Curve {
        name: String::new(),
        colour,
        dash: DASH,
        width: 1.0,
        points: trace.minutes.iter().enumerate().map(|(i, m)| (hour(i), m.setpoint_c.unwrap_or(f64::NAN))).collect(),
    });
    let mut cabin = curves(|m| m.cabin_temperature_c);
    cabin.extend(setpoints);
    let ambient = traces.first().map(|trace| Curve {
        name: "ambient".to_owned(),
        colour: COLOURS[4],
        dash: "",
        width: 1.2,
        points: trace.minutes.iter().enumerate().map(|(i, m)| (hour(i), m.ambient_temperature_c)).collect(),
    });
    let panel = |label: &str, curves| Panel { label: label.to_owned(), curves };
    let first = traces.first();
    PanelFigure {
        title: format!("A hot mission with {} under causal controllers", first.map_or("", |t| &t.design)),
        caption: format!("{}; setpoints dashed", first.map_or("", |t| &t.mission)),
        note: note.unwrap_or_default().to_owned(),
        hours: [0.0, longest as f64 / 60.0],
        axis: "h since the start of the mission".to_owned(),
        panels: vec![
            panel("ambient °C", ambient.into_iter().collect()),
            panel("cabin °C", cabin),
            panel("PMV, 15-minute mean", curves(|m| m.pmv_15min)),
            panel("HVAC power kW", curves(|m| m.hvac_power_w / 1e3)),
        ],
    }
}

fn pareto(study: &StudyReport) -> String {
    let design = study.control_traces.first().map(|t| &t.design);
    let points = || study.control_trace_points.iter().filter(|(p, ..)| Some(&p.design) == design);
    let extracted = || points().filter(|(p, ..)| p.controller == "extracted");
    let steady = extracted().map(|(p, _, most)| (*most, p.static_mean_hvac_power_w / 1e3)).collect();
    let driven = extracted().filter_map(|(p, most, _)| Some(((*most)?, p.mean_hvac_power_w / 1e3))).collect();
    let mut fronts = vec![
        Front { name: "steady state".to_owned(), dash: "6 3", points: steady },
        Front { name: "extracted".to_owned(), dash: "", points: driven },
    ];
    for (p, most, _) in points().filter(|(p, ..)| !p.controller.starts_with("extracted")) {
        if !fronts.iter().any(|f| f.name == p.controller) {
            let points = most.iter().map(|most| (*most, p.mean_hvac_power_w / 1e3)).collect();
            fronts.push(Front { name: p.controller.clone(), dash: "", points });
        }
    }
    let axes = Axes {
        title: "A hot mission under causal controllers",
        x: "largest |PMV| (15-minute mean)",
        y: "mean HVAC power in kW",
        x_step: 0.25,
        told: "Mean HVAC power in kW over the largest absolute 15-minute vote of a mission, by controller",
    };
    fronts_svg(&fronts, &axes)
}
