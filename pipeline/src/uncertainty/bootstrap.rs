//! The bootstrap of days: how far a figure would move if other days of the same months had been recorded.
//!
//! A year is drawn anew from its days: within every month one day less than there are, with replacement (McCarthy and Snowden
//! 1985, Vital and Health Statistics 2(95); Rao and Wu 1988, doi 10.1080/01621459.1988.10478591). With that one day less the
//! spread of a mean is neither too small nor too large, however few days a month has. A day keeps all its missions, and a mission
//! counts to the day on which it begins: hours of a day are alike, and so are hours of a mission.

use cabin::unit_interval;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use rayon::prelude::*;

/// Years that are drawn: the 100th and the 1,900th of them in their order are the ends of an interval of 90 %.
pub const REPLICATES: usize = 1_999;
/// Where the random numbers begin.
const SEED: u64 = 20_190_724;
/// Share of the drawn years below an interval, and above it.
const TAIL: f64 = 0.05;
/// Months of a year.
pub const MONTHS: usize = 12;

/// How often each day is in each of the drawn years.
pub struct Draws {
    days: usize,
    counts: Vec<u16>,
}

/// What a day adds to a month: a mission at the end of a month has hours in the next one.
#[derive(Debug, Clone)]
pub struct Part {
    /// Place of the day.
    pub day: usize,
    /// Month of the hours, 0 … 11.
    pub month: usize,
    /// Sums of as many quantities as all parts have.
    pub sums: Vec<f64>,
}

impl Draws {
    /// Draws years from days, each with its month; a month of a single day has it every time.
    pub fn new(months: &[u8], replicates: usize, seed: u64) -> Self {
        let mut strata: Vec<Vec<usize>> = vec![Vec::new(); MONTHS + 1];
        for (day, month) in months.iter().enumerate() {
            strata[usize::from(*month).min(MONTHS)].push(day);
        }
        let mut counts = vec![0; replicates * months.len()];
        if !months.is_empty() {
            counts.par_chunks_mut(months.len()).enumerate().for_each(|(year, counts)| {
                let mut dice = ChaCha8Rng::seed_from_u64(seed);
                dice.set_stream(year as u64);
                for days in &strata {
                    match days.as_slice() {
                        [] => {}
                        [day] => counts[*day] = 1,
                        _ => (1..days.len()).for_each(|_| {
                            let place = unit_interval(dice.next_u64()) * days.len() as f64;
                            counts[days[place as usize]] += 1;
                        }),
                    }
                }
            });
        }
        Self { days: months.len(), counts }
    }

    /// The draws of every study; no year at all where a month has a single day, since nobody knows how far that month would
    /// move.
    pub fn of_study(months: &[u8]) -> Self {
        Self::new(months, if single_day_months(months) > 0 { 0 } else { REPLICATES }, SEED)
    }

    /// A statistic of each drawn year, year by year: `outputs` values from the sums of twelve months, `quantities` each.
    pub fn each(
        &self,
        parts: &[Part],
        quantities: usize,
        outputs: usize,
        statistic: impl Fn(&[f64], &mut [f64]) + Sync,
    ) -> Vec<f64> {
        let years = self.counts.len().checked_div(self.days).unwrap_or(0);
        let mut values = vec![f64::NAN; years * outputs];
        let year = |(year, values): (usize, &mut [f64])| {
            let counts = &self.counts[year * self.days..][..self.days];
            let mut months = vec![0.0; MONTHS * quantities];
            for part in parts.iter().filter(|part| counts[part.day] > 0) {
                let count = f64::from(counts[part.day]);
                let sums = &mut months[part.month * quantities..][..quantities];
                sums.iter_mut().zip(&part.sums).for_each(|(sum, of_day)| *sum += count * of_day);
            }
            statistic(&months, values);
        };
        if outputs > 0 {
            values.par_chunks_mut(outputs).enumerate().for_each(year);
        }
        values
    }
}

