//! How passengers fare on a mission: their mean vote, and how long they ride outside comfort windows.

use cabin::{Lanes, Real};

use crate::Variant;
use crate::average::Votes;

/// How the passengers of a mission fare, by the vote of their last 15 minutes.
#[derive(Debug, Clone, PartialEq)]
pub struct Rides {
    /// Passengers times hours on board.
    pub passenger_hours: f64,
    /// Mean absolute vote of the passengers; `None` where nobody ever is on board.
    pub mean_abs_pmv: Option<f64>,
    /// Passenger-hours with a vote outside each of the variant's windows.
    pub hours_outside: Vec<f64>,
}

/// Sums over all seconds, each weighted by its passengers. What is judged is the vote of the last 15 minutes, a typical ride.
#[derive(Debug, Clone)]
pub(crate) struct Judge<const W: usize> {
    windows: Vec<Window<W>>,
    passenger_s: f64,
    abs_vote: Lanes<W>,
}

/// A window of each lane; one that a lane does not have is never left.
#[derive(Debug, Clone, Copy)]
struct Window<const W: usize> {
    low: Lanes<W>,
    high: Lanes<W>,
    outside_s: Lanes<W>,
}

const HOUR_S: f64 = 3600.0;

impl<const W: usize> Judge<W> {
    pub fn new(variants: &[Variant<'_>; W]) -> Self {
        let most = variants.iter().map(|v| v.windows.len()).max().unwrap_or(0);
        let window = |place: usize| {
            let limit = |of: fn(&cabin::ComfortWindow) -> f64, none: f64| {
                Lanes(std::array::from_fn(|lane| variants[lane].windows.get(place).map_or(none, of)))
            };
            Window {
                low: limit(|w| w.pmv_min(), f64::NEG_INFINITY),
                high: limit(|w| w.pmv_max(), f64::INFINITY),
                outside_s: Lanes::ZERO,
            }
        };
        Self { windows: (0..most).map(window).collect(), passenger_s: 0.0, abs_vote: Lanes::ZERO }
    }

    /// Adds the 15-minute votes of some seconds, and who is on board in each.
    #[inline(always)]
    pub fn add(&mut self, votes: &Votes<W>, passengers: &[f64]) {
        for (vote, passengers) in votes.iter().zip(passengers) {
            if *passengers == 0.0 {
                continue;
            }
            self.passenger_s += passengers;
            self.abs_vote = vote.abs().mul_add(*passengers, self.abs_vote);
            for window in &mut self.windows {
                let below = window.low.above(*vote, Lanes::ONE, Lanes::ZERO);
                window.outside_s = vote.above(window.high, Lanes::ONE, below).mul_add(*passengers, window.outside_s);
            }
        }
    }

    /// What a lane comes to, which has so many windows.
    #[inline(always)]
    pub fn rides(&self, lane: usize, windows: usize) -> Rides {
        Rides {
            passenger_hours: self.passenger_s / HOUR_S,
            mean_abs_pmv: (self.passenger_s > 0.0).then(|| self.abs_vote.0[lane] / self.passenger_s),
            hours_outside: self.windows.iter().take(windows).map(|w| w.outside_s.0[lane] / HOUR_S).collect(),
        }
    }
}
