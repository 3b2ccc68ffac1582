//! The heat-flow diagram of one operation: reservoirs as boxes, flows as arrows.

use cabin::{HeatFlows, Temperatures, celsius};
use minijinja::{AutoEscape, Environment, Value, context};

use crate::ReportError;

const TEMPLATE: &str = include_str!("../../templates/heat_flow.svg");

/// What the diagram shows.
#[derive(Debug, Clone, PartialEq)]
pub struct HeatFlowFigure {
    /// First line.
    pub title: String,
    /// Second line.
    pub description: String,
    /// Ambient temperature in K.
    pub ambient_k: f64,
    /// Temperatures of the reservoirs.
    pub temperatures: Temperatures,
    /// Every flow.
    pub flows: HeatFlows,
    /// Electric power of the air unit in W.
    pub air_unit_power_w: f64,
}

/// Where a box stands, and its size.
#[derive(Clone, Copy)]
struct Place {
    x: f64,
    y: f64,
    w: f64,
    h: f64,
}

const AMBIENT: Place = Place { x: 20.0, y: 250.0, w: 110.0, h: 60.0 };
const OUTSIDE: Place = Place { x: 235.0, y: 250.0, w: 110.0, h: 60.0 };
const INSIDE: Place = Place { x: 440.0, y: 250.0, w: 110.0, h: 60.0 };
const CABIN: Place = Place { x: 640.0, y: 250.0, w: 110.0, h: 60.0 };
const HEATERS: Place = Place { x: 540.0, y: 90.0, w: 120.0, h: 60.0 };
const INTERIOR: Place = Place { x: 540.0, y: 410.0, w: 120.0, h: 60.0 };
const AIR_UNIT: Place = Place { x: 830.0, y: 90.0, w: 110.0, h: 60.0 };
const PASSENGERS: Place = Place { x: 830.0, y: 200.0, w: 110.0, h: 44.0 };
const OTHER: Place = Place { x: 830.0, y: 290.0, w: 110.0, h: 44.0 };
const DOORS: Place = Place { x: 830.0, y: 410.0, w: 110.0, h: 60.0 };
const SUN: Place = Place { x: 235.0, y: 410.0, w: 110.0, h: 60.0 };
const GRID: Place = Place { x: 235.0, y: 90.0, w: 110.0, h: 60.0 };

impl Place {
    /// A point of the box: −1 … 1 from left to right and from top to bottom.
    fn at(self, across: f64, down: f64) -> (f64, f64) {
        (self.x + 0.5 * self.w * (1.0 + across), self.y + 0.5 * self.h * (1.0 + down))
    }
}

