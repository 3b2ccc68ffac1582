//! The tables as CSV, with every digit.

use csv::Writer;
use std::borrow::Cow;

use crate::{PaperFinding, ReportError, StudyReport};

pub(crate) fn annual_average(study: &StudyReport) -> Result<Vec<u8>, ReportError> {
    let header = [
        "design",
        "pmv_limit",
        "pmv_min",
        "pmv_max",
        "hvac_power_w",
        "heating_power_w",
        "cooling_power_w",
        "sample_count",
        "unsolved_count",
        "unsolved_weight",
        "reduction_vs_ptc",
        "missing_months",
    ];
    let missing = missing_months(study);
    table(&header, study.annual.iter(), |r| {
        vec![
            text(&r.design),
            r.pmv_limit.to_string(),
            r.pmv_min.to_string(),
            r.pmv_max.to_string(),
            optional(r.hvac_power_w),
            optional(r.heating_power_w),
            optional(r.cooling_power_w),
            r.sample_count.to_string(),
            r.unsolved_count.to_string(),
            r.unsolved_weight.to_string(),
            optional(r.reduction_vs_ptc),
            missing.clone(),
        ]
    })
}

pub(crate) fn monthly_average(study: &StudyReport) -> Result<Vec<u8>, ReportError> {
    let header = ["design", "pmv_limit", "pmv_min", "pmv_max", "month", "hvac_power_w", "sample_count"];
    table(&header, study.monthly.iter(), |r| {
        vec![
            text(&r.design),
            r.pmv_limit.to_string(),
            r.pmv_min.to_string(),
            r.pmv_max.to_string(),
            r.month.to_string(),
            optional(r.hvac_power_w),
            r.sample_count.to_string(),
        ]
    })
}

pub(crate) fn paper_comparison(findings: &[PaperFinding]) -> Result<Vec<u8>, ReportError> {
    table(&["finding", "paper", "this_study", "verdict"], findings.iter(), |f| {
        vec![f.claim.to_owned(), f.paper.to_owned(), f.ours.clone(), f.verdict.word().to_owned()]
    })
}

pub(crate) fn sources(study: &StudyReport) -> Result<Vec<u8>, ReportError> {
    let header = ["path", "kind", "blake3", "bytes", "rows", "first_utc", "last_utc", "outcome"];
    table(&header, study.files.iter(), |f| {
        vec![
            text(&f.path),
            f.kind.clone(),
            f.blake3.clone(),
            f.bytes.to_string(),
            f.rows.to_string(),
            f.first_utc.clone().unwrap_or_default(),
            f.last_utc.clone().unwrap_or_default(),
            if f.accepted { "accepted" } else { "refused" }.to_owned(),
        ]
    })
}

pub(crate) fn data_quality(study: &StudyReport) -> Result<Vec<u8>, ReportError> {
    let header = ["path", "file_kind", "finding", "count", "line", "column", "message"];
    table(&header, study.findings.iter(), |f| {
        let finding = &f.finding;
        vec![
            text(&f.path),
            f.file_kind.clone(),
            finding.kind.clone(),
            finding.count.to_string(),
            finding.line.map(|l| l.to_string()).unwrap_or_default(),
            text(finding.column.as_deref().unwrap_or_default()),
            text(&finding.message),
        ]
    })
}

pub(crate) fn table<T>(
    header: &[&str],
    rows: impl Iterator<Item = T>,
    cells: impl Fn(T) -> Vec<String>,
) -> Result<Vec<u8>, ReportError> {
    let mut writer = Writer::from_writer(Vec::new());
    writer.write_record(header)?;
    for row in rows {
        writer.write_record(cells(row))?;
    }
    Ok(writer.into_inner().map_err(|e| csv::Error::from(e.into_error()))?)
}

pub(crate) fn optional(value: Option<f64>) -> String {
    value.map(|v| v.to_string()).unwrap_or_default()
}

/// Text from outside: a spreadsheet must not take it for a formula.
pub(crate) fn text(cell: &str) -> String {
    let formula = cell.starts_with(['=', '+', '-', '@', '\t', '\r']);
    if formula { Cow::Owned(format!("'{cell}")) } else { Cow::Borrowed(cell) }.into_owned()
}

fn missing_months(study: &StudyReport) -> String {
    study.missing_months().iter().map(u8::to_string).collect::<Vec<_>>().join(" ")
}
