//! Causal controllers over the year: what extracted profiles reach beside steady state, and published setpoints beside them.

use cabin::ComfortWindow;
use store::{ControlPoint, ControlYear, Outside};

use super::control_front::{Coordinate, Front, Verdict, controllers_chart, verdicts};
use super::{value, weights_note};
use crate::StudyReport;
use crate::document::{Block, DataTable, Section, Span, Table};
use crate::figure::Chart;
use crate::numbers::{of_point, optional, percent, signed_percent, signed_percent_within, text, watts, window, within};

/// The last of the designs that are driven stands for them; all are in the tables of data.
pub(super) fn section(study: &StudyReport) -> Option<Section> {
    let mut tables = Vec::new();
    if !study.control_failures.is_empty() {
        tables.push(failures(study));
    }
    if study.control_years.is_empty() && tables.is_empty() {
        return None;
    }
    tables.extend([annual(study), outside(study)]);
    let Some(design) = study.control_years.last().map(|y| y.point.design.clone()) else {
        let text = "No mission could be driven by a controller; control_failures.csv says why.";
        return Some(Section { tables, ..Section::new("Causal controllers") }.with(Block::words(text)));
    };
    let years: Vec<&ControlYear> = study.control_years.iter().filter(|y| y.point.design == design).collect();
    let shown = shown(&years)?;
    let title = format!("Causal controllers over the year: {design}");
    let mut section = Section { tables, ..Section::new(title) }
        .asking("What does a year take with a control that sees the present alone, and how do published setpoints compare?")
        .with(Block::words(
            "Every mission once more, second by second, by a controller that sees the present alone: the paper's state machine and PI controller follow the\n\
             extracted profiles of a window, or setpoints that others have published, with the same air curtains and heaters. Passengers judge by the vote of\n\
             their last 15 minutes: its mean distance from neutral, and the passenger-hours with a vote outside the window.",
        ))
        .with(Block::Table(extracted(study, &years)));
    let verdicts = verdicts(study, &design, shown);
    if !verdicts.is_empty() {
        section = section
            .with(Block::Paragraph(vec![
                Span::Text("Published setpoints beside the extracted ones at the same power (between two windows, a straight line), judged by the mean vote and by\n\
                            the passenger-hours outside PMV "),
                Span::Value(window(shown)),
                Span::Text(":"),
            ]))
            .with(Block::Table(published(&verdicts)));
    }
    for (file, caption, chart) in [
        ("control_pareto", "Annual power over the mean vote", votes(&years)),
        ("control_outside", "Annual power over the passenger-hours outside", hours_outside(study, &design, shown)),
    ] {
        section = section.with_chart(file, caption, chart);
    }
    if let Some(table) = trained(&years) {
        section = section
            .with(Block::words(
                "What is lost where a profile has never seen the year that it drives: profiles of all years, of all other years, and of the year before alone.",
            ))
            .with(Block::Table(table));
    }
    Some(section.with(weights_note(study)).with(meaning(&years, shown, &verdicts)).with(Block::limits(
        "Sensors are exact and the bus is the one of the model. Votes are means over the passengers: single ones may differ.",
    )))
}

/// What the extracted profiles take more than the optima, and how many published setpoints they beat.
fn meaning(years: &[&ControlYear], shown: ComfortWindow, verdicts: &[Verdict]) -> Option<Block> {
    let point = of(years, "extracted").into_iter().find(|y| y.point.window == shown).map(|y| &y.point)?;
    let gap = signed_percent(point.mean_hvac_power_w - point.static_mean_hvac_power_w, point.static_mean_hvac_power_w);
    let beaten = |by: fn(&&Verdict) -> bool| verdicts.iter().filter(by).count();
    let both = beaten(|v| v.mean_vote.is_beaten() && v.outside.is_beaten());
    let mut text = format!("Not knowing the hour costs {gap} of power at PMV {}.", window(shown));
    if !verdicts.is_empty() {
        text += &format!(
            " At the same power the extracted profiles leave less discomfort by both measures than {both} of {} published setpoints.",
            verdicts.len()
        );
    }
    Some(Block::Means(value(text)))
}

/// The window that is driven and is nearest to ±1.
pub(super) fn shown(years: &[&ControlYear]) -> Option<ComfortWindow> {
    let windows = years.iter().map(|y| y.point.window);
    windows.min_by(|a, b| (a.pmv_limit() - 1.0).abs().total_cmp(&(b.pmv_limit() - 1.0).abs()))
}

