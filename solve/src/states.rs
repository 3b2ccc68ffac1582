//! The cabin states that the optima of a sample can take, for one state of the radiant heaters.
//!
//! These are the passive states, without heat from the air unit, and from there outward the states at the limits of the
//! windows: at lower limits above the passive vote the unit heats, at upper limits below it the unit cools. No other state
//! is an optimum.
//!
//! A state is the same to the last bit whatever else the grid asks for, so that optima computed at different times fit
//! together: the walks go from neutral outward over votes that are fixed, each predicted from the last two, and a limit is
//! predicted from the fixed votes before it.

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
    fn new(cabin: &Cabin<'_>, heaters: Heaters, state: &State) -> Self {
        let t = state.temperatures;
        let heat_w = |curtain| cabin.air_unit_heat_w(&t, &state.slopes, curtain).0;
        Self {
            temperatures: t,
            mean_radiant_k: cabin.mean_radiant_temperature_k(&t),
            pmv: state.pmv,
            standard_range: cabin.standard_range(&t, state.pmv),
            air_unit_heat_w: [heat_w(false), heat_w(true)],
            radiant_heater_power_w: match heaters {
                Heaters::Off => 0.0,
                Heaters::On => cabin.radiant_heater_power_w(&t),
            },
        }
    }
}

/// The states for one state of the heaters, kept from sample to sample. `None` where a state is not needed, or where the
/// iteration did not settle.
#[derive(Debug, Clone)]
pub(crate) struct States {
    heaters: Heaters,
    /// Without and with air curtain.
    pub passive: [Option<SteadyState>; 2],
    /// At the grid's limits.
    pub limits: Vec<Option<SteadyState>>,
}

impl States {
    pub fn new(heaters: Heaters, limits: usize) -> Self {
        Self { heaters, passive: [None; 2], limits: vec![None; limits] }
    }

    /// Finds the states of a sample, for designs without and with air curtain as far as they are wanted.
    pub fn find(&mut self, cabin: &Cabin<'_>, limits: &[Limit], curtains: [bool; 2]) {
        self.passive = [None; 2];
        self.limits.fill(None);
        if !curtains.contains(&true) {
            return;
        }
        // One without curtain is where the others start, wanted or not.
        let mut guess = cabin.rough_state(START_K);
        // The least and the largest vote of the passive states.
        let mut ends: Option<[f64; 2]> = None;
        for curtain in [false, true] {
            if curtain && !curtains[1] {
                continue;
            }
            let Some(state) = cabin.state(Target::Passive { curtain }, self.heaters, &guess) else { continue };
            if curtains[usize::from(curtain)] {
                self.passive[usize::from(curtain)] = Some(SteadyState::new(cabin, self.heaters, &state));
                let [least, largest] = ends.unwrap_or([state.pmv; 2]);
                ends = Some([least.min(state.pmv), largest.max(state.pmv)]);
            }
            if !curtain {
                guess = state;
            }
        }
        let Some([least, largest]) = ends else { return };
        let wanted = |&i: &usize| {
            let limit = limits[i];
            limit.lower && limit.pmv > least || limit.upper && limit.pmv < largest
        };
        if !(0..limits.len()).any(|i| wanted(&i)) {
            return;
        }
        let Some(neutral) = cabin.state(Target::Vote(0.0), self.heaters, &guess) else { return };
        let first_warm = limits.partition_point(|l| l.pmv < 0.0);
        self.walk(cabin, limits, neutral, FIXED_STEP, (first_warm..limits.len()).filter(wanted));
        self.walk(cabin, limits, neutral, -FIXED_STEP, (0..first_warm).rev().filter(wanted));
    }

    /// From neutral outward in fixed steps of the vote, up to the last wanted limit.
    fn walk(
        &mut self,
        cabin: &Cabin<'_>,
        limits: &[Limit],
        neutral: State,
        step: f64,
        wanted: impl Iterator<Item = usize>,
    ) {
        let (mut before, mut last) = (None, neutral);
        // The fixed vote that was walked to last, and whether `last` is its state.
        let (mut steps, mut there) = (0.0, true);
        for i in wanted {
            let pmv = limits[i].pmv;
            while ((steps + 1.0) * step).abs() <= pmv.abs() {
                steps += 1.0;
                let vote = steps * step;
                let found = cabin.state(Target::Vote(vote), self.heaters, &last.extrapolate(vote, before.as_ref()));
                there = found.is_some();
                if let Some(state) = found {
                    (before, last) = (Some(last), state);
                }
            }
            let state = if there && pmv == steps * step {
                Some(last)
            } else {
                cabin.state(Target::Vote(pmv), self.heaters, &last.extrapolate(pmv, before.as_ref()))
            };
            self.limits[i] = state.map(|state| SteadyState::new(cabin, self.heaters, &state));
        }
    }
}

/// Distance of the fixed votes.
const FIXED_STEP: f64 = 0.5;

/// Where the search for the first state starts, in K.
const START_K: f64 = 295.0;
