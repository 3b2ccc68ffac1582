//! One mission under causal controllers (paper, figures `causal-time-resolved` and `causal-pareto-front`).

use store::{ControlMinute, ControlTrace};

use super::mission_hour::{clock_h, clock_label};
use crate::StudyReport;
use crate::document::Section;
use crate::figure::palette::{LIMIT, Style};
use crate::figure::{Axis, Chart, Mark, Panel, Ticks};
use crate::numbers::window;

use super::control_front::{Front, controllers_chart};

/// A part of the section before it, without a title of its own.
pub(super) fn section(study: &StudyReport) -> Option<Section> {
    if study.control_traces.is_empty() {
        return None;
    }
    let mut section = Section { level: 0, ..Section::default() };
    let (file, caption) = ("causal_time_resolved", "A hot mission under causal controllers");
    section = section.with_chart(file, caption, in_time(study));
    let (file, caption) = ("causal_pareto_front", "The same mission under all controllers");
    Some(section.with_chart(file, caption, pareto(study)))
}

fn name(trace: &ControlTrace) -> String {
    if trace.controller == "extracted" { format!("PMV {}", window(trace.window)) } else { trace.controller.clone() }
}

fn in_time(study: &StudyReport) -> Chart {
    let traces = &study.control_traces;
    let first = traces.first();
    // The mission begins when that of the simulation does.
    let segments = study.traces.iter().filter_map(|t| t.segments.first()).map(|(sample, _)| &sample.segment);
    let start = segments.into_iter().find(|s| first.is_some_and(|t| t.mission == s.mission)).map(|s| s.start);
    let first_h = start.map_or(0.0, |start| clock_h(start, study.zone));
    let hour = |minute: usize| first_h + (minute as f64 + 0.5) / 60.0;
    let longest = traces.iter().map(|t| t.minutes.len()).max().unwrap_or(0);
    let end_h = first_h + longest as f64 / 60.0;
    let line = |name: String, style: Style, trace: &ControlTrace, value: &dyn Fn(&ControlMinute) -> f64| {
        Mark::line(name, style, trace.minutes.iter().enumerate().map(|(i, m)| (hour(i), value(m))).collect())
    };
    let styled = || traces.iter().enumerate().map(|(i, trace)| (Style::of_place(2 * i).without_marker(), trace));
    let lines = |value: fn(&ControlMinute) -> f64| -> Vec<Mark> {
        let of =
            |(style, trace): (Style, &ControlTrace)| line(name(trace), Style { width: 0.9, ..style }, trace, &value);
        styled().map(of).collect()
    };
    // At rest there is no setpoint: the line breaks.
    let setpoints = styled().map(|(style, trace)| {
        let style = Style { dash: "0.8 1.4", width: 0.7, ..style };
        let value = |m: &ControlMinute| m.setpoint_c.unwrap_or(f64::NAN);
        let points = trace.minutes.iter().enumerate().map(|(i, m)| (hour(i), value(m))).collect();
        Mark::Line { name: name(trace), what: "setpoint", style, points }
    });
    let mut cabin = lines(|m| m.cabin_temperature_c);
    cabin.extend(setpoints);
    let ambient =
        first.map(|trace| line("ambient".to_owned(), Style::line(LIMIT, "", 0.8), trace, &|m| m.ambient_temperature_c));
    let axis = |label: &str, marks, height_ticks| Panel {
        x: Axis::default().from(first_h).to(end_h).with(height_ticks),
        y: Axis::new(label),
        marks,
        ..Panel::default()
    };
    let mut votes = lines(|m| m.pmv_15min);
    for trace in traces.iter().filter(|t| t.controller == "extracted") {
        let name = format!("±{}", trace.window.pmv_limit());
        votes.push(Mark::Limit { at: trace.window.pmv_max(), name });
        votes.push(Mark::Limit { at: trace.window.pmv_min(), name: String::new() });
    }
    let mut panels = vec![
        axis("ambient °C", ambient.into_iter().collect(), Ticks::None),
        axis("cabin °C", cabin, Ticks::None),
        axis("PMV, 15 minutes", votes, Ticks::None),
        axis("HVAC kW", lines(|m| m.hvac_power_w / 1e3), Ticks::Clock),
    ];
    if let Some(last) = panels.last_mut() {
        last.x.label = match start {
            Some(start) => clock_label(start, study.zone),
            None => "hours and minutes since the start of the mission".to_owned(),
        };
    }
    let note = study.note.as_ref().map_or_else(String::new, |note| format!(" {note}"));
    Chart {
        title: format!("A hot mission with {} under causal controllers", first.map_or("", |t| &t.design)),
        told: format!("{}; setpoints dotted.{note}", first.map_or("", |t| &t.mission)),
        columns: 1,
        panels,
        height: 54.0,
    }
}

fn pareto(study: &StudyReport) -> Chart {
    let design = study.control_traces.first().map(|t| &t.design);
    let points = || study.control_trace_points.iter().filter(|(p, ..)| Some(&p.design) == design);
    let extracted = || points().filter(|(p, ..)| p.controller == "extracted");
    let steady = extracted().map(|(p, _, most)| (*most, p.static_mean_hvac_power_w / 1e3)).collect();
    let driven = extracted().filter_map(|(p, most, _)| Some(((*most)?, p.mean_hvac_power_w / 1e3))).collect();
    let mut fronts = vec![Front::steady(steady), Front::new("extracted", driven)];
    for (p, most, _) in points().filter(|(p, ..)| !p.controller.starts_with("extracted")) {
        if !fronts.iter().any(|f| f.name == p.controller) {
            let points = most.iter().map(|most| (*most, p.mean_hvac_power_w / 1e3)).collect();
            fronts.push(Front::new(&p.controller, points));
        }
    }
    controllers_chart(
        "A hot mission under causal controllers",
        "Mean HVAC power over the largest |PMV| of the mission, under control its 15-minute mean.",
        ["largest |PMV|", "mean HVAC power in kW"],
        &fronts,
    )
}
