//! What the year depends on: tornado and Sobol' indices of the best equipped design, and all of it as data.

use store::{IndexRow, SensitivityResult, SwingRow};

use super::value;
use crate::StudyReport;
use crate::document::{Block, DataTable, Section, Table};
use crate::figure::palette::{COOLING, HEATING, Style};
use crate::figure::{Bar, Bars};
use crate::numbers::{optional, percent, signed, text, watts, window};

/// Inputs that figures show: the strongest ones.
const SHOWN: usize = 14;
const POWER: &str = "hvac_power_w";

pub(super) fn section(study: &StudyReport) -> Option<Section> {
    let all = &study.sensitivities;
    let powers: Vec<&SensitivityResult> = all.results.iter().filter(|r| r.of.quantity == POWER).collect();
    // The cheapest of the designs that meet the window stands for them.
    let misses = |r: &SensitivityResult| study.misses(&r.of.design, r.of.window);
    let base = |r: &SensitivityResult| r.base_value.unwrap_or(f64::INFINITY);
    let shown = powers.iter().min_by(|a, b| misses(a).cmp(&misses(b)).then(base(a).total_cmp(&base(b))))?;
    let sets = format!(
        "{} sets of {} inputs, seed {}, at PMV {}. Figures are of {}; the tables have all designs.",
        shown.sets,
        all.swings.iter().filter(|s| s.of == shown.of).count(),
        shown.seed,
        window(shown.of.window),
        shown.of.design
    );
    let rows = powers.iter().map(|r| result_row(study, r)).collect();
    let columns = ["W", "mean of the sets W", "standard deviation W", "5 % … 95 % W"];
    let mut section = Section { tables: data(study), ..Section::new("What the year depends on") }
        .asking("Which input moves the annual power most, alone and together with the others?")
        .with(Block::Paragraph(value(sets)))
        .with(Block::Table(Table::new("sensitivity_result.csv", &["design", "strongest input"], &columns, rows)));
    let mut swings: Vec<&SwingRow> = all.swings.iter().filter(|s| s.of == shown.of).collect();
    swings.sort_by(|a, b| b.width().total_cmp(&a.width()));
    let mut indices: Vec<&IndexRow> = all.indices.iter().filter(|i| i.of == shown.of).collect();
    indices.sort_by(|a, b| b.total[0].total_cmp(&a.total[0]));
    if !swings.is_empty() {
        section = section.with(Block::bars("tornado", "One input at a time", tornado(&shown.of.design, &swings)));
    }
    if !indices.is_empty() {
        let caption = "Shares of the variance";
        section = section.with(Block::bars("sobol_indices", caption, sobol(&shown.of.design, &indices)));
    }
    Some(section.with(Block::means(
        "A long bar is leverage: what a change of that input is worth, with all else as it is. A total index well above the one of first\n\
         order says that the input acts through others; an input whose total index is near zero may stay at any value of its range.",
    ))
    .with(Block::limits(
        "Both say as much as the ranges do. Without ranges of its own a study varies each input within a fifth of its value, which compares\n\
         leverages and is nobody's uncertainty. Inputs vary independently; where they cannot, such as glazing that changes both heat loss\n\
         and sun, a variant is the better question.",
    )))
}

fn result_row(study: &StudyReport, r: &SensitivityResult) -> Vec<String> {
    let swings = study.sensitivities.swings.iter().filter(|s| s.of == r.of);
    let strongest = swings.max_by(|a, b| a.width().total_cmp(&b.width())).map(|s| {
        let share = |c: Option<f64>| c.zip(r.base_value).map_or_else(String::new, |(c, base)| percent_of(c, base));
        let [at_low, at_high] = s.changes().map(share);
        format!("{} {} … {}: {at_low} … {at_high}", s.input.name, s.inputs[1], s.inputs[2])
    });
    let [low, high] = r.ends;
    vec![
        r.of.design.clone(),
        strongest.unwrap_or_default(),
        watts(r.base_value),
        watts(Some(r.mean_value)),
        watts(Some(r.sd_value)),
        format!("{} … {}", watts(Some(low)), watts(Some(high))),
    ]
}

fn percent_of(change: f64, base: f64) -> String {
    if base > 0.0 { format!("{} %", signed(100.0 * change / base, 1)) } else { percent(None) }
}

