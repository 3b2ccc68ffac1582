//! The heat flows of one operation (paper, figures `single-scenario`): reservoirs as boxes in the colour of their temperature, flows
//! as arrows as broad as they are strong.

use cabin::{HeatFlows, Temperatures, celsius};

use super::canvas::{Anchor, Canvas, Drawing, Form, INK, Pen, Word, path, rectangle};
use super::palette::{IN_TIME, STEADY, SUN};
use crate::ReportError;

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

/// Middle of a box, from the upper end of the diagram; half its width and height.
#[derive(Clone, Copy)]
struct Place(f64, f64);
const HALF: (f64, f64) = (21.5, 13.0);

const HEATERS: Place = Place(88.0, 18.0);
const INTERIOR: Place = Place(88.0, 92.0);
const CABIN: Place = Place(88.0, 166.0);
const INSIDE: Place = Place(152.0, 92.0);
const OUTSIDE: Place = Place(215.0, 92.0);
const AMBIENT: Place = Place(215.0, 166.0);
const SUN_AT: Place = Place(184.0, 18.0);
const HEIGHT: f64 = 190.0;
/// Where the arrows of what comes from no reservoir begin.
const LEFT: f64 = 30.0;

/// What carries a flow.
#[derive(Clone, Copy, PartialEq)]
enum Carrier {
    /// Convection, conduction, air: full arrows.
    Matter,
    /// Radiation: open arrows.
    Radiation,
    /// The sun: open arrows of its colour.
    Sun,
    /// Electric power: dark arrows.
    Electricity,
}

impl Place {
    /// A point of the box: −1 … 1 from left to right and from top to bottom.
    fn at(self, across: f64, down: f64) -> (f64, f64) {
        (self.0 + HALF.0 * across, self.1 + HALF.1 * down)
    }
}

/// A flow in W from one point to another, with the share of the way at which its label stands.
struct Flow {
    watt: f64,
    from: (f64, f64),
    to: (f64, f64),
    carrier: Carrier,
    share: f64,
}

/// The diagram as SVG.
///
/// # Errors
/// [`ReportError::Template`] where template and data do not fit; not for any operation.
pub fn heat_flow_svg(figure: &HeatFlowFigure) -> Result<String, ReportError> {
    drawn(figure).svg(Form::File)
}

/// The diagram.
pub(crate) fn drawn(figure: &HeatFlowFigure) -> Drawing {
    let (t, f) = (&figure.temperatures, &figure.flows);
    let mut canvas = Canvas::default();
    let top = canvas.heading(&figure.title, &figure.description) + 6.0;
    let flows = flows(f);
    let strongest = flows.iter().map(|flow| flow.watt.abs()).fold(4e3, f64::max);
    for flow in &flows {
        arrow(&mut canvas, flow, strongest, top);
    }
    let mut reservoir = |Place(x, y): Place, name: &str, kelvin: f64| {
        let (x0, y0) = (x - HALF.0, top + y - HALF.1);
        let edge = Pen { colour: INK, width: 0.6, dash: "" };
        canvas.edged(&rectangle((x0, y0), (x0 + 2.0 * HALF.0, y0 + 2.0 * HALF.1)), warmth(celsius(kelvin)), edge);
        canvas.text((x, top + y - 2.0), name, Anchor::Middle);
        let degrees = format!("{:.1} °C", celsius(kelvin) + 0.0).replace('-', "−");
        canvas.word((x, top + y + 8.0), &degrees, Anchor::Middle, Word { bold: true, ..Word::default() });
    };
    reservoir(HEATERS, "heaters", t.radiant_heater_k);
    reservoir(INTERIOR, "interior", t.interior_k);
    reservoir(CABIN, "cabin air", t.cabin_k);
    reservoir(INSIDE, "shell in", t.shell_inside_k);
    reservoir(OUTSIDE, "shell out", t.shell_outside_k);
    reservoir(AMBIENT, "ambient", figure.ambient_k);
    let solar_w = f.solar.interior_w + f.solar.shell_inside_w + f.solar.shell_outside_w;
    if solar_w >= LEAST_W {
        canvas.word((SUN_AT.0, top + SUN_AT.1 - 6.0), "sun", Anchor::Middle, Word { bold: true, ..Word::default() });
    }
    for (y, name, watt) in [
        (CABIN.1 - 16.0, "passengers", f.passengers_w),
        (CABIN.1 + 0.0, "electronics", f.other_w),
        (CABIN.1 + 16.0, "air unit", f.air_unit_w),
        (HEATERS.1, "power", f.radiant_heater_power_w),
    ] {
        if watt.abs() >= LEAST_W {
            canvas.text((2.0, top + y - 4.5), name, Anchor::Start);
        }
    }
    for flow in &flows {
        label(&mut canvas, flow, top);
    }
    let power = format!(
        "kW, in the direction of the arrow. Full: convection, conduction, air; open: radiation; blue: electric power. \
         The air unit draws {:.2} kW.",
        figure.air_unit_power_w / 1e3 + 0.0
    );
    let y = canvas.remark(top + HEIGHT + 3.0, &power);
    canvas.finished(y + 5.0, &figure.title, &figure.description)
}

