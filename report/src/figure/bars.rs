//! Bars with names: what many things do to one quantity, from zero to both sides.

use super::axis::{Axis, Scale, Ticks};
use super::canvas::{
    Anchor, Canvas, Drawing, FONT, LINE, MARGIN, Of, PALE_INK, Pen, WIDTH, Word, path, rectangle, width_of,
};
use super::palette::{LIMIT, Style};
use super::values::{ValueTable, with_ends};

/// A figure of bars.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Bars {
    /// First line.
    pub title: String,
    /// What it is; also for those who cannot see it.
    pub told: String,
    /// Quantity with its unit.
    pub quantity: String,
    /// Names of the series with their looks.
    pub series: Vec<(String, Style)>,
    /// Whether the bars of a name stand below each other, or on one line.
    pub below_each_other: bool,
    /// A row each.
    pub rows: Vec<Bar>,
}

/// The bars of a name, one for each series.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Bar {
    pub name: String,
    /// What stands below the name.
    pub note: String,
    /// Value and interval; `None` where there is none.
    pub values: Vec<Option<(f64, Option<[f64; 2]>)>>,
}

const THICK: f64 = 6.0;
const GRID: Pen = Pen { colour: "#e2e2e2", width: 0.5, dash: "" };
const ZERO: Pen = Pen { colour: LIMIT, width: 0.7, dash: "" };
const WHISKER: Pen = Pen { colour: "#1a1a1a", width: 0.7, dash: "" };

/// The figure.
pub(crate) fn drawn(bars: &Bars) -> Drawing {
    let mut canvas = Canvas::default();
    let mut y = canvas.heading(&bars.title, &bars.told) + 3.0;
    y = legend(&mut canvas, bars, y);
    let names = bars.rows.iter().flat_map(|row| [&row.name, &row.note]);
    let left = MARGIN + 4.0 + names.map(|name| width_of(name, FONT)).fold(0.0, f64::max);
    let width = WIDTH - left - MARGIN - 6.0;
    let lines = if bars.below_each_other { bars.series.len().max(1) } else { 1 };
    let noted = bars.rows.iter().any(|row| !row.note.is_empty());
    let height = (lines as f64 * THICK).max(if noted { 2.0 * LINE - 3.0 } else { 0.0 });
    let row_height = height + 4.0;
    let bottom = y + bars.rows.len() as f64 * row_height + 2.0;
    let values = bars.rows.iter().flat_map(|row| row.values.iter().flatten());
    let reach = values.flat_map(|(value, ends)| ends.unwrap_or([*value; 2]).into_iter().chain([*value]));
    let scale = Scale::of(&axis(reach.chain([0.0])), std::iter::empty(), (width / 42.0).clamp(2.0, 6.0));
    let x = |value: f64| left + width * scale.share(value);
    for (value, label) in scale.ticks(&Ticks::Numbers) {
        canvas.line(&path([(x(value), y), (x(value), bottom)].into_iter()), GRID);
        canvas.text((x(value), bottom + LINE), &label, Anchor::Middle);
    }
    for (place, row) in bars.rows.iter().enumerate() {
        let top = y + 3.0 + place as f64 * row_height;
        let middle = top + height / 2.0;
        let up = if noted { LINE / 2.0 } else { 0.0 };
        canvas.text((left - 4.0, middle + 2.6 - up), &row.name, Anchor::End);
        let pale = Word { fill: PALE_INK, ..Word::default() };
        canvas.word((left - 4.0, middle + 2.6 + up), &row.note, Anchor::End, pale);
        let top = middle - lines as f64 * THICK / 2.0;
        for (series, (value, (_, style))) in row.values.iter().zip(&bars.series).enumerate() {
            let Some((value, ends)) = value else { continue };
            let line = if bars.below_each_other { series as f64 } else { 0.0 };
            let (from, to) = (top + line * THICK + 0.6, top + (line + 1.0) * THICK - 0.6);
            canvas.of(Of::Series(vec![series]));
            let edge = Pen { colour: style.colour, width: 0.6, dash: "" };
            canvas.edged(&rectangle((x(0.0), from), (x(*value), to)), fill(style, series), edge);
            if let Some(ends) = ends {
                let middle = (from + to) / 2.0;
                canvas.line(&path(ends.map(|end| (x(end), middle)).into_iter()), WHISKER);
            }
            canvas.of(Of::Figure);
        }
    }
    canvas.line(&path([(x(0.0), y), (x(0.0), bottom)].into_iter()), ZERO);
    // Within the figure, whatever names have left of it.
    let half = width_of(&bars.quantity, FONT) / 2.0;
    let label_x = (left + width / 2.0).min(WIDTH - MARGIN - half);
    canvas.text((label_x, bottom + 2.0 * LINE), &bars.quantity, Anchor::Middle);
    canvas.finished(bottom + 2.0 * LINE + 5.0, &bars.title, &bars.told)
}

/// An axis that begins and ends a little beyond its values.
fn axis(values: impl Iterator<Item = f64>) -> Axis {
    let finite = values.filter(|v| v.is_finite());
    let (low, high) = finite.fold((0.0_f64, 0.0_f64), |(low, high), v| (low.min(v), high.max(v)));
    let beyond = 0.03 * (high - low).max(1e-9);
    let from = if low < 0.0 { low - beyond } else { 0.0 };
    Axis::default().from(from).to(high + beyond)
}

/// Every second series is hollow, so that two are apart in grey.
fn fill(style: &Style, series: usize) -> &'static str {
    if series.is_multiple_of(2) { style.colour } else { "#ffffff" }
}

fn legend(canvas: &mut Canvas, bars: &Bars, y: f64) -> f64 {
    let (mut x, y) = (MARGIN, y + 6.0);
    for (series, (name, style)) in bars.series.iter().enumerate() {
        canvas.of(Of::Legend(series));
        let edge = Pen { colour: style.colour, width: 0.6, dash: "" };
        canvas.edged(&rectangle((x, y - 2.5), (x + 12.0, y + 2.5)), fill(style, series), edge);
        canvas.text((x + 15.0, y + 2.7), name, Anchor::Start);
        x += 15.0 + width_of(name, FONT) + 9.0;
    }
    canvas.of(Of::Figure);
    y + 6.0
}

/// Every value: name, series, value and the ends of its interval.
pub(crate) fn all_values(bars: &Bars) -> Vec<(String, String, f64, Option<[f64; 2]>)> {
    let of_row = |row: &Bar| {
        let values = row.values.iter().zip(&bars.series);
        let known =
            values.filter_map(|(v, (series, _))| v.map(|(v, ends)| (row.name.clone(), series.clone(), v, ends)));
        known.collect::<Vec<_>>()
    };
    bars.rows.iter().flat_map(of_row).collect()
}

/// The values that a reader can take in.
pub(crate) fn value_table(bars: &Bars) -> ValueTable {
    let cell = |value: &Option<(f64, Option<[f64; 2]>)>| match value {
        Some((value, ends)) => with_ends(Some(*value), *ends),
        None => with_ends(None, None),
    };
    let name = |row: &Bar| if row.note.is_empty() { row.name.clone() } else { format!("{}, {}", row.name, row.note) };
    let row = |row: &Bar| (0.0, name(row), row.values.iter().map(cell).collect());
    ValueTable {
        caption: bars.quantity.clone(),
        at: "what".to_owned(),
        columns: bars.series.iter().map(|(name, _)| name.clone()).collect(),
        rows: bars.rows.iter().map(row).collect(),
        panel: None,
    }
}
