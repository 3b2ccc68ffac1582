//! What the study is, what it found, and what to know before reading on.

use super::missing_names;
use crate::StudyReport;
use crate::answer::answer;
use crate::document::{Block, Prose, Section, Span};

pub(super) fn section(study: &StudyReport) -> Section {
    let versions =
        format!("busclimate {} · study {} · inputs {}", study.program_version, study.study_hash, study.input_hash);
    let samples: u64 = study.months.iter().map(|m| m.sample_count).sum();
    let s = &study.status;
    let points = s.solved + s.infeasible + s.not_converged;
    let counts =
        format!("{samples} hourly samples, {points} points (sample × design × comfort window), {} solved.", s.solved);
    let value = |text: String| Block::Paragraph(vec![Span::Value(text)]);
    let section = Section { level: 1, ..Section::new(&study.name) };
    section
        .with(study.note.clone().map(|note| Block::Quote(vec![Span::Value(note)])))
        .with(answer(study).map(value))
        .with(value(versions))
        .with(value(counts))
        .with(Block::List(warnings(study)))
}

fn warnings(study: &StudyReport) -> Vec<Prose> {
    let mut list = Vec::new();
    let missing = missing_names(study);
    if !missing.is_empty() {
        list.push(vec![
            Span::Strong("Months are missing".to_owned()),
            Span::Text(" ("),
            Span::Value(missing),
            Span::Text("): the annual figures stand for the other months only."),
        ]);
    }
    let refused = study.files.iter().filter(|f| !f.accepted).count();
    if refused > 0 {
        let files = if refused == 1 { "file" } else { "files" };
        list.push(vec![Span::Strong(format!("{refused} input {files} refused")), Span::Text(": see Data quality.")]);
    }
    if study.status.infeasible > 0 {
        list.push(vec![
            Span::Strong(format!("{} points have no operation", study.status.infeasible)),
            Span::Text(" that meets their comfort window; they are left out of the averages."),
        ]);
    }
    if study.status.not_converged > 0 {
        list.push(vec![
            Span::Strong(format!("{} points did not converge", study.status.not_converged)),
            Span::Text("; they are left out of the averages."),
        ]);
    }
    if !study.simulation_failures.is_empty() {
        list.push(vec![
            Span::Strong(format!("{} missions are not simulated", study.simulation_failures.len())),
            Span::Text(" with some design and window; simulation_failures.csv says why."),
        ]);
    }
    list.push(vec![
        Span::Text("COP curves and some constants are "),
        Span::Strong("substitutes for unpublished data".to_owned()),
        Span::Text(": see Assumptions."),
    ]);
    list
}
