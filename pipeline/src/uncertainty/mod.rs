//! How sure the year is: intervals from its days, the independent samples of a month, the year without a part of it.

mod annual;
mod bootstrap;
mod days;
mod driven;
mod left_out;
mod months;

use chrono::{Datelike, NaiveDate};
use solve::DAYS_OF_MONTH;
use std::collections::{BTreeMap, BTreeSet};
use store::{MonthDays, MonthSums, Uncertainty};

use self::bootstrap::{Draws, Part, single_day_months};
pub use self::days::{DaysOfMonth, day};
pub use self::driven::driven_ends;

/// Means of the year of what months sum up, each with how many samples or seconds it has: months by their days, within one all
/// alike (paper, eq. meanPower); those without any do not weigh. Not a number where no month has any.
fn year_mean<const N: usize>(months: impl Iterator<Item = (f64, [f64; N])>) -> [f64; N] {
    let (mut weight, mut sums) = (0.0, [0.0; N]);
    for ((count, of_month), days) in months.zip(DAYS_OF_MONTH).filter(|((count, _), _)| *count > 0.0) {
        weight += days;
        sums.iter_mut().zip(of_month).for_each(|(sum, value)| *sum += days * value / count);
    }
    sums.map(|sum| sum / weight)
}

/// The year as days: every month with the sums of its days.
struct Year<'m> {
    months: Vec<&'m MonthDays>,
    points: usize,
    windows: usize,
    /// Every day once, with its place.
    places: BTreeMap<NaiveDate, usize>,
}

impl<'m> Year<'m> {
    fn new(mut months: Vec<&'m MonthDays>, points: usize, windows: usize) -> Self {
        months.sort_by_key(|m| m.month);
        let days: BTreeSet<_> = months.iter().flat_map(|m| m.days.iter().copied()).collect();
        Self { months, points, windows, places: days.into_iter().zip(0..).collect() }
    }

    /// What each day adds to each month: `sums` of the day at a place of the month.
    fn parts(&self, sums: &dyn Fn(&MonthDays, usize) -> Vec<f64>) -> Vec<Part> {
        let of_month = |m: &&MonthDays| -> Vec<Part> {
            let part = |(n, day)| Part { day: self.places[day], month: usize::from(m.month) - 1, sums: sums(m, n) };
            m.days.iter().enumerate().map(part).collect()
        };
        self.months.iter().flat_map(of_month).collect()
    }
}

/// How sure a year is, from the days of all months, those that have changed (`new`) and the others (`kept`), and from its classes.
/// `ptc` is the place of the design with resistive heating, `pmv_1` that of the window ±1.
pub fn uncertainty(
    new: Vec<MonthDays>,
    kept: &[MonthDays],
    classes: &[&MonthSums],
    [points, windows]: [usize; 2],
    ptc: Option<usize>,
    pmv_1: Option<usize>,
) -> Uncertainty {
    let year = Year::new(kept.iter().chain(&new).collect(), points, windows);
    let months: Vec<u8> = year.places.keys().map(|day| day.month() as u8).collect();
    let single_day_months = single_day_months(&months) as u64;
    let (annual, pairs) = annual::intervals(&year, &Draws::of_study(&months), ptc, pmv_1);
    let spreads = months::spreads(&year);
    let left_out = left_out::left_out(&year, classes, ptc);
    let day_count = months.len() as u64;
    Uncertainty { days: new, day_count, single_day_months, annual, pairs, spreads, left_out }
}
