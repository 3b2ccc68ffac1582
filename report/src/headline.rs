//! What a study found, in a few lines.

use crate::answer::answer;
use crate::numbers::{percent, window};
use crate::section::{Verdict, paper_findings};
use crate::study_report::StudyReport;

/// Up to three lines: the cheapest design, what binds, and how the paper's findings compare. None without optima.
#[must_use]
pub fn headline(study: &StudyReport) -> Vec<String> {
    let Some(answer) = answer(study) else { return Vec::new() };
    let mut lines = vec![answer];
    let shown = study.shown_window();
    let binding = study.limit_shares.iter().rev().find(|s| Some(s.window) == shown && s.solved_count > 0);
    if let (Some(s), Some(shown)) = (binding, shown) {
        let share = |count: u64| percent(Some(count as f64 / s.solved_count as f64));
        lines.push(format!(
            "With {} at PMV {}, the lower limit binds in {} of the hours, the air unit cools in {}.",
            s.design,
            window(shown),
            share(s.lower_count),
            share(s.cooling_count)
        ));
    }
    let findings = paper_findings(study);
    let count = |verdict| findings.iter().filter(|f| f.verdict == verdict).count();
    let (within, outside) = (count(Verdict::Within), count(Verdict::Outside));
    lines.push(format!(
        "Of the paper's findings, {within} hold here, {outside} lie outside their range, {} are not covered.",
        count(Verdict::NotCovered)
    ));
    lines
}
