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

/// Seconds that are judged at once: in most of them nobody enters or leaves a window.
const AT_ONCE: usize = 60;

/// Sums over all seconds, each weighted by its passengers. What is judged is the vote of the last 15 minutes, a typical ride.
#[derive(Debug, Clone)]
pub(crate) struct Judge<const W: usize> {
    windows: Vec<Window<W>>,
    passenger_s: f64,
    abs_vote: Lanes<W>,
    /// Seconds with passengers that windows have not judged yet: the first so many of these.
    waiting: usize,
    votes: [Lanes<W>; AT_ONCE],
    on_board: [f64; AT_ONCE],
}

/// A window of each lane; one that a lane does not have is never left.
#[derive(Debug, Clone, Copy)]
struct Window<const W: usize> {
    low: Lanes<W>,
    high: Lanes<W>,
    outside_s: Lanes<W>,
}

impl<const W: usize> Window<W> {
    /// 1 where the first vote is below it or the second one above.
    #[inline(always)]
    fn is_left(&self, below: Lanes<W>, above: Lanes<W>) -> Lanes<W> {
        above.above(self.high, Lanes::ONE, self.low.above(below, Lanes::ONE, Lanes::ZERO))
    }
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
        Self {
            windows: (0..most).map(window).collect(),
            passenger_s: 0.0,
            abs_vote: Lanes::ZERO,
            waiting: 0,
            votes: [Lanes::ZERO; AT_ONCE],
            on_board: [0.0; AT_ONCE],
        }
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
            self.votes[self.waiting] = *vote;
            self.on_board[self.waiting] = *passengers;
            self.waiting += 1;
            if self.waiting == AT_ONCE {
                self.judge_windows();
            }
        }
    }

    /// Judges the seconds that wait.
    #[inline(always)]
    pub fn judge_windows(&mut self) {
        let seconds = || self.votes.iter().zip(&self.on_board).take(self.waiting);
        let (mut lowest, mut highest, mut passenger_s) = (self.votes[0], self.votes[0], 0.0);
        for (vote, passengers) in seconds() {
            (lowest, highest) = (lowest.min(*vote), highest.max(*vote));
            passenger_s += passengers;
        }
        for window in &mut self.windows {
            let (always, ever) = (window.is_left(highest, lowest), window.is_left(lowest, highest));
            // To the same bit either way, so that no lane sees another.
            let outside_s = if (ever - always).any() {
                let add = |sum, (vote, passengers): (&_, &f64)| window.is_left(*vote, *vote).mul_add(*passengers, sum);
                seconds().fold(Lanes::ZERO, add)
            } else {
                always * passenger_s
            };
            window.outside_s = window.outside_s + outside_s;
        }
        self.waiting = 0;
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::average::VOTE_S;

    const LIMITS: [f64; 4] = [0.2, 0.5, 0.9, 3.0];

    fn vote(lane: usize, second: usize) -> f64 {
        (second as f64 * 1e-3 * (1 + lane) as f64).sin() * 0.3 * lane as f64
    }

    fn passengers(second: usize) -> f64 {
        (second / 50 % 4) as f64 * 0.7
    }

    fn outside_s(lanes: [usize; 4]) -> [Vec<u64>; 4] {
        let window = |limit: f64| Window { low: Lanes([-limit; 4]), high: Lanes([limit; 4]), outside_s: Lanes::ZERO };
        let windows = LIMITS.into_iter().map(window).collect();
        let (votes, on_board) = ([Lanes::ZERO; AT_ONCE], [0.0; AT_ONCE]);
        let mut judge = Judge { windows, passenger_s: 0.0, abs_vote: Lanes::ZERO, waiting: 0, votes, on_board };
        for from in (0..20_000).step_by(VOTE_S) {
            let votes = std::array::from_fn(|j| Lanes(lanes.map(|lane| vote(lane, from + j))));
            let on_board: [f64; VOTE_S] = std::array::from_fn(|j| passengers(from + j));
            judge.add(&votes, &on_board);
        }
        judge.judge_windows();
        std::array::from_fn(|lane| judge.windows.iter().map(|w| w.outside_s.0[lane].to_bits()).collect())
    }

    #[test]
    fn prop_a_minute_is_judged_as_its_seconds_are_and_no_lane_sees_another() {
        let together = outside_s([0, 1, 2, 3]);
        for (lane, judged) in together.iter().enumerate() {
            for (judged, limit) in judged.iter().zip(LIMITS) {
                let outside = |second: &usize| vote(lane, *second).abs() > limit;
                let expected: f64 = (0..20_000).filter(outside).map(passengers).sum();
                let judged = f64::from_bits(*judged);
                assert!((judged - expected).abs() <= 1e-9 * expected, "{lane}, {limit}: {judged} {expected}");
            }
            assert_eq!(&outside_s([lane; 4])[0], judged);
        }
        assert!(together[1][0] > 0.0_f64.to_bits() && together[3][3] == 0.0_f64.to_bits());
    }
}
