//! What the two missions come to with every window (paper, figure `dynamic-comparison-pareto`).

use cabin::ComfortWindow;
use store::TraceWindow;

use crate::figure::palette::{COOLING, DASHED, HEATING, Marker, Style};
use crate::figure::{Axis, Chart, Mark, Panel};
use crate::numbers::window;

/// Power over the comfort that is reached, simulated and in steady state, with a box around each window.
pub(super) fn fronts(all: &[TraceWindow]) -> Chart {
    let mut marks = Vec::new();
    let mut windows: Vec<ComfortWindow> = Vec::new();
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
            marks.push(Mark::Frame { low: (x0, y0), high: (x1, y1), name: window(of) });
        }
    }
    for (label, colour, markers) in
        [("cold", COOLING, [Marker::Cross, Marker::Circle]), ("hot", HEATING, [Marker::OpenSquare, Marker::Square])]
    {
        let rows = || all.iter().filter(|w| w.label == label);
        let line = |name: &str, dash, marker, mut points: Vec<(f64, f64)>| {
            points.sort_by(|a, b| a.0.total_cmp(&b.0));
            let style = Style { colour, dash, width: 1.0, marker: Some(marker) };
            Mark::line(format!("{label}, {name}"), style, points)
        };
        marks.push(line("steady state", DASHED, markers[0], rows().map(steady).collect()));
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
