//! In how much of the time a limit of comfort binds.

use cabin::ComfortWindow;
use store::{LimitShare, LimitedRow};

use super::over_windows::{OverWindows, over_windows};
use super::{by_window, value, weights_note};
use crate::StudyReport;
use crate::document::{Block, DataTable, Section, Table};
use crate::figure::{Axis, Chart};
use crate::numbers::{percent, text, watts, window};

pub(super) fn section(study: &StudyReport) -> Option<Section> {
    if study.limit_shares.iter().all(|s| s.solved_count == 0) {
        return None;
    }
    let tables = [Some(data(study)), limited_data(study)].into_iter().flatten().collect();
    let section = Section { tables, ..Section::new("Limits of comfort") }
        .asking("How much of the time are passengers only just as comfortable as was asked for?")
        .with(chart(study).map(|chart| Block::chart("limit_share", "Time at the lower limit of comfort", chart)))
        .with(Block::words(
            "Shares of the solved samples; the weighted ones count every month by its days. The last column is the share of states\n\
             outside the range of use of ISO 7730, where the PMV is an extrapolation.",
        ))
        .with(by_window(study, |w| {
            [Block::Table(table(study, w))].into_iter().chain(meaning(study, w)).chain(limited(study, w)).collect()
        })?);
    Some(section.with(weights_note(study)).with(Block::limits(
        "A limit binds where the optimum lies on it: more comfort would cost power there. Whether a limit binds says nothing on how much.",
    )))
}

fn table(study: &StudyReport, w: ComfortWindow) -> Table {
    let rows = study.limit_shares.iter().filter(|s| s.window == w && s.solved_count > 0).map(|s| {
        let share = |n: u64| percent(Some(n as f64 / s.solved_count as f64));
        vec![
            s.design.clone(),
            share(s.lower_count),
            percent(Some(s.lower_weight)),
            share(s.upper_count),
            share(s.heating_count),
            share(s.cooling_count),
            percent(Some(s.cooling_weight)),
            share(s.outside_range_count),
        ]
    });
    let columns = [
        "at the lower limit",
        "weighted",
        "at the upper limit",
        "air unit heats",
        "cools",
        "weighted",
        "outside ISO 7730",
    ];
    Table::new("limit_share.csv", &["design"], &columns, rows.collect())
}

/// What designs with limits of their own miss.
fn limited(study: &StudyReport, w: ComfortWindow) -> Option<Block> {
    let rows: Vec<Vec<String>> = study.limited.iter().filter(|r| r.window == w).map(limited_row).collect();
    let columns =
        ["hours not met", "of the year", "heat missing W", "at most", "PMV beyond", "at most", "back-up heater W"];
    (!rows.is_empty()).then(|| Block::Table(Table::new("limited_annual.csv", &["limited design"], &columns, rows)))
}

fn limited_row(r: &LimitedRow) -> Vec<String> {
    let [unmet_w, most_w] = r.unmet_heat_w.map(|w| watts(Some(w)));
    let [miss, largest] = r.pmv_miss.map(|vote| format!("{vote:.2}"));
    let back_up = watts(Some(r.backup_heater_power_w));
    vec![r.design.clone(), r.limited.to_string(), percent(Some(r.weight)), unmet_w, most_w, miss, largest, back_up]
}

fn limited_data(study: &StudyReport) -> Option<DataTable> {
    let table = || {
        DataTable::of(
            "limited_annual.csv",
            &study.limited,
            &[
                ("design", &|r: &LimitedRow| text(&r.design)),
                ("pmv_min", &|r: &LimitedRow| r.window.pmv_min().to_string()),
                ("pmv_max", &|r: &LimitedRow| r.window.pmv_max().to_string()),
                ("limited_count", &|r: &LimitedRow| r.limited.to_string()),
                ("limited_weight", &|r: &LimitedRow| r.weight.to_string()),
                ("mean_unmet_heat_w", &|r: &LimitedRow| r.unmet_heat_w[0].to_string()),
                ("largest_unmet_heat_w", &|r: &LimitedRow| r.unmet_heat_w[1].to_string()),
                ("mean_pmv_miss", &|r: &LimitedRow| r.pmv_miss[0].to_string()),
                ("largest_pmv_miss", &|r: &LimitedRow| r.pmv_miss[1].to_string()),
                ("backup_heater_power_w", &|r: &LimitedRow| r.backup_heater_power_w.to_string()),
            ],
        )
    };
    (!study.limited.is_empty()).then(table)
}

fn meaning(study: &StudyReport, w: ComfortWindow) -> Option<Block> {
    let (design, _) = study.cheapest(w)?;
    let s = study.limit_shares.iter().find(|s| s.design == design && s.window == w && s.solved_count > 0)?;
    let idle = 1.0 - (s.heating_count + s.cooling_count) as f64 / s.solved_count as f64;
    Some(Block::Means(value(format!(
        "With {design} at PMV {}, in {} of the hours the air unit neither heats nor cools: sun, passengers and electronics keep the bus \
         comfortable.",
        window(w),
        percent(Some(idle))
    ))))
}

fn chart(study: &StudyReport) -> Option<Chart> {
    let chart = OverWindows {
        title: "Time at the lower limit of comfort".to_owned(),
        told: "Share of the samples whose optimum lies at the lower limit of its comfort window, months weighted by their days."
            .to_owned(),
        quantity: Axis::new("time at the lower limit in %").from(0.0),
        height: 110.0,
    };
    over_windows(study, chart, |design, w| {
        let of = |s: &&LimitShare| s.design == design && s.window == w && s.solved_count > 0;
        study.limit_shares.iter().find(of).map(|s| (100.0 * s.lower_weight, None))
    })
}

fn data(study: &StudyReport) -> DataTable {
    DataTable::of(
        "limit_share.csv",
        &study.limit_shares,
        &[
            ("design", &|s: &LimitShare| text(&s.design)),
            ("pmv_min", &|s| s.window.pmv_min().to_string()),
            ("pmv_max", &|s| s.window.pmv_max().to_string()),
            ("solved_count", &|s| s.solved_count.to_string()),
            ("lower_count", &|s| s.lower_count.to_string()),
            ("upper_count", &|s| s.upper_count.to_string()),
            ("heating_count", &|s| s.heating_count.to_string()),
            ("cooling_count", &|s| s.cooling_count.to_string()),
            ("lower_weight", &|s| s.lower_weight.to_string()),
            ("cooling_weight", &|s| s.cooling_weight.to_string()),
            ("outside_range_count", &|s| s.outside_range_count.to_string()),
        ],
    )
}
