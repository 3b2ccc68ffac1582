//! The report of a study, as named bytes.
//!
//! [`render`] is a pure function of a [`StudyReport`], which consists of rows of the database: it knows no files and no
//! clock, so that the same rows give the same bytes. `section` says what the report says, a file a section, as data;
//! `render` turns sections into Markdown and CSV; `figure` draws.

mod answer;
mod document;
mod figure;
mod headline;
mod numbers;
mod render;
mod section;
mod study_report;

pub use figure::{HeatFlowFigure, heat_flow_svg};
pub use headline::headline;
pub use section::{PaperFinding, Verdict, nearest_windows, paper_findings};
pub use study_report::StudyReport;

/// A file of the report.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ReportFile {
    /// Name without a folder.
    pub name: &'static str,
    /// Content.
    pub bytes: Vec<u8>,
}

/// The names of all files that a report can have.
pub const FILES: [&str; 37] = [
    "report.md",
    "aircurtain_setpoint.svg",
    "annual_average.csv",
    "causal_pareto_front.svg",
    "causal_time_resolved.svg",
    "control_annual.csv",
    "control_classes.csv",
    "control_failures.csv",
    "control_outside.csv",
    "control_outside.svg",
    "control_pareto.svg",
    "curtain_threshold.csv",
    "data_quality.csv",
    "data_sample.svg",
    "design_interval.csv",
    "heat_flow_cold.svg",
    "heat_flow_hot.svg",
    "left_out.csv",
    "mission_cold.svg",
    "mission_hot.svg",
    "model_approximations.svg",
    "model_parameters.svg",
    "month_spread.csv",
    "monthly_average.csv",
    "paper_comparison.csv",
    "paper_numbers.csv",
    "pareto.svg",
    "pmv_range.svg",
    "scenarios_overview.svg",
    "setpoint_profile.csv",
    "shadow_fraction.svg",
    "simulated_pareto.svg",
    "simulation_annual.csv",
    "simulation_classes.csv",
    "simulation_failures.csv",
    "sources.csv",
    "temperature_setpoints.svg",
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

/// All files of the report: the page, and beside it every figure and every table of data.
///
/// # Errors
/// [`ReportError`] where template and data do not fit; not for any data of a study.
pub fn render(study: &StudyReport) -> Result<Vec<ReportFile>, ReportError> {
    let sections = section::all(study)?;
    let mut files = vec![ReportFile { name: "report.md", bytes: render::markdown(&sections).into_bytes() }];
    for section in sections {
        for table in &section.tables {
            files.push(ReportFile { name: table.file, bytes: render::csv(table)? });
        }
        let figures = section.figures.into_iter();
        files.extend(figures.map(|figure| ReportFile { name: figure.file, bytes: figure.svg.into_bytes() }));
    }
    Ok(files)
}
