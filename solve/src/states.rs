//! The cabin states that the optima of a sample can take, for one state of the radiant heaters.
//!
//! These are the states at the limits of the windows, at lower limits where the unit heats and at upper ones where it cools,
//! and the passive states between them, without heat from the air unit. No other state is an optimum.
//!
//! The heat that a vote takes rises with the vote, so that whoever goes from neutral outward sees once where it changes its
//! sign, and needs no limit of that kind beyond. A state is the same to the last bit whatever else the grid asks for, so that
//! optima computed at different times fit together: the walks go over votes that are fixed, each predicted from the last two,
//! limits are predicted from the two fixed votes around them, and passive states from the last two before them.

use cabin::{Cabin, Heaters, StandardRange, State, Target, Temperatures};

use crate::grid::Limit;

/// A cabin state with everything that the comparison of designs needs.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SteadyState {
    pub temperatures: Temperatures,
    pub mean_radiant_k: f64,
    pub pmv: f64,
    pub standard_range: StandardRange,
    /// Heat that the air unit has to bring, without and with air curtain.
    pub air_unit_heat_w: [f64; 2],
    /// 0 while the heaters are off.
    pub radiant_heater_power_w: f64,
}

impl SteadyState {
    pub fn new(cabin: &Cabin<'_>, heaters: Heaters, state: &State) -> Self {
        let t = state.temperatures;
        let mean_radiant_k = cabin.mean_radiant_temperature_k(&t);
        Self {
            temperatures: t,
            mean_radiant_k,
            pmv: state.pmv,
            standard_range: cabin.standard_range(t.cabin_k, mean_radiant_k, state.pmv),
            air_unit_heat_w: heats_w(cabin, state),
            radiant_heater_power_w: match heaters {
                Heaters::Off => 0.0,
                Heaters::On => cabin.radiant_heater_power_w(&t),
            },
        }
    }
}

/// Heat that the air unit has to bring in W, without and with air curtain.
fn heats_w(cabin: &Cabin<'_>, state: &State) -> [f64; 2] {
    [false, true].map(|curtain| cabin.air_unit_heat_w(&state.temperatures, &state.slopes, curtain).0)
}

/// What is known of a state that might be an optimum.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Seen {
    /// It is none: the unit is not needed there.
    Needless,
    /// The iteration did not settle.
    Lost,
    /// The state.
    Settled(SteadyState),
}

/// The states for one state of the heaters, kept from sample to sample.
#[derive(Debug, Clone)]
pub(crate) struct States {
    heaters: Heaters,
    /// Without and with air curtain.
    pub passive: [Seen; 2],
    /// At the grid's limits.
    pub limits: Vec<Seen>,
    /// Of the walk at work: its states at the fixed votes from neutral outward, those that have settled.
    fixed: Vec<State>,
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
    pub fn new(heaters: Heaters, limits: usize) -> Self {
        Self { heaters, passive: [Seen::Needless; 2], limits: vec![Seen::Needless; limits], fixed: Vec::new() }
    }

    /// Finds the states of a sample, for designs without and with air curtain as far as they are wanted.
    pub fn find(&mut self, cabin: &Cabin<'_>, limits: &[Limit], curtains: [bool; 2]) {
        let Some(neutral) = cabin.state(Target::Vote(0.0), self.heaters, &cabin.rough_state(START_K)) else {
            self.passive.fill(Seen::Lost);
            self.limits.fill(Seen::Lost);
            return;
        };
        self.passive.fill(Seen::Needless);
        self.limits.fill(Seen::Needless);
        let first_warm = limits.partition_point(|l| l.pmv < 0.0);
        self.walk(cabin, limits, curtains, &neutral, Way::Colder, (0..first_warm).rev());
        self.walk(cabin, limits, curtains, &neutral, Way::Warmer, first_warm..limits.len());
    }

