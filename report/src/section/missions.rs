//! Two missions in time, and what they come to with every window (paper, figures `dynamic-comparison` and
//! `dynamic-comparison-pareto`).

use cabin::celsius;
use chrono::Timelike;
use chrono_tz::Tz;
use simulate::TraceMinute;
use store::MissionTrace;

use crate::document::{Block, Figure, Section};
use crate::figure::{Curve, Panel, PanelFigure, ParetoPoint, panels_svg, simulated_pareto_svg};
use crate::{ReportError, StudyReport};

const BLUE: &str = "#0072b2";
const ORANGE: &str = "#d55e00";
const GREY: &str = "#777777";
const DASH: &str = "5 3";

/// A part of the section before it, without a title of its own.
pub(super) fn section(study: &StudyReport) -> Result<Option<Section>, ReportError> {
    if study.traces.is_empty() {
        return Ok(None);
    }
    let mut section = Section { level: 0, ..Section::default() };
    for trace in &study.traces {
        let (file, caption) = match trace.label.as_str() {
            "cold" => ("mission_cold.svg", "A cold mission"),
            _ => ("mission_hot.svg", "A hot mission"),
        };
        let figure = figure(trace, study.note.as_deref(), study.zone);
        section.figures.push(Figure { file, svg: panels_svg(&figure)? });
        section = section.with(Block::Figure { file, caption });
    }
    let points = pareto_points(study);
    if !points.is_empty() {
        let (file, caption) = ("simulated_pareto.svg", "Simulated missions beside their optima");
        section.figures.push(Figure { file, svg: simulated_pareto_svg(&points) });
        section = section.with(Block::Figure { file, caption });
    }
    Ok(Some(section))
}

fn pareto_points(study: &StudyReport) -> Vec<ParetoPoint> {
    let mut points = Vec::new();
    for w in &study.trace_windows {
        let point = |simulated, max_abs_pmv, power_w: f64| ParetoPoint {
            mission: format!("{} mission", w.label),
            simulated,
            max_abs_pmv,
            power_kw: power_w / 1e3,
        };
        points.push(point(false, w.static_max_abs_pmv, w.static_mean_hvac_power_w));
        points.extend(w.max_abs_pmv_15min.map(|pmv| point(true, pmv, w.mean_hvac_power_w)));
    }
    points.sort_by_key(|p| (p.mission.clone(), p.simulated));
    points
}

fn figure(trace: &MissionTrace, note: Option<&str>, zone: Tz) -> PanelFigure {
    let segments = &trace.segments;
    let first = segments.first().map(|(sample, _)| &sample.segment);
    let first_h = first.map_or(0.0, |s| f64::from(s.start.with_timezone(&zone).num_seconds_from_midnight()) / 3600.0);
    let segment_h = first.map_or(1.0, |s| f64::from(s.duration_s) / 3600.0);
    let end_h = first_h + segment_h * segments.len() as f64;
    let minutes = |value: &dyn Fn(&TraceMinute) -> f64| -> Vec<(f64, f64)> {
        trace.minutes.iter().map(|m| (first_h + (f64::from(m.minute) + 0.5) / 60.0, value(m))).collect()
    };
    let steps = |value: &dyn Fn(usize) -> f64| -> Vec<(f64, f64)> {
        let of = |i: usize| [0.0, 1.0].map(|end| (first_h + segment_h * (i as f64 + end), value(i)));
        (0..segments.len()).flat_map(of).collect()
    };
    let curve = |name: &str, colour, dash, width, points| Curve { name: name.to_owned(), colour, dash, width, points };
    let panel = |label: &str, curves| Panel { label: label.to_owned(), curves };
    let flat = |value: f64| vec![(first_h, value), (end_h, value)];
    let (d, o) = (|i: usize| &segments[i].0.disturbances, |i: usize| &segments[i].1);
    let window = trace.window;
    let panels = vec![
        panel(
            "ambient °C",
            vec![
                curve("in time", BLUE, "", 1.4, minutes(&|m| celsius(m.ambient_k))),
                curve("segment mean", ORANGE, DASH, 1.4, steps(&|i| celsius(d(i).ambient_temperature_k))),
            ],
        ),
        panel(
            "irradiance W/m²",
            vec![
                curve("direct normal", BLUE, DASH, 1.4, steps(&|i| d(i).dni_w_m2)),
                curve("diffuse horizontal", ORANGE, DASH, 1.4, steps(&|i| d(i).dhi_w_m2)),
            ],
        ),
        panel(
            "passengers",
            vec![
                curve("in time", BLUE, "", 1.0, minutes(&|m| m.passengers)),
                curve("segment mean", ORANGE, DASH, 1.4, steps(&|i| d(i).passengers)),
            ],
        ),
        panel(
            "doors open %",
            vec![
                curve("minute mean", BLUE, "", 0.7, minutes(&|m| 100.0 * m.door_open_fraction)),
                curve("segment mean", ORANGE, DASH, 1.4, steps(&|i| 100.0 * d(i).door_open_fraction)),
            ],
        ),
        panel(
            "temperature °C",
            vec![
                curve("cabin", BLUE, "", 1.2, minutes(&|m| celsius(m.cabin_k))),
                curve("shell inside", GREY, "", 1.2, minutes(&|m| celsius(m.shell_inside_k))),
                curve("steady state", ORANGE, DASH, 1.4, steps(&|i| celsius(o(i).temperatures.cabin_k))),
                curve("", ORANGE, DASH, 1.4, steps(&|i| celsius(o(i).temperatures.shell_inside_k))),
            ],
        ),
        panel(
            "PMV",
            vec![
                curve("minute mean", GREY, "", 0.8, minutes(&|m| m.pmv)),
                curve("15-minute mean", BLUE, "", 1.4, minutes(&|m| m.pmv_15min)),
                curve("steady state", ORANGE, DASH, 1.4, steps(&|i| o(i).pmv)),
                curve("window", GREY, "1 3", 1.2, flat(window.pmv_min())),
                curve("", GREY, "1 3", 1.2, flat(window.pmv_max())),
            ],
        ),
        panel(
            "HVAC power kW",
            vec![
                curve("simulated", BLUE, "", 1.0, minutes(&|m| m.hvac_power_w / 1e3)),
                curve("steady state", ORANGE, DASH, 1.4, steps(&|i| o(i).hvac_power_w() / 1e3)),
            ],
        ),
    ];
    let of_paper =
        if trace.of_paper { "named like the mission that the paper shows" } else { "not a mission of the paper" };
    PanelFigure {
        title: format!(
            "A {} mission with {} at PMV {} … {}",
            trace.label,
            trace.design,
            window.pmv_min(),
            window.pmv_max()
        ),
        caption: format!("{}; {of_paper}", first.map_or("", |s| s.source_path.as_str())),
        note: note.unwrap_or_default().to_owned(),
        hours: [first_h, end_h],
        axis: format!("local time in h ({zone})"),
        panels,
    }
}
