//! Charts: panels in columns, each with two axes, and marks on them. Every figure over axes is one of these.

use super::axis::{Axis, Scale, Ticks};
use super::canvas::{Anchor, Canvas, Drawing, FONT, LINE, MARGIN, Of, Pen, WIDTH, Word, path, rectangle, width_of};
use super::marks::{Mark, Place, dot, draw_mark, extent, marker, pen};

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

const TICK: Pen = Pen { colour: "#e2e2e2", width: 0.5, dash: "" };
const EDGE: Pen = Pen { colour: "#666666", width: 0.6, dash: "" };
const KEY: f64 = 17.0;

impl Chart {
    /// The names of all series, in the order of the legend.
    pub fn series(&self) -> Vec<&str> {
        let mut names: Vec<&str> = Vec::new();
        for mark in self.panels.iter().flat_map(|p| &p.marks) {
            if let Mark::Line { name, points, .. } | Mark::Dots { name, points, .. } = mark
                && !(name.is_empty() || points.is_empty() || names.contains(&name.as_str()))
            {
                names.push(name);
            }
        }
        names
    }
}

/// Whom a mark belongs to.
fn of_mark(mark: &Mark, series: &[&str]) -> Of {
    let places: Vec<usize> = mark.series().iter().filter_map(|s| series.iter().position(|name| name == s)).collect();
    if places.is_empty() { Of::Figure } else { Of::Series(places) }
}

/// The figure.
pub(crate) fn chart_drawn(chart: &Chart) -> Drawing {
    drawn(chart).0
}

/// The figure, and where its panels lie.
pub(super) fn drawn(chart: &Chart) -> (Drawing, Vec<Place>) {
    let mut canvas = Canvas::default();
    let series = chart.series();
    let mut places = Vec::new();
    let told_to = canvas.heading(&chart.title, &chart.told);
    let mut y = legend(&mut canvas, chart, told_to + 3.0);
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
            draw(&mut canvas, panel, &place, &series);
            places.push(place);
            below = below.max(match (&panel.x.ticks, panel.x.label.is_empty()) {
                (Ticks::None, _) => 2.0,
                (_, true) => LINE + 1.0,
                (_, false) => 2.0 * LINE + 2.0,
            });
        }
        y += chart.height + below;
    }
    (canvas.finished(y + 3.0, &chart.title, &chart.told), places)
}

fn scales(panel: &Panel, chart: &Chart, width: f64) -> (Scale, Scale) {
    let points: Vec<(f64, f64)> = panel.marks.iter().flat_map(extent).collect();
    let of_x = points.iter().map(|p| p.0);
    let x = Scale::of(&panel.x, of_x, (width / 42.0).clamp(2.0, 6.0));
    let y = Scale::of(&panel.y, points.iter().map(|p| p.1), (chart.height / 22.0).clamp(2.0, 8.0));
    (x, y)
}

fn left_margin(panel: &Panel, y: &Scale) -> f64 {
    let widest = y.ticks(&panel.y.ticks).iter().map(|(_, label)| width_of(label, FONT)).fold(0.0, f64::max);
    widest + 4.0 + if panel.y.label.is_empty() { 0.0 } else { LINE + 1.0 }
}

/// Every name once, in as many rows as they need.
fn legend(canvas: &mut Canvas, chart: &Chart, y: f64) -> f64 {
    let (mut x, mut y) = (MARGIN, y + 6.0);
    let series = chart.series();
    for (i, name) in series.iter().enumerate() {
        let wide = KEY + 3.0 + width_of(name, FONT) + 7.0;
        if x + wide > WIDTH && x > MARGIN {
            (x, y) = (MARGIN, y + LINE);
        }
        canvas.of(Of::Legend(i));
        let of_name = |mark: &&Mark| {
            matches!(mark, Mark::Line { name: of, what: "", points, .. } | Mark::Dots { name: of, points, .. }
                if of == name && !points.is_empty())
        };
        let found = chart.panels.iter().flat_map(|p| &p.marks).find(of_name);
        match found {
            Some(Mark::Line { style, points, .. }) => {
                if points.len() > 1 {
                    canvas.line(&path([(x, y), (x + KEY, y)].into_iter()), pen(*style));
                }
                marker(canvas, (x + KEY / 2.0, y), *style);
            }
            Some(Mark::Dots { colour, .. }) => canvas.dots(&dot((x + KEY / 2.0, y)), colour, 3.0),
            _ => {}
        }
        canvas.text((x + KEY + 3.0, y + 2.7), name, Anchor::Start);
        x += wide;
    }
    canvas.of(Of::Figure);
    if series.is_empty() { y - 6.0 } else { y + 7.0 }
}

fn draw(canvas: &mut Canvas, panel: &Panel, place: &Place, series: &[&str]) {
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
        canvas.of(of_mark(mark, series));
        draw_mark(canvas, mark, place);
    }
    canvas.of(Of::Figure);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figure::canvas::Form;
    use crate::figure::marks::Side;
    use crate::figure::palette::{HEATING, REST, Style};

    fn all_marks() -> Chart {
        let wave: Vec<(f64, f64)> = (0..60).map(|i| f64::from(i) / 30.0).map(|x| (x, 300.0 * x.sin())).collect();
        let broken = wave.iter().map(|(x, y)| (*x, if *x > 1.0 { *y } else { f64::NAN })).collect();
        let marks = vec![
            Mark::Band {
                name: "<a>".to_owned(),
                style: Style::of_place(0),
                points: wave.iter().map(|(x, y)| (*x, [y - 20.0, y + 20.0])).collect(),
            },
            Mark::Band { name: "b".to_owned(), style: Style::of_place(0), points: Vec::new() },
            Mark::line("<a>", Style::of_place(0), wave.clone()),
            Mark::line("b", Style::line(HEATING, "3 1.5", 1.0), broken),
            Mark::Dots { name: "c".to_owned(), colour: REST, points: wave },
            Mark::Limit { at: -250.0, name: "limit".to_owned() },
            Mark::Shade { from: 0.5, to: 9.0 },
            Mark::Frame { low: (0.2, 10.0), high: (0.4, 90.0), name: "box".to_owned() },
            Mark::Label {
                at: (1.0, 200.0),
                name: "label".to_owned(),
                of: Vec::new(),
                colour: HEATING,
                side: Side::Below,
            },
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

    fn svg() -> String {
        drawn(&all_marks()).0.svg(Form::File).unwrap()
    }

    #[test]
    fn prop_charts_are_xml_that_every_renderer_draws_alike() {
        let svg = svg();
        assert_eq!(svg, self::svg());
        let document = roxmltree::Document::parse(&svg).unwrap();
        let texts: Vec<&str> =
            document.descendants().filter(|n| n.has_tag_name("text")).filter_map(|n| n.text()).collect();
        for text in ["A & B", "synthetic", "<a>", "b", "c", "limit", "box", "label", "T", "none", "when", "2.0", "−250"]
        {
            assert!(texts.contains(&text), "{text} is missing in {texts:?}");
        }
        for odd in ["NaN", "inf", "<style", "<script", "id=", "clip", "paint-order", "marker-end", "url(", "d=\"Z"] {
            assert!(!svg.contains(odd), "{odd}");
        }
    }

    #[test]
    fn prop_texts_are_large_enough_to_print_and_lie_within_the_figure() {
        let svg = svg();
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
