//! Samples by what they have in common, and the sums of a month.

use cabin::{Operation, celsius};
use ingest::mission::NO_ROUTE;
use ingest::sample::Sample;
use std::collections::BTreeMap;
use store::{Class, ClassSum, MonthSums};

/// Width of a class of ambient temperatures in K.
const WARMTH_K: f64 = 5.0;
/// Classes of votes in one PMV.
const VOTES_PER_PMV: f64 = 10.0;
/// A limit of comfort that binds is met to rounding; of a class's width.
const ROUNDING: f64 = 1e-5;
const WEEKDAYS: [&str; 7] = ["Monday", "Tuesday", "Wednesday", "Thursday", "Friday", "Saturday", "Sunday"];

/// Sums of a month that is being added up.
pub struct Classes {
    places: BTreeMap<Class, usize>,
    votes: BTreeMap<i64, usize>,
    cells: Vec<Vec<ClassSum>>,
}

/// Those that a sample counts into.
pub struct OfSample<'c> {
    classes: &'c mut Classes,
    places: Vec<usize>,
    sample: &'c Sample,
}

impl Classes {
    pub fn new(points: usize) -> Self {
        Self { places: BTreeMap::new(), votes: BTreeMap::new(), cells: vec![Vec::new(); points] }
    }

    pub fn sample<'c>(&'c mut self, sample: &'c Sample) -> OfSample<'c> {
        let mut places = Vec::new();
        let mut class = |sorted_by: &str, order: i64, name: String| {
            places.push(self.place(Class { sorted_by: sorted_by.to_owned(), order, name }));
        };
        class("year", 0, "all".to_owned());
        class("month", sample.month.into(), format!("{:02}", sample.month));
        if let Some(clock) = sample.clock {
            class("local hour", clock.hour.into(), format!("{:02}", clock.hour));
            class("weekday", clock.weekday.into(), WEEKDAYS[usize::from(clock.weekday) - 1].to_owned());
        }
        let warmth = (celsius(sample.disturbances.ambient_temperature_k) / WARMTH_K).floor();
        let name = format!("{} … {}", WARMTH_K * warmth, WARMTH_K * (warmth + 1.0));
        class("ambient temperature in °C", warmth as i64, name);
        class("route", 0, sample.segment.route.clone().unwrap_or_else(|| NO_ROUTE.to_owned()));
        OfSample { classes: self, places, sample }
    }

    fn place(&mut self, class: Class) -> usize {
        let next = self.places.len();
        *self.places.entry(class).or_insert(next)
    }

    fn vote(&mut self, pmv: f64) -> usize {
        let vote = vote(pmv);
        if let Some(place) = self.votes.get(&vote) {
            return *place;
        }
        let from = vote as f64 / VOTES_PER_PMV;
        let name = format!("{from:.1} … {:.1}", (vote + 1) as f64 / VOTES_PER_PMV);
        let place = self.place(Class { sorted_by: "PMV".to_owned(), order: vote, name });
        self.votes.insert(vote, place);
        place
    }

    /// The sums in the order of the classes.
    pub fn finish(self, month: u8) -> MonthSums {
        let sorted = |cell: Vec<ClassSum>| {
            self.places.values().map(|place| cell.get(*place).copied().unwrap_or_default()).collect()
        };
        let cells = self.cells.into_iter().map(sorted).collect();
        MonthSums { month, classes: self.places.into_keys().collect(), cells }
    }
}

impl OfSample<'_> {
    /// Counts the optimum of a design and window.
    pub fn add(&mut self, point: usize, o: &Operation) {
        let segment = &self.sample.segment;
        let power_w = o.hvac_power_w();
        let vote = self.classes.vote(o.pmv);
        let cell = &mut self.classes.cells[point];
        for place in self.places.iter().copied().chain([vote]) {
            if cell.len() <= place {
                cell.resize(place + 1, ClassSum::default());
            }
            let sum = &mut cell[place];
            sum.samples += 1.0;
            sum.power_w += power_w;
            if let Some(distance_m) = segment.distance_m {
                sum.driven_energy_j += power_w * f64::from(segment.duration_s);
                sum.distance_m += distance_m;
            }
            if let Some(vehicle_power_w) = segment.vehicle_power_w {
                sum.drawn_power_w += power_w;
                sum.vehicle_power_w += vehicle_power_w;
            }
        }
    }
}

/// The class of a vote by its lower end in tenths. The ends that are farther from neutral belong to their class, so that a limit
/// of comfort lies inside.
fn vote(pmv: f64) -> i64 {
    let place = pmv * VOTES_PER_PMV;
    if pmv < 0.0 { (place + ROUNDING).floor() as i64 } else { ((place - ROUNDING).ceil() as i64 - 1).max(0) }
}

#[cfg(test)]
mod tests {
    use super::vote;

    #[test]
    fn prop_a_vote_at_a_limit_lies_inside() {
        let at = [-0.5, -0.5 - 1e-9, 0.5, 0.5 + 1e-9, 0.0, -1e-9, 0.3, 0.25, -0.25];
        assert_eq!(at.map(vote), [-5, -5, 4, 4, 0, 0, 2, 2, -3]);
    }
}
