//! Intervals of the annual means of driven missions, and of how far they are from steady state.

use chrono::{Datelike, NaiveDate};
use chrono_tz::Tz;
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};
use store::{DrivenEnds, DrivenMission, DrivenMissions};

use super::bootstrap::{Draws, Part, interval};
use super::year_mean;

/// Seconds, energy, energy of the optima.
const QUANTITIES: usize = 3;

/// The intervals of driven missions; unknown where a month has a single day.
pub fn driven_ends(points: &[DrivenMissions], zone: Tz) -> Vec<DrivenEnds> {
    let day = |m: &DrivenMission| m.start.with_timezone(&zone).date_naive();
    let days: BTreeSet<NaiveDate> = points.iter().flat_map(|of| &of.missions).map(day).collect();
    let months: Vec<u8> = days.iter().map(|day| day.month() as u8).collect();
    let places: BTreeMap<NaiveDate, usize> = days.into_iter().zip(0..).collect();
    let draws = Draws::of_study(&months);
    let of_point = |of: &DrivenMissions| {
        let part = |m: &DrivenMission| Part {
            day: places[&day(m)],
            month: usize::from(m.month) - 1,
            sums: vec![m.seconds, m.seconds * m.power_w, m.seconds * m.static_power_w],
        };
        let parts: Vec<Part> = of.missions.iter().map(part).collect();
        let values = draws.each(&parts, QUANTITIES, 2, means);
        let ends = |place: usize| interval(values.chunks_exact(2).map(|v| v[place]));
        DrivenEnds { point: of.point.clone(), power_w: ends(0), relative_difference: ends(1) }
    };
    points.par_iter().map(of_point).collect()
}

/// Mean power, and how far it is from that of the optima; within a month every second counts alike.
fn means(months: &[f64], out: &mut [f64]) {
    let [power_w, static_w] = year_mean(months.chunks_exact(QUANTITIES).map(|of| (of[0], [of[1], of[2]])));
    out.copy_from_slice(&[power_w, power_w / static_w - 1.0]);
}