/// What the diagram shows: what it is, how much, and of what unit.
pub(crate) fn values(figure: &HeatFlowFigure) -> Vec<(&'static str, f64, &'static str)> {
    let (t, f) = (&figure.temperatures, &figure.flows);
    let degrees = [
        ("radiant heaters", t.radiant_heater_k),
        ("interior", t.interior_k),
        ("cabin air", t.cabin_k),
        ("shell inside", t.shell_inside_k),
        ("shell outside", t.shell_outside_k),
        ("ambient", figure.ambient_k),
    ];
    let flows = f.named_w().map(|(_, what, watt)| (what, watt));
    let watts = flows.into_iter().chain([("electric power of the air unit", figure.air_unit_power_w)]);
    let degrees = degrees.map(|(what, kelvin)| (what, celsius(kelvin), "°C"));
    degrees.into_iter().chain(watts.map(|(what, watt)| (what, watt, "W"))).collect()
}

/// Flows below half a hundredth of a kilowatt are not drawn.
const LEAST_W: f64 = 5.0;

fn flows(f: &HeatFlows) -> Vec<Flow> {
    use Carrier::{Electricity, Matter, Radiation, Sun};
    let flow = |watt, from, to, carrier, share| Flow { watt, from, to, carrier, share };
    let left = |y: f64| (LEFT, y);
    vec![
        flow(f.convection_shell_outside_w, OUTSIDE.at(-0.45, 1.0), AMBIENT.at(-0.45, -1.0), Matter, 0.35),
        flow(f.radiation_shell_outside_w, OUTSIDE.at(0.55, 1.0), AMBIENT.at(0.55, -1.0), Radiation, 0.65),
        flow(f.conduction_shell_w, INSIDE.at(1.0, 0.3), OUTSIDE.at(-1.0, 0.3), Matter, 0.5),
        flow(f.convection_shell_inside_w, CABIN.at(1.0, -0.5), INSIDE.at(-0.2, 1.0), Matter, 0.5),
        flow(f.convection_interior_w, INTERIOR.at(0.1, 1.0), CABIN.at(0.1, -1.0), Matter, 0.5),
        flow(f.radiation_interior_shell_w, INTERIOR.at(1.0, 0.2), INSIDE.at(-1.0, 0.2), Radiation, 0.5),
        flow(f.convection_radiant_heater_w, HEATERS.at(-0.8, 1.0), CABIN.at(-0.8, -1.0), Matter, 0.2),
        flow(f.radiation_heater_shell_w, HEATERS.at(1.0, 0.6), INSIDE.at(-0.7, -1.0), Radiation, 0.5),
        flow(f.radiation_heater_interior_w, HEATERS.at(0.2, 1.0), INTERIOR.at(0.2, -1.0), Radiation, 0.35),
        flow(f.air_unit_w, left(CABIN.1 + 16.0), (CABIN.0 - HALF.0, CABIN.1 + 10.0), Matter, 0.45),
        flow(f.passengers_w, left(CABIN.1 - 16.0), (CABIN.0 - HALF.0, CABIN.1 - 10.0), Matter, 0.45),
        flow(f.other_w, left(CABIN.1), (CABIN.0 - HALF.0, CABIN.1), Matter, 0.45),
        flow(f.door_w, CABIN.at(1.0, 0.5), AMBIENT.at(-1.0, 0.5), Matter, 0.5),
        flow(f.solar.shell_outside_w, (SUN_AT.0 + 8.0, SUN_AT.1), OUTSIDE.at(0.0, -1.0), Sun, 0.55),
        flow(f.solar.shell_inside_w, (SUN_AT.0 - 6.0, SUN_AT.1), INSIDE.at(0.4, -1.0), Sun, 0.6),
        flow(f.solar.interior_w, (SUN_AT.0 - 14.0, SUN_AT.1 - 4.0), INTERIOR.at(0.85, -1.0), Sun, 0.45),
        flow(f.radiant_heater_power_w, left(HEATERS.1), HEATERS.at(-1.0, 0.0), Electricity, 0.45),
    ]
}

