//! What the model is made of (paper, figures `model-parameters` and `model-approximations`): coefficients of performance with their
//! data, clothing, the vote, and what the paper's approximations of them do.

use cabin::{Cop, PmvModel, Vehicle, clothing_insulation_clo, kelvin, named_cooling_cops, named_heating_cops};
use solve::nlp::Surrogate;
use store::DesignRow;

use crate::StudyReport;
use crate::document::{Block, Section};
use crate::figure::palette::{COOLING, DASHED, DOTTED, FROM_COLD_TO_WARM, HEATING, LIMIT, Marker, Style};
use crate::figure::{Axis, Chart, Mark, Panel, Side};
use crate::numbers::signed;

/// Lifts that are shown, in K.
const LIFTS_K: [f64; 2] = [0.0, 40.0];
/// Ambient temperature of the paper's figure of the vote's approximation, in °C.
const APPROXIMATION_AT_C: f64 = 10.0;
/// The constant under the paper's smooth root, in K² (eq. sqrt-of-abs-approx).
const SMOOTH_K2: f64 = 0.01;

pub(super) fn section(study: &StudyReport) -> Option<Section> {
    if study.designs.is_empty() {
        return None;
    }
    let mut section = Section::new("What the model is made of")
        .asking("Which curves of equipment, clothing and comfort do all numbers rest on?");
    for (file, caption, chart) in [
        ("model_parameters", "Coefficients of performance, clothing and vote", parameters(study)),
        ("model_approximations", "The paper's approximations", approximations(&study.vehicle)),
    ] {
        section = section.with_chart(file, caption, chart);
    }
    Some(
        section
            .with(Block::means(
                "A heat pump gives the more heat for its power the smaller the lift is from outside to inside: mild hours are cheap, cold ones\n\
                 doubly dear. Clothing lets the neutral temperature fall in winter.",
            ))
            .with(Block::limits("Curves that are substitutes for unpublished ones are named under Assumptions.")),
    )
}

fn line(name: impl Into<String>, style: Style, points: impl Iterator<Item = (f64, f64)>) -> Mark {
    Mark::line(name, style, points.collect())
}

fn between([from, to]: [f64; 2], count: u32) -> impl Iterator<Item = f64> + Clone {
    (0..=count).map(move |i| from + (to - from) * f64::from(i) / f64::from(count))
}

fn parameters(study: &StudyReport) -> Chart {
    let mut marks = curves(study, "heating", HEATING, |d| &d.heating_cop, &named_heating_cops());
    marks.extend(curves(study, "cooling", COOLING, |d| &d.cooling_cop, &named_cooling_cops()));
    let vehicle = &study.vehicle;
    let clothing =
        between([-20.0, 40.0], 120).map(|t| (t, clothing_insulation_clo(kelvin(t), vehicle.clothing_floor_clo)));
    Chart {
        title: "Coefficients of performance, clothing and vote".to_owned(),
        told: "Curves of the study with the data that they are fitted to; clothing by ambient temperature; where passengers vote \
               −1, 0 and +1 at three ambient temperatures."
            .to_owned(),
        columns: 1,
        panels: vec![
            Panel {
                x: Axis::new("lift in K").from(LIFTS_K[0]).to(LIFTS_K[1]),
                y: Axis::new("COP").from(0.0),
                marks,
                ..Panel::default()
            },
            Panel {
                x: Axis::new("ambient temperature in °C"),
                y: Axis::new("clothing in clo").from(0.0),
                marks: vec![line("", Style::line(LIMIT, "", 1.1), clothing)],
                ..Panel::default()
            },
            Panel {
                x: Axis::new("cabin temperature in °C").from(5.0).to(35.0),
                y: Axis::new("mean radiant temp. in °C").from(0.0).to(50.0),
                marks: votes(vehicle),
                ..Panel::default()
            },
        ],
        height: 88.0,
    }
}

/// Every curve of the designs once, with its data where they are known.
fn curves(
    study: &StudyReport,
    side: &str,
    colour: &'static str,
    of: fn(&DesignRow) -> &String,
    known: &[(&'static str, Cop, &'static str)],
) -> Vec<Mark> {
    let find = |name: &str| known.iter().find(|(n, ..)| *n == name).map(|(_, cop, _)| cop);
    let mut names: Vec<&str> = Vec::new();
    for design in &study.designs {
        if !names.contains(&of(design).as_str()) {
            names.push(of(design));
        }
    }
    let mut marks = Vec::new();
    // In grey both colours are alike.
    let dashes = if colour == HEATING { ["", DASHED, DOTTED] } else { ["6 2 1.5 2", "5 1.5", "2 2"] };
    let shown = names.into_iter().filter_map(|name| Some((name, find(name)?)));
    for (i, (name, cop)) in shown.enumerate() {
        let data = match find(&format!("{name}-rows")) {
            Some(Cop::Table(rows)) => rows.as_slice(),
            _ => &[],
        };
        let label = match r_squared(cop, data) {
            Some(r2) => format!("{side} {name}, R² {r2:.3}"),
            None => format!("{side} {name}"),
        };
        let style = Style::line(colour, dashes[i % dashes.len()], 1.1);
        marks.push(line(label, style, between(LIFTS_K, 160).map(|lift| (lift, cop.at(lift)))));
        let marker = if colour == HEATING { Marker::Circle } else { Marker::OpenSquare };
        let points = data.iter().copied().filter(|(lift, _)| (LIFTS_K[0]..=LIFTS_K[1]).contains(lift));
        marks.push(line(String::new(), Style { width: 0.0, marker: Some(marker), ..style }, points));
    }
    marks
}

