//! The months of the year, and heating and cooling apart, in each comfort window.

use cabin::ComfortWindow;

use super::{by_window, value, weights_note};
use crate::StudyReport;
use crate::document::{Block, DataTable, Section, Table};
use crate::figure::palette::of_designs;
use crate::figure::{Axis, Chart, Mark, Panel, Ticks};
use crate::numbers::{month, optional, percent, text, watts, window};

pub(super) fn section(study: &StudyReport) -> Option<Section> {
    let of = |w: ComfortWindow| {
        let mut blocks = vec![Block::chart("monthly", "Mean HVAC power by month", chart(study, w))];
        blocks.push(Block::Table(months(study, w)));
        blocks.push(Block::words(
            "Heating and cooling apart, in W over the year; radiant heaters and air curtains count to the side on which the air unit works:",
        ));
        blocks.push(Block::Table(parts(study, w)));
        blocks.extend(meaning(study, w));
        blocks
    };
    let section = Section { tables: vec![data(study)], ..Section::new("Monthly mean HVAC power in W") }
        .asking("In which months does the power go, and into heating or into cooling?");
    Some(section.with(by_window(study, of)?).with(weights_note(study)).with(Block::limits(
        "A month rests on the hours that missions have in it, which the table counts; the weight is what one of them has in the year.",
    )))
}

fn power_w(study: &StudyReport, design: &str, w: ComfortWindow, month: u8) -> Option<f64> {
    let of = |r: &&store::MonthlyRow| r.design == design && r.month == month && r.window == w;
    study.monthly.iter().find(of).and_then(|r| r.hvac_power_w)
}

fn months(study: &StudyReport, w: ComfortWindow) -> Table {
    let designs = study.design_names();
    let row = |m: &store::MonthRow| {
        let head = [month(m.month).to_owned(), m.sample_count.to_string(), format!("{:.3e}", m.sample_weight)];
        head.into_iter().chain(designs.iter().map(|d| watts(power_w(study, d, w, m.month)))).collect()
    };
    let rows = study.months.iter().map(row).collect();
    let columns: Vec<&str> = ["samples", "weight of a sample"].into_iter().chain(designs.iter().copied()).collect();
    Table::new("monthly_average.csv", &["month"], &columns, rows)
}

fn parts(study: &StudyReport, w: ComfortWindow) -> Table {
    let rows = study.design_names().into_iter().filter_map(|d| study.annual_row(d, w));
    let rows =
        rows.map(|r| vec![r.design.clone(), watts(r.heating_power_w), watts(r.cooling_power_w), watts(r.hvac_power_w)]);
    Table::new("annual_average.csv", &["design"], &["heating", "cooling", "total"], rows.collect())
}

/// Where the power of the cheapest design goes.
fn meaning(study: &StudyReport, w: ComfortWindow) -> Option<Block> {
    let (design, annual_w) = study.cheapest(w)?;
    let months = study.months.iter().filter_map(|m| Some((power_w(study, design, w, m.month)?, m.month)));
    let months: Vec<(f64, u8)> = months.collect();
    let most = months.iter().max_by(|a, b| a.0.total_cmp(&b.0))?;
    let least = months.iter().min_by(|a, b| a.0.total_cmp(&b.0))?;
    let heating_w = study.annual_row(design, w)?.heating_power_w.filter(|_| annual_w > 0.0)?;
    (months.len() > 1).then(|| {
        Block::Means(value(format!(
            "With {design} at PMV {}, {} takes the most, {} W, and {} the least, {} W; {} of the year's energy goes into heating.",
            window(w),
            month(most.1),
            watts(Some(most.0)),
            month(least.1),
            watts(Some(least.0)),
            percent(Some(heating_w / annual_w))
        )))
    })
}

fn chart(study: &StudyReport, w: ComfortWindow) -> Chart {
    let names = study.design_names();
    let line = |(name, style)| {
        let at = |m: &store::MonthRow| Some((f64::from(m.month), power_w(study, name, w, m.month)? / 1e3));
        Mark::line(name, style, study.months.iter().filter_map(at).collect())
    };
    Chart {
        title: format!("Mean HVAC power by month at PMV {}", window(w)),
        told: "Over the hours in service of each month.".to_owned(),
        columns: 1,
        panels: vec![Panel {
            x: Axis::new("month").from(1.0).to(12.0).with(Ticks::Months),
            y: Axis::new("mean HVAC power in kW").from(0.0),
            marks: names.iter().copied().zip(of_designs(&names)).map(line).collect(),
            ..Panel::default()
        }],
        height: 120.0,
    }
}

fn data(study: &StudyReport) -> DataTable {
    DataTable::of(
        "monthly_average.csv",
        &study.monthly,
        &[
            ("design", &|r| text(&r.design)),
            ("pmv_limit", &|r| r.window.pmv_limit().to_string()),
            ("pmv_min", &|r| r.window.pmv_min().to_string()),
            ("pmv_max", &|r| r.window.pmv_max().to_string()),
            ("month", &|r| r.month.to_string()),
            ("hvac_power_w", &|r| optional(r.hvac_power_w)),
            ("sample_count", &|r| r.sample_count.to_string()),
        ],
    )
}
