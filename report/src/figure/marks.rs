//! What stands on a panel, and how it is drawn.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

use super::axis::Scale;
use super::canvas::{Anchor, Canvas, FONT, INK, LINE, PALE_INK, Pen, Word, coordinate, path, rectangle, width_of};
use super::palette::{LIMIT, Marker, Style, ink_of};

/// Something on a panel, in the order in which it is drawn.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Mark {
    /// A line; where a value is not a number, it breaks. `what` says what it is where its series has another one on the panel,
    /// which alone stands in the legend.
    Line { name: String, what: &'static str, style: Style, points: Vec<(f64, f64)> },
    /// An area between two values at each place of a series.
    Band { name: String, style: Style, points: Vec<(f64, [f64; 2])> },
    /// An area from zero to a line.
    Area { name: String, style: Style, points: Vec<(f64, f64)> },
    /// A cloud.
    Dots { name: String, colour: &'static str, points: Vec<(f64, f64)> },
    /// A limit: a dotted line across, with its name.
    Limit { at: f64, name: String },
    /// A piece of the axis below that is spoken of elsewhere.
    Shade { from: f64, to: f64 },
    /// A dotted box with its name.
    Frame { low: (f64, f64), high: (f64, f64), name: String },
    /// A name beside lines, those of the series `of`.
    Label { at: (f64, f64), name: String, of: Vec<String>, colour: &'static str, side: Side },
}

impl Mark {
    /// A line that has its series alone.
    pub fn line(name: impl Into<String>, style: Style, points: Vec<(f64, f64)>) -> Self {
        Self::Line { name: name.into(), what: "", style, points }
    }

    /// The series it belongs to.
    pub fn series(&self) -> &[String] {
        match self {
            Self::Line { name, .. } | Self::Band { name, .. } | Self::Area { name, .. } | Self::Dots { name, .. } => {
                std::slice::from_ref(name)
            }
            Self::Label { of, .. } => of,
            Self::Limit { .. } | Self::Shade { .. } | Self::Frame { .. } => &[],
        }
    }
}

/// On which side of a falling line its name stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Side {
    /// Above, to the right.
    Above,
    /// Below, to the left.
    Below,
}

/// Where a panel lies, and its scales.
pub(super) struct Place {
    pub left: f64,
    /// What stands left of it.
    pub margin: f64,
    pub top: f64,
    pub width: f64,
    pub height: f64,
    pub x: Scale,
    pub y: Scale,
}

impl Place {
    fn at(&self, (x, y): (f64, f64)) -> (f64, f64) {
        (self.left + self.width * self.x.share(x), self.top + self.height * (1.0 - self.y.share(y)))
    }
}

/// All that an axis has to hold.
pub(super) fn extent(mark: &Mark) -> Vec<(f64, f64)> {
    match mark {
        Mark::Line { points, .. } | Mark::Dots { points, .. } => points.clone(),
        Mark::Area { points, .. } => points.iter().flat_map(|(x, y)| [(*x, 0.0), (*x, *y)]).collect(),
        Mark::Band { points, .. } => points.iter().flat_map(|(x, ends)| ends.map(|end| (*x, end))).collect(),
        Mark::Limit { at, .. } => vec![(f64::NAN, *at)],
        Mark::Shade { from, to } => vec![(*from, f64::NAN), (*to, f64::NAN)],
        Mark::Frame { low, high, .. } => vec![*low, *high],
        Mark::Label { at, .. } => vec![*at],
    }
}

pub(super) fn draw_mark(canvas: &mut Canvas, mark: &Mark, place: &Place) {
    let (left, right) = (place.left, place.left + place.width);
    if extent(mark).is_empty() {
        return;
    }
    match mark {
        Mark::Line { style, points, .. } => {
            if points.len() > 1 && style.width > 0.0 {
                canvas.line(&path(points.iter().map(|p| place.at(*p))), pen(*style));
            }
            if style.marker.is_some() {
                points.iter().for_each(|p| marker(canvas, place.at(*p), *style));
            }
        }
        Mark::Band { style, points, .. } => {
            let low = points.iter().map(|(x, [low, _])| place.at((*x, *low)));
            let high = points.iter().rev().map(|(x, [_, high])| place.at((*x, *high)));
            let d = format!("{}Z", path(low.chain(high)));
            canvas.area(&d, style.colour, 0.22);
        }
        Mark::Area { style, points, .. } => {
            let ground = points.iter().rev().map(|(x, _)| place.at((*x, 0.0)));
            let d = format!("{}Z", path(points.iter().map(|p| place.at(*p)).chain(ground)));
            canvas.area(&d, style.colour, 0.22);
        }
        Mark::Dots { colour, points, .. } => cloud(canvas, points, colour, place),
        Mark::Limit { at, name } => {
            let y = place.at((0.0, *at)).1;
            canvas.line(&path([(left, y), (right, y)].into_iter()), Pen { colour: LIMIT, width: 0.8, dash: "1 2" });
            let word = Word { fill: PALE_INK, halo: true, ..Word::default() };
            // Below the line where there is no room above it.
            let y = if y - place.top < LINE { y + 7.5 } else { y - 2.0 };
            canvas.word((right - 2.0, y), name, Anchor::End, word);
        }
        Mark::Shade { from, to } => {
            let ends = [*from, *to].map(|x| place.at((x, 0.0)).0.clamp(left, right));
            canvas.area(&rectangle((ends[0], place.top), (ends[1], place.top + place.height)), INK, 0.12);
        }
        Mark::Frame { low, high, name } => {
            let (low, high) = (place.at(*low), place.at(*high));
            let d = rectangle((low.0 - 4.0, low.1 + 4.0), (high.0 + 4.0, high.1 - 4.0));
            canvas.line(&d, Pen { colour: LIMIT, width: 0.7, dash: "2 1.5" });
            let word = Word { fill: PALE_INK, halo: true, ..Word::default() };
            let half = width_of(name, FONT) / 2.0;
            let x = ((low.0 + high.0) / 2.0).clamp(left + half, right - half);
            let y = if high.1 - 7.0 - LINE > place.top { high.1 - 7.0 } else { low.1 + 12.0 };
            canvas.word((x, y), name, Anchor::Middle, word);
        }
        Mark::Label { at, name, colour, side, .. } => {
            let (x, y) = place.at(*at);
            let word = Word { fill: ink_of(colour), halo: true, ..Word::default() };
            match side {
                Side::Above => canvas.word((x + 3.0, y - 2.5), name, Anchor::Start, word),
                // On the right where the left has no room.
                Side::Below if x - 3.0 - width_of(name, FONT) < left => {
                    canvas.word((x + 3.0, y + 7.5), name, Anchor::Start, word);
                }
                Side::Below => canvas.word((x - 3.0, y + 7.5), name, Anchor::End, word),
            }
        }
    }
}

pub(super) fn pen(style: Style) -> Pen {
    Pen { colour: style.colour, width: style.width, dash: style.dash }
}

pub(super) fn dot((x, y): (f64, f64)) -> String {
    format!("M{} {}h0", coordinate(x), coordinate(y))
}

/// A dot for each half point of print that has values: as many as the eye can tell apart.
fn cloud(canvas: &mut Canvas, points: &[(f64, f64)], colour: &str, place: &Place) {
    let halves = |(x, y): (f64, f64)| ((2.0 * x).round() as i64, (2.0 * y).round() as i64);
    let pixels: BTreeSet<(i64, i64)> = points.iter().map(|p| halves(place.at(*p))).collect();
    let mut rows: BTreeMap<i64, Vec<i64>> = BTreeMap::new();
    for (x, y) in pixels {
        rows.entry(y).or_default().push(x);
    }
    let mut d = String::new();
    for (y, xs) in rows {
        for x in xs {
            let _ = write!(d, "M{} {}h0", coordinate(x as f64 / 2.0), coordinate(y as f64 / 2.0));
        }
    }
    if !d.is_empty() {
        canvas.dots(&d, colour, 1.0);
    }
}

pub(super) fn marker(canvas: &mut Canvas, (x, y): (f64, f64), style: Style) {
    let Some(marker) = style.marker else { return };
    let r = 2.1;
    let at = |points: &[(f64, f64)]| format!("{}Z", path(points.iter().map(|(dx, dy)| (x + r * dx, y + r * dy))));
    let circle = || {
        let c = coordinate;
        format!("M{} {}a{r} {r} 0 1 0 {} 0a{r} {r} 0 1 0 {} 0Z", c(x - r), c(y), c(2.0 * r), c(-2.0 * r))
    };
    let square = [(-0.9, -0.9), (0.9, -0.9), (0.9, 0.9), (-0.9, 0.9)];
    let open = |canvas: &mut Canvas, d: &str| {
        canvas.edged(d, "#ffffff", Pen { colour: style.colour, width: 0.9, dash: "" });
    };
    match marker {
        Marker::Circle => canvas.area(&circle(), style.colour, 1.0),
        Marker::Square => canvas.area(&at(&square), style.colour, 1.0),
        Marker::Triangle => canvas.area(&at(&[(-1.1, 0.9), (1.1, 0.9), (0.0, -1.2)]), style.colour, 1.0),
        Marker::Diamond => canvas.area(&at(&[(-1.2, 0.0), (0.0, -1.3), (1.2, 0.0), (0.0, 1.3)]), style.colour, 1.0),
        Marker::OpenCircle => open(canvas, &circle()),
        Marker::OpenSquare => open(canvas, &at(&square)),
        Marker::Cross => {
            let d = [[(-1.0, -1.0), (1.0, 1.0)], [(-1.0, 1.0), (1.0, -1.0)]]
                .map(|ends| path(ends.iter().map(|(dx, dy)| (x + r * dx, y + r * dy))));
            canvas.line(&d.concat(), Pen { colour: style.colour, width: 1.1, dash: "" });
        }
    }
}
