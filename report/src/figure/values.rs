//! The values behind a chart: every one of them for spreadsheets, and tables that a reader can take in, a panel each.

use super::axis::{Axis, Ticks, clock};
use super::chart::{Chart, Panel, drawn};
use super::marks::{Mark, Place};
use crate::numbers::{month, significant, within};

/// More rows than this and a table of lines has a part of them.
const MOST_ROWS: usize = 48;

/// A table of the values on a panel.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ValueTable {
    /// What the panel is.
    pub caption: String,
    /// What a row stands for.
    pub at: String,
    /// Columns, a series each.
    pub columns: Vec<String>,
    /// Rows: where they lie on the figure from its left, at what, and a cell for each column.
    pub rows: Vec<(f64, String, Vec<String>)>,
    /// The panel on the figure: left, top, right, bottom.
    pub panel: Option<[f64; 4]>,
}

/// A value of a chart.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ValueRow {
    pub panel: String,
    pub series: String,
    pub at_what: String,
    pub at: f64,
    pub what: String,
    pub value: f64,
    pub ends: Option<[f64; 2]>,
}

/// Every value: of lines with the ends of the band around them, of clouds each dot.
pub(crate) fn all_values(chart: &Chart) -> Vec<ValueRow> {
    let mut rows = Vec::new();
    for (i, panel) in chart.panels.iter().enumerate() {
        for mark in &panel.marks {
            let (Mark::Line { points, .. } | Mark::Dots { points, .. }) = mark else { continue };
            let row = |(x, y): &(f64, f64)| ValueRow {
                panel: caption(chart, i),
                series: title_of(mark, panel),
                at_what: axis_below(chart, i).label.clone(),
                at: *x,
                what: value_axis(chart, i).label.clone(),
                value: *y,
                ends: ends_at(panel, mark, *x),
            };
            rows.extend(points.iter().filter(|(x, y)| x.is_finite() && y.is_finite()).map(row));
        }
    }
    rows
}

/// A table for each panel; those without lines and dots have none.
pub(crate) fn value_tables(chart: &Chart) -> Vec<ValueTable> {
    let (_, places) = drawn(chart);
    let table = |(i, (panel, place)): (usize, (&Panel, &Place))| {
        let shown: Vec<&Mark> = panel.marks.iter().filter(|m| !points_of(m).is_empty()).collect();
        let has_dots = shown.iter().any(|m| matches!(m, Mark::Dots { .. }));
        let ticks = &axis_below(chart, i).ticks;
        let mut rows = if has_dots { binned(&shown, place) } else { listed(panel, &shown, ticks) };
        rows.iter_mut().for_each(|(x, ..)| *x = place.left + place.width * place.x.share(*x));
        let what = if axis_below(chart, i).label.is_empty() { "x" } else { &axis_below(chart, i).label };
        let part = match (has_dots, places_of(&shown).len() > MOST_ROWS) {
            (true, _) => "; of dots the middle one (5 % … 95 %) between two lines of the grid",
            (false, true) => "; a part of the values",
            (false, false) => "",
        };
        (!rows.is_empty()).then(|| ValueTable {
            caption: format!("{}{part}", caption(chart, i)),
            at: what.to_owned(),
            columns: shown.iter().map(|mark| title_of(mark, panel)).collect(),
            rows,
            panel: Some([place.left, place.top, place.left + place.width, place.top + place.height]),
        })
    };
    chart.panels.iter().zip(&places).enumerate().filter_map(table).collect()
}

/// What a panel is: its title and quantity.
fn caption(chart: &Chart, i: usize) -> String {
    let quantity = &value_axis(chart, i).label;
    match chart.panels[i].title.as_str() {
        "" => quantity.clone(),
        title => format!("{title}: {quantity}"),
    }
}

/// Panels above each other have their axis below the last one.
fn axis_below(chart: &Chart, i: usize) -> &Axis {
    let columns = chart.columns.max(1);
    let below = chart.panels.iter().skip(i).step_by(columns).find(|p| p.x.ticks != Ticks::None);
    &below.unwrap_or(&chart.panels[i]).x
}

/// Panels beside each other have their quantity on the left of the first one.
fn value_axis(chart: &Chart, i: usize) -> &Axis {
    let first = i - i % chart.columns.max(1);
    let own = &chart.panels[i].y;
    if own.label.is_empty() { &chart.panels[first].y } else { own }
}

fn points_of(mark: &Mark) -> &[(f64, f64)] {
    match mark {
        Mark::Line { points, .. } | Mark::Dots { points, .. } => points,
        _ => &[],
    }
}