/// An arrow as one area, in the direction in which the heat flows.
fn arrow(canvas: &mut Canvas, flow: &Flow, strongest: f64, top: f64) {
    if flow.watt.abs() < LEAST_W {
        return;
    }
    let ((x0, y0), (x1, y1)) = if flow.watt < 0.0 { (flow.to, flow.from) } else { (flow.from, flow.to) };
    let length = (x1 - x0).hypot(y1 - y0);
    let (along, across) = (((x1 - x0) / length, (y1 - y0) / length), ((y0 - y1) / length, (x1 - x0) / length));
    let half = 0.4 + 3.6 * flow.watt.abs() / strongest;
    let head = (half + 2.2, (1.3 * half + 3.0).min(0.6 * length));
    let point =
        |way: f64, aside: f64| (x0 + along.0 * way + across.0 * aside, top + y0 + along.1 * way + across.1 * aside);
    let neck = length - head.1;
    let points = [
        point(0.0, half),
        point(neck, half),
        point(neck, head.0),
        point(length, 0.0),
        point(neck, -head.0),
        point(neck, -half),
        point(0.0, -half),
    ];
    let d = format!("{}Z", path(points.into_iter()));
    match flow.carrier {
        Carrier::Matter => canvas.area(&d, STEADY, 0.75),
        Carrier::Electricity => canvas.area(&d, IN_TIME, 1.0),
        Carrier::Radiation => canvas.edged(&d, "#ffffff", Pen { colour: STEADY, width: 0.8, dash: "" }),
        Carrier::Sun => canvas.edged(&d, "#fff4cc", Pen { colour: SUN, width: 0.8, dash: "" }),
    }
}

fn label(canvas: &mut Canvas, flow: &Flow, top: f64) {
    if flow.watt.abs() >= LEAST_W {
        let (x, y) = (
            flow.from.0 + flow.share * (flow.to.0 - flow.from.0),
            top + flow.from.1 + flow.share * (flow.to.1 - flow.from.1) + 2.6,
        );
        // On a short level arrow there is no room; its label stands above it.
        let is_short = (flow.to.0 - flow.from.0).abs() < 24.0 && (flow.to.1 - flow.from.1).abs() < 1.0;
        let y = if is_short { y - 8.0 } else { y };
        let text = format!("{:.2}", flow.watt.abs() / 1e3);
        canvas.word((x, y), &text, Anchor::Middle, Word { halo: true, ..Word::default() });
    }
}

/// Fills from cold to warm, in steps of 5 K: pale, so that what is written on them stays readable in grey.
fn warmth(celsius: f64) -> &'static str {
    const STEPS: [&str; 9] =
        ["#9ecae9", "#b8d8f0", "#d0e4f5", "#e6f0f8", "#f7f3ee", "#fbe3d2", "#f9cfb2", "#f5b58e", "#f0996b"];
    let step = ((celsius + 2.5) / 5.0).floor().clamp(0.0, 8.0);
    STEPS[step as usize]
}

#[cfg(test)]
mod tests {
    use super::super::canvas::coordinate;
    use super::*;

    #[test]
    fn prop_arrows_are_as_broad_as_they_are_strong() {
        let broad = |watt: f64| {
            let mut canvas = Canvas::default();
            let flow = Flow { watt, from: (0.0, 0.0), to: (100.0, 0.0), carrier: Carrier::Matter, share: 0.5 };
            arrow(&mut canvas, &flow, 14e3, 0.0);
            canvas.finished(10.0, "", "").svg(Form::File).unwrap()
        };
        for watt in [1e3, 7e3, 14e3] {
            let half = coordinate(0.4 + 3.6 * watt / 14e3);
            assert!(broad(watt).contains(&format!("M0 {half} ")), "{watt}");
        }
        // Heat that flows the other way begins at the other end.
        assert!(broad(-7e3).contains("M100 "));
    }
}