fn tornado(design: &str, swings: &[&SwingRow]) -> Bars {
    let row = |s: &&SwingRow| Bar {
        name: s.input.name.clone(),
        note: format!("{} … {}", short(s.inputs[1]), short(s.inputs[2])),
        values: s.changes().map(|change| change.map(|c| (c, None))).to_vec(),
    };
    Bars {
        title: format!("One input at a time: {design}"),
        told: "Change of the annual mean power with each input at its low and its high value, all others as they are."
            .to_owned(),
        quantity: "change of the annual mean power in W".to_owned(),
        series: vec![
            ("low value".to_owned(), Style::line(COOLING, "", 1.0)),
            ("high value".to_owned(), Style::line(HEATING, "", 1.0)),
        ],
        below_each_other: false,
        rows: swings.iter().take(SHOWN).map(row).collect(),
    }
}

fn sobol(design: &str, indices: &[&IndexRow]) -> Bars {
    let of = |[value, low, high]: [f64; 3]| Some((value, Some([low, high])));
    let row =
        |i: &&IndexRow| Bar { name: i.input.name.clone(), note: String::new(), values: vec![of(i.first), of(i.total)] };
    Bars {
        title: format!("Shares of the variance of the annual power: {design}"),
        told: "Sobol' indices where all inputs vary together, with intervals of 90 %.".to_owned(),
        quantity: "share of the variance".to_owned(),
        series: vec![
            ("first order".to_owned(), Style::line(COOLING, "", 1.0)),
            ("total".to_owned(), Style::line(HEATING, "", 1.0)),
        ],
        below_each_other: true,
        rows: indices.iter().take(SHOWN).map(row).collect(),
    }
}

/// A value of an input with the digits that a figure has room for.
fn short(value: f64) -> String {
    let text = format!("{value:.3}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

fn data(study: &StudyReport) -> Vec<DataTable> {
    let all = &study.sensitivities;
    let results = DataTable::of(
        "sensitivity_result.csv",
        &all.results,
        &[
            ("design", &|r: &SensitivityResult| text(&r.of.design)),
            ("pmv_min", &|r: &SensitivityResult| r.of.window.pmv_min().to_string()),
            ("pmv_max", &|r: &SensitivityResult| r.of.window.pmv_max().to_string()),
            ("quantity", &|r: &SensitivityResult| r.of.quantity.clone()),
            ("base_value", &|r: &SensitivityResult| optional(r.base_value)),
            ("mean_value", &|r: &SensitivityResult| r.mean_value.to_string()),
            ("sd_value", &|r: &SensitivityResult| r.sd_value.to_string()),
            ("low_value", &|r: &SensitivityResult| r.ends[0].to_string()),
            ("high_value", &|r: &SensitivityResult| r.ends[1].to_string()),
            ("set_count", &|r: &SensitivityResult| r.sets.to_string()),
            ("unsolved_count", &|r: &SensitivityResult| r.unsolved.to_string()),
            ("limited_count", &|r: &SensitivityResult| r.limited.to_string()),
            ("seed", &|r: &SensitivityResult| r.seed.to_string()),
        ],
    );
    let swings = DataTable::of(
        "sensitivity_swing.csv",
        &all.swings,
        &[
            ("design", &|r: &SwingRow| text(&r.of.design)),
            ("pmv_min", &|r: &SwingRow| r.of.window.pmv_min().to_string()),
            ("pmv_max", &|r: &SwingRow| r.of.window.pmv_max().to_string()),
            ("quantity", &|r: &SwingRow| r.of.quantity.clone()),
            ("input", &|r: &SwingRow| text(&r.input.name)),
            ("input_base", &|r: &SwingRow| r.inputs[0].to_string()),
            ("input_low", &|r: &SwingRow| r.inputs[1].to_string()),
            ("input_high", &|r: &SwingRow| r.inputs[2].to_string()),
            ("base_value", &|r: &SwingRow| optional(r.values[0])),
            ("low_value", &|r: &SwingRow| optional(r.values[1])),
            ("high_value", &|r: &SwingRow| optional(r.values[2])),
        ],
    );
    let indices = DataTable::of(
        "sensitivity_index.csv",
        &all.indices,
        &[
            ("design", &|r: &IndexRow| text(&r.of.design)),
            ("pmv_min", &|r: &IndexRow| r.of.window.pmv_min().to_string()),
            ("pmv_max", &|r: &IndexRow| r.of.window.pmv_max().to_string()),
            ("quantity", &|r: &IndexRow| r.of.quantity.clone()),
            ("input", &|r: &IndexRow| text(&r.input.name)),
            ("first_order", &|r: &IndexRow| r.first[0].to_string()),
            ("first_order_low", &|r: &IndexRow| r.first[1].to_string()),
            ("first_order_high", &|r: &IndexRow| r.first[2].to_string()),
            ("total_order", &|r: &IndexRow| r.total[0].to_string()),
            ("total_order_low", &|r: &IndexRow| r.total[1].to_string()),
            ("total_order_high", &|r: &IndexRow| r.total[2].to_string()),
        ],
    );
    vec![results, swings, indices]
}