/// In how many months only one of the days lies.
pub fn single_day_months(months: &[u8]) -> usize {
    (1..=MONTHS as u8).filter(|month| months.iter().filter(|m| *m == month).count() == 1).count()
}

/// The interval of 90 % of a value of drawn years (percentile interval: Davison and Hinkley 1997, section 5.3.1); `None` where
/// too few of them have the value.
pub fn interval(values: impl Iterator<Item = f64>) -> Option<[f64; 2]> {
    let mut values: Vec<f64> = values.filter(|v| v.is_finite()).collect();
    values.sort_by(f64::total_cmp);
    let rank = ((values.len() + 1) as f64 * TAIL).floor() as usize;
    let low = rank.checked_sub(1)?;
    Some([values[low], values[values.len() - 1 - low]])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers around 0 with a variance of 1, by the central limit of twelve uniform ones.
    fn normal(dice: &mut ChaCha8Rng) -> f64 {
        (0..12).map(|_| unit_interval(dice.next_u64())).sum::<f64>() - 6.0
    }

    /// A synthetic study: days with a common deviation, missions and hours with their own, in months of their own level. The mean
    /// of the year is known: 12 months with the levels 1 … 12 count alike.
    fn study(dice: &mut ChaCha8Rng, days_of: impl Fn(usize) -> usize) -> (Vec<u8>, Vec<Part>) {
        let (mut months, mut parts) = (Vec::new(), Vec::new());
        for month in 0..MONTHS {
            for _ in 0..days_of(month) {
                let of_day = normal(dice);
                let mut sums = vec![0.0, 0.0];
                for _ in 0..=(unit_interval(dice.next_u64()) * 2.0) as usize {
                    let of_mission = 0.5 * normal(dice);
                    for _ in 0..2 + (unit_interval(dice.next_u64()) * 10.0) as usize {
                        sums[0] += 1.0;
                        sums[1] += (month + 1) as f64 + of_day + of_mission + normal(dice);
                    }
                }
                parts.push(Part { day: months.len(), month, sums });
                months.push(month as u8 + 1);
            }
        }
        (months, parts)
    }

    fn mean(months: &[f64], out: &mut [f64]) {
        out[0] = months.chunks_exact(2).map(|m| m[1] / m[0]).sum::<f64>() / MONTHS as f64;
    }

    /// In how many of 1,000 studies the interval holds the truth.
    fn coverage(seed: u64, days_of: impl Fn(usize) -> usize) -> f64 {
        let mut dice = ChaCha8Rng::seed_from_u64(seed);
        let holds = (0..1_000).filter(|study_seed| {
            let (months, parts) = study(&mut dice, &days_of);
            let values = Draws::new(&months, 499, *study_seed).each(&parts, 2, 1, mean);
            let [low, high] = interval(values.into_iter()).expect("499 drawn years have an interval");
            (low..=high).contains(&6.5)
        });
        holds.count() as f64 / 1_000.0
    }

    #[test]
    fn prop_intervals_of_90_percent_hold_the_truth_in_90_percent_of_synthetic_studies() {
        let (full, thin) = (coverage(1, |_| 25), coverage(2, |month| if month < 4 { 4 } else { 25 }));
        assert!((0.88..=0.92).contains(&full), "25 days a month: {full}");
        assert!((0.88..=0.92).contains(&thin), "four months of four days: {thin}");
    }

    #[test]
    fn prop_a_month_of_one_day_has_it_in_every_year() {
        let draws = Draws::new(&[3, 4, 4, 4], 50, 1);
        for counts in draws.counts.chunks(4) {
            assert_eq!((counts[0], counts[1..].iter().sum::<u16>()), (1, 2));
        }
    }

    #[test]
    fn prop_the_ends_are_the_100th_and_the_1900th() {
        let ends = interval((1..=REPLICATES).rev().map(|n| n as f64));
        assert_eq!(ends, Some([100.0, 1_900.0]));
        assert_eq!(interval([1.0; 18].into_iter()), None);
        assert_eq!(interval((1..=19).map(f64::from).chain([f64::NAN])), Some([1.0, 19.0]));
    }
}
