//! Charts: panels in columns, each with two axes, and marks on them. Every figure over axes is one of these.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

use super::axis::{Axis, Scale, Ticks};
use super::canvas::{
    Anchor, Canvas, FONT, INK, PALE_INK, Pen, TITLE_FONT, WIDTH, Word, coordinate, path, rectangle, width_of, wrapped,
};
use super::palette::{LIMIT, Marker, Style};
use crate::ReportError;

/// A figure over axes.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Chart {
    /// First line.
    pub title: String,
    /// What it is, and where the data come from; also for those who cannot see it.
    pub told: String,
    /// Panels side by side.
    pub columns: usize,
    /// Panels, row by row.
    pub panels: Vec<Panel>,
    /// Height of a panel in points.
    pub height: f64,
}

/// A panel.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Panel {
    pub title: String,
    pub x: Axis,
    pub y: Axis,
    pub marks: Vec<Mark>,
}

/// Something on a panel, in the order in which it is drawn.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Mark {
    /// A line; where a value is not a number, it breaks.
    Line { name: String, style: Style, points: Vec<(f64, f64)> },
    /// An area between two values at each place.
    Band { style: Style, points: Vec<(f64, [f64; 2])> },
    /// A cloud.
    Dots { name: String, colour: &'static str, points: Vec<(f64, f64)> },
    /// A limit: a dotted line across, with its name.
    Limit { at: f64, name: String },
    /// A piece of the axis below that is spoken of elsewhere.
    Shade { from: f64, to: f64 },
    /// A dotted box with its name.
    Frame { low: (f64, f64), high: (f64, f64), name: String },
    /// The name of a line beside it.
    Label { at: (f64, f64), name: String, colour: &'static str, side: Side },
}

/// On which side of a falling line its name stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Side {
    /// Above, to the right.
    Above,
    /// Below, to the left.
    Below,
}

const MARGIN: f64 = 4.0;
const LINE: f64 = 9.5;
const TICK: Pen = Pen { colour: "#e2e2e2", width: 0.5, dash: "" };
const EDGE: Pen = Pen { colour: "#666666", width: 0.6, dash: "" };
const KEY: f64 = 17.0;

/// Where a panel lies, and its scales.
struct Place {
    left: f64,
    /// What stands left of it.
    margin: f64,
    top: f64,
    width: f64,
    height: f64,
    x: Scale,
    y: Scale,
}

impl Place {
    fn at(&self, (x, y): (f64, f64)) -> (f64, f64) {
        (self.left + self.width * self.x.share(x), self.top + self.height * (1.0 - self.y.share(y)))
    }
}

/// The figure as SVG.
pub(crate) fn chart_svg(chart: &Chart) -> Result<String, ReportError> {
    let mut canvas = Canvas::default();
    let mut y = heading(&mut canvas, chart);
    y = legend(&mut canvas, chart, y);
    let columns = chart.columns.max(1);
    let column_width = (WIDTH - 2.0 * MARGIN) / columns as f64;
    // Panels above each other have equal margins.
    let margin = |column: usize| {
        let of_column = chart.panels.iter().skip(column).step_by(columns);
        of_column.map(|panel| left_margin(panel, &scales(panel, chart, column_width).1)).fold(0.0, f64::max)
    };
    let margins: Vec<f64> = (0..columns).map(margin).collect();
    for row in chart.panels.chunks(columns) {
        let of_row: Vec<(Scale, Scale)> = row.iter().map(|panel| scales(panel, chart, column_width)).collect();
        let titled = row.iter().any(|panel| !panel.title.is_empty());
        y += if titled { LINE + 2.0 } else { 3.0 };
        let mut below: f64 = 4.0;
        for (i, (panel, (x_scale, y_scale))) in row.iter().zip(of_row).enumerate() {
            let left = MARGIN + column_width * i as f64 + margins[i];
            let width = column_width - margins[i] - 7.0;
            let place = Place { left, margin: margins[i], top: y, width, height: chart.height, x: x_scale, y: y_scale };
            draw(&mut canvas, panel, &place);
            below = below.max(match (&panel.x.ticks, panel.x.label.is_empty()) {
                (Ticks::None, _) => 2.0,
                (_, true) => LINE + 1.0,
                (_, false) => 2.0 * LINE + 2.0,
            });
        }
        y += chart.height + below;
    }
    canvas.svg(y + 3.0, &chart.title, &chart.told)
}

fn scales(panel: &Panel, chart: &Chart, width: f64) -> (Scale, Scale) {
    let points: Vec<(f64, f64)> = panel.marks.iter().flat_map(extent).collect();
    let of_x = points.iter().map(|p| p.0);
    let x = Scale::of(&panel.x, of_x, (width / 42.0).clamp(2.0, 6.0));
    let y = Scale::of(&panel.y, points.iter().map(|p| p.1), (chart.height / 22.0).clamp(2.0, 8.0));
    (x, y)
}