/// The diagram as SVG.
///
/// # Errors
/// [`ReportError::Template`] where template and data do not fit; not for any operation.
pub fn heat_flow_svg(figure: &HeatFlowFigure) -> Result<String, ReportError> {
    let (t, f) = (&figure.temperatures, &figure.flows);
    let degrees = |k: f64| format!("{:.1} °C", celsius(k));
    let kw = |w: f64| format!("{:.2} kW", w / 1e3);
    let shape = |p: Place, name: &str, value: String, fill: &str| {
        let (cx, _) = p.at(0.0, 0.0);
        let cy = p.y + 0.5 * p.h + if value.is_empty() { 5.0 } else { -4.0 };
        context! { x => p.x, y => p.y, w => p.w, h => p.h, cx, cy, name, value, fill }
    };
    let boxes = vec![
        shape(AMBIENT, "ambient", degrees(figure.ambient_k), "#e8eef4"),
        shape(OUTSIDE, "shell outside", degrees(t.shell_outside_k), "#dddddd"),
        shape(INSIDE, "shell inside", degrees(t.shell_inside_k), "#dddddd"),
        shape(CABIN, "cabin air", degrees(t.cabin_k), "#dddddd"),
        shape(HEATERS, "radiant heaters", degrees(t.radiant_heater_k), "#dddddd"),
        shape(INTERIOR, "interior", degrees(t.interior_k), "#dddddd"),
        shape(AIR_UNIT, "air unit", kw(figure.air_unit_power_w), "#f3ecd9"),
        shape(PASSENGERS, "passengers", String::new(), "#f3ecd9"),
        shape(OTHER, "electronics", String::new(), "#f3ecd9"),
        shape(DOORS, "doors", degrees(figure.ambient_k), "#e8eef4"),
        shape(SUN, "sun", kw(f.solar.interior_w + f.solar.shell_inside_w + f.solar.shell_outside_w), "#fbf3c4"),
        shape(GRID, "heater power", kw(f.radiant_heater_power_w), "#f3ecd9"),
    ];
    let solid = |w, from, to| arrow(w, from, to, "", MIDDLE);
    let radiation = |w, from, to| arrow(w, from, to, "8 4", MIDDLE);
    let arrows: Vec<Value> = vec![
        solid(f.convection_shell_outside_w, OUTSIDE.at(-1.0, -0.5), AMBIENT.at(1.0, -0.5)),
        radiation(f.radiation_shell_outside_w, OUTSIDE.at(-1.0, 0.5), AMBIENT.at(1.0, 0.5)),
        solid(f.conduction_shell_w, INSIDE.at(-1.0, 0.0), OUTSIDE.at(1.0, 0.0)),
        solid(f.convection_shell_inside_w, CABIN.at(-1.0, 0.0), INSIDE.at(1.0, 0.0)),
        solid(f.convection_interior_w, INTERIOR.at(0.6, -1.0), CABIN.at(-0.4, 1.0)),
        radiation(f.radiation_interior_shell_w, INTERIOR.at(-0.7, -1.0), INSIDE.at(0.4, 1.0)),
        solid(f.convection_radiant_heater_w, HEATERS.at(0.6, 1.0), CABIN.at(-0.4, -1.0)),
        radiation(f.radiation_heater_shell_w, HEATERS.at(-0.7, 1.0), INSIDE.at(0.4, -1.0)),
        // Its middle lies on the arrow from cabin to shell.
        arrow(f.radiation_heater_interior_w, HEATERS.at(0.0, 1.0), INTERIOR.at(0.0, -1.0), "8 4", 0.17),
        solid(f.air_unit_w, AIR_UNIT.at(-0.6, 1.0), CABIN.at(0.7, -1.0)),
        solid(f.passengers_w, PASSENGERS.at(-1.0, 0.0), CABIN.at(1.0, -0.5)),
        solid(f.other_w, OTHER.at(-1.0, 0.0), CABIN.at(1.0, 0.5)),
        solid(f.door_w, CABIN.at(0.7, 1.0), DOORS.at(-0.6, -1.0)),
        radiation(f.solar.shell_outside_w, SUN.at(0.0, -1.0), OUTSIDE.at(0.0, 1.0)),
        radiation(f.solar.shell_inside_w, SUN.at(0.8, -1.0), INSIDE.at(-0.6, 1.0)),
        radiation(f.solar.interior_w, SUN.at(1.0, 0.0), INTERIOR.at(-1.0, 0.0)),
        arrow(f.radiant_heater_power_w, GRID.at(1.0, 0.0), HEATERS.at(-1.0, 0.0), "2 4", MIDDLE),
    ]
    .into_iter()
    .flatten()
    .collect();
    let mut environment = Environment::new();
    environment.set_auto_escape_callback(|_| AutoEscape::Html);
    environment.add_template("heat_flow.svg", TEMPLATE)?;
    let content = context! { title => &figure.title, description => &figure.description, boxes, arrows };
    Ok(environment.get_template("heat_flow.svg")?.render(content)?)
}

/// Where labels stand along their arrows.
const MIDDLE: f64 = 0.45;

/// An arrow in the direction in which the heat flows; none for less than half a hundredth of a kilowatt. Its label stands
/// at a share of the way.
fn arrow(watt: f64, from: (f64, f64), to: (f64, f64), dash: &str, share: f64) -> Option<Value> {
    let kw = watt / 1e3;
    if kw.abs() < 0.005 {
        return None;
    }
    let ((x1, y1), (x2, y2)) = if kw < 0.0 { (to, from) } else { (from, to) };
    let round = |v: f64| format!("{v:.1}");
    let colour = "#333";
    Some(context! {
        x1 => round(x1), y1 => round(y1), x2 => round(x2), y2 => round(y2), colour, dash,
        width => format!("{:.2}", 1.0 + 0.45 * kw.abs().min(12.0)),
        xm => round(from.0 + share * (to.0 - from.0)), ym => round(from.1 + share * (to.1 - from.1) + 5.0),
        label => format!("{:.2}", kw.abs()),
    })
}
