//! The sums that the views give, once more from the rows.

use cabin::Outcome;
use ingest::sample::Sample;
use std::collections::BTreeMap;
use store::{Store, StoredOptimum};
use study::Study;

use super::table::{Kind, Table};
use crate::PipelineError;

/// Days of the months of a year without 29 February (paper, eq. meanPower).
const DAYS: [u32; 12] = [31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31];

/// The power of every solved point, by design and window.
#[derive(Debug, Default)]
pub struct Sums {
    powers: BTreeMap<(usize, usize), Vec<(i64, f64)>>,
}

impl Sums {
    pub fn add(&mut self, row: &StoredOptimum) {
        if let Some(Outcome::Solved(operation, _)) = &row.outcome {
            let key = (row.design, row.window);
            self.powers.entry(key).or_default().push((row.sample_id, operation.hvac_power_w()));
        }
    }

    /// Weights, monthly and annual averages against those of the views.
    pub fn compare(
        &self,
        study: &Study,
        samples: &[Sample],
        store: &mut Store,
        table: &mut Table,
    ) -> Result<(), PipelineError> {
        let month_of: BTreeMap<i64, usize> = samples.iter().map(|s| (s.id, usize::from(s.month))).collect();
        let mut counts = [0_u32; 12];
        samples.iter().for_each(|s| counts[usize::from(s.month) - 1] += 1);
        let days: u32 = (0..12).filter(|&m| counts[m] > 0).map(|m| DAYS[m]).sum();

        let mut total = 0.0;
        for month in store.months()? {
            let m = usize::from(month.month) - 1;
            let weight = f64::from(DAYS[m]) / f64::from(days) / f64::from(counts[m]);
            close(table, Kind::Weights, month.sample_weight, weight, 1e-12, || format!("month {}", month.month));
            total += month.sample_weight * month.sample_count as f64;
        }
        close(table, Kind::Weights, total, 1.0, 1e-12, || "sum over the year".to_owned());

        let (monthly, annual) = (store.monthly()?, store.annual()?);
        for (&(design, window), powers) in &self.powers {
            let (name, comfort) = (&study.design_rows[design].name, study.grid.windows()[window]);
            let mut sums = [(0.0, 0_u32); 12];
            for (sample, power_w) in powers {
                if let Some(month) = month_of.get(sample) {
                    sums[month - 1].0 += power_w;
                    sums[month - 1].1 += 1;
                }
            }
            let here = || format!("{name}, PMV {} … {}", comfort.pmv_min(), comfort.pmv_max());
            let (mut year, mut solved_days) = (0.0, 0.0);
            for (m, (sum, count)) in sums.iter().enumerate().filter(|(_, s)| s.1 > 0) {
                let mean_w = sum / f64::from(*count);
                year += mean_w * f64::from(DAYS[m]);
                solved_days += f64::from(DAYS[m]);
                let row =
                    monthly.iter().find(|r| r.design == *name && usize::from(r.month) == m + 1 && r.window == comfort);
                let stored_w = row.and_then(|r| r.hvac_power_w).unwrap_or(f64::NAN);
                close(table, Kind::Monthly, stored_w, mean_w, 1e-9, || format!("{}, month {}", here(), m + 1));
            }
            let row = annual.iter().find(|r| r.design == *name && r.window == comfort);
            let stored_w = row.and_then(|r| r.hvac_power_w).unwrap_or(f64::NAN);
            close(table, Kind::Annual, stored_w, year / solved_days, 1e-9, here);
        }
        Ok(())
    }
}

fn close(table: &mut Table, kind: Kind, stored: f64, computed: f64, relative: f64, place: impl FnOnce() -> String) {
    let off = (stored - computed).abs();
    table.check(kind, off <= relative * computed.abs().max(1e-300), off, || {
        format!("{}: {stored} instead of {computed}", place())
    });
}
