//! The report's content out of the database, its files onto the disk.

use anyhow::Context;
use report::StudyReport;
use std::path::Path;
use store::Store;

use super::assumptions::assumptions;
use super::input_hash;
use super::missions;
use crate::failure::Failure;
use crate::study::Study;

/// Writes the report and returns what the study found, in a few lines.
pub fn report(study: &Study, store: &mut Store) -> Result<Vec<String>, Failure> {
    let (mission_figures, pareto_points) = missions::figures(study, store)?;
    let content = StudyReport {
        name: study.name.clone(),
        note: study.note.clone(),
        program_version: env!("CARGO_PKG_VERSION").to_owned(),
        study_hash: study.hash.clone(),
        input_hash: input_hash(store)?,
        designs: study.design_rows.clone(),
        annual: store.annual()?,
        monthly: store.monthly()?,
        months: store.months()?,
        limit_shares: store.limit_shares()?,
        status: store.status_counts()?,
        files: store.files()?,
        findings: store.findings()?,
        exclusions: store.exclusion_counts()?,
        assumptions: assumptions(study),
        simulated_years: store.simulated_years()?,
        simulated_classes: store.simulated_classes()?,
        mission_figures,
        pareto_points,
    };
    let files = report::render(&content).map_err(|e| Failure::Inputs(e.into()))?;
    std::fs::create_dir_all(&study.report_dir)
        .with_context(|| format!("cannot make the folder {}", study.report_dir.display()))
        .map_err(Failure::Inputs)?;
    for file in files {
        write_beside(&study.report_dir.join(file.name), &file.bytes).map_err(Failure::Inputs)?;
    }
    Ok(report::headline(&content))
}

/// Writes beside the place and renames, so that a file that is there is whole.
pub fn write_beside(path: &Path, bytes: &[u8]) -> anyhow::Result<()> {
    let mut beside = path.as_os_str().to_owned();
    beside.push(".part");
    std::fs::write(&beside, bytes)
        .and_then(|()| std::fs::rename(&beside, path))
        .with_context(|| format!("cannot write {}; check permissions and free space", path.display()))
}