/// All that an axis has to hold.
fn extent(mark: &Mark) -> Vec<(f64, f64)> {
    match mark {
        Mark::Line { points, .. } | Mark::Dots { points, .. } => points.clone(),
        Mark::Band { points, .. } => points.iter().flat_map(|(x, ends)| ends.map(|end| (*x, end))).collect(),
        Mark::Limit { at, .. } => vec![(f64::NAN, *at)],
        Mark::Shade { from, to } => vec![(*from, f64::NAN), (*to, f64::NAN)],
        Mark::Frame { low, high, .. } => vec![*low, *high],
        Mark::Label { at, .. } => vec![*at],
    }
}

fn left_margin(panel: &Panel, y: &Scale) -> f64 {
    let widest = y.ticks(&panel.y.ticks).iter().map(|(_, label)| width_of(label, FONT)).fold(0.0, f64::max);
    widest + 4.0 + if panel.y.label.is_empty() { 0.0 } else { LINE + 1.0 }
}

fn heading(canvas: &mut Canvas, chart: &Chart) -> f64 {
    let mut y = MARGIN;
    let bold = Word { size: TITLE_FONT, bold: true, ..Word::default() };
    for line in wrapped(&chart.title, TITLE_FONT * 1.06, WIDTH - 2.0 * MARGIN) {
        y += LINE;
        canvas.word((MARGIN, y), &line, Anchor::Start, bold);
    }
    let pale = Word { fill: PALE_INK, ..Word::default() };
    for line in wrapped(&chart.told, FONT, WIDTH - 2.0 * MARGIN) {
        y += LINE;
        canvas.word((MARGIN, y), &line, Anchor::Start, pale);
    }
    y + 3.0
}

/// Every name once, in as many rows as they need.
fn legend(canvas: &mut Canvas, chart: &Chart, y: f64) -> f64 {
    let mut seen = BTreeSet::new();
    let (mut x, mut y) = (MARGIN, y + 6.0);
    for mark in chart.panels.iter().flat_map(|p| &p.marks) {
        let (Mark::Line { name, points, .. } | Mark::Dots { name, points, .. }) = mark else { continue };
        if name.is_empty() || points.is_empty() || !seen.insert(name) {
            continue;
        }
        let wide = KEY + 3.0 + width_of(name, FONT) + 7.0;
        if x + wide > WIDTH && x > MARGIN {
            (x, y) = (MARGIN, y + LINE);
        }
        match mark {
            Mark::Line { style, .. } => {
                if points.len() > 1 {
                    canvas.line(&path([(x, y), (x + KEY, y)].into_iter()), pen(*style));
                }
                marker(canvas, (x + KEY / 2.0, y), *style);
            }
            Mark::Dots { colour, .. } => canvas.dots(&dot((x + KEY / 2.0, y)), colour, 3.0),
            _ => {}
        }
        canvas.text((x + KEY + 3.0, y + 2.7), name, Anchor::Start);
        x += wide;
    }
    if seen.is_empty() { y - 6.0 } else { y + 7.0 }
}

fn draw(canvas: &mut Canvas, panel: &Panel, place: &Place) {
    let Place { left, top, width, height, .. } = *place;
    let (right, bottom) = (left + width, top + height);
    for (value, label) in place.y.ticks(&panel.y.ticks) {
        let y = bottom - height * place.y.share(value);
        canvas.line(&path([(left, y), (right, y)].into_iter()), TICK);
        canvas.text((left - 3.0, y + 2.6), &label, Anchor::End);
    }
    for (value, label) in place.x.ticks(&panel.x.ticks) {
        let x = left + width * place.x.share(value);
        canvas.line(&path([(x, top), (x, bottom)].into_iter()), TICK);
        // Those at the ends stay within the figure.
        let half = width_of(&label, FONT) / 2.0;
        canvas.text((x.min(WIDTH - 1.0 - half).max(1.0 + half), bottom + LINE), &label, Anchor::Middle);
    }
    for mark in &panel.marks {
        draw_mark(canvas, mark, place);
    }
    canvas.line(&rectangle((left, top), (right, bottom)), EDGE);
    let bold = Word { bold: true, ..Word::default() };
    canvas.word((left + width / 2.0, top - 3.0), &panel.title, Anchor::Middle, bold);
    if panel.x.ticks != Ticks::None {
        canvas.text((left + width / 2.0, bottom + 2.0 * LINE), &panel.x.label, Anchor::Middle);
    }
    let turned = Word { turned: true, ..Word::default() };
    let label_x = left - place.margin + LINE - 2.0;
    canvas.word((label_x, top + height / 2.0), &panel.y.label, Anchor::Middle, turned);
}

