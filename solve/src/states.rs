//! The cabin states that the optima of a sample can take, for one state of the radiant heaters.
//!
//! These are the passive states, without heat from the air unit, and from there outward the states at the limits of the
//! windows: at lower limits above the passive vote the unit heats, at upper limits below it the unit cools. No other state
//! is an optimum, so no other is computed. Each walk starts at the passive state and predicts every next state from the
//! last two.

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
        let mut guess = cabin.rough_state(START_K);
        // The passive states with the least and the largest vote.
        let mut ends: Option<[State; 2]> = None;
        for curtain in [false, true] {
            if !curtains[usize::from(curtain)] {
                continue;
            }
            let Some(state) = cabin.state(Target::Passive { curtain }, self.heaters, &guess) else { continue };
            self.passive[usize::from(curtain)] = Some(SteadyState::new(cabin, self.heaters, &state));
            let [mut least, mut largest] = ends.unwrap_or([state; 2]);
            if state.pmv < least.pmv {
                least = state;
            }
            if state.pmv > largest.pmv {
                largest = state;
            }
            ends = Some([least, largest]);
            guess = state;
        }
        let Some([least, largest]) = ends else { return };
        let above = limits.partition_point(|l| l.pmv <= least.pmv);
        let below = limits.partition_point(|l| l.pmv < largest.pmv);
        self.walk(cabin, limits, least, (above..limits.len()).filter(|&i| limits[i].lower));
        self.walk(cabin, limits, largest, (0..below).rev().filter(|&i| limits[i].upper));
    }

    fn walk(&mut self, cabin: &Cabin<'_>, limits: &[Limit], from: State, indices: impl Iterator<Item = usize>) {
        let (mut before, mut last) = (None, from);
        for i in indices {
            let pmv = limits[i].pmv;
            let guess = last.extrapolate(pmv, before.as_ref());
            let Some(state) = cabin.state(Target::Vote(pmv), self.heaters, &guess) else { continue };
            self.limits[i] = Some(SteadyState::new(cabin, self.heaters, &state));
            (before, last) = (Some(last), state);
        }
    }
}

/// Where the search for the first state starts, in K.
const START_K: f64 = 295.0;
