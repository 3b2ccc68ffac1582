//! The question of the study, answered in two sentences of its own names.

use std::fmt::Write as _;

use crate::numbers::{percent_within, window, within};
use crate::study_report::StudyReport;

/// The cheapest design, whatever it is called, beside the one that others are compared with, and what more comfort costs. Means
/// are over the hours in service, which are not those of a year.
pub(crate) fn answer(study: &StudyReport) -> Option<String> {
    let shown = study.shown_window()?;
    let (design, power_w) = study.cheapest(shown)?;
    let mut text = format!(
        "Within PMV {}, {design} is the cheapest design: {} W in the mean over the hours in service, months weighted by their days",
        window(shown),
        within(power_w, study.annual_ends(design, shown), 0)
    );
    let reference = study.reference(shown).filter(|(other, _)| *other != design);
    match reference.and_then(|(other, _)| Some((other, study.saving(design, other, shown)?))) {
        Some((other, (saving, ends))) => {
            let _ = write!(text, "; {} less than {other}.", percent_within(saving, ends));
        }
        None => text.push('.'),
    }
    let stricter = study.windows().into_iter().find(|w| w.is_plus_minus(shown.pmv_limit() / 2.0));
    if let Some((stricter, (more, ends))) = stricter
        .filter(|_| shown.is_symmetric() && shown.pmv_limit() > 0.0)
        .and_then(|w| Some((w, study.change(design, w, shown)?)))
    {
        let _ = write!(text, " Comfort within PMV {} takes {} more.", window(stricter), percent_within(more, ends));
    }
    Some(text)
}
