//! What comfort costs in money and emissions, by the user's own figures.

use store::EconomicRow;

use super::{by_window, value};
use crate::StudyReport;
use crate::document::{Block, DataTable, Section, Table};
use crate::numbers::{optional, text};

pub(super) fn section(study: &StudyReport) -> Option<Section> {
    let first = study.economics.first()?;
    let currency = first.currency.clone();
    let of_window = |window| {
        let rows = study.economics.iter().filter(|r| r.window == window).map(row).collect();
        let columns = [
            "kWh a year".to_owned(),
            format!("energy {currency} a year"),
            format!("all costs {currency} a year"),
            format!("net present cost {currency}"),
            format!("break-even price {currency}/kWh"),
            "emissions kg a year".to_owned(),
        ];
        let columns: Vec<&str> = columns.iter().map(String::as_str).collect();
        vec![Block::Table(Table::new("economics.csv", &["design"], &columns, rows))]
    };
    let against = format!(
        "A bus as it is driven in a year. All costs are energy, maintenance and the investment spread over the life with interest; the \
         break-even price of electricity is the one at which a design costs as much as {}.",
        first.designs[1]
    );
    let section = Section { tables: vec![data(study)], ..Section::new("What comfort costs") }
        .asking("Which design is the cheapest over its life, and from which price of electricity on?")
        .with(Block::Paragraph(value(against)))
        .with(by_window(study, of_window));
    Some(section.with(Block::limits(
        "Every price is the study file's own; none is the program's. Prices stay as they are over the life, and the heat of the HVAC system\n\
         is all that differs between designs: no battery, no range, no depot.",
    )))
}

fn row(r: &EconomicRow) -> Vec<String> {
    let whole = |value: Option<f64>| value.map_or_else(|| "–".to_owned(), |v| format!("{v:.0}").replace('-', "−"));
    let price = |value: Option<f64>| value.map_or_else(|| "–".to_owned(), |v| format!("{v:.3}"));
    vec![
        r.designs[0].clone(),
        whole(r.kwh_per_bus_year),
        whole(r.energy_cost_per_year),
        whole(r.annual_cost),
        whole(r.net_present_cost),
        price(r.break_even_price_per_kwh),
        whole(r.emissions_kg_per_year),
    ]
}

fn data(study: &StudyReport) -> DataTable {
    DataTable::of(
        "economics.csv",
        &study.economics,
        &[
            ("design", &|r: &EconomicRow| text(&r.designs[0])),
            ("pmv_min", &|r: &EconomicRow| r.window.pmv_min().to_string()),
            ("pmv_max", &|r: &EconomicRow| r.window.pmv_max().to_string()),
            ("currency", &|r: &EconomicRow| text(&r.currency)),
            ("kwh_per_bus_year", &|r: &EconomicRow| optional(r.kwh_per_bus_year)),
            ("energy_cost_per_year", &|r: &EconomicRow| optional(r.energy_cost_per_year)),
            ("annual_cost", &|r: &EconomicRow| optional(r.annual_cost)),
            ("net_present_cost", &|r: &EconomicRow| optional(r.net_present_cost)),
            ("emissions_kg_per_year", &|r: &EconomicRow| optional(r.emissions_kg_per_year)),
            ("reference_design", &|r: &EconomicRow| text(&r.designs[1])),
            ("saved_kwh_per_year", &|r: &EconomicRow| optional(r.saved_kwh_per_year)),
            ("cost_per_saved_kwh", &|r: &EconomicRow| optional(r.cost_per_saved_kwh)),
            ("break_even_price_per_kwh", &|r: &EconomicRow| optional(r.break_even_price_per_kwh)),
        ],
    )
}
