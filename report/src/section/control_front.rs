//! Controllers beside each other: whether extracted profiles are better than other setpoints that take the same power, and how
//! figures show it.

use cabin::ComfortWindow;

use crate::StudyReport;
use crate::figure::palette::{BLACK, DASHED, LIMIT, Marker, Style};
use crate::figure::{Axis, Chart, Mark, Panel, Side};

/// A controller's line, or its point.
pub(super) struct Front {
    pub name: String,
    is_steady: bool,
    /// Discomfort and power in kW, in the order of the line.
    points: Vec<(f64, f64)>,
}

impl Front {
    pub fn new(name: &str, points: Vec<(f64, f64)>) -> Self {
        Self { name: name.to_owned(), is_steady: false, points }
    }

    /// What the optima come to, which no controller reaches.
    pub fn steady(points: Vec<(f64, f64)>) -> Self {
        Self { is_steady: true, ..Self::new("steady state", points) }
    }
}

/// Power over discomfort. Extracted profiles are black, the optima grey; all others have a look of their own.
pub(super) fn controllers_chart(title: &str, told: &str, [x, y]: [&str; 2], fronts: &[Front]) -> Chart {
    let mut next = 0;
    let mut style = |front: &Front| match front.name.as_str() {
        _ if front.is_steady => Style { colour: LIMIT, dash: DASHED, width: 1.0, marker: Some(Marker::Cross) },
        "extracted" => Style { colour: BLACK, dash: "", width: 1.1, marker: Some(Marker::OpenCircle) },
        _ => {
            next += 1;
            Style::of_place(next - 1)
        }
    };
    let mut line = |front: &Front| Mark::line(&front.name, style(front), front.points.clone());
    let all = || fronts.iter().flat_map(|front| &front.points).copied();
    let (wide, high) = all().fold((0.0, 0.0), |(w, h), (x, y)| (f64::max(w, x), f64::max(h, y)));
    let names = names(fronts, (0.01 * wide, 0.02 * high));
    // A single point has its name beside it, on the left where another one lies in its way, and beneath all points.
    let in_way = |(x, y): (f64, f64)| {
        let beside = |(other_x, other_y): (f64, f64)| {
            (0.001 * wide..0.25 * wide).contains(&(other_x - x)) && (other_y - y).abs() < 0.06 * high
        };
        names.iter().any(|(at, _)| beside(*at))
    };
    let label = |(at, of): &((f64, f64), Vec<String>)| {
        let side = if in_way(*at) { Side::Below } else { Side::Above };
        Mark::Label { at: *at, of: of.clone(), name: of.join(", "), colour: LIMIT, side }
    };
    Chart {
        title: title.to_owned(),
        told: told.to_owned(),
        columns: 1,
        panels: vec![Panel {
            x: Axis::new(x).from(0.0),
            y: Axis::new(y).from(0.0),
            marks: names.iter().map(label).chain(fronts.iter().map(&mut line)).collect(),
            ..Panel::default()
        }],
        height: 150.0,
    }
}

/// The names of single points, of those that lie within so much of each other together, at the first of them.
fn names(fronts: &[Front], (width, height): (f64, f64)) -> Vec<((f64, f64), Vec<String>)> {
    let mut names: Vec<((f64, f64), Vec<String>)> = Vec::new();
    for front in fronts {
        let [(x, y)] = front.points[..] else { continue };
        let here = |((other_x, other_y), _): &&mut ((f64, f64), Vec<String>)| {
            (*other_x - x).abs() <= width && (*other_y - y).abs() <= height
        };
        match names.iter_mut().find(here) {
            Some((_, names)) => names.push(front.name.clone()),
            None => names.push(((x, y), vec![front.name.clone()])),
        }
    }
    names
}

/// How a controller compares with extracted profiles of the same annual power.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Verdict {
    pub controller: String,
    pub mean_hvac_power_w: f64,
    /// Mean absolute vote.
    pub mean_vote: Coordinate,
    /// Share of the passenger-hours outside the window.
    pub outside: Coordinate,
}

/// A measure of discomfort, of the controller and of extracted profiles at its power; `None` where these do not reach it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Coordinate {
    pub own: Option<f64>,
    pub extracted: Option<f64>,
}

impl Coordinate {
    /// Whether extracted profiles leave less discomfort.
    pub fn is_beaten(self) -> bool {
        self.own.zip(self.extracted).is_some_and(|(own, extracted)| extracted < own)
    }
}

/// All controllers of a design whose setpoints belong to no window, judged by one.
pub(super) fn verdicts(study: &StudyReport, design: &str, window: ComfortWindow) -> Vec<Verdict> {
    let years = || study.control_years.iter().map(|y| &y.point).filter(|p| p.design == design);
    let votes: Vec<(f64, f64)> = years()
        .filter(|p| p.controller == "extracted")
        .filter_map(|p| Some((p.mean_hvac_power_w, p.mean_abs_pmv?)))
        .collect();
    let outside = study.control_outside.iter().filter(|o| o.design == design && o.window == window);
    let outside: Vec<(f64, f64)> = outside
        .filter(|o| o.profile.is_some())
        .filter_map(|o| Some((o.mean_hvac_power_w, o.outside_fraction?)))
        .collect();
    if votes.is_empty() {
        return Vec::new();
    }
    years()
        .filter(|p| p.window == window && !p.controller.starts_with("extracted"))
        .map(|p| Verdict {
            controller: p.controller.clone(),
            mean_hvac_power_w: p.mean_hvac_power_w,
            mean_vote: Coordinate { own: p.mean_abs_pmv, extracted: at(&votes, p.mean_hvac_power_w) },
            outside: Coordinate { own: p.outside_fraction, extracted: at(&outside, p.mean_hvac_power_w) },
        })
        .collect()
}

/// The discomfort of a line of powers and discomforts at a power: linear in between, at a higher one that of the most powerful,
/// at a lower one none.
fn at(line: &[(f64, f64)], power_w: f64) -> Option<f64> {
    let mut line = line.to_vec();
    line.sort_by(|a, b| a.0.total_cmp(&b.0));
    let after = line.partition_point(|(power, _)| *power <= power_w);
    let (x0, y0) = *line.get(after.checked_sub(1)?)?;
    let Some((x1, y1)) = line.get(after) else { return Some(y0) };
    Some(y0 + (y1 - y0) * (power_w - x0) / (x1 - x0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prop_points_that_coincide_have_one_name_and_lines_none() {
        let fronts = [
            Front::new("a", vec![(1.0, 2.0)]),
            Front::new("line", vec![(1.0, 2.0), (2.0, 1.0)]),
            Front::new("b", vec![(3.0, 2.0)]),
            Front::new("c", vec![(1.01, 1.99)]),
        ];
        let joined: Vec<String> = names(&fronts, (0.05, 0.05)).iter().map(|(_, names)| names.join(", ")).collect();
        assert_eq!(joined, ["a, c", "b"]);
    }

    #[test]
    fn prop_discomfort_at_a_power_lies_on_the_line() {
        let line = [(2000.0, 0.2), (1000.0, 0.8)];
        assert_eq!(
            [900.0, 1000.0, 1500.0, 2000.0, 3000.0].map(|w| at(&line, w)),
            [None, Some(0.8), Some(0.5), Some(0.2), Some(0.2)]
        );
        assert!(Coordinate { own: Some(0.5), extracted: Some(0.4) }.is_beaten());
        assert!(!Coordinate { own: Some(0.4), extracted: Some(0.4) }.is_beaten());
        assert!(!Coordinate { own: Some(0.4), extracted: None }.is_beaten());
    }
}
