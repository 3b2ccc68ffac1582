//! How much a sample counts in the year.

/// Days of the months of a year of 365 days.
pub const MONTH_DAYS: [u32; 12] = [31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31];

/// Weights of the samples by month.
#[derive(Debug, Clone, PartialEq)]
pub struct MonthWeights {
    /// Weight of one sample of each month, January first; 0 for a month without samples.
    pub sample_weight: [f64; 12],
    /// Months without samples, 1 … 12.
    pub missing: Vec<u8>,
}

/// The weight of one sample is `1/N_month · days_month/365` (paper, before eq. meanPower), so that every month counts
/// by its days however many samples it has. Months without samples leave the sum below 1: the weights are then scaled
/// up to the months present.
#[must_use]
pub fn month_weights(counts: &[u64; 12]) -> MonthWeights {
    let present: u32 = MONTH_DAYS.iter().zip(counts).filter(|(_, n)| **n > 0).map(|(d, _)| d).sum();
    let mut weights = MonthWeights { sample_weight: [0.0; 12], missing: Vec::new() };
    for (month, (&days, &count)) in MONTH_DAYS.iter().zip(counts).enumerate() {
        if count == 0 {
            weights.missing.push(month as u8 + 1);
        } else {
            weights.sample_weight[month] = f64::from(days) / f64::from(present) / count as f64;
        }
    }
    weights
}
