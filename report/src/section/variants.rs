//! Buses that differ from the study's, beside it.

use store::{VariantSetting, VariantYear};

use super::value;
use crate::StudyReport;
use crate::document::{Block, DataTable, Section, Table};
use crate::numbers::{optional, signed, text, watts, window};

pub(super) fn section(study: &StudyReport) -> Option<Section> {
    let shown = study.shown_window()?;
    let rows: Vec<&VariantYear> = study.variants.iter().filter(|v| v.window == shown).collect();
    if rows.is_empty() {
        return None;
    }
    let mut names: Vec<&str> = Vec::new();
    for row in &rows {
        if !names.contains(&row.variant.as_str()) {
            names.push(&row.variant);
        }
    }
    let said = names.iter().map(|name| value(format!("{name}: {}", overrides(study, name)))).collect();
    let cells = |row: &&VariantYear| {
        let change = row.hvac_power_w.zip(row.base_hvac_power_w);
        let relative = change.filter(|(_, base)| *base > 0.0).map(|(own, base)| 100.0 * (own / base - 1.0));
        vec![
            row.variant.clone(),
            row.design.clone(),
            watts(row.hvac_power_w),
            watts(row.base_hvac_power_w),
            change.map_or_else(|| "–".to_owned(), |(own, base)| signed(own - base, 0)),
            relative.map_or_else(|| "–".to_owned(), |percent| format!("{} %", signed(percent, 1))),
            row.limited.to_string(),
            row.unsolved.to_string(),
        ]
    };
    let columns = ["W", "W of the bus", "difference W", "change", "hours limited", "hours unsolved"];
    let table = Table::new("variant_annual.csv", &["variant", "design"], &columns, rows.iter().map(cells).collect());
    let section = Section { tables: data(study), ..Section::new("Buses that differ") }
        .asking("What would the year take with a bus that is built otherwise, or meets something else?")
        .with(Block::List(said))
        .with(Block::Paragraph(value(format!("Comfort window, PMV: {}", window(shown)))))
        .with(Block::Table(table));
    Some(section.with(Block::limits(
        "The same hours are solved for every variant, so that their weather does not blur the difference; passengers, timetable and\n\
         controls do not answer to it. Hours are limited in which the equipment cannot reach the window; what they take is part of\n\
         the mean. Heat capacities are not asked: this is the steady state.",
    )))
}

fn overrides(study: &StudyReport, variant: &str) -> String {
    let setting = |s: &VariantSetting| {
        let base = s.base_value.map_or_else(String::new, |base| format!(" instead of {base}"));
        format!("{} = {}{base}", s.name, s.value)
    };
    let of: Vec<String> = study.variant_settings.iter().filter(|s| s.variant == variant).map(setting).collect();
    if of.is_empty() { "no difference".to_owned() } else { of.join(", ") }
}

fn data(study: &StudyReport) -> Vec<DataTable> {
    let annual = DataTable::of(
        "variant_annual.csv",
        &study.variants,
        &[
            ("variant", &|r: &VariantYear| text(&r.variant)),
            ("design", &|r: &VariantYear| text(&r.design)),
            ("pmv_min", &|r: &VariantYear| r.window.pmv_min().to_string()),
            ("pmv_max", &|r: &VariantYear| r.window.pmv_max().to_string()),
            ("hvac_power_w", &|r: &VariantYear| optional(r.hvac_power_w)),
            ("heating_power_w", &|r: &VariantYear| optional(r.heating_power_w)),
            ("cooling_power_w", &|r: &VariantYear| optional(r.cooling_power_w)),
            ("base_hvac_power_w", &|r: &VariantYear| optional(r.base_hvac_power_w)),
            ("unsolved_count", &|r: &VariantYear| r.unsolved.to_string()),
            ("limited_count", &|r: &VariantYear| r.limited.to_string()),
            ("base_limited_count", &|r: &VariantYear| r.base_limited.to_string()),
        ],
    );
    let settings = DataTable::of(
        "variant_setting.csv",
        &study.variant_settings,
        &[
            ("variant", &|r: &VariantSetting| text(&r.variant)),
            ("name", &|r: &VariantSetting| text(&r.name)),
            ("value", &|r: &VariantSetting| r.value.to_string()),
            ("base_value", &|r: &VariantSetting| optional(r.base_value)),
        ],
    );
    vec![annual, settings]
}