fn title_of(mark: &Mark, panel: &Panel) -> String {
    match mark {
        Mark::Line { name, what, .. } if !what.is_empty() => format!("{name}, {what}"),
        Mark::Line { name, .. } | Mark::Dots { name, .. } if !name.is_empty() => name.clone(),
        _ => panel.y.label.clone(),
    }
}

/// The ends of the band of a series at a place.
fn ends_at(panel: &Panel, of: &Mark, x: f64) -> Option<[f64; 2]> {
    let bands = panel.marks.iter().filter(|m| matches!(m, Mark::Band { .. }) && m.series() == of.series());
    let points = bands.filter_map(|m| if let Mark::Band { points, .. } = m { Some(points) } else { None });
    points.flatten().find(|(at, _)| *at == x).map(|(_, ends)| *ends)
}

/// Every place that a line has a value at, rising.
fn places_of(marks: &[&Mark]) -> Vec<f64> {
    let mut places: Vec<f64> = marks.iter().flat_map(|m| points_of(m)).map(|p| p.0).filter(|x| x.is_finite()).collect();
    places.sort_by(f64::total_cmp);
    places.dedup();
    places
}

/// Lines at their places; where these are many, at evenly spread ones, between two values on the line that is drawn.
fn listed(panel: &Panel, marks: &[&Mark], ticks: &Ticks) -> Vec<(f64, String, Vec<String>)> {
    let all = places_of(marks);
    let is_part = all.len() > MOST_ROWS;
    let step = all.len().div_ceil(MOST_ROWS).max(1);
    let row = |x: f64| {
        let cell = |mark: &&Mark| {
            let points = points_of(mark);
            // Of a step, what follows it.
            let exact = points.iter().rfind(|p| p.0 == x).map(|p| p.1);
            let value = exact.or_else(|| is_part.then(|| on_line(points, x)).flatten()).filter(|v| v.is_finite());
            with_interval(value, ends_at(panel, mark, x))
        };
        (x, said(x, ticks), marks.iter().map(cell).collect())
    };
    all.into_iter().step_by(step).map(row).collect()
}

/// Dots between the lines of the grid: their middle, and between what nine of ten lie; lines in the middle between.
fn binned(marks: &[&Mark], place: &Place) -> Vec<(f64, String, Vec<String>)> {
    let ticks: Vec<f64> = place.x.ticks(&Ticks::Numbers).into_iter().map(|(x, _)| x).collect();
    let row = |ends: &[f64]| {
        let (from, to) = (ends[0], ends[1]);
        let middle = (from + to) / 2.0;
        let cell = |mark: &&Mark| match mark {
            Mark::Dots { points, .. } => {
                let within = points.iter().filter(|(x, _)| (from..to).contains(x));
                let mut values: Vec<f64> = within.map(|p| p.1).filter(|v| v.is_finite()).collect();
                values.sort_by(f64::total_cmp);
                let at = |share: f64| values.get((share * (values.len().max(1) - 1) as f64).round() as usize).copied();
                with_ends(at(0.5), at(0.05).zip(at(0.95)).map(|(low, high)| [low, high]))
            }
            _ => with_interval(on_line(points_of(mark), middle), None),
        };
        let range = format!("{} … {}", significant(from), significant(to));
        (middle, range, marks.iter().map(cell).collect::<Vec<_>>())
    };
    ticks.windows(2).map(row).filter(|(.., cells)| cells.iter().any(|c| c != NOTHING)).collect()
}

const NOTHING: &str = "–";

/// A value with the digits that its interval lets stand.
fn with_interval(value: Option<f64>, ends: Option<[f64; 2]>) -> String {
    match (value, ends) {
        (Some(value), Some(_)) => within(value, ends, 3),
        _ => with_ends(value, None),
    }
}

pub(super) fn with_ends(value: Option<f64>, ends: Option<[f64; 2]>) -> String {
    match (value, ends) {
        (Some(value), Some([low, high])) => {
            format!("{} ({} … {})", significant(value), significant(low), significant(high))
        }
        (Some(value), None) => significant(value),
        (None, _) => NOTHING.to_owned(),
    }
}

/// The value of a line between two of its points; none where it breaks or has ended.
fn on_line(points: &[(f64, f64)], x: f64) -> Option<f64> {
    let piece = points.windows(2).find(|pair| pair[0].0 <= x && x <= pair[1].0 && pair[0].0 < pair[1].0)?;
    let ((x0, y0), (x1, y1)) = (piece[0], piece[1]);
    Some(y0 + (y1 - y0) * (x - x0) / (x1 - x0)).filter(|y| y.is_finite())
}

/// A place on an axis in words.
fn said(x: f64, ticks: &Ticks) -> String {
    match ticks {
        Ticks::Clock => clock(x),
        Ticks::Months => month(x.round() as u8).to_owned(),
        Ticks::Numbers | Ticks::None => significant(x),
    }
}
