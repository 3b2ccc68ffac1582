//! The year without one route, one year or one month: whether a part of it carries a finding.

use chrono::Datelike;
use std::collections::{BTreeMap, BTreeSet};
use store::{LeftOut, MonthSums};

use super::bootstrap::MONTHS;
use super::{Year, year_mean};

/// Samples and power of each month.
type Months = [[f64; 2]; MONTHS];

/// A part of the year for every point.
struct Left {
    kind: &'static str,
    name: String,
    of_point: Vec<Months>,
}

/// Every part, for each design and window; a year, a month or a route alone has nothing to be compared with.
pub fn left_out(year: &Year<'_>, classes: &[&MonthSums], ptc: Option<usize>) -> Vec<LeftOut> {
    let whole: Vec<Months> = (0..year.points).map(|point| sums(year, point, &|_| true)).collect();
    let mut rows = Vec::new();
    for left in parts(year, classes) {
        let rest: Vec<Months> = whole.iter().zip(&left.of_point).map(|(all, part)| less(all, part)).collect();
        let power_w: Vec<Option<f64>> = rest.iter().map(mean_w).collect();
        for (point, months) in rest.iter().enumerate() {
            let (Some(hvac_power_w), Some(all_w)) = (power_w[point], mean_w(&whole[point])) else { continue };
            let reference = ptc.and_then(|ptc| power_w[ptc * year.windows + point % year.windows]);
            rows.push(LeftOut {
                point: [point / year.windows, point % year.windows],
                kind: left.kind,
                name: left.name.clone(),
                samples: months.iter().map(|m| m[0]).sum::<f64>() as u64,
                months: months.iter().filter(|m| m[0] > 0.0).count() as u64,
                hvac_power_w,
                change: if all_w > 0.0 { hvac_power_w / all_w - 1.0 } else { 0.0 },
                reduction_vs_ptc: reference.filter(|w| *w > 0.0).map(|w| 1.0 - hvac_power_w / w),
            });
        }
    }
    rows
}

fn parts(year: &Year<'_>, classes: &[&MonthSums]) -> Vec<Left> {
    let mut parts = Vec::new();
    let years: BTreeSet<i32> = year.places.keys().map(Datelike::year).collect();
    for left in &years {
        let of_point = (0..year.points).map(|point| sums(year, point, &|day| day.year() == *left)).collect();
        parts.push(Left { kind: "year", name: left.to_string(), of_point });
    }
    for month in &year.months {
        let place = usize::from(month.month) - 1;
        let only = |point| {
            let all = sums(year, point, &|_| true);
            std::array::from_fn(|m| if m == place { all[m] } else { [0.0; 2] })
        };
        let of_point = (0..year.points).map(only).collect();
        parts.push(Left { kind: "month", name: format!("{:02}", month.month), of_point });
    }
    let mut routes: BTreeMap<&str, Vec<Months>> = BTreeMap::new();
    for month in classes {
        for (place, class) in month.classes.iter().enumerate().filter(|(_, c)| c.sorted_by == "route") {
            let of = routes.entry(&class.name).or_insert_with(|| vec![[[0.0; 2]; MONTHS]; year.points]);
            for (months, cell) in of.iter_mut().zip(&month.cells) {
                months[usize::from(month.month) - 1] = [cell[place].samples, cell[place].power_w];
            }
        }
    }
    parts.extend(routes.into_iter().map(|(name, of_point)| Left { kind: "route", name: name.to_owned(), of_point }));
    parts
}

fn sums(year: &Year<'_>, point: usize, wanted: &dyn Fn(&chrono::NaiveDate) -> bool) -> Months {
    let mut sums = [[0.0; 2]; MONTHS];
    for month in &year.months {
        let of = &mut sums[usize::from(month.month) - 1];
        for (_, day) in month.days.iter().zip(&month.cells[point]).filter(|(day, _)| wanted(day)) {
            of[0] += day.samples;
            of[1] += day.power_w;
        }
    }
    sums
}

fn less(all: &Months, part: &Months) -> Months {
    std::array::from_fn(|m| [all[m][0] - part[m][0], all[m][1] - part[m][1]])
}

fn mean_w(months: &Months) -> Option<f64> {
    let [power_w] = year_mean(months.iter().map(|[samples, power_w]| (*samples, [*power_w])));
    power_w.is_finite().then_some(power_w)
}

#[cfg(test)]
mod tests {
    use super::*;
    use chrono::NaiveDate;
    use store::{DaySum, MonthDays};

    #[test]
    fn prop_a_mission_counts_to_the_year_in_which_it_begins() {
        let day = |text: &str| text.parse::<NaiveDate>().unwrap();
        let sum = |samples, power_w| DaySum { samples, power_w, ..DaySum::default() };
        let january = MonthDays {
            month: 1,
            days: vec![day("2019-12-31"), day("2020-01-02"), day("2021-01-02")],
            cells: vec![vec![sum(1.0, 10.0), sum(2.0, 40.0), sum(1.0, 50.0)]],
        };
        let december = MonthDays { month: 12, days: vec![day("2019-12-31")], cells: vec![vec![sum(1.0, 30.0)]] };
        let year = Year::new(vec![&january, &december], 1, 1);
        let rows = left_out(&year, &[], Some(0));
        let without = |name: &str| rows.iter().find(|r| r.name == name).unwrap();
        assert_eq!((without("2019").hvac_power_w, without("2019").months), (30.0, 1));
        assert_eq!((without("2020").hvac_power_w, without("2020").samples), (30.0, 3));
        assert_eq!((without("01").hvac_power_w, without("12").hvac_power_w), (30.0, 25.0));
        // Both months have 31 days: (25 + 30) / 2.
        assert!((without("12").change - (25.0 / 27.5 - 1.0)).abs() < 1e-12);
        assert_eq!(without("2021").reduction_vs_ptc, Some(0.0));
    }
}
