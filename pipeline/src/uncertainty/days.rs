//! Solved samples by the day on which their mission begins.

use cabin::{OperatingMode, Operation};
use chrono::{NaiveDate, TimeDelta};
use chrono_tz::Tz;
use ingest::sample::Sample;
use std::collections::BTreeMap;
use store::{DaySum, MonthDays};

/// Sums of a month that is being added up.
pub struct DaysOfMonth {
    places: BTreeMap<NaiveDate, usize>,
    cells: Vec<Vec<DaySum>>,
}

/// The local day on which the mission of a sample begins: segments are counted from there.
pub fn day(sample: &Sample, zone: Tz) -> NaiveDate {
    let segment = &sample.segment;
    let since = TimeDelta::seconds(i64::from(segment.segment) * i64::from(segment.duration_s));
    (segment.start - since).with_timezone(&zone).date_naive()
}

impl DaysOfMonth {
    pub fn new(points: usize) -> Self {
        Self { places: BTreeMap::new(), cells: vec![Vec::new(); points] }
    }

    /// Place of a day.
    pub fn place(&mut self, day: NaiveDate) -> usize {
        let next = self.places.len();
        *self.places.entry(day).or_insert(next)
    }

    /// Counts the optimum of a design and window.
    pub fn add(&mut self, point: usize, place: usize, sample: &Sample, o: &Operation) {
        let segment = &sample.segment;
        let power_w = o.hvac_power_w();
        let cell = &mut self.cells[point];
        if cell.len() <= place {
            cell.resize(place + 1, DaySum::default());
        }
        let sum = &mut cell[place];
        sum.samples += 1.0;
        sum.power_w += power_w;
        sum.power_w2 += power_w * power_w;
        if o.mode != OperatingMode::Cooling {
            sum.heating_power_w += power_w;
        }
        if let Some(distance_m) = segment.distance_m {
            sum.driven_energy_j += power_w * f64::from(segment.duration_s);
            sum.distance_m += distance_m;
        }
    }

    /// The sums in the order of the days.
    pub fn finish(self, month: u8) -> MonthDays {
        let sorted = |cell: Vec<DaySum>| {
            self.places.values().map(|place| cell.get(*place).copied().unwrap_or_default()).collect()
        };
        let cells = self.cells.into_iter().map(sorted).collect();
        MonthDays { month, days: self.places.into_keys().collect(), cells }
    }
}
