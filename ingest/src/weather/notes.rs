//! What is noticed while a weather file is read.

use super::format::Layout;
use super::values::{PerQuantity, Quantity};
use crate::parse::likely_cause;
use crate::{Finding, FindingKind};

/// Share of a column's values above which a file with unusable ones is refused.
pub(crate) const MAX_UNUSABLE_SHARE: f64 = 0.1;
/// So few say nothing of the column, where others can be used.
const FEW_UNUSABLE: u64 = 5;

/// Whether so many unusable values say that the column is something else.
pub(crate) fn are_too_many(unusable: u64, values: u64) -> bool {
    let few = unusable < FEW_UNUSABLE && unusable < values;
    unusable > 0 && !few && unusable as f64 > MAX_UNUSABLE_SHARE * values as f64
}

/// What was noticed, one finding for each kind and column.
#[derive(Default)]
pub(crate) struct Notes {
    pub list: Vec<Finding>,
    /// Whether stamps are without an offset of their own.
    pub bare_stamps: bool,
    /// How many values there are that can be read.
    pub values: PerQuantity<u64>,
    /// How many cannot, with the line and the text of the first.
    unreadable: PerQuantity<Option<(u64, u64, String)>>,
}

impl Notes {
    pub fn add(&mut self, kind: FindingKind, column: &str, line: u64, message: impl FnOnce() -> String) {
        match self.list.iter_mut().find(|f| f.kind == kind && f.column.as_deref() == Some(column)) {
            Some(finding) => {
                finding.count += 1;
                if finding.line > Some(line) {
                    (finding.line, finding.message) = (Some(line), message());
                }
            }
            None => self.list.push(Finding::whole(kind, message()).in_column(column).at_line(line)),
        }
    }

    /// A value that cannot be read.
    pub fn unreadable(&mut self, quantity: Quantity, column: &str, line: u64, text: &str) {
        let text: String = text.chars().take(40).collect();
        let of_column = self.unreadable.get_mut(quantity).get_or_insert_with(|| (0, line, text.clone()));
        of_column.0 += 1;
        self.add(FindingKind::RefusedValue, column, line, || format!("{text:?}: not a number; taken as missing"));
    }

    /// How many rows have a finding of a kind.
    pub fn count(&self, kind: FindingKind) -> u64 {
        self.list.iter().filter(|finding| finding.kind == kind).map(|finding| finding.count).sum()
    }

    /// Why a file is refused: a column that is mostly unreadable.
    pub fn refusal(&self, layout: &Layout) -> Option<Finding> {
        Quantity::ALL.into_iter().find_map(|quantity| {
            let (count, line, text) = self.unreadable.get(quantity).as_ref()?;
            let values = count + self.values.get(quantity);
            if !are_too_many(*count, values) {
                return None;
            }
            let message = format!(
                "{text:?}: {count} of {values} values cannot be used, more than {:.0} %; probably {}",
                100.0 * MAX_UNUSABLE_SHARE,
                likely_cause(text)
            );
            let column = layout.column(quantity);
            Some(Finding::whole(FindingKind::RefusedValue, message).in_column(column).at_line(*line).times(*count))
        })
    }
}
