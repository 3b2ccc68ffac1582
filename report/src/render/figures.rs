//! Figures as SVG, and the values in them as tables.

use crate::ReportError;
use crate::document::{DataTable, Figure, Picture};
use crate::figure::{
    Form, ValueRow, ValueTable, all_values, bar_table, bar_values, bars_drawn, chart_drawn, heat_flow_drawn,
    heat_flow_values, value_tables,
};
use crate::numbers::{optional, significant, text};

/// A figure as SVG.
pub(crate) fn svg(figure: &Figure, form: Form) -> Result<String, ReportError> {
    match &figure.picture {
        Picture::Chart(chart) => chart_drawn(chart).svg(form),
        Picture::Bars(bars) => bars_drawn(bars).svg(form),
        Picture::HeatFlow(flows) => heat_flow_drawn(flows).svg(form),
    }
}

/// The name of the table of data behind a figure.
pub(crate) fn data_file(figure: &Figure) -> String {
    format!("{}_values.csv", figure.file)
}

/// Every value in a figure, with all digits.
pub(crate) fn data(figure: &Figure) -> DataTable {
    let file = data_file(figure);
    match &figure.picture {
        Picture::Chart(chart) => {
            let row = |v: ValueRow| {
                let [low, high] = v.ends.map_or([None, None], |ends| ends.map(Some));
                vec![
                    text(&v.panel),
                    text(&v.series),
                    text(&v.at_what),
                    v.at.to_string(),
                    text(&v.what),
                    v.value.to_string(),
                    optional(low),
                    optional(high),
                ]
            };
            let columns = vec!["panel", "series", "x_quantity", "x", "y_quantity", "y", "y_low", "y_high"];
            DataTable { file, columns, rows: all_values(chart).into_iter().map(row).collect() }
        }
        Picture::Bars(bars) => {
            let row = |(name, series, value, ends): (String, String, f64, Option<[f64; 2]>)| {
                let [low, high] = ends.map_or([None, None], |ends| ends.map(Some));
                let quantity = text(&bars.quantity);
                vec![text(&name), text(&series), quantity, value.to_string(), optional(low), optional(high)]
            };
            let columns = vec!["name", "series", "quantity", "value", "value_low", "value_high"];
            DataTable { file, columns, rows: bar_values(bars).into_iter().map(row).collect() }
        }
        Picture::HeatFlow(flows) => {
            let row =
                |(what, value, unit): (&str, f64, &str)| vec![what.to_owned(), value.to_string(), unit.to_owned()];
            let rows = heat_flow_values(flows).into_iter().map(row).collect();
            DataTable { file, columns: vec!["what", "value", "unit"], rows }
        }
    }
}

/// The values that a reader can take in, as tables.
pub(crate) fn tables(figure: &Figure) -> Vec<ValueTable> {
    match &figure.picture {
        Picture::Chart(chart) => value_tables(chart),
        Picture::Bars(bars) => vec![bar_table(bars)],
        Picture::HeatFlow(flows) => {
            let row = |(what, value, unit): (&str, f64, &str)| {
                (0.0, what.to_owned(), vec![format!("{} {unit}", significant(value))])
            };
            vec![ValueTable {
                caption: flows.title.clone(),
                at: "what".to_owned(),
                columns: vec!["value".to_owned()],
                rows: heat_flow_values(flows).into_iter().map(row).collect(),
                panel: None,
            }]
        }
    }
}
