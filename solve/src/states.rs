//! The cabin states that the optima of a sample can take, with the radiant heaters off and on.
//!
//! These are the states at the limits of the windows, at lower limits where the unit heats and at upper ones where it cools,
//! and the passive states between them, without heat from the air unit. No other state is an optimum.
//!
//! The heat that a vote takes rises with the vote, so that whoever goes from neutral outward sees once where it changes its
//! sign, and needs no limit of that kind beyond. The walks go over votes that are fixed, each predicted from the last two;
//! limits and passive states lie between two fixed votes and are predicted from these. That makes a state the same to the
//! last bit whatever else the grid asks for, so that optima computed at different times fit together, and leaves states that do
//! not wait for each other: those with the heaters off and on, and the limits between two fixed votes, are found abreast. So
//! are two fixed votes in a row, although the second one may turn out to be beyond need.

use cabin::{Cabin, Heaters, Lanes, Real, State, Target};

use crate::abreast::{Found, Guess, LANES, Search};
use crate::grid::Limit;
use crate::steady::Seen;

/// Limits between two fixed votes that are found abreast, each with heaters off and on.
const LIMITS: usize = LANES / 2;
/// The heaters of the lanes then.
const HEATERS: [Heaters; LANES] = [Heaters::Off, Heaters::On, Heaters::Off, Heaters::On];

/// The states of a sample, kept from sample to sample. The first index is 0 with the heaters off, 1 with them on.
#[derive(Debug, Clone)]
pub(crate) struct States {
    /// Without and with air curtain.
    pub passive: [[Seen; 2]; 2],
    /// At the grid's limits.
    pub limits: [Vec<Seen>; 2],
    /// Of the walk at work: its states at the fixed votes from neutral outward.
    fixed: Vec<Fixed>,
    /// The next of them, where it was found together with the last.
    ahead: Option<Fixed>,
}

/// States at a fixed vote, with heaters off and on.
#[derive(Debug, Clone, Copy)]
struct Fixed {
    vote: f64,
    found: Found,
}

/// Which way a walk goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Way {
    /// To colder votes, where the unit is needed at lower limits as long as it heats.
    Colder,
    /// To warmer ones, where it is needed at upper limits as long as it cools.
    Warmer,
}

impl States {
    pub fn new(limits: usize) -> Self {
        let needless = || vec![Seen::Needless; limits];
        Self { passive: [[Seen::Needless; 2]; 2], limits: [needless(), needless()], fixed: Vec::new(), ahead: None }
    }

    /// Finds the states of a sample for the heaters off and on, and designs without and with air curtain, as far as they are
    /// wanted.
    pub fn find(&mut self, cabin: &Cabin<'_>, limits: &[Limit], wanted: [[bool; 2]; 2]) {
        self.passive = [[Seen::Needless; 2]; 2];
        for seen in &mut self.limits {
            seen.fill(Seen::Needless);
        }
        let neutral = Fixed::new(cabin, 0.0, Guess::Is(&State::of(&[cabin.rough_state(START_K); LANES])));
        let first_warm = limits.partition_point(|l| l.pmv < 0.0);
        self.walk(cabin, Walk { limits, wanted, way: Way::Colder }, &neutral, (0..first_warm).rev());
        self.walk(cabin, Walk { limits, wanted, way: Way::Warmer }, &neutral, first_warm..limits.len());
    }

