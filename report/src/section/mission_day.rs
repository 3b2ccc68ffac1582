//! A mission in time: its disturbances, temperatures, votes and power, with the hour that is shown shaded (paper, figures
//! `dynamic-comparison` and `data-sample`).

use cabin::celsius;
use chrono_tz::Tz;
use simulate::TraceMinute;
use store::MissionTrace;

use super::mission_hour::{clock_h, clock_label, shown_segment};
use crate::figure::palette::{DASHED, IN_TIME, REST, STEADY, SUN, Style};
use crate::figure::{Axis, Chart, Mark, Panel, Ticks};
use crate::numbers;

/// The whole of a mission.
pub(super) fn mission(trace: &MissionTrace, note: Option<&str>, zone: Tz) -> Chart {
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
    let line = |name: &str, colour, dash, width, points| Mark::line(name, Style::line(colour, dash, width), points);
    let in_time = |width, points| line("in time", IN_TIME, "", width, points);
    let steady = |points| line("hourly mean, steady state", STEADY, DASHED, 1.0, points);
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

/// The disturbances of the day beside those of the hour that is shown (paper, figure `data-sample`).
pub(super) fn data_sample(trace: &MissionTrace, zone: Tz) -> Option<Chart> {
    let day = mission(trace, None, zone);
    let first = &trace.segments.first()?.0.segment;
    let shown = shown_segment(trace, zone)?;
    let hour_h = f64::from(first.duration_s) / 3600.0;
    let from = clock_h(first.start, zone) + hour_h * shown as f64;
    let within = |(x, _): &(f64, f64)| (from - 1e-9..=from + hour_h + 1e-9).contains(x);
    let zoomed = |mark: &Mark| match mark {
        Mark::Line { name, style, points, .. } => {
            Some(Mark::line(name, *style, points.iter().copied().filter(within).collect()))
        }
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
