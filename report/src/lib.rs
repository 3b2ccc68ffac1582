//! The report of a study, as named bytes.
//!
//! [`render`] is a pure function of a [`StudyReport`], which consists of rows of the database: it knows no files and no
//! clock, so that the same rows give the same bytes. `section` says what the report says, a file a section, as data;
//! `render` turns sections into Markdown and CSV; `figure` draws.

mod answer;
mod climates;
mod document;
mod figure;
mod headline;
mod numbers;
mod render;
mod section;
mod study_report;
mod words;

pub use climates::{Climate, Climates};
pub use figure::{HeatFlowFigure, heat_flow_svg};
pub use headline::headline;
pub use section::{PaperFinding, Verdict, nearest_windows, paper_findings};
pub use study_report::StudyReport;

use document::DataTable;

/// A file of the report.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ReportFile {
    /// Name without a folder.
    pub name: String,
    /// Content.
    pub bytes: Vec<u8>,
}

/// The names of all files that a report can have.
pub const FILES: [&str; 83] = [
    "report.html",
    "report.md",
    "aircurtain_setpoint.svg",
    "aircurtain_setpoint_values.csv",
    "annual_average.csv",
    "assumptions.csv",
    "causal_pareto_front.svg",
    "causal_pareto_front_values.csv",
    "causal_time_resolved.svg",
    "causal_time_resolved_values.csv",
    "comfort_cost.svg",
    "comfort_cost_values.csv",
    "control_annual.csv",
    "control_classes.csv",
    "control_failures.csv",
    "control_outside.csv",
    "control_outside.svg",
    "control_outside_values.csv",
    "control_pareto.svg",
    "control_pareto_values.csv",
    "curtain_threshold.csv",
    "data_quality.csv",
    "data_sample.svg",
    "data_sample_values.csv",
    "design_interval.csv",
    "designs.csv",
    "economics.csv",
    "excluded.csv",
    "heat_flow_cold.svg",
    "heat_flow_cold_values.csv",
    "heat_flow_hot.svg",
    "heat_flow_hot_values.csv",
    "left_out.csv",
    "limit_share.csv",
    "limit_share.svg",
    "limit_share_values.csv",
    "limited_annual.csv",
    "mission_cold.svg",
    "mission_cold_values.csv",
    "mission_hot.svg",
    "mission_hot_values.csv",
    "model_approximations.svg",
    "model_approximations_values.csv",
    "model_parameters.svg",
    "model_parameters_values.csv",
    "month_spread.csv",
    "month_spread.svg",
    "month_spread_values.csv",
    "monthly.svg",
    "monthly_average.csv",
    "monthly_values.csv",
    "paper_comparison.csv",
    "paper_numbers.csv",
    "pareto.svg",
    "pareto_values.csv",
    "pmv_range.svg",
    "pmv_range_values.csv",
    "reduction.svg",
    "reduction_values.csv",
    "scenarios_overview.svg",
    "scenarios_overview_values.csv",
    "sensitivity_index.csv",
    "sensitivity_result.csv",
    "sensitivity_swing.csv",
    "setpoint_profile.csv",
    "shadow_fraction.svg",
    "shadow_fraction_values.csv",
    "simulated_pareto.svg",
    "simulated_pareto_values.csv",
    "simulation.svg",
    "simulation_annual.csv",
    "simulation_classes.csv",
    "simulation_failures.csv",
    "simulation_values.csv",
    "sobol_indices.svg",
    "sobol_indices_values.csv",
    "sources.csv",
    "temperature_setpoints.svg",
    "temperature_setpoints_values.csv",
    "tornado.svg",
    "tornado_values.csv",
    "variant_annual.csv",
    "variant_setting.csv",
];

/// The report could not be made.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// The template of a figure does not fit its content.
    #[error("the template of a figure failed: {0}")]
    Template(#[from] minijinja::Error),
    /// A table could not be written.
    #[error("a table of the report failed: {0}")]
    Table(#[from] csv::Error),
}

/// All files of the report: the page, its twin in Markdown, and beside them every figure and every table of data.
///
/// # Errors
/// [`ReportError`] where template and data do not fit; not for any data of a study.
pub fn render(study: &StudyReport) -> Result<Vec<ReportFile>, ReportError> {
    let sections = section::all(study);
    let mut files = vec![
        ReportFile { name: "report.html".to_owned(), bytes: render::html(&sections)?.into_bytes() },
        ReportFile { name: "report.md".to_owned(), bytes: render::markdown(&sections).into_bytes() },
    ];
    for section in &sections {
        let table = |table: &DataTable| -> Result<ReportFile, ReportError> {
            Ok(ReportFile { name: table.file.clone(), bytes: render::csv(table)? })
        };
        for data in &section.tables {
            files.push(table(data)?);
        }
        for figure in section.figures() {
            let svg = render::svg(figure, figure::Form::File)?;
            files.push(ReportFile { name: format!("{}.svg", figure.file), bytes: svg.into_bytes() });
            files.push(table(&render::data(figure))?);
        }
    }
    Ok(files)
}
