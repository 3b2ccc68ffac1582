//! Annual power over the comfort that is asked for.

use crate::StudyReport;
use crate::document::{Block, Figure, Section, Span};
use crate::figure::pareto_svg;

const FILE: &str = "pareto.svg";

pub(super) fn section(study: &StudyReport) -> Section {
    let unequal = study.windows().into_iter().filter(|w| !w.is_symmetric()).count();
    let windows = if unequal == 1 { "window is" } else { "windows are" };
    let note = format!("{unequal} unequal comfort {windows} in the tables only.");
    Section { figures: vec![Figure { file: FILE, svg: pareto_svg(study) }], ..Section::new("Pareto fronts") }
        .with(Block::Figure { file: FILE, caption: "Pareto fronts" })
        .with((unequal > 0).then_some(Block::Paragraph(vec![Span::Value(note)])))
}
