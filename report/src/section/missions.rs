//! Two missions in time, and what they come to with every window (paper, figures `dynamic-comparison` and
//! `dynamic-comparison-pareto`).

use cabin::{Cabin, HeatFlows, Operation, PassengerViews, celsius};
use chrono::{DateTime, TimeDelta, Timelike, Utc};
use chrono_tz::Tz;
use ingest::sample::Sample;
use simulate::TraceMinute;
use store::{MissionTrace, TraceWindow};

use crate::document::{Block, Figure, Section};
use crate::figure::palette::{COOLING, HEATING, IN_TIME, Marker, REST, STEADY, SUN, Style};
use crate::figure::{Axis, Chart, HeatFlowFigure, Mark, Panel, Ticks, chart_svg, heat_flow_svg};
use crate::numbers;
use crate::{ReportError, StudyReport};

const DASH: &str = "3 1.5";

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
        section.figures.push(Figure { file, svg: chart_svg(&mission(trace, study.note.as_deref(), study.zone))? });
        section = section.with(Block::Figure { file, caption });
        if let Some(sample) = data_sample(trace, study.zone).filter(|_| trace.label == "hot") {
            let (file, caption) = ("data_sample.svg", "The disturbances of the hot mission, and of its shaded hour");
            section.figures.push(Figure { file, svg: chart_svg(&sample)? });
            section = section.with(Block::Figure { file, caption });
        }
        if let Some(svg) = heat_flows(trace, study)? {
            let (file, caption) = match trace.label.as_str() {
                "cold" => ("heat_flow_cold.svg", "Heat flows of the shaded hour of the cold mission"),
                _ => ("heat_flow_hot.svg", "Heat flows of the shaded hour of the hot mission"),
            };
            section.figures.push(Figure { file, svg });
            section = section.with(Block::Figure { file, caption });
        }
    }
    if !study.trace_windows.is_empty() {
        let (file, caption) = ("simulated_pareto.svg", "Simulated missions beside their optima");
        section.figures.push(Figure { file, svg: chart_svg(&fronts(&study.trace_windows))? });
        section = section.with(Block::Figure { file, caption });
    }
    Ok(Some(section))
}

/// Power over the comfort that is reached, simulated and in steady state, with a box around each window.
fn fronts(all: &[TraceWindow]) -> Chart {
    let mut marks = Vec::new();
    let mut windows: Vec<cabin::ComfortWindow> = Vec::new();
    for w in all {
        if !windows.contains(&w.window) {
            windows.push(w.window);
        }
    }
    let steady = |w: &TraceWindow| (w.static_max_abs_pmv, w.static_mean_hvac_power_w / 1e3);
    let driven = |w: &TraceWindow| Some((w.max_abs_pmv_15min?, w.mean_hvac_power_w / 1e3));
    for of in windows {
        let rows = || all.iter().filter(|w| w.window == of);
        let points: Vec<(f64, f64)> = rows().map(steady).chain(rows().filter_map(driven)).collect();
        let end = |of: fn(&(f64, f64)) -> f64, pick: fn(f64, f64) -> f64| points.iter().map(of).reduce(pick);
        if let (Some(x0), Some(x1), Some(y0), Some(y1)) =
            (end(|p| p.0, f64::min), end(|p| p.0, f64::max), end(|p| p.1, f64::min), end(|p| p.1, f64::max))
        {
            marks.push(Mark::Frame { low: (x0, y0), high: (x1, y1), name: numbers::window(of) });
        }
    }
    for (label, colour, markers) in
        [("cold", COOLING, [Marker::Cross, Marker::Circle]), ("hot", HEATING, [Marker::OpenSquare, Marker::Square])]
    {
        let rows = || all.iter().filter(|w| w.label == label);
        let line = |name: &str, dash, marker, mut points: Vec<(f64, f64)>| {
            points.sort_by(|a, b| a.0.total_cmp(&b.0));
            let style = Style { colour, dash, width: 1.0, marker: Some(marker) };
            Mark::Line { name: format!("{label}, {name}"), style, points }
        };
        marks.push(line("steady state", DASH, markers[0], rows().map(steady).collect()));
        marks.push(line("simulated", "", markers[1], rows().filter_map(driven).collect()));
    }
    Chart {
        title: "Simulated missions beside their steady-state optima".to_owned(),
        told: "Mean HVAC power over the largest |PMV| of a mission, of a simulation its 15-minute mean; boxes: comfort windows."
            .to_owned(),
        columns: 1,
        panels: vec![Panel {
            x: Axis::new("largest |PMV|").from(0.0),
            y: Axis::new("mean HVAC power in kW").from(0.0),
            marks,
            ..Panel::default()
        }],
        height: 150.0,
    }
}

