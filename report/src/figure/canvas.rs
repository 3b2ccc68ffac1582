//! What figures are drawn on: paths and texts in points of print, 85 mm wide, as SVG that every renderer draws alike.
//!
//! No style sheets, markers, clip paths or ids: renderers differ in them, and pages that inline several figures would mix them up.

use minijinja::{AutoEscape, Environment, Value, context};

use crate::ReportError;

const TEMPLATE: &str = include_str!("../../templates/figure.svg");

/// Width of a column of print, 85 mm, in points.
pub(super) const WIDTH: f64 = 241.0;
/// Size of all texts but the title: 7 pt is the least that journals print.
pub(super) const FONT: f64 = 7.5;
const TITLE_FONT: f64 = 8.5;
/// From one line of text to the next.
pub(super) const LINE: f64 = 9.5;
/// Around everything.
pub(super) const MARGIN: f64 = 4.0;
pub(super) const INK: &str = "#1a1a1a";
pub(super) const PALE_INK: &str = "#555555";
/// Pixels that a point is shown with where nobody says how wide.
const SHOWN: f64 = 3.0;

/// Where a text stands at its place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

impl Anchor {
    fn word(self) -> &'static str {
        match self {
            Self::Start => "start",
            Self::Middle => "middle",
            Self::End => "end",
        }
    }
}

/// How a line is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Pen {
    pub colour: &'static str,
    pub width: f64,
    /// Dashes as in SVG; empty for a solid line.
    pub dash: &'static str,
}

/// A drawing that grows.
#[derive(Debug, Default)]
pub(super) struct Canvas {
    groups: Vec<Group>,
    /// Whom the next shapes belong to.
    of: Of,
}

/// Whom a shape belongs to: readers of a page choose series.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) enum Of {
    /// Axes and words, which are always there.
    #[default]
    Figure,
    /// Series by their places among those of the figure: there while one of them is.
    Series(Vec<usize>),
    /// What the legend says of a series.
    Legend(usize),
}

/// Shapes that belong together.
#[derive(Debug)]
struct Group {
    of: Of,
    shapes: Vec<Value>,
}

/// Where a drawing stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Form {
    /// A file of its own.
    File,
    /// Within a page, which says of what size.
    Inline,
}

/// A finished drawing.
#[derive(Debug)]
pub(crate) struct Drawing {
    groups: Vec<Group>,
    height: f64,
    title: String,
    told: String,
}

impl Canvas {
    /// What follows belongs to these series.
    pub fn of(&mut self, of: Of) {
        self.of = of;
    }

    fn push(&mut self, shape: Value) {
        match self.groups.last_mut() {
            Some(group) if group.of == self.of => group.shapes.push(shape),
            _ => self.groups.push(Group { of: self.of.clone(), shapes: vec![shape] }),
        }
    }

    /// A line along a path.
    pub fn line(&mut self, d: &str, pen: Pen) {
        let Pen { colour, width, dash } = pen;
        self.push(context! { d, fill => "none", stroke => colour, stroke_width => coordinate(width), dash });
    }

    /// Dots along a path of pieces without length.
    pub fn dots(&mut self, d: &str, colour: &str, width: f64) {
        self.push(
            context! { d, fill => "none", stroke => colour, stroke_width => coordinate(width), dash => "", round => true },
        );
    }

    /// An area within a path.
    pub fn area(&mut self, d: &str, fill: &str, opacity: f64) {
        let fill_opacity = if opacity < 1.0 { coordinate(opacity) } else { String::new() };
        self.push(context! { d, fill, fill_opacity });
    }

    /// An area with an edge.
    pub fn edged(&mut self, d: &str, fill: &str, pen: Pen) {
        let Pen { colour, width, dash } = pen;
        self.push(context! { d, fill, stroke => colour, stroke_width => coordinate(width), dash });
    }

    pub fn text(&mut self, (x, y): (f64, f64), text: &str, anchor: Anchor) {
        self.word((x, y), text, anchor, Word::default());
    }

    pub fn word(&mut self, (x, y): (f64, f64), text: &str, anchor: Anchor, word: Word) {
        if text.is_empty() {
            return;
        }
        let Word { size, bold, turned, fill, halo } = word;
        let (x, y, size, anchor) = (coordinate(x), coordinate(y), coordinate(size), anchor.word());
        // Two texts, as renderers differ in what they paint first.
        let (x, y, size) = (&x, &y, &size);
        if halo {
            self.push(context! { text, x, y, size, bold, turned, anchor, fill => "#ffffff", halo });
        }
        self.push(context! { text, x, y, size, bold, turned, anchor, fill });
    }

