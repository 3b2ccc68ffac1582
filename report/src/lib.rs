//! The tables and figures of a study, as named bytes.
//!
//! [`render`] is a pure function of a [`StudyReport`]: it knows no files, no clock and no database, so that the same
//! study gives the same bytes.

mod figure;
mod findings;
mod headline;
mod heat_flow;
mod markdown;
mod mission_figure;
mod numbers;
mod simulation;
mod tables;

pub use figure::{ParetoPoint, simulated_pareto_svg};
pub use findings::{PaperFinding, Verdict, paper_findings};
pub use headline::headline;
pub use heat_flow::{HeatFlowFigure, heat_flow_svg};
pub use mission_figure::{Curve, MissionFigure, Panel, mission_svg};

use store::{
    AnnualRow, DesignRow, ExclusionCount, LimitShare, MonthRow, MonthlyRow, SimulatedClass, SimulatedYear,
    StatusCounts, StoredFile, StoredFinding,
};

/// Everything that a report says, in the order of the study.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct StudyReport {
    /// Name of the study.
    pub name: String,
    /// A line of the study's author, shown at the top.
    pub note: Option<String>,
    /// Version of the program.
    pub program_version: String,
    /// BLAKE3 of the study with all its defaults.
    pub study_hash: String,
    /// BLAKE3 of all inputs.
    pub input_hash: String,
    /// Designs.
    pub designs: Vec<DesignRow>,
    /// Annual means by design and window.
    pub annual: Vec<AnnualRow>,
    /// Monthly means by design, window and month.
    pub monthly: Vec<MonthlyRow>,
    /// Months that have samples.
    pub months: Vec<MonthRow>,
    /// In how many samples the limits of comfort bind.
    pub limit_shares: Vec<LimitShare>,
    /// Points by status.
    pub status: StatusCounts,
    /// Input files.
    pub files: Vec<StoredFile>,
    /// What was noticed in them.
    pub findings: Vec<StoredFinding>,
    /// Segments without a sample by reason.
    pub exclusions: Vec<ExclusionCount>,
    /// What the numbers rest on.
    pub assumptions: Vec<Assumption>,
    /// Annual means of the simulated missions, by design, window and controller; empty where nothing is simulated.
    pub simulated_years: Vec<SimulatedYear>,
    /// The simulated missions by month, temperature and length.
    pub simulated_classes: Vec<SimulatedClass>,
    /// Two missions in time, and their powers in steady state and simulated; none where nothing is simulated.
    pub mission_figures: Vec<MissionFigure>,
    /// Points of the comparison of both ways.
    pub pareto_points: Vec<ParetoPoint>,
}

/// Something that the numbers rest on.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Assumption {
    /// What it is about.
    pub what: String,
    /// What is assumed.
    pub value: String,
    /// Where it comes from.
    pub source: String,
    /// Whether it stands in for something that the paper does not publish.
    pub substitute: bool,
}

/// A file of the report.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ReportFile {
    /// Name without a folder.
    pub name: &'static str,
    /// Content.
    pub bytes: Vec<u8>,
}

/// The report could not be written.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// The template does not fit the study.
    #[error("the report's template failed: {0}")]
    Template(#[from] minijinja::Error),
    /// A table could not be written.
    #[error("a table of the report failed: {0}")]
    Table(#[from] csv::Error),
}

/// Names of the files of [`StudyReport::mission_figures`].
const MISSION_FILES: [&str; 2] = ["mission_cold.svg", "mission_hot.svg"];

/// All files of the report.
///
/// # Errors
/// [`ReportError`] where template and data do not fit; not for any data of a study.
pub fn render(study: &StudyReport) -> Result<Vec<ReportFile>, ReportError> {
    let findings = paper_findings(study);
    let file = |name, bytes| ReportFile { name, bytes };
    let mut files = vec![
        file("report.md", markdown::render(study, &findings)?.into_bytes()),
        file("annual_average.csv", tables::annual_average(study)?),
        file("monthly_average.csv", tables::monthly_average(study)?),
        file("paper_comparison.csv", tables::paper_comparison(&findings)?),
        file("sources.csv", tables::sources(study)?),
        file("data_quality.csv", tables::data_quality(study)?),
        file("pareto.svg", figure::pareto(study).into_bytes()),
    ];
    if !study.simulated_years.is_empty() {
        files.push(file("simulation_annual.csv", simulation::annual_csv(study)?));
        files.push(file("simulation_classes.csv", simulation::classes_csv(study)?));
    }
    for (figure, name) in study.mission_figures.iter().zip(MISSION_FILES) {
        files.push(file(name, mission_svg(figure)?.into_bytes()));
    }
    if !study.pareto_points.is_empty() {
        files.push(file("simulated_pareto.svg", simulated_pareto_svg(&study.pareto_points).into_bytes()));
    }
    Ok(files)
}

impl StudyReport {
    /// Months without samples, 1 … 12.
    #[must_use]
    pub fn missing_months(&self) -> Vec<u8> {
        (1..=12).filter(|month| !self.months.iter().any(|m| m.month == *month)).collect()
    }

    /// The distinct windows in the order of the study.
    pub(crate) fn windows(&self) -> Vec<(f64, f64)> {
        let mut windows = Vec::new();
        for row in &self.annual {
            if !windows.contains(&(row.pmv_min, row.pmv_max)) {
                windows.push((row.pmv_min, row.pmv_max));
            }
        }
        windows
    }

    pub(crate) fn annual_power_w(&self, design: &str, window: (f64, f64)) -> Option<f64> {
        self.annual_row(design, window)?.hvac_power_w
    }

    pub(crate) fn annual_row(&self, design: &str, (pmv_min, pmv_max): (f64, f64)) -> Option<&AnnualRow> {
        self.annual.iter().find(|r| r.design == design && r.pmv_min == pmv_min && r.pmv_max == pmv_max)
    }
}