/// The segment that the paper shows of its missions (figures `single-scenario`: 17:35 and 15:50), of others the one of most
/// power.
fn shown_segment(trace: &MissionTrace, zone: Tz) -> Option<usize> {
    let of_paper_h = if trace.label == "cold" { 17.0 + 35.0 / 60.0 } else { 15.0 + 50.0 / 60.0 };
    let segments = trace.segments.iter().enumerate();
    if trace.of_paper {
        let off = |(sample, _): &(Sample, Operation)| (clock_h(sample.segment.start, zone) - of_paper_h).abs();
        return segments.min_by(|a, b| off(a.1).total_cmp(&off(b.1))).map(|(i, _)| i);
    }
    segments.max_by(|a, b| a.1.1.hvac_power_w().total_cmp(&b.1.1.hvac_power_w())).map(|(i, _)| i)
}

/// When each segment of a mission begins, by local time.
pub(super) fn starts(trace: &MissionTrace, zone: Tz) -> Vec<DateTime<Tz>> {
    trace.segments.iter().map(|(sample, _)| sample.segment.start.with_timezone(&zone)).collect()
}

/// The segment that is shown, its optimum and where its heat flows.
pub(super) fn shown_operation<'t>(
    trace: &'t MissionTrace,
    study: &StudyReport,
) -> Option<(&'t Sample, &'t Operation, HeatFlows)> {
    let (sample, o) = trace.segments.get(shown_segment(trace, study.zone)?)?;
    let views = PassengerViews::new(&study.vehicle);
    let cabin = Cabin::new(&study.vehicle, &views, &sample.disturbances);
    let flows = cabin.flows(&o.temperatures, o.devices.air_curtain, o.air_unit_heat_w, o.radiant_heater_power_w);
    Some((sample, o, flows))
}

fn heat_flows(trace: &MissionTrace, study: &StudyReport) -> Result<Option<String>, ReportError> {
    let Some((sample, o, flows)) = shown_operation(trace, study) else { return Ok(None) };
    let d = &sample.disturbances;
    let start = sample.segment.start.with_timezone(&study.zone);
    let end = start + TimeDelta::seconds(sample.segment.duration_s.into());
    let figure = HeatFlowFigure {
        title: format!("Heat flows of an hour, {} at PMV {}", trace.design, numbers::window(trace.window)),
        description: format!(
            "{} to {}; {:.1} passengers, {:.1} % of the doors open, shadow fraction {:.2}, PMV {}.",
            start.format("%-d %B %Y, %H:%M"),
            end.format("%H:%M"),
            d.passengers,
            100.0 * d.door_open_fraction,
            d.shadow_fraction,
            numbers::signed(o.pmv, 2)
        ),
        ambient_k: d.ambient_temperature_k,
        temperatures: o.temperatures,
        flows,
        air_unit_power_w: o.air_unit_power_w,
    };
    heat_flow_svg(&figure).map(Some)
}

/// The disturbances of the day beside those of the hour that is shown (paper, figure `data-sample`).
fn data_sample(trace: &MissionTrace, zone: Tz) -> Option<Chart> {
    let day = mission(trace, None, zone);
    let first = &trace.segments.first()?.0.segment;
    let shown = shown_segment(trace, zone)?;
    let hour_h = f64::from(first.duration_s) / 3600.0;
    let from = clock_h(first.start, zone) + hour_h * shown as f64;
    let within = |(x, _): &(f64, f64)| (from - 1e-9..=from + hour_h + 1e-9).contains(x);
    let zoomed = |mark: &Mark| match mark {
        Mark::Line { name, style, points } => Some(Mark::Line {
            name: name.clone(),
            style: *style,
            points: points.iter().copied().filter(within).collect(),
        }),
        _ => None,
    };
    let disturbances = &day.panels[..4.min(day.panels.len())];
    let rows = disturbances.iter().enumerate().flat_map(|(i, panel)| {
        let last = i + 1 == disturbances.len();
        let ticks = if last { Ticks::Clock } else { Ticks::None };
        let mut left = Panel { x: panel.x.clone().with(ticks.clone()), ..panel.clone() };
        let x = Axis::default().from(from).to(from + hour_h).with(ticks);
        let mut right = Panel { x, marks: panel.marks.iter().filter_map(zoomed).collect(), ..panel.clone() };
        right.y.label.clear();
        if last {
            left.x.label = "local time".to_owned();
            right.x.label = "the shaded hour".to_owned();
        }
        [left, right]
    });
    Some(Chart {
        title: format!("What a day gives: {}", first.start.with_timezone(&zone).format("%-d %B %Y")),
        told: format!("{}; the shaded hour on the right.", first.mission),
        columns: 2,
        panels: rows.collect(),
        height: 46.0,
    })
}

/// Hours since the local midnight before.
pub(super) fn clock_h(start: DateTime<Utc>, zone: Tz) -> f64 {
    f64::from(start.with_timezone(&zone).num_seconds_from_midnight()) / 3600.0
}

/// What an axis of such hours is called.
pub(super) fn clock_label(start: DateTime<Utc>, zone: Tz) -> String {
    format!("local time on {} ({zone})", start.with_timezone(&zone).format("%-d %B %Y"))
}