/// Share of the data's variance that a curve explains.
fn r_squared(cop: &Cop, data: &[(f64, f64)]) -> Option<f64> {
    let mean = data.iter().map(|d| d.1).sum::<f64>() / data.len() as f64;
    let all: f64 = data.iter().map(|d| (d.1 - mean).powi(2)).sum();
    let left: f64 = data.iter().map(|(lift, value)| (value - cop.at(*lift)).powi(2)).sum();
    (data.len() > 2 && all > 0.0).then(|| 1.0 - left / all)
}

fn vote_model(vehicle: &Vehicle, ambient_c: f64) -> PmvModel {
    let clo = clothing_insulation_clo(kelvin(ambient_c), vehicle.clothing_floor_clo);
    PmvModel::new(clo, vehicle.metabolic_rate_met, vehicle.relative_humidity, vehicle.air_velocity_m_s)
}

/// Lines of equal vote. The vote rises with the mean radiant temperature: halving finds it.
fn votes(vehicle: &Vehicle) -> Vec<Mark> {
    let mut marks = Vec::new();
    for (i, (ambient_c, style)) in [-10.0, 10.0, 30.0].into_iter().zip(FROM_COLD_TO_WARM).enumerate() {
        let model = vote_model(vehicle, ambient_c);
        for vote in [-1.0, 0.0, 1.0] {
            let radiant = |air_c: f64| {
                let (mut low, mut high) = (-20.0, 80.0);
                for _ in 0..40 {
                    let middle = (low + high) / 2.0;
                    if model.at(air_c, middle).pmv < vote { low = middle } else { high = middle }
                }
                low
            };
            let on = between([5.0, 35.0], 90).map(|air_c| (air_c, radiant(air_c)));
            let points: Vec<(f64, f64)> = on.filter(|(_, r)| (0.0..=50.0).contains(r)).collect();
            // Each temperature has its labels where the others have none.
            let place = points.len() * (i + 1) / 4;
            let Some(&at) = points.get(place) else { continue };
            let series = format!("PMV at {} °C ambient", signed(ambient_c, 0));
            let what = if vote < 0.0 {
                ""
            } else if vote > 0.0 {
                "+1"
            } else {
                "0"
            };
            marks.push(Mark::Line { name: series.clone(), what, style, points });
            let (name, of) = (signed(vote, 0), vec![series]);
            marks.push(Mark::Label { at, name, of, colour: style.colour, side: Side::Above });
        }
    }
    marks
}

/// The surrogate is the one of the paper's bus; another bus has another one, which is not drawn.
fn approximations(vehicle: &Vehicle) -> Chart {
    let exact = between([-5.0, 5.0], 200).map(|k: f64| (k, k.abs().sqrt()));
    let smooth = between([-5.0, 5.0], 200).map(|k: f64| (k, (k * k + SMOOTH_K2).powf(0.25)));
    let mut panels = vec![Panel {
        title: "root of a temperature difference".to_owned(),
        x: Axis::new("cabin less ambient temperature in K"),
        y: Axis::new("root in √K").from(0.0),
        marks: vec![
            line("exact", Style::line(COOLING, "", 1.1), exact),
            line("smooth", Style::line(HEATING, DASHED, 1.1), smooth),
        ],
    }];
    if *vehicle == Vehicle::default() {
        let (surrogate, model) = (Surrogate::stored(), vote_model(vehicle, APPROXIMATION_AT_C));
        let clo = clothing_insulation_clo(kelvin(APPROXIMATION_AT_C), vehicle.clothing_floor_clo);
        let of = |(radiant_c, style): (f64, Style)| {
            let error = |air_c: f64| (air_c, model.at(air_c, radiant_c).pmv - surrogate.vote(clo, air_c, radiant_c));
            let name = format!("radiant {radiant_c:.0} °C");
            line(name, style, between([5.0, 35.0], 240).map(error))
        };
        panels.push(Panel {
            title: "PMV less that of the paper's network, at 10 °C ambient".to_owned(),
            x: Axis::new("cabin temperature in °C"),
            y: Axis::new("error of PMV"),
            marks: [10.0, 20.0, 30.0].into_iter().zip(FROM_COLD_TO_WARM).map(of).collect(),
        });
    }
    Chart {
        title: "The paper's approximations".to_owned(),
        told: "Of the nonlinear programs only: the fast method uses the exact root and the exact vote.".to_owned(),
        columns: 1,
        panels,
        height: 88.0,
    }
}
