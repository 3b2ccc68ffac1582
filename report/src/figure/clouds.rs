//! Clouds of points with curves through them: panels side by side over the same axes.

use minijinja::{AutoEscape, Environment, Value, context};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

use super::panels::{Curve, coordinate, tick_step};
use crate::ReportError;

const TEMPLATE: &str = include_str!("../../templates/clouds.svg");

/// Panels side by side.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct CloudFigure {
    /// First line.
    pub title: String,
    /// What it is.
    pub caption: String,
    /// What the axes are called.
    pub axes: [&'static str; 2],
    /// Panels from left to right.
    pub panels: Vec<CloudPanel>,
    /// Width of a panel, its height.
    pub size: [f64; 2],
}

/// One panel.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct CloudPanel {
    pub title: String,
    pub clouds: Vec<PointCloud>,
    /// Curves over the points; those of the same name have one place in the legend.
    pub curves: Vec<Curve>,
}

/// Points of one kind.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct PointCloud {
    /// Name in the legend.
    pub name: &'static str,
    pub colour: &'static str,
    pub points: Vec<(f64, f64)>,
}

const LEFT: f64 = 62.0;
const GAP: f64 = 26.0;
const LEGEND: f64 = 64.0;
const LEGEND_ROW: f64 = 18.0;

/// An axis that holds all values, from one tick to another.
struct Axis {
    low: f64,
    high: f64,
    step: f64,
}

impl Axis {
    fn of(values: impl Iterator<Item = f64>) -> Self {
        let (least, most) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, m), v| (l.min(v), m.max(v)));
        let (least, most) = if least <= most { (least, most) } else { (0.0, 1.0) };
        let step = tick_step(most - least);
        let low = (least / step).floor() * step;
        Self { low, high: ((most / step).ceil() * step).max(low + step), step }
    }

    fn share(&self, value: f64) -> f64 {
        (value - self.low) / (self.high - self.low)
    }

    fn ticks(&self, at: &dyn Fn(f64) -> f64) -> Vec<Value> {
        let count = ((self.high - self.low) / self.step).round() as i64;
        let tick = |i: i64| self.low + i as f64 * self.step;
        let label = |v: f64| format!("{:.0}", v + 0.0).replace('-', "−");
        (0..=count).map(tick).map(|v| context! { at => coordinate(at(v)), label => label(v) }).collect()
    }
}

/// The figure as SVG.
pub(crate) fn clouds_svg(figure: &CloudFigure) -> Result<String, ReportError> {
    let all = || {
        let of = |p: &'_ CloudPanel| -> Vec<(f64, f64)> {
            let points = p.clouds.iter().flat_map(|c| c.points.iter());
            points.chain(p.curves.iter().flat_map(|c| c.points.iter())).copied().collect()
        };
        figure.panels.iter().flat_map(of)
    };
    let (x, y) = (Axis::of(all().map(|p| p.0)), Axis::of(all().map(|p| p.1)));
    let [width, height] = figure.size;
    let total = LEFT + (width + GAP) * figure.panels.len() as f64 + 8.0;
    let (legend, legend_rows) = legend(figure, total);
    let top = LEGEND + LEGEND_ROW * legend_rows as f64 + 18.0;
    let at_x = |value: f64| width * x.share(value);
    let at_y = |value: f64| top + height * (1.0 - y.share(value));
    let panel = |(i, p): (usize, &CloudPanel)| {
        let left = LEFT + (width + GAP) * i as f64;
        let place = |(px, py): (f64, f64)| (left + at_x(px), at_y(py));
        let clouds: Vec<Value> =
            p.clouds.iter().map(|c| context! { path => dots(&c.points, &place), colour => c.colour }).collect();
        let curves: Vec<Value> = p
            .curves
            .iter()
            .map(|c| {
                context! { path => line(&c.points, &place), colour => c.colour, width => c.width, dash => c.dash }
            })
            .collect();
        let x_ticks = x.ticks(&|value| left + at_x(value));
        context! { title => &p.title, left, first => i == 0, clouds, curves, x_ticks }
    };
    let panels: Vec<Value> = figure.panels.iter().enumerate().map(panel).collect();
    let mut environment = Environment::new();
    environment.set_auto_escape_callback(|_| AutoEscape::Html);
    environment.add_template("clouds.svg", TEMPLATE)?;
    let [x_label, y_label] = figure.axes;
    let content = context! {
        title => &figure.title, caption => &figure.caption, panels, legend, x_label, y_label, top,
        bottom => top + height, width => total, height => top + height + 46.0, panel_width => width,
        panel_height => height, middle => (LEFT + total) / 2.0, y_ticks => y.ticks(&at_y),
    };
    Ok(environment.get_template("clouds.svg")?.render(content)?)
}

/// A dot for each pixel that has points: as many as the eye can tell apart.
fn dots(points: &[(f64, f64)], place: &dyn Fn((f64, f64)) -> (f64, f64)) -> String {
    let pixels: BTreeSet<(i64, i64)> =
        points.iter().map(|p| place(*p)).map(|(x, y)| (x.round() as i64, y.round() as i64)).collect();
    let mut rows: BTreeMap<i64, Vec<i64>> = BTreeMap::new();
    for (x, y) in pixels {
        rows.entry(y).or_default().push(x);
    }
    let mut path = String::new();
    for (y, xs) in rows {
        for x in xs {
            let _ = write!(path, "M{x} {y}h0");
        }
    }
    path
}

fn line(points: &[(f64, f64)], place: &dyn Fn((f64, f64)) -> (f64, f64)) -> String {
    let mut path = String::new();
    for (i, p) in points.iter().enumerate() {
        let (x, y) = place(*p);
        let _ = write!(path, "{}{} {}", if i == 0 { "M" } else { " " }, coordinate(x), coordinate(y));
    }
    path
}

/// Every name once, in rows as wide as the figure; the number of rows.
fn legend(figure: &CloudFigure, width: f64) -> (Vec<Value>, usize) {
    let mut seen: BTreeSet<&str> = BTreeSet::new();
    let mut entries = Vec::new();
    for panel in &figure.panels {
        for c in &panel.clouds {
            if !c.points.is_empty() && seen.insert(c.name) {
                entries.push((c.name.to_owned(), context! { dot => true, colour => c.colour }));
            }
        }
        for c in &panel.curves {
            if !c.name.is_empty() && seen.insert(&c.name) {
                let key = context! { colour => c.colour, width => c.width, dash => c.dash };
                entries.push((c.name.clone(), key));
            }
        }
    }
    let (mut x, mut row) = (16.0, 0);
    let mut values = Vec::new();
    for (name, key) in entries {
        let wide = 44.0 + 6.6 * name.chars().count() as f64;
        if x + wide > width && x > 16.0 {
            (x, row) = (16.0, row + 1);
        }
        values.push(context! { x, y => LEGEND + LEGEND_ROW * row as f64, name, ..key });
        x += wide;
    }
    (values, row + 1)
}
