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
    let cheapest = shown.and_then(|shown| study.cheapest(shown));
    let of = |s: &&store::LimitShare| Some(s.window) == shown && cheapest.is_some_and(|(design, _)| design == s.design);
    if let (Some(s), Some(shown)) = (study.limit_shares.iter().find(of), shown) {
        lines.push(format!(
            "With {} at PMV {}, the lower limit binds in {} of the time, the air unit cools in {}, weighted alike.",
            s.design,
            window(shown),
            percent(Some(s.lower_weight)),
            percent(Some(s.cooling_weight))
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
