//! Quantities in time: stacked panels over one axis of hours.

use minijinja::{AutoEscape, Environment, Value, context};
use std::fmt::Write as _;

use crate::ReportError;

const TEMPLATE: &str = include_str!("../../templates/mission.svg");

/// A mission in time.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PanelFigure {
    /// First line.
    pub title: String,
    /// What it is, and where the data come from.
    pub caption: String,
    /// What the author of the study says of the data; empty for nothing.
    pub note: String,
    /// From the first to the last hour on the axis.
    pub hours: [f64; 2],
    /// What the axis of hours is called.
    pub axis: String,
    /// Panels from top to bottom.
    pub panels: Vec<Panel>,
}

/// One panel.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Panel {
    /// Quantity with its unit.
    pub label: String,
    /// Its curves.
    pub curves: Vec<Curve>,
}

/// A curve.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Curve {
    /// Name in the legend; empty for none.
    pub name: String,
    /// Colour.
    pub colour: &'static str,
    /// Dashes as in SVG; empty for a solid line.
    pub dash: &'static str,
    /// Width.
    pub width: f64,
    /// Hour and value, in the order of time. Where a value is not a number, the line breaks.
    pub points: Vec<(f64, f64)>,
}

const LEFT: f64 = 70.0;
const RIGHT: f64 = 880.0;
const TOP: f64 = 96.0;
const PANEL: f64 = 92.0;
const STRIDE: f64 = 116.0;

/// The figure as SVG.
///
/// # Errors
/// [`ReportError::Template`] where template and data do not fit; not for any mission.
pub fn panels_svg(figure: &PanelFigure) -> Result<String, ReportError> {
    let [from, to] = figure.hours;
    let x = |hour: f64| LEFT + (RIGHT - LEFT) * (hour - from) / (to - from).max(1e-9);
    let bottom = TOP + STRIDE * figure.panels.len() as f64;
    let step = if to - from > 8.0 { 2.0 } else { 1.0 };
    let first = (from / step).ceil() as i64;
    let last = (to / step).floor() as i64;
    let hours: Vec<Value> = (first..=last)
        .map(|i| context! { x => coordinate(x(i as f64 * step)), label => (i * step as i64).rem_euclid(24) })
        .collect();
    let panels: Vec<Value> =
        figure.panels.iter().enumerate().map(|(i, p)| panel(p, TOP + STRIDE * i as f64, &x)).collect();
    let mut environment = Environment::new();
    environment.set_auto_escape_callback(|_| AutoEscape::Html);
    environment.add_template("mission.svg", TEMPLATE)?;
    let content = context! {
        title => &figure.title, caption => &figure.caption, note => &figure.note, axis => &figure.axis, panels, hours, left => LEFT, right => RIGHT,
        top => TOP, bottom, axis_y => bottom + 14.0, height => bottom + 40.0,
    };
    Ok(environment.get_template("mission.svg")?.render(content)?)
}

fn panel(panel: &Panel, top: f64, x: &dyn Fn(f64) -> f64) -> Value {
    let values = || panel.curves.iter().flat_map(|c| c.points.iter().map(|p| p.1));
    let (least, most) = (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
    let (least, most) = if least <= most { (least, most) } else { (0.0, 1.0) };
    let step = tick_step(most - least);
    let (low, high) =
        ((least / step).floor() * step, ((most / step).ceil() * step).max((least / step).floor() * step + step));
    let y = |value: f64| top + PANEL - PANEL * (value - low) / (high - low);
    let decimals = if step < 1.0 { 1 } else { 0 };
    let count = ((high - low) / step).round() as i64;
    let ticks: Vec<Value> = (0..=count)
        .map(|i| low + i as f64 * step)
        .map(|v| context! { y => coordinate(y(v)), label => format!("{:.decimals$}", v + 0.0).replace('-', "−") })
        .collect();
    let mut at = LEFT + 6.0;
    let curves: Vec<Value> = panel
        .curves
        .iter()
        .map(|c| {
            let mut path = String::new();
            let mut move_to = "M";
            for (hour, value) in &c.points {
                if value.is_nan() {
                    move_to = "M";
                    continue;
                }
                let _ = write!(path, "{move_to}{} {}", coordinate(x(*hour)), coordinate(y(*value)));
                move_to = " ";
            }
            let place = at;
            if !c.name.is_empty() {
                at += 44.0 + 6.6 * c.name.chars().count() as f64;
            }
            context! {
                path, colour => c.colour, dash => c.dash, width => c.width, name => &c.name,
                x1 => coordinate(place), x2 => coordinate(place + 24.0), xt => coordinate(place + 29.0),
            }
        })
        .collect();
    context! { label => &panel.label, top, low => top + PANEL, middle => top + 0.5 * PANEL, legend => top - 7.0, ticks, curves }
}

/// A step of 1, 2 or 5 times a power of ten that gives two to five ticks.
pub(super) fn tick_step(range: f64) -> f64 {
    let rough = (range / 3.0).max(1e-3);
    let power = 10_f64.powf(rough.log10().floor());
    let mantissa = rough / power;
    power
        * if mantissa < 1.5 {
            1.0
        } else if mantissa < 3.5 {
            2.0
        } else if mantissa < 7.5 {
            5.0
        } else {
            10.0
        }
}

/// Two decimals, so that a platform's arithmetic cannot change bytes.
pub(super) fn coordinate(value: f64) -> String {
    format!("{value:.2}")
}
