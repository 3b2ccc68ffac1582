//! How to get the same bytes again.

use crate::StudyReport;
use crate::document::{Block, Section, Span};

pub(super) fn section(study: &StudyReport) -> Section {
    Section::new("How to repeat this").with(Block::Paragraph(vec![
        Span::Text("The same study file, the same inputs and busclimate "),
        Span::Value(study.program_version.clone()),
        Span::Text(" give these bytes again: "),
        Span::Code("busclimate run"),
        Span::Text(
            ". The hash of\nthe inputs covers the content of every file in sources.csv, that of the study every setting with its default.",
        ),
    ]))
}
