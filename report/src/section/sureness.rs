//! How sure the annual figures are: independent hours of each month, savings of design against design, the year without a part.

use cabin::ComfortWindow;
use store::{DesignInterval, LeftOutRow, SpreadRow};

use super::annual::interval_note;
use super::value;
use crate::StudyReport;
use crate::document::{Block, DataTable, Section, Span, Table};
use crate::figure::palette::{COOLING, REST, Style};
use crate::figure::{Axis, Chart, Mark, Panel, Ticks};
use crate::numbers::{month, optional, percent_within, signed, text, watts, window};

pub(super) fn section(study: &StudyReport) -> Option<Section> {
    let shown = study.shown_window()?;
    let (design, _) = study.cheapest(shown)?;
    let of_design = |s: &&SpreadRow| s.design == design && s.window == shown;
    let months: Vec<Vec<String>> = study.month_spreads.iter().filter(of_design).map(month_row).collect();
    let pairs: Vec<Vec<String>> =
        study.design_intervals.iter().filter(|p| p.window == shown && p.saving > 0.0).map(pair_row).collect();
    let left: Vec<Vec<String>> = study
        .left_out
        .iter()
        .filter(|l| l.design == design && l.window == shown && l.kind != "month")
        .map(left_row)
        .collect();
    let of = |words: &'static str| {
        let design = vec![Span::Text(words), Span::Value(format!(" {design} at PMV {}:", window(shown)))];
        Block::Paragraph(design)
    };
    let section = Section { tables: data(study), ..Section::new("How sure these figures are") }
        .asking("How far could other days of the same years have moved these numbers?");
    let mut section = section.with(Block::words(
        "Hours of a day resemble each other, and so do days of a winter. Intervals come from years that are drawn anew from the days on\n\
         which missions begin, month by month; designs are compared within the same drawn years. They hold for the weather of the recorded\n\
         years: what another winter may bring, the table of the year without one of them shows.",
    ));
    if !pairs.is_empty() {
        let columns = ["saving of its power"];
        section = section
            .with(Block::Table(Table::new("design_interval.csv", &["design", "against"], &columns, pairs)))
            .with(study.has_intervals().then(interval_note));
    }
    section = section.with(of("Hours that count as independent, with")).with(Block::Table(Table::new(
        "month_spread.csv",
        &["month"],
        &["hours", "days", "independent hours", "standard error W"],
        months,
    )));
    section = section.with(
        chart(study, design, shown).map(|chart| Block::chart("month_spread", "Hours that count as independent", chart)),
    );
    if !left.is_empty() {
        let columns = ["hours that remain", "W", "change", "saving against ptc"];
        section = section.with(of("The year without a part of it, with")).with(Block::Table(Table::new(
            "left_out.csv",
            &["without"],
            &columns,
            left,
        )));
    }
    Some(section.with(meaning(study, shown)).with(Block::limits(
        "An interval knows the days that were recorded and no others: what is wrong in every hour alike, such as a coefficient of the\n\
         model or a substitute, does not widen it.",
    )))
}

/// How many of the savings are sure.
fn meaning(study: &StudyReport, shown: ComfortWindow) -> Option<Block> {
    let with_ends = study.design_intervals.iter().filter(|p| p.window == shown && p.saving > 0.0);
    let ends: Vec<f64> = with_ends.filter_map(|p| p.ends.map(|[low, _]| low)).collect();
    let sure = ends.iter().filter(|low| **low > 0.0).count();
    (!ends.is_empty()).then(|| {
        Block::Means(value(format!(
            "Of {} pairs of designs at PMV {}, {sure} have a saving whose whole interval is above zero: there other days would not have \
             turned the order around.",
            ends.len(),
            window(shown)
        )))
    })
}