fn of<'y>(years: &[&'y ControlYear], controller: &str) -> Vec<&'y ControlYear> {
    years.iter().copied().filter(|y| y.point.controller == controller).collect()
}

fn vote(value: Option<f64>) -> String {
    value.map_or_else(|| "–".to_owned(), |v| format!("{v:.2}"))
}

fn extracted(study: &StudyReport, years: &[&ControlYear]) -> Table {
    let row = |y: &&ControlYear| {
        let p = &y.point;
        let ends = of_point(&study.control_intervals, &p.design, p.window, &p.controller);
        vec![
            window(p.window),
            watts(Some(p.static_mean_hvac_power_w)),
            within(p.mean_hvac_power_w, ends.and_then(|e| e.power_w), 0),
            signed_percent_within(
                p.mean_hvac_power_w - p.static_mean_hvac_power_w,
                p.static_mean_hvac_power_w,
                ends.and_then(|e| e.relative_difference),
            ),
            vote(p.static_mean_abs_pmv),
            vote(p.mean_abs_pmv),
            percent(p.outside_fraction),
            p.mission_count.to_string(),
        ]
    };
    let columns = [
        "steady state W",
        "controlled W",
        "gap",
        "steady state mean PMV",
        "controlled mean PMV",
        "passenger-hours outside",
        "missions",
    ];
    Table::new("control_annual.csv", &["profiles of PMV"], &columns, of(years, "extracted").iter().map(row).collect())
}

fn published(verdicts: &[Verdict]) -> Table {
    let row = |v: &Verdict| {
        let beaten = match (v.mean_vote.is_beaten(), v.outside.is_beaten()) {
            (true, true) => "in both",
            (true, false) => "in the mean vote",
            (false, true) => "in the hours outside",
            (false, false) => "in neither",
        };
        let Coordinate { own, extracted } = v.mean_vote;
        let hours = v.outside;
        vec![
            v.controller.clone(),
            beaten.to_owned(),
            watts(Some(v.mean_hvac_power_w)),
            vote(own),
            vote(extracted),
            percent(hours.own),
            percent(hours.extracted),
        ]
    };
    let columns = ["W", "mean PMV", "extracted", "hours outside", "extracted"];
    Table::new(
        "control_outside.csv",
        &["setpoints", "extracted ones are better"],
        &columns,
        verdicts.iter().map(row).collect(),
    )
}

/// `None` where there is one year alone.
fn trained(years: &[&ControlYear]) -> Option<Table> {
    const TRAININGS: [&str; 3] = ["extracted", "extracted-other-years", "extracted-one-year"];
    if of(years, TRAININGS[1]).is_empty() {
        return None;
    }
    let row = |y: &&ControlYear| {
        let mut cells = vec![window(y.point.window)];
        for training in TRAININGS {
            let found = of(years, training).into_iter().find(|o| o.point.window == y.point.window);
            cells.push(watts(found.map(|o| o.point.mean_hvac_power_w)));
            cells.push(vote(found.and_then(|o| o.point.mean_abs_pmv)));
            cells.push(percent(found.and_then(|o| o.point.outside_fraction)));
        }
        cells
    };
    let columns = [
        "all years W",
        "mean PMV",
        "outside",
        "other years W",
        "mean PMV",
        "outside",
        "one year W",
        "mean PMV",
        "outside",
    ];
    Some(Table::new(
        "control_annual.csv",
        &["profiles of PMV"],
        &columns,
        of(years, TRAININGS[0]).iter().map(row).collect(),
    ))
}

/// Lines of steady state and of the extracted profiles, and a point of every other controller.
fn fronts(years: &[&ControlYear], of_point: impl Fn(&ControlPoint) -> Option<(f64, f64)>) -> Vec<Front> {
    let mut fronts = Vec::new();
    let points = of(years, "extracted").iter().filter_map(|y| of_point(&y.point)).collect();
    fronts.push(Front::new("extracted", points));
    let mut names: Vec<&str> = Vec::new();
    for y in years.iter().filter(|y| !y.point.controller.starts_with("extracted")) {
        if !names.contains(&y.point.controller.as_str()) {
            names.push(&y.point.controller);
            let points = of_point(&y.point).into_iter().collect();
            fronts.push(Front::new(&y.point.controller, points));
        }
    }
    fronts
}

