//! Charts with a line of every design over the comfort that is asked for.

use cabin::ComfortWindow;
use store::Ends;

use crate::StudyReport;
use crate::figure::palette::of_designs;
use crate::figure::{Axis, Chart, Mark, Panel};

/// What a chart over comfort windows shows.
pub(super) struct OverWindows {
    pub title: String,
    pub told: String,
    /// Quantity with its unit.
    pub quantity: Axis,
    pub height: f64,
}

/// A value of every design and symmetric window with the ends of its interval; unequal windows have no place on the axis. `None`
/// where no line has two points.
pub(super) fn over_windows(
    study: &StudyReport,
    chart: OverWindows,
    value: impl Fn(&str, ComfortWindow) -> Option<(f64, Ends)>,
) -> Option<Chart> {
    let names = study.design_names();
    let mut windows: Vec<ComfortWindow> = study.windows().into_iter().filter(|w| w.is_symmetric()).collect();
    windows.sort_by(|a, b| a.pmv_limit().total_cmp(&b.pmv_limit()));
    let mut marks = Vec::new();
    for (name, style) in names.iter().zip(of_designs(&names)) {
        let values = || windows.iter().filter_map(|w| Some((w.pmv_limit(), value(name, *w)?)));
        let points: Vec<(f64, f64)> = values().map(|(limit, (value, _))| (limit, value)).collect();
        if !points.is_empty() {
            let band = values().filter_map(|(limit, (_, ends))| Some((limit, ends?))).collect();
            marks.push(Mark::Band { name: (*name).to_owned(), style, points: band });
            marks.push(Mark::line(*name, style, points));
        }
    }
    let OverWindows { title, told, quantity, height } = chart;
    let x = Axis::new("limit of |PMV|").from(0.0);
    let panels = vec![Panel { x, y: quantity, marks, ..Panel::default() }];
    let has_line = panels[0].marks.iter().any(|m| matches!(m, Mark::Line { points, .. } if points.len() > 1));
    has_line.then_some(Chart { title, told, columns: 1, panels, height })
}