    /// From neutral outward in fixed steps of the vote as far as limits need it, and to all limits and passive states on that
    /// way.
    fn walk(
        &mut self,
        cabin: &Cabin<'_>,
        walk: Walk<'_>,
        neutral: &Fixed,
        places: impl Iterator<Item = usize> + Clone,
    ) {
        self.fixed.clear();
        self.ahead = None;
        self.fixed.push(*neutral);
        let mut places = places.peekable();
        // As far as windows that begin beyond neutral ask for it.
        let anyway = places.clone().filter(|&place| walk.is_of_other_end(place)).last();
        let anyway = anyway.map_or(0, |place| walk.limits[place].fixed);
        while let Some(&place) = places.peek() {
            let after = walk.limits[place].fixed;
            while self.fixed.len() <= after {
                if !(after <= anyway || walk.needed(&self.fixed[self.fixed.len() - 1]).as_flattened().contains(&true)) {
                    break;
                }
                self.step(cabin, walk.way);
            }
            if self.fixed.len() <= after {
                break;
            }
            let mut some = [place; LIMITS];
            let mut count = 0;
            while let Some(place) = places.next_if(|&place| count < LIMITS && walk.limits[place].fixed == after) {
                some[count] = place;
                count += 1;
            }
            self.between(cabin, &walk, after, &some[..count]);
        }
        self.passive_states(cabin, &walk);
    }

    /// To the next fixed vote; the one after it is found abreast.
    fn step(&mut self, cabin: &Cabin<'_>, way: Way) {
        if let Some(fixed) = self.ahead.take() {
            self.fixed.push(fixed);
            return;
        }
        let step = if way == Way::Warmer { FIXED_STEP } else { -FIXED_STEP };
        let vote = |after: usize| (self.fixed.len() + after) as f64 * step;
        let votes = [vote(0), vote(1)];
        let guess = match self.fixed.as_slice() {
            [.., before, last] => Guess::Beyond(&last.found.state, &before.found.state),
            [last] => Guess::Along(&last.found.state),
            [] => return,
        };
        let target = Target::Vote(Lanes(std::array::from_fn(|lane| votes[lane / 2])));
        let found = Search { cabin, target, heaters: HEATERS, guess }.run();
        self.fixed.push(Fixed { vote: votes[0], found: found.pair(0) });
        self.ahead = Some(Fixed { vote: votes[1], found: found.pair(1) });
    }

    /// The states at some limits that lie between two fixed votes, or at the second of them.
    fn between(&mut self, cabin: &Cabin<'_>, walk: &Walk<'_>, after: usize, places: &[usize]) {
        let last = &self.fixed[after];
        let before = &self.fixed[after.saturating_sub(1)];
        let needed = walk.needed(before).map(|needed| needed.contains(&true));
        let votes: [f64; LIMITS] = std::array::from_fn(|n| walk.limits[places[n.min(places.len() - 1)]].pmv);
        let found: Option<Found> = votes.iter().any(|vote| *vote != last.vote).then(|| {
            let search = Search {
                cabin,
                target: Target::Vote(Lanes(std::array::from_fn(|lane| votes[lane / 2]))),
                heaters: HEATERS,
                guess: Guess::Beyond(&last.found.state, &before.found.state),
            };
            search.run()
        });
        for (n, place) in places.iter().enumerate() {
            for (on, limits) in self.limits.iter_mut().enumerate() {
                if !(walk.is_of_other_end(*place) || needed[on]) {
                    continue;
                }
                let (at, lane) = match &found {
                    Some(found) if votes[n] != last.vote => (found, 2 * n + on),
                    _ => (&last.found, on),
                };
                limits[*place] = match before.found.settles[on] && last.found.settles[on] {
                    true => at.seen(cabin, lane),
                    false => Seen::Lost,
                };
            }
        }
    }