    /// From neutral outward in fixed steps of the vote, as far as limits need it, and to the passive states on that way.
    fn walk(
        &mut self,
        cabin: &Cabin<'_>,
        limits: &[Limit],
        curtains: [bool; 2],
        neutral: &State,
        way: Way,
        places: impl Iterator<Item = usize>,
    ) {
        self.fixed.clear();
        self.fixed.push(*neutral);
        let mut needed = way.needed(heats_w(cabin, neutral));
        let neutral_needed = needed;
        // What cannot be settled on the way stops the walk.
        let mut lost = false;
        for i in places {
            let limit = &limits[i];
            let wanted = [0, 1].map(|c| curtains[c] && needed[c]);
            let (ends_walk, other) = match way {
                Way::Colder => (limit.lower, limit.upper),
                Way::Warmer => (limit.upper, limit.lower),
            };
            if !(other || ends_walk && wanted.contains(&true)) {
                continue;
            }
            lost = lost || !self.reach(cabin, way, limit.pmv);
            self.limits[i] = if lost { Seen::Lost } else { self.limit(cabin, limit.pmv) };
            if let Seen::Settled(state) = &self.limits[i] {
                let here = way.needed(state.air_unit_heat_w);
                needed = [0, 1].map(|c| needed[c] && here[c]);
            }
        }
        for curtain in [0, 1] {
            // The unit is needed at neutral and no more at the last limit: the passive state lies between.
            if curtains[curtain] && neutral_needed[curtain] && !needed[curtain] {
                self.passive[curtain] = self.passive_state(cabin, way, curtain == 1);
            }
        }
    }

    /// Walks on to the first fixed vote that is not before a vote; `false` where that does not settle.
    fn reach(&mut self, cabin: &Cabin<'_>, way: Way, vote: f64) -> bool {
        let step = if way == Way::Warmer { FIXED_STEP } else { -FIXED_STEP };
        let farthest = (vote / step).ceil();
        while ((self.fixed.len() - 1) as f64) < farthest {
            let next = self.fixed.len() as f64 * step;
            let (before, last) = self.fixed_before(self.fixed.len());
            let mut state = last.toward(next, before);
            if !cabin.settle_state(Target::Vote(next), self.heaters, &mut state) {
                return false;
            }
            self.fixed.push(state);
        }
        true
    }

    /// The state at a vote between the fixed ones.
    fn limit(&self, cabin: &Cabin<'_>, vote: f64) -> Seen {
        let after = (vote.abs() / FIXED_STEP).ceil();
        if vote.abs() == after * FIXED_STEP {
            return Seen::Settled(SteadyState::new(cabin, self.heaters, &self.fixed[after as usize]));
        }
        let (before, last) = self.fixed_before(after as usize + 1);
        self.settled(cabin, Target::Vote(vote), last.toward(vote, before))
    }

    /// The last two of the first so many fixed states.
    fn fixed_before(&self, count: usize) -> (Option<&State>, &State) {
        (count.checked_sub(2).map(|place| &self.fixed[place]), &self.fixed[count - 1])
    }

    fn settled(&self, cabin: &Cabin<'_>, target: Target, mut state: State) -> Seen {
        match cabin.settle_state(target, self.heaters, &mut state) {
            true => Seen::Settled(SteadyState::new(cabin, self.heaters, &state)),
            false => Seen::Lost,
        }
    }

    /// The passive state, from the last fixed vote at which the unit is needed.
    fn passive_state(&self, cabin: &Cabin<'_>, way: Way, curtain: bool) -> Seen {
        let heat = |state: &State| cabin.air_unit_heat_w(&state.temperatures, &state.slopes, curtain);
        let from = self.fixed.partition_point(|state| way.needed([heat(state).0; 2])[0]).max(1) - 1;
        let (before, state) = self.fixed_before(from + 1);
        let (heat_w, slope_w_k) = heat(state);
        let vote = state.pmv - heat_w / slope_w_k * state.pmv_slope;
        self.settled(cabin, Target::passive(curtain), state.toward(vote, before))
    }
}

impl Way {
    /// Whether the unit is needed where it has to bring these heats, without and with air curtain.
    fn needed(self, heats_w: [f64; 2]) -> [bool; 2] {
        heats_w.map(|heat_w| match self {
            // None at neutral is the passive state, which the colder walk finds.
            Self::Colder => heat_w >= 0.0,
            Self::Warmer => heat_w < 0.0,
        })
    }
}

/// Distance of the fixed votes.
const FIXED_STEP: f64 = 0.5;

/// Where the search for the first state starts, in K.
pub(crate) const START_K: f64 = 295.0;
