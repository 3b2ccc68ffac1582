//! Annual power over the comfort that is asked for (paper, figure `pareto-fronts-thermal`).

use crate::StudyReport;
use crate::document::{Block, Section, Span};
use crate::figure::palette::{Style, of_designs};
use crate::figure::{Axis, Chart, Mark, Panel, Side};
use crate::words::{capital, equipment};

const FILE: &str = "pareto";
/// Of the axis: lines that are nowhere farther apart lie on each other.
const APART: f64 = 0.006;

/// A design's line.
struct Front {
    name: String,
    style: Style,
    /// Limit of |PMV| and annual power in kW, in the order of the line.
    points: Vec<(f64, f64)>,
    /// The ends of its interval.
    band: Vec<(f64, [f64; 2])>,
}

/// The section with its figure. Symmetric windows only; unequal ones have no place on the axis.
pub(super) fn with_fronts(mut section: Section, study: &StudyReport) -> Section {
    let unequal = study.windows().into_iter().filter(|w| !w.is_symmetric()).count();
    let windows = if unequal == 1 { "window is" } else { "windows are" };
    let note = (unequal > 0).then(|| format!("{unequal} unequal comfort {windows} in the tables only."));
    let fronts = fronts(study);
    if fronts.iter().any(|f| !f.points.is_empty()) {
        section = section.with_chart(FILE, "Pareto fronts", chart(&fronts));
    } else {
        section = section.with(Block::words("No symmetric comfort window is solved: there is no front to show."));
    }
    section.with(note.map(|note| Block::Paragraph(vec![Span::Value(note)])))
}

fn fronts(study: &StudyReport) -> Vec<Front> {
    let names = study.design_names();
    let front = |(name, style): (&&'_ str, Style)| {
        let mut rows: Vec<_> = study.annual.iter().filter(|r| r.design == **name && r.window.is_symmetric()).collect();
        rows.sort_by(|a, b| a.window.pmv_limit().total_cmp(&b.window.pmv_limit()));
        let points = rows.iter().filter_map(|r| Some((r.window.pmv_limit(), r.hvac_power_w? / 1e3))).collect();
        let band = rows.iter().filter_map(|r| {
            let ends = study.annual_ends(&r.design, r.window)?;
            Some((r.window.pmv_limit(), ends.map(|end| end / 1e3)))
        });
        Front { name: (**name).to_owned(), style, points, band: band.collect() }
    };
    names.iter().zip(of_designs(&names)).map(front).collect()
}

/// Of all designs by what they are, without names on the lines.
pub(super) fn in_words(study: &StudyReport) -> Option<Chart> {
    let mut fronts = fronts(study);
    fronts.iter_mut().for_each(|front| front.name = capital(&equipment(&study.designs, &front.name)));
    let mut chart = chart(&fronts);
    chart.title = "What comfort costs".to_owned();
    chart.told =
        "Electricity for heating and cooling, over how far the mean vote of the passengers may be from neutral."
            .to_owned();
    if fronts.iter().any(|f| !f.band.is_empty()) {
        chart.told += " Pale: its range.";
    }
    let panel = chart.panels.first_mut()?;
    panel.x.label = "mean vote at most this far from neutral".to_owned();
    panel.y.label = "kWh for every hour in service".to_owned();
    panel.marks.retain(|mark| !matches!(mark, Mark::Label { .. }));
    fronts.iter().any(|f| f.points.len() > 1).then_some(chart)
}

fn chart(fronts: &[Front]) -> Chart {
    let most = fronts.iter().flat_map(|f| &f.points).map(|p| p.1).fold(0.0, f64::max);
    // A line that another one lies on is drawn broad beneath it.
    let hidden = |i: usize| fronts[i + 1..].iter().any(|other| is_same(&fronts[i], other, APART * most));
    let mut marks: Vec<Mark> =
        fronts.iter().map(|f| Mark::Band { name: f.name.clone(), style: f.style, points: f.band.clone() }).collect();
    for (i, front) in fronts.iter().enumerate().filter(|(_, f)| !f.points.is_empty()) {
        let broad = Style { width: 3.4, dash: "", marker: None, ..front.style };
        let style = if hidden(i) { broad } else { front.style };
        marks.push(Mark::line(&front.name, style, front.points.clone()));
    }
    marks.extend((0..fronts.len()).filter_map(|i| label(fronts, i, APART * most)));
    let banded = fronts.iter().any(|f| !f.band.is_empty());
    Chart {
        title: "What comfort costs in a year".to_owned(),
        told: if banded {
            "Annual mean HVAC power over the limit of the predicted mean vote; bands: 90 % intervals.".to_owned()
        } else {
            "Annual mean HVAC power over the limit of the predicted mean vote.".to_owned()
        },
        columns: 1,
        panels: vec![Panel {
            x: Axis::new("limit of |PMV|").from(0.0),
            y: Axis::new("annual mean HVAC power in kW").from(0.0),
            marks,
            ..Panel::default()
        }],
        height: 150.0,
    }
}

fn is_same(a: &Front, b: &Front, apart: f64) -> bool {
    let same = |(a, b): (&(f64, f64), &(f64, f64))| a.0 == b.0 && (a.1 - b.1).abs() <= apart;
    !a.points.is_empty() && a.points.len() == b.points.len() && a.points.iter().zip(&b.points).all(same)
}

/// The name of a line, on the side where the next line is farther away; lines on each other have one place for their names.
fn label(fronts: &[Front], i: usize, apart: f64) -> Option<Mark> {
    let front = &fronts[i];
    if fronts[..i].iter().any(|other| is_same(other, front, apart)) {
        return None;
    }
    let same = fronts[i..].iter().filter(|other| is_same(front, other, apart));
    let of: Vec<String> = same.map(|other| other.name.clone()).collect();
    let gap = |at: (f64, f64), sign: f64| {
        let others = fronts.iter().filter(|other| !is_same(front, other, apart)).flat_map(|f| &f.points);
        let gaps = others.filter(|p| p.0 == at.0).map(|p| sign * (p.1 - at.1));
        gaps.filter(|gap| *gap > 0.0).fold(f64::INFINITY, f64::min)
    };
    let (early, late) = (front.points.get(1).or(front.points.first())?, front.points.get(front.points.len() / 4)?);
    let (at, side) = if gap(*early, 1.0) >= gap(*late, -1.0) { (*early, Side::Above) } else { (*late, Side::Below) };
    Some(Mark::Label { at, name: of.join(", "), of, colour: front.style.colour, side })
}
