//! The question of the study, answered.

use std::fmt::Write as _;

use crate::numbers::{percent_within, watts, window, within};
use crate::study_report::{SHOWN_LIMIT, StudyReport};

/// The limit of a stricter window to compare with ±1.
const STRICTER: f64 = 0.5;

/// The question of the study, answered in two sentences.
pub(crate) fn answer(study: &StudyReport) -> Option<String> {
    let shown = study.shown_window()?;
    let power = |d: &str, w| study.annual_power_w(d, w);
    let cheapest = study.cheapest(shown)?;
    let mut text = format!(
        "Within PMV {}, the design {} is the cheapest: {} W averaged over the year",
        window(shown),
        cheapest.0,
        within(cheapest.1, study.annual_ends(cheapest.0, shown), 0)
    );
    match power("ptc", shown) {
        Some(reference) if cheapest.0 != "ptc" && reference > 0.0 => {
            let ends = study.interval(cheapest.0, shown).and_then(|r| r.reduction_vs_ptc);
            let _ = write!(text, ", {} less than ptc.", percent_within(1.0 - cheapest.1 / reference, ends));
        }
        _ => text.push('.'),
    }
    let stricter = study.windows().into_iter().find(|w| w.is_symmetric() && w.pmv_limit() == STRICTER);
    if let Some((window_of, stricter)) = stricter
        .filter(|_| shown.is_symmetric() && shown.pmv_limit() == SHOWN_LIMIT)
        .and_then(|w| Some((w, power(cheapest.0, w)?)))
    {
        let _ = write!(
            text,
            " Comfort within PMV {} costs {} W more.",
            window(window_of),
            watts(Some(stricter - cheapest.1))
        );
    }
    Some(text)
}
