//! Causal controllers by month and ambient temperature: where the gap to steady state is, and why setpoints are not beaten.

use store::{ControlClass, ControlPoint, ControlYear};

use super::control::shown;
use super::control_front::verdicts;
use crate::StudyReport;
use crate::document::{Block, DataTable, Section, Table};
use crate::numbers::{optional, percent, signed_percent, text, watts, window};

pub(super) fn section(study: &StudyReport) -> Option<Section> {
    let design = &study.control_years.last()?.point.design;
    let years: Vec<&ControlYear> = study.control_years.iter().filter(|y| y.point.design == *design).collect();
    let shown = shown(&years)?;
    let of = |controller: &str| -> Vec<&ControlClass> {
        let same = |p: &ControlPoint| p.controller == controller && p.design == *design && p.window == shown;
        study.control_classes.iter().filter(|c| same(&c.point)).collect()
    };
    let columns = [
        "missions",
        "steady state W",
        "controlled W",
        "gap",
        "steady state mean PMV",
        "controlled mean PMV",
        "passenger-hours outside",
    ];
    let title = format!("Extracted profiles of PMV {}, by class of mission", window(shown));
    let extracted = of("extracted");
    let table =
        Table::new("control_classes.csv", &["by", "class"], &columns, extracted.iter().map(|c| row(c)).collect());
    let section = Section { level: 3, tables: vec![data(study)], ..Section::new(title) }
        .with(Block::words("All designs, windows and controllers are in control_classes.csv."))
        .with(Block::Table(table));
    // Who is not beaten spreads its discomfort otherwise over the temperatures.
    let names: Vec<String> = verdicts(study, design, shown)
        .into_iter()
        .filter(|v| !v.mean_vote.is_beaten() || !v.outside.is_beaten())
        .map(|v| v.controller)
        .collect();
    if names.is_empty() || extracted.is_empty() {
        return Some(section);
    }
    let by_temperature = |c: &&&ControlClass| c.sorted_by != "month";
    let cell = |c: Option<&ControlClass>| {
        let vote = c.and_then(|c| c.point.mean_abs_pmv).map_or_else(|| "–".to_owned(), |v| format!("{v:.2}"));
        format!("{} W, {vote}", watts(c.map(|c| c.point.mean_hvac_power_w)))
    };
    let rows = extracted.iter().filter(by_temperature).map(|class| {
        let same = |name: &String| of(name).into_iter().find(|c| c.class == class.class);
        let others = names.iter().map(|name| cell(same(name)));
        [class.class.clone(), cell(Some(class))].into_iter().chain(others).collect()
    });
    let mut titles = vec![format!("extracted {}", window(shown))];
    titles.extend(names.iter().cloned());
    let titles: Vec<&str> = titles.iter().map(String::as_str).collect();
    Some(
        section
            .with(Block::words(
                "Setpoints that extracted ones do not beat in both measures, by ambient temperature: mean power and mean PMV. A window asks for the same distance\n\
                 from neutral at all temperatures; who asks for more where it is cheap and for less where it is dear can have a lower mean at the same power.",
            ))
            .with(Block::Table(Table::new("control_classes.csv", &["ambient temperature in °C"], &titles, rows.collect()))),
    )
}

fn row(c: &ControlClass) -> Vec<String> {
    let p = &c.point;
    let vote = |value: Option<f64>| value.map_or_else(|| "–".to_owned(), |v| format!("{v:.2}"));
    vec![
        c.sorted_by.clone(),
        c.class.clone(),
        p.mission_count.to_string(),
        watts(Some(p.static_mean_hvac_power_w)),
        watts(Some(p.mean_hvac_power_w)),
        signed_percent(p.mean_hvac_power_w - p.static_mean_hvac_power_w, p.static_mean_hvac_power_w),
        vote(p.static_mean_abs_pmv),
        vote(p.mean_abs_pmv),
        percent(p.outside_fraction),
    ]
}

fn data(study: &StudyReport) -> DataTable {
    DataTable::of(
        "control_classes.csv",
        &study.control_classes,
        &[
            ("design", &|c| text(&c.point.design)),
            ("pmv_min", &|c| c.point.window.pmv_min().to_string()),
            ("pmv_max", &|c| c.point.window.pmv_max().to_string()),
            ("controller", &|c| text(&c.point.controller)),
            ("sorted_by", &|c| c.sorted_by.clone()),
            ("class", &|c| c.class.clone()),
            ("mission_count", &|c| c.point.mission_count.to_string()),
            ("mean_hvac_power_w", &|c| c.point.mean_hvac_power_w.to_string()),
            ("static_mean_hvac_power_w", &|c| c.point.static_mean_hvac_power_w.to_string()),
            ("mean_abs_pmv", &|c| optional(c.point.mean_abs_pmv)),
            ("static_mean_abs_pmv", &|c| optional(c.point.static_mean_abs_pmv)),
            ("outside_fraction", &|c| optional(c.point.outside_fraction)),
        ],
    )
}