    /// The passive states on the way: the unit is needed at neutral and no more at the last fixed vote.
    fn passive_states(&mut self, cabin: &Cabin<'_>, walk: &Walk<'_>) {
        let (Some(first), Some(last)) = (self.fixed.first(), self.fixed.last()) else { return };
        let (at_first, at_last) = (walk.needed(first), walk.needed(last));
        let mut wanted = [(0, 0); LANES];
        let mut count = 0;
        for (on, curtain) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            if at_first[on][curtain] && !at_last[on][curtain] {
                wanted[count] = (on, curtain);
                count += 1;
            }
        }
        if count == 0 {
            return;
        }
        // Lanes that are left over find the first one once more.
        let mut guesses = [self.passive_guess(walk, wanted[0]); LANES];
        for lane in 1..count {
            guesses[lane] = self.passive_guess(walk, wanted[lane]);
        }
        let first = wanted[0];
        wanted[count..].fill(first);
        let search = Search {
            cabin,
            target: Target::passive(Lanes(wanted.map(|(_, curtain)| cabin.door_loss_share(curtain == 1)))),
            heaters: wanted.map(|(on, _)| HEATERS[on]),
            guess: Guess::Is(&State::of(&guesses)),
        };
        let found = search.run();
        for (lane, (on, curtain)) in wanted.into_iter().enumerate() {
            self.passive[on][curtain] = found.seen(cabin, lane);
        }
    }

    /// Between the last fixed vote at which the unit is needed and the next one.
    fn passive_guess(&self, walk: &Walk<'_>, (on, curtain): (usize, usize)) -> State {
        let after = self.fixed.partition_point(|fixed| walk.needed(fixed)[on][curtain]);
        let (before, last) = (&self.fixed[after - 1], &self.fixed[after]);
        let (state, other) = (last.found.state.lane(on), before.found.state.lane(on));
        // Hermite's cubic through the votes over the heat, at no heat.
        let of = |fixed: &Fixed, state: &State| {
            let (heat_w, slope_w_k) = &fixed.found.air_unit_heat_w[curtain];
            (heat_w.0[on], state.pmv_slope / slope_w_k.0[on])
        };
        let ((heat0_w, slope0), (heat1_w, slope1)) = (of(before, &other), of(last, &state));
        let width_w = heat1_w - heat0_w;
        let (s, rest) = (-heat0_w / width_w, heat1_w / width_w);
        let vote = rest * rest * ((1.0 + 2.0 * s) * before.vote + s * width_w * slope0)
            + s * s * ((1.0 + 2.0 * rest) * last.vote - rest * width_w * slope1);
        state.beyond(vote, &other)
    }
}

impl Fixed {
    fn new(cabin: &Cabin<'_>, vote: f64, guess: Guess<'_>) -> Self {
        let search = Search { cabin, target: Target::Vote(Lanes::splat(vote)), heaters: HEATERS, guess };
        Self { vote, found: search.run() }
    }
}

/// What a walk is to find.
#[derive(Debug, Clone, Copy)]
struct Walk<'l> {
    limits: &'l [Limit],
    wanted: [[bool; 2]; 2],
    way: Way,
}

impl Walk<'_> {
    /// Whether windows end there that begin beyond neutral, so that its state is asked for in any case.
    fn is_of_other_end(&self, place: usize) -> bool {
        match self.way {
            Way::Colder => self.limits[place].upper,
            Way::Warmer => self.limits[place].lower,
        }
    }

    /// Whether the unit is needed at a fixed vote, or might be for all that is known.
    fn needed(&self, fixed: &Fixed) -> [[bool; 2]; 2] {
        std::array::from_fn(|on| {
            std::array::from_fn(|curtain| {
                let heat_w = fixed.found.air_unit_heat_w[curtain].0.0[on];
                let needed = match self.way {
                    // None at neutral is the passive state, which the colder walk finds.
                    Way::Colder => heat_w >= 0.0,
                    Way::Warmer => heat_w < 0.0,
                };
                self.wanted[on][curtain] && (needed || !fixed.found.settles[on])
            })
        })
    }
}

/// Distance of the fixed votes.
const FIXED_STEP: f64 = 0.375;

/// The first fixed vote that is not before a vote, by its place from neutral.
pub(crate) fn fixed_vote(pmv: f64) -> usize {
    (pmv.abs() / FIXED_STEP).ceil() as usize
}

/// Where the search for the first state starts, in K.
pub(crate) const START_K: f64 = 295.0;
