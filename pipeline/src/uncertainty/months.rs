//! How sure the mean power of a month is, and how many independent samples would be as sure.

use store::{DaySum, MonthDays, MonthSpread};

use super::Year;

/// Every month of every design and window.
pub fn spreads(year: &Year<'_>) -> Vec<MonthSpread> {
    let of_point = |point: usize| {
        let of_month = move |month: &&MonthDays| spread(year, month, point);
        year.months.iter().filter_map(of_month).collect::<Vec<_>>()
    };
    (0..year.points).flat_map(of_point).collect()
}

fn spread(year: &Year<'_>, month: &MonthDays, point: usize) -> Option<MonthSpread> {
    let days: Vec<&DaySum> = month.cells[point].iter().filter(|d| d.samples > 0.0).collect();
    let samples: f64 = days.iter().map(|d| d.samples).sum();
    (samples > 0.0).then(|| {
        let variance = variance_of_mean(&days, samples);
        let independent = variance.filter(|v| *v > 0.0).map(|v| variance_of_sample(&days, samples) / v);
        MonthSpread {
            point: [point / year.windows, point % year.windows],
            month: month.month,
            samples: samples as u64,
            days: days.len() as u64,
            standard_error_w: variance.map(f64::sqrt),
            effective_samples: independent,
        }
    })
}

/// Of a mean of days of unequal length (ratio of two sums, linearised: Cochran 1977, Sampling Techniques, section 6.3); `None`
/// with less than two days.
fn variance_of_mean(days: &[&DaySum], samples: f64) -> Option<f64> {
    let mean = days.iter().map(|d| d.power_w).sum::<f64>() / samples;
    let n = days.len() as f64;
    let squares: f64 = days.iter().map(|d| (d.power_w - mean * d.samples).powi(2)).sum();
    (days.len() > 1).then(|| n / (n - 1.0) * squares / (samples * samples))
}

/// Of a single sample.
fn variance_of_sample(days: &[&DaySum], samples: f64) -> f64 {
    let mean = days.iter().map(|d| d.power_w).sum::<f64>() / samples;
    let squares = days.iter().map(|d| d.power_w2).sum::<f64>() - samples * mean * mean;
    (squares / (samples - 1.0)).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn day(powers_w: &[f64]) -> DaySum {
        DaySum {
            samples: powers_w.len() as f64,
            power_w: powers_w.iter().sum(),
            power_w2: powers_w.iter().map(|p| p * p).sum(),
            ..DaySum::default()
        }
    }

    #[test]
    fn prop_samples_that_repeat_their_day_count_once() {
        let days: Vec<DaySum> = [1.0, 2.0, 4.0, 5.0].map(|p| day(&[p; 6])).into();
        let days: Vec<&DaySum> = days.iter().collect();
        let error = variance_of_mean(&days, 24.0).unwrap();
        // Four numbers with the mean 3: (4 + 1 + 1 + 4) / 3 / 4.
        assert!((error - 10.0 / 12.0).abs() < 1e-12, "{error}");
        let independent = variance_of_sample(&days, 24.0) / error;
        assert!((independent - 60.0 / 23.0 / (10.0 / 12.0)).abs() < 1e-12, "{independent}");
    }

    #[test]
    fn prop_one_day_has_no_spread() {
        assert_eq!(variance_of_mean(&[&day(&[1.0, 2.0])], 2.0), None);
    }
}