fn votes(years: &[&ControlYear]) -> Chart {
    let steady = of(years, "extracted");
    let steady =
        steady.iter().filter_map(|y| Some((y.point.static_mean_abs_pmv?, y.point.static_mean_hvac_power_w / 1e3)));
    let mut all = vec![Front::steady(steady.collect())];
    all.extend(fronts(years, |p| Some((p.mean_abs_pmv?, p.mean_hvac_power_w / 1e3))));
    controllers_chart(
        "A year of causal controllers: power over the mean vote",
        "Annual mean HVAC power over the mean |PMV| of the passengers, by their 15-minute votes.",
        ["mean |PMV|", "annual mean HVAC power in kW"],
        &all,
    )
}

fn hours_outside(study: &StudyReport, design: &str, shown: ComfortWindow) -> Chart {
    let rows = study.control_outside.iter().filter(|o| o.design == design && o.window == shown);
    let point = |o: &Outside| Some((100.0 * o.outside_fraction?, o.mean_hvac_power_w / 1e3));
    let (followed, others): (Vec<&Outside>, Vec<&Outside>) = rows.partition(|o| o.profile.is_some());
    let points = followed.into_iter().filter_map(point).collect();
    // Steady state is never outside its window.
    let mut fronts = vec![Front::steady(Vec::new()), Front::new("extracted", points)];
    fronts.extend(others.into_iter().map(|o| Front::new(&o.controller, point(o).into_iter().collect())));
    controllers_chart(
        "A year of causal controllers: power over the hours outside one window",
        &format!("Annual mean HVAC power over the share of the passenger-hours outside PMV {}.", window(shown)),
        ["passenger-hours outside in %", "annual mean HVAC power in kW"],
        &fronts,
    )
}

fn annual(study: &StudyReport) -> DataTable {
    let ends =
        |y: &ControlYear| of_point(&study.control_intervals, &y.point.design, y.point.window, &y.point.controller);
    DataTable::of(
        "control_annual.csv",
        &study.control_years,
        &[
            ("design", &|y| text(&y.point.design)),
            ("pmv_min", &|y| y.point.window.pmv_min().to_string()),
            ("pmv_max", &|y| y.point.window.pmv_max().to_string()),
            ("controller", &|y| text(&y.point.controller)),
            ("mean_hvac_power_w", &|y| y.point.mean_hvac_power_w.to_string()),
            ("static_mean_hvac_power_w", &|y| y.point.static_mean_hvac_power_w.to_string()),
            ("mean_abs_pmv", &|y| optional(y.point.mean_abs_pmv)),
            ("static_mean_abs_pmv", &|y| optional(y.point.static_mean_abs_pmv)),
            ("passenger_hours", &|y| y.passenger_hours.to_string()),
            ("passenger_hours_outside", &|y| y.passenger_hours_outside.to_string()),
            ("outside_fraction", &|y| optional(y.point.outside_fraction)),
            ("saturated_fraction", &|y| y.saturated_fraction.to_string()),
            ("mission_count", &|y| y.point.mission_count.to_string()),
            ("mean_hvac_power_low_w", &|y| optional(ends(y).and_then(|e| e.power_w).map(|[low, _]| low))),
            ("mean_hvac_power_high_w", &|y| optional(ends(y).and_then(|e| e.power_w).map(|[_, high]| high))),
        ],
    )
}

fn outside(study: &StudyReport) -> DataTable {
    DataTable::of(
        "control_outside.csv",
        &study.control_outside,
        &[
            ("design", &|o| text(&o.design)),
            ("controller", &|o| text(&o.controller)),
            ("profile_pmv_min", &|o| optional(o.profile.map(|w| w.pmv_min()))),
            ("profile_pmv_max", &|o| optional(o.profile.map(|w| w.pmv_max()))),
            ("pmv_min", &|o| o.window.pmv_min().to_string()),
            ("pmv_max", &|o| o.window.pmv_max().to_string()),
            ("mean_hvac_power_w", &|o| o.mean_hvac_power_w.to_string()),
            ("outside_fraction", &|o| optional(o.outside_fraction)),
        ],
    )
}

fn failures(study: &StudyReport) -> DataTable {
    DataTable::of(
        "control_failures.csv",
        &study.control_failures,
        &[("mission", &|f| text(&f[0])), ("design", &|f| text(&f[1])), ("reason", &|f| text(&f[2]))],
    )
}
