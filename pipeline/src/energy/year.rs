//! The year of months: they weigh by their days, within one solved samples alike (paper, eq. meanPower).

use std::collections::BTreeMap;
use store::{Class, ClassSum, ClassYear, MonthRow, MonthSums};

const J_PER_KWH_AND_M_PER_KM: f64 = 3600.0;

/// What every class comes to, for each design and window.
pub fn classes(year: &[&MonthSums], months: &[MonthRow], windows: usize) -> Vec<ClassYear> {
    let points = year.first().map_or(0, |m| m.cells.len());
    (0..points).flat_map(|point| of_point(year, months, point, windows)).collect()
}

fn of_point(year: &[&MonthSums], months: &[MonthRow], point: usize, windows: usize) -> Vec<ClassYear> {
    // Every sample is in the class of the whole year.
    let solved = |month: &MonthSums| {
        let whole = month.classes.iter().position(|class| class.sorted_by == "year");
        whole.map_or(0.0, |place| month.cells[point][place].samples)
    };
    let share = |month: &MonthSums| {
        let row = months.iter().find(|m| m.month == month.month).filter(|_| solved(month) > 0.0);
        row.map_or(0.0, |m| m.sample_weight * m.sample_count as f64)
    };
    let all: f64 = year.iter().map(|m| share(m)).sum();
    let mut classes: BTreeMap<&Class, (ClassSum, u64)> = BTreeMap::new();
    for month in year.iter().filter(|m| share(m) > 0.0) {
        let weight = share(month) / all / solved(month);
        for (class, sum) in month.classes.iter().zip(&month.cells[point]).filter(|(_, sum)| sum.samples > 0.0) {
            let (total, samples) = classes.entry(class).or_default();
            *samples += sum.samples as u64;
            total.samples += weight * sum.samples;
            total.power_w += weight * sum.power_w;
            total.driven_energy_j += weight * sum.driven_energy_j;
            total.distance_m += weight * sum.distance_m;
            total.drawn_power_w += weight * sum.drawn_power_w;
            total.vehicle_power_w += weight * sum.vehicle_power_w;
        }
    }
    let row = |(class, (sum, samples)): (&Class, (ClassSum, u64))| ClassYear {
        design: point / windows,
        window: point % windows,
        class: class.clone(),
        weight: sum.samples,
        hvac_power_w: sum.power_w / sum.samples,
        kwh_per_km: (sum.distance_m > 0.0).then(|| sum.driven_energy_j / sum.distance_m / J_PER_KWH_AND_M_PER_KM),
        vehicle_power_share: (sum.vehicle_power_w > 0.0).then(|| sum.drawn_power_w / sum.vehicle_power_w),
        samples,
    };
    classes.into_iter().map(row).collect()
}
