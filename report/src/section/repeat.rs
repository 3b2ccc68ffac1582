//! How to get the same bytes again.

use crate::StudyReport;
use crate::document::{Block, Section, Span};

pub(super) fn section(study: &StudyReport) -> Section {
    let s = &study.status;
    let samples: u64 = study.months.iter().map(|m| m.sample_count).sum();
    let points = s.solved + s.infeasible + s.not_converged;
    let versions =
        format!("busclimate {} · study {} · inputs {}", study.program_version, study.study_hash, study.input_hash);
    let counts =
        format!("{samples} hourly samples, {points} points (sample × design × comfort window), {} solved.", s.solved);
    let value = |text: String| Block::Paragraph(vec![Span::Value(text)]);
    Section::new("How to repeat this").asking("How are the same numbers had again?").with(value(counts)).with(value(versions)).with(Block::Paragraph(vec![
        Span::Text("The same study file, the same inputs and busclimate "),
        Span::Value(study.program_version.clone()),
        Span::Text(" give these bytes again: "),
        Span::Code("busclimate run"),
        Span::Text(
            ". The hash of\nthe inputs covers the content of every file in sources.csv, that of the study every setting with its default.",
        ),
    ]))
}