    /// Title and what is told beneath it, on as many lines as they need; gives where they end.
    pub fn heading(&mut self, title: &str, told: &str) -> f64 {
        let bold = Word { size: TITLE_FONT, bold: true, ..Word::default() };
        // Bold letters are wider.
        let y = self.lines(MARGIN, title, 1.06 * TITLE_FONT, bold);
        self.remark(y, told)
    }

    /// A remark from a height on; gives where it ends.
    pub fn remark(&mut self, y: f64, text: &str) -> f64 {
        self.lines(y, text, FONT, Word { fill: PALE_INK, ..Word::default() })
    }

    fn lines(&mut self, mut y: f64, text: &str, measured_as: f64, word: Word) -> f64 {
        for line in wrapped(text, measured_as, WIDTH - 2.0 * MARGIN) {
            y += LINE;
            self.word((MARGIN, y), &line, Anchor::Start, word);
        }
        y
    }

    /// The drawing, of a height, with a title and words for those who cannot see it.
    pub fn finished(self, height: f64, title: &str, told: &str) -> Drawing {
        Drawing { groups: self.groups, height, title: title.to_owned(), told: told.to_owned() }
    }
}

impl Drawing {
    /// As SVG.
    pub fn svg(&self, form: Form) -> Result<String, ReportError> {
        let mut environment = Environment::new();
        environment.set_auto_escape_callback(|_| AutoEscape::Html);
        environment.add_template("figure.svg", TEMPLATE)?;
        let group = |group: &Group| {
            let places = |of: &[usize]| of.iter().map(usize::to_string).collect::<Vec<_>>().join(" ");
            let (series, legend) = match &group.of {
                Of::Figure => (String::new(), String::new()),
                Of::Series(of) => (places(of), String::new()),
                Of::Legend(of) => (String::new(), of.to_string()),
            };
            context! { series, legend, shapes => &group.shapes }
        };
        let content = context! {
            title => &self.title, told => &self.told, groups => self.groups.iter().map(group).collect::<Vec<_>>(),
            width => WIDTH, height => coordinate(self.height), inline => form == Form::Inline,
            shown_width => coordinate(SHOWN * WIDTH), shown_height => coordinate(SHOWN * self.height),
        };
        Ok(environment.get_template("figure.svg")?.render(content)?)
    }
}

/// How a text looks.
#[derive(Debug, Clone, Copy)]
pub(super) struct Word {
    pub size: f64,
    pub bold: bool,
    /// Reads from below to above.
    pub turned: bool,
    pub fill: &'static str,
    /// White around it, where it stands on lines.
    pub halo: bool,
}

impl Default for Word {
    fn default() -> Self {
        Self { size: FONT, bold: false, turned: false, fill: INK, halo: false }
    }
}

/// A path that begins anew wherever a value is not a number.
pub(super) fn path(points: impl Iterator<Item = (f64, f64)>) -> String {
    let (mut d, mut pen_down) = (String::new(), false);
    for (x, y) in points {
        if x.is_finite() && y.is_finite() {
            d.push_str(if pen_down { " " } else { "M" });
            d.push_str(&coordinate(x));
            d.push(' ');
            d.push_str(&coordinate(y));
        }
        pen_down = x.is_finite() && y.is_finite();
    }
    d
}

/// A rectangle from one corner to the opposite one.
pub(super) fn rectangle((x0, y0): (f64, f64), (x1, y1): (f64, f64)) -> String {
    format!("M{0} {1}H{2}V{3}H{0}Z", coordinate(x0), coordinate(y0), coordinate(x1), coordinate(y1))
}

/// Two decimals, so that a platform's arithmetic cannot change bytes.
pub(crate) fn coordinate(value: f64) -> String {
    let text = format!("{:.2}", value + 0.0);
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// How wide a text is, about: letters of Helvetica, rounded up to those of wider fonts that stand in for it.
pub(super) fn width_of(text: &str, size: f64) -> f64 {
    let of = |c: char| match c {
        'i' | 'j' | 'l' | 'I' | '.' | ',' | ':' | ';' | '|' | '\'' | '!' => 0.3,
        'f' | 't' | 'r' | ' ' | '(' | ')' | '-' | '/' => 0.38,
        'm' | 'M' | 'W' | '%' | '…' => 0.95,
        'A'..='Z' | 'w' | '+' | '±' | '−' | '=' => 0.7,
        _ => 0.58,
    };
    size * text.chars().map(of).sum::<f64>()
}

/// The lines of a text that are at most so wide.
fn wrapped(text: &str, size: f64, width: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if width_of(line, size) + width_of(" ", size) + width_of(word, size) <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}