fn mission(trace: &MissionTrace, note: Option<&str>, zone: Tz) -> Chart {
    let segments = &trace.segments;
    let first = segments.first().map(|(sample, _)| &sample.segment);
    let first_h = first.map_or(0.0, |s| clock_h(s.start, zone));
    let segment_h = first.map_or(1.0, |s| f64::from(s.duration_s) / 3600.0);
    let end_h = first_h + segment_h * segments.len() as f64;
    let minutes = |value: &dyn Fn(&TraceMinute) -> f64| -> Vec<(f64, f64)> {
        trace.minutes.iter().map(|m| (first_h + (f64::from(m.minute) + 0.5) / 60.0, value(m))).collect()
    };
    let steps = |value: &dyn Fn(usize) -> f64| -> Vec<(f64, f64)> {
        let of = |i: usize| [0.0, 1.0].map(|end| (first_h + segment_h * (i as f64 + end), value(i)));
        (0..segments.len()).flat_map(of).collect()
    };
    let line = |name: &str, colour, dash, width, points| Mark::Line {
        name: name.to_owned(),
        style: Style::line(colour, dash, width),
        points,
    };
    let in_time = |width, points| line("in time", IN_TIME, "", width, points);
    let steady = |points| line("hourly mean, steady state", STEADY, DASH, 1.0, points);
    let panel = |label: &str, marks| Panel {
        x: Axis::default().from(first_h).to(end_h).with(Ticks::None),
        y: Axis::new(label),
        marks,
        ..Panel::default()
    };
    let (d, o) = (|i: usize| &segments[i].0.disturbances, |i: usize| &segments[i].1);
    let window = trace.window;
    let limits = [(window.pmv_max(), "comfort window"), (window.pmv_min(), "")]
        .map(|(at, name)| Mark::Limit { at, name: name.to_owned() });
    let power = |of: fn(&TraceMinute) -> f64| minutes(&|m| of(m) / 1e3);
    let mut panels = vec![
        panel(
            "ambient °C",
            vec![
                in_time(0.9, minutes(&|m| celsius(m.ambient_k))),
                steady(steps(&|i| celsius(d(i).ambient_temperature_k))),
            ],
        ),
        panel(
            "sun W/m²",
            vec![
                line("direct normal", SUN, "", 0.9, steps(&|i| d(i).dni_w_m2)),
                line("diffuse horizontal", REST, "1.5 1.5", 1.0, steps(&|i| d(i).dhi_w_m2)),
            ],
        ),
        panel("passengers", vec![in_time(0.7, minutes(&|m| m.passengers)), steady(steps(&|i| d(i).passengers))]),
        panel(
            "doors %",
            vec![
                in_time(0.4, minutes(&|m| 100.0 * m.door_open_fraction)),
                steady(steps(&|i| 100.0 * d(i).door_open_fraction)),
            ],
        ),
        panel(
            "cabin °C",
            vec![
                in_time(0.7, minutes(&|m| celsius(m.cabin_k))),
                steady(steps(&|i| celsius(o(i).temperatures.cabin_k))),
            ],
        ),
        panel(
            "shell °C",
            vec![
                in_time(0.9, minutes(&|m| celsius(m.shell_inside_k))),
                steady(steps(&|i| celsius(o(i).temperatures.shell_inside_k))),
            ],
        ),
        panel(
            "PMV",
            [
                line("minute mean", REST, "", 0.5, minutes(&|m| m.pmv)),
                in_time(0.9, minutes(&|m| m.pmv_15min)),
                steady(steps(&|i| o(i).pmv)),
            ]
            .into_iter()
            .chain(limits)
            .collect(),
        ),
        panel("HVAC kW", vec![in_time(0.6, power(|m| m.hvac_power_w)), steady(steps(&|i| o(i).hvac_power_w() / 1e3))]),
    ];
    if let Some(shown) = shown_segment(trace, zone) {
        let from = first_h + segment_h * shown as f64;
        panels.iter_mut().for_each(|p| p.marks.insert(0, Mark::Shade { from, to: from + segment_h }));
    }
    if let (Some(last), Some(first)) = (panels.last_mut(), first) {
        last.x = Axis::new(clock_label(first.start, zone)).from(first_h).to(end_h).with(Ticks::Clock);
    }
    let of_paper =
        if trace.of_paper { "named like the mission that the paper shows" } else { "not a mission of the paper" };
    let note = note.map_or_else(String::new, |note| format!(" {note}"));
    Chart {
        title: format!("A {} mission with {} at PMV {}", trace.label, trace.design, numbers::window(window)),
        told: format!(
            "{}; {of_paper}. PMV in time is the 15-minute mean.{note}",
            first.map_or("", |s| s.mission.as_str())
        ),
        columns: 1,
        panels,
        height: 38.0,
    }
}
