//! In how many samples a limit of comfort binds.

use super::weights_note;
use crate::StudyReport;
use crate::document::{Block, Section, Table};
use crate::numbers::{percent, window};

pub(super) fn section(study: &StudyReport) -> Option<Section> {
    let shown = study.shown_window()?;
    let rows = study.limit_shares.iter().filter(|s| s.window == shown && s.solved_count > 0).map(|s| {
        let share = |n: u64| percent(Some(n as f64 / s.solved_count as f64));
        vec![
            s.design.clone(),
            share(s.lower_count),
            percent(Some(s.lower_weight)),
            share(s.upper_count),
            share(s.heating_count),
            share(s.cooling_count),
            percent(Some(s.cooling_weight)),
            share(s.outside_range_count),
        ]
    });
    let columns = [
        "at the lower limit",
        "weighted",
        "at the upper limit",
        "air unit heats",
        "cools",
        "weighted",
        "outside ISO 7730",
    ];
    Some(
        Section::new(format!("Limits of comfort at PMV {}", window(shown)))
            .with(Block::words(
                "Shares of the solved samples; the weighted ones count every month by its days. The last column is the share of states\n\
                 outside the range of use of ISO 7730, where the PMV is an extrapolation.",
            ))
            .with(Block::Table(Table::new(&["design"], &columns, rows.collect())))
            .with(weights_note(study)),
    )
}