/// The hours of each month, and those that count as independent.
fn chart(study: &StudyReport, design: &str, shown: ComfortWindow) -> Option<Chart> {
    let rows = || study.month_spreads.iter().filter(|s| s.design == design && s.window == shown);
    let hours = rows().map(|s| (f64::from(s.month), s.samples as f64)).collect();
    let independent = rows().filter_map(|s| Some((f64::from(s.month), s.effective_samples?)));
    let lines = [
        Mark::line("hours", Style { colour: REST, ..Style::of_place(0) }, hours),
        Mark::line("independent hours", Style { colour: COOLING, ..Style::of_place(1) }, independent.collect()),
    ];
    (rows().count() > 1).then(|| Chart {
        title: "Hours that count as independent".to_owned(),
        told: format!("With {design} at PMV {}: as many independent hours would be as sure.", window(shown)),
        columns: 1,
        panels: vec![Panel {
            x: Axis::new("month").from(1.0).to(12.0).with(Ticks::Months),
            y: Axis::new("hours").from(0.0),
            marks: lines.into(),
            ..Panel::default()
        }],
        height: 100.0,
    })
}

fn month_row(s: &SpreadRow) -> Vec<String> {
    let independent = s.effective_samples.map_or_else(|| "–".to_owned(), |n| format!("{n:.0}"));
    vec![month(s.month).to_owned(), s.samples.to_string(), s.days.to_string(), independent, watts(s.standard_error_w)]
}

fn pair_row(p: &DesignInterval) -> Vec<String> {
    let [design, other] = p.designs.clone();
    vec![design, other, percent_within(p.saving, p.ends)]
}

fn left_row(l: &LeftOutRow) -> Vec<String> {
    let name = match (l.kind.as_str(), l.name.as_str()) {
        ("route", "none") => "hours on no route".to_owned(),
        ("route", name) => format!("route {name}"),
        (_, name) => name.to_owned(),
    };
    let saving = l.reduction_vs_ptc.map_or_else(|| "–".to_owned(), |s| format!("{:.1} %", 100.0 * s));
    let change = format!("{} %", signed(100.0 * l.change, 1));
    vec![name, l.samples.to_string(), watts(Some(l.hvac_power_w)), change, saving]
}

fn data(study: &StudyReport) -> Vec<DataTable> {
    let pairs = DataTable::of(
        "design_interval.csv",
        &study.design_intervals,
        &[
            ("design", &|r| text(&r.designs[0])),
            ("other_design", &|r| text(&r.designs[1])),
            ("pmv_min", &|r| r.window.pmv_min().to_string()),
            ("pmv_max", &|r| r.window.pmv_max().to_string()),
            ("saving", &|r| r.saving.to_string()),
            ("saving_low", &|r| optional(r.ends.map(|[low, _]| low))),
            ("saving_high", &|r| optional(r.ends.map(|[_, high]| high))),
        ],
    );
    let months = DataTable::of(
        "month_spread.csv",
        &study.month_spreads,
        &[
            ("design", &|r| text(&r.design)),
            ("pmv_min", &|r| r.window.pmv_min().to_string()),
            ("pmv_max", &|r| r.window.pmv_max().to_string()),
            ("month", &|r| r.month.to_string()),
            ("sample_count", &|r| r.samples.to_string()),
            ("day_count", &|r| r.days.to_string()),
            ("standard_error_w", &|r| optional(r.standard_error_w)),
            ("effective_sample_count", &|r| optional(r.effective_samples)),
        ],
    );
    let left = DataTable::of(
        "left_out.csv",
        &study.left_out,
        &[
            ("design", &|r| text(&r.design)),
            ("pmv_min", &|r| r.window.pmv_min().to_string()),
            ("pmv_max", &|r| r.window.pmv_max().to_string()),
            ("kind", &|r| r.kind.clone()),
            ("name", &|r| text(&r.name)),
            ("sample_count", &|r| r.samples.to_string()),
            ("hvac_power_w", &|r| r.hvac_power_w.to_string()),
            ("relative_change", &|r| r.change.to_string()),
            ("reduction_vs_ptc", &|r| optional(r.reduction_vs_ptc)),
        ],
    );
    vec![pairs, months, left]
}