fn draw_mark(canvas: &mut Canvas, mark: &Mark, place: &Place) {
    let (left, right) = (place.left, place.left + place.width);
    match mark {
        Mark::Line { style, points, .. } => {
            if points.len() > 1 && style.width > 0.0 {
                canvas.line(&path(points.iter().map(|p| place.at(*p))), pen(*style));
            }
            if style.marker.is_some() {
                points.iter().for_each(|p| marker(canvas, place.at(*p), *style));
            }
        }
        Mark::Band { style, points } => {
            let low = points.iter().map(|(x, [low, _])| place.at((*x, *low)));
            let high = points.iter().rev().map(|(x, [_, high])| place.at((*x, *high)));
            let d = format!("{}Z", path(low.chain(high)));
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
        Mark::Label { at, name, colour, side } => {
            let (x, y) = place.at(*at);
            let word = Word { fill: colour, halo: true, ..Word::default() };
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

fn pen(style: Style) -> Pen {
    Pen { colour: style.colour, width: style.width, dash: style.dash }
}

fn dot((x, y): (f64, f64)) -> String {
    format!("M{} {}h0", coordinate(x), coordinate(y))
}

/// A dot for each half point of print that has values: as many as the eye can tell apart. Several paths, so that dots that lie
/// close together show how close.
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

fn marker(canvas: &mut Canvas, (x, y): (f64, f64), style: Style) {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figure::palette::{HEATING, REST};

    fn all_marks() -> Chart {
        let wave: Vec<(f64, f64)> = (0..60).map(|i| f64::from(i) / 30.0).map(|x| (x, 300.0 * x.sin())).collect();
        let broken = wave.iter().map(|(x, y)| (*x, if *x > 1.0 { *y } else { f64::NAN })).collect();
        let marks = vec![
            Mark::Band {
                style: Style::of_place(0),
                points: wave.iter().map(|(x, y)| (*x, [y - 20.0, y + 20.0])).collect(),
            },
            Mark::Line { name: "<a>".to_owned(), style: Style::of_place(0), points: wave.clone() },
            Mark::Line { name: "b".to_owned(), style: Style::line(HEATING, "3 1.5", 1.0), points: broken },
            Mark::Dots { name: "c".to_owned(), colour: REST, points: wave },
            Mark::Limit { at: -250.0, name: "limit".to_owned() },
            Mark::Shade { from: 0.5, to: 9.0 },
            Mark::Frame { low: (0.2, 10.0), high: (0.4, 90.0), name: "box".to_owned() },
            Mark::Label { at: (1.0, 200.0), name: "label".to_owned(), colour: HEATING, side: Side::Below },
        ];
        let panel = |ticks, label: &str, marks| Panel {
            title: "part".to_owned(),
            x: Axis::new("when").to(2.0).with(ticks),
            y: Axis::new(label),
            marks,
        };
        Chart {
            title: "A & B".to_owned(),
            told: "synthetic".to_owned(),
            columns: 1,
            panels: vec![panel(Ticks::None, "T", marks), panel(Ticks::Numbers, "none", Vec::new())],
            height: 60.0,
        }
    }

    #[test]
    fn prop_charts_are_xml_that_every_renderer_draws_alike() {
        let svg = chart_svg(&all_marks()).unwrap();
        assert_eq!(svg, chart_svg(&all_marks()).unwrap());
        let document = roxmltree::Document::parse(&svg).unwrap();
        let texts: Vec<&str> =
            document.descendants().filter(|n| n.has_tag_name("text")).filter_map(|n| n.text()).collect();
        for text in ["A & B", "synthetic", "<a>", "b", "c", "limit", "box", "label", "T", "none", "when", "2.0", "−250"]
        {
            assert!(texts.contains(&text), "{text} is missing in {texts:?}");
        }
        for odd in ["NaN", "inf", "<style", "<script", "id=", "clip", "paint-order", "marker-end", "url("] {
            assert!(!svg.contains(odd), "{odd}");
        }
    }

    #[test]
    fn prop_texts_are_large_enough_to_print_and_lie_within_the_figure() {
        let svg = chart_svg(&all_marks()).unwrap();
        let document = roxmltree::Document::parse(&svg).unwrap();
        let bounds: Vec<f64> =
            document.root_element().attribute("viewBox").unwrap().split(' ').map(|v| v.parse().unwrap()).collect();
        assert!((bounds[2] - 85.0 / 25.4 * 72.0).abs() < 0.1, "85 mm");
        for text in document.descendants().filter(|n| n.has_tag_name("text")) {
            let number = |name| text.attribute(name).unwrap().parse::<f64>().unwrap();
            assert!(number("font-size") >= 7.0);
            assert!((0.0..=bounds[2]).contains(&number("x")) && (0.0..=bounds[3]).contains(&number("y")), "{text:?}");
        }
    }
}
