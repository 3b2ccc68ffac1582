//! The year of many buses that differ from one: each optimum is sought from that one's state, and only the sums of a year are
//! kept.
//!
//! A study of many buses asks for few windows, so that there is nothing to walk: the end of the window at which the unit is
//! needed in the one bus is tried first, and two Newton steps from its state are usual. Radiant heaters are only looked at
//! where the unit heats without them. Elsewhere they cannot be the cheapest: at the same vote the cabin is colder with them,
//! so that a unit that cools has more to cool at a COP that is no better, and a unit that rests takes nothing.

use cabin::{
    Cabin, ComfortWindow, Design, Devices, Disturbances, Heaters, OperatingMode, PassengerViews, State, Target, Vehicle,
};
use rayon::prelude::*;
use std::sync::Arc;

use crate::Grid;
use crate::annual::{AnnualMean, MonthSum, Used, YearSamples, year};
use crate::choice::{Best, nearest};
use crate::offer::{Cheapest, Powers, Units};
use crate::states::START_K;

/// Where the search for the optima of a sample in a window starts, and what the unit does there; with the heaters off and on.
#[derive(Debug, Clone, Copy)]
struct Start {
    states: [State; 2],
    ends: [OperatingMode; 2],
}

/// The states of one bus in a year, from which those of buses much like it are sought.
#[derive(Debug, Clone)]
pub struct YearStates<'y> {
    samples: &'y YearSamples,
    grid: &'y Grid,
    /// Of every month and sample, in the order of the grid's windows; `None` where a search does not settle.
    months: Vec<Vec<Option<Start>>>,
}

/// A bus that differs from the one.
#[derive(Debug, Clone)]
pub struct Bus {
    /// Its constants.
    pub vehicle: Vehicle,
    /// Its passengers.
    pub views: Arc<PassengerViews>,
    /// Its designs, in the order of the grid's.
    pub designs: Vec<Design>,
}

impl<'y> YearStates<'y> {
    /// The states of a bus at all samples and windows of a grid.
    #[must_use]
    pub fn new(samples: &'y YearSamples, vehicle: &Vehicle, grid: &'y Grid) -> Self {
        let views = PassengerViews::new(vehicle);
        let of_sample = |sample: &Disturbances| -> Vec<Option<Start>> {
            let cabin = Cabin::new(vehicle, &views, sample);
            grid.windows().iter().map(|window| Start::cold(&cabin, window)).collect()
        };
        let of_month = |of_month: &Vec<Disturbances>| of_month.iter().flat_map(of_sample).collect();
        Self { samples, grid, months: samples.months().par_iter().map(of_month).collect() }
    }

    /// The grid.
    #[must_use]
    pub fn grid(&self) -> &Grid {
        self.grid
    }

    /// The means of the year of a bus, as [`YearSamples::means`] gives them to rounding, with every sample as `changed` has it.
    /// Allocates nothing per sample and uses one thread: buses are what goes abreast.
    #[must_use]
    pub fn means(&self, bus: &Bus, changed: impl Fn(&Disturbances) -> Disturbances) -> Vec<AnnualMean> {
        let windows = self.grid.windows();
        let mut units = Units::new(&bus.designs);
        let wanted = units.wanted();
        let month = |(samples, starts): (&Vec<Disturbances>, &Vec<Option<Start>>)| {
            let mut sums = vec![MonthSum::default(); self.grid.points()];
            for (sample, starts) in samples.iter().zip(starts.chunks(windows.len())) {
                let cabin = Cabin::new(&bus.vehicle, &bus.views, &changed(sample));
                for (place, (window, start)) in windows.iter().zip(starts).enumerate() {
                    let start = start.or_else(|| Start::cold(&cabin, window));
                    let bests = start.map_or([Best::Lost; 4], |start| start.bests(&cabin, window, wanted));
                    units.price(&bus.designs, &bests, [true; 4]);
                    for (design, spec) in bus.designs.iter().enumerate() {
                        let nearest = || {
                            let guess = start.map(|start| start.states[0])?;
                            let nearest = nearest(&cabin, spec, &bests, window, &guess)?;
                            Some(used(nearest.choice.mode, &nearest.powers))
                        };
                        sums[design * windows.len() + place].add(of_design(&bests, units.cheapest(design), nearest));
                    }
                }
            }
            sums
        };
        let months: Vec<Vec<MonthSum>> = self.samples.months().iter().zip(&self.months).map(month).collect();
        year(self.grid.points(), &months)
    }
}

/// What a design does in the cheapest choice, or in the `nearest` one where none meets the window within its limits.
fn of_design(bests: &[Best; 4], cheapest: Cheapest<'_>, nearest: impl FnOnce() -> Option<Used>) -> Option<Used> {
    match cheapest {
        Cheapest::Choice { place, powers, .. } => match bests[place] {
            Best::Found(choice) => Some(used(choice.mode, powers)),
            _ => None,
        },
        Cheapest::Limited => nearest(),
        Cheapest::Infeasible(_) | Cheapest::NotConverged => None,
    }
}

fn used(mode: OperatingMode, powers: &Powers) -> Used {
    Used { mode, hvac_power_w: powers.total_w, is_limited: powers.supply.unmet_w > 0.0 }
}

impl Start {
    /// From nothing: the states without air curtain that are the best in a window.
    fn cold(cabin: &Cabin<'_>, window: &ComfortWindow) -> Option<Self> {
        let mut guess = cabin.rough_state(START_K);
        let (mut states, mut ends) = ([guess; 2], [OperatingMode::Heating; 2]);
        for (place, heaters) in [Heaters::Off, Heaters::On].into_iter().enumerate() {
            let search = Search { cabin, heaters, window, guess: &guess, first: OperatingMode::Heating };
            let (state, end) = search.run(&mut [None; 2], false)?;
            (states[place], ends[place], guess) = (state, end, state);
        }
        Some(Self { states, ends })
    }

    /// The wanted choices at their best; left out also where another choice is known to be cheaper.
    fn bests(&self, cabin: &Cabin<'_>, window: &ComfortWindow, wanted: [bool; 4]) -> [Best; 4] {
        let mut bests = [Best::LeftOut; 4];
        for (place, heaters) in [Heaters::Off, Heaters::On].into_iter().enumerate() {
            let search = Search { cabin, heaters, window, guess: &self.states[place], first: self.ends[place] };
            let mut known = [None; 2];
            for curtain in [false, true] {
                let choice = 2 * place + usize::from(curtain);
                let without = bests[usize::from(curtain)];
                let rests = matches!(without, Best::Found(c) if c.mode != OperatingMode::Heating);
                if wanted[choice] && !(heaters == Heaters::On && rests) {
                    bests[choice] = search.best(&mut known, Devices::CHOICES[choice]);
                }
            }
        }
        bests
    }
}

/// The search for the best state in a window, with the heaters as they are.
struct Search<'s, 'c> {
    cabin: &'s Cabin<'c>,
    heaters: Heaters,
    window: &'s ComfortWindow,
    guess: &'s State,
    /// What the unit does where the guess is from.
    first: OperatingMode,
}

impl Search<'_, '_> {
    fn best(&self, known: &mut [Option<State>; 2], devices: Devices) -> Best {
        let Some((state, end)) = self.run(known, devices.air_curtain) else { return Best::Lost };
        let t = &state.temperatures;
        let heat_w = self.heat_w(&state, devices.air_curtain);
        let radiant_heater_power_w = match self.heaters {
            Heaters::Off => 0.0,
            Heaters::On => self.cabin.radiant_heater_power_w(t),
        };
        Best::at(self.cabin, devices, end, t.cabin_k, heat_w, radiant_heater_power_w)
    }

    /// The best state and what the unit does there; `known` are the states at the lower and the upper end, as far as they have
    /// been visited, which do not depend on the curtain.
    fn run(&self, known: &mut [Option<State>; 2], curtain: bool) -> Option<(State, OperatingMode)> {
        let mut passive = None;
        if self.first == OperatingMode::Passive {
            let state = self.passive(self.guess, curtain)?;
            if self.window.pmv_min() < state.pmv && state.pmv < self.window.pmv_max() {
                return Some((state, OperatingMode::Passive));
            }
            passive = Some(state);
        }
        let ends = match self.first {
            OperatingMode::Cooling => [1, 0],
            OperatingMode::Heating | OperatingMode::Passive => [0, 1],
        };
        let mut last = *self.guess;
        for end in ends {
            let state = match known[end] {
                Some(state) => state,
                None => self.end(end)?,
            };
            known[end] = Some(state);
            let heat_w = self.heat_w(&state, curtain);
            if end == 0 && heat_w >= 0.0 {
                return Some((state, OperatingMode::Heating));
            }
            if end == 1 && heat_w < 0.0 {
                return Some((state, OperatingMode::Cooling));
            }
            last = state;
        }
        let passive = match passive {
            Some(state) => state,
            None => self.passive(&last, curtain)?,
        };
        Some((passive, OperatingMode::Passive))
    }

    /// The state at the lower or upper end of the window.
    fn end(&self, end: usize) -> Option<State> {
        let vote = if end == 0 { self.window.pmv_min() } else { self.window.pmv_max() };
        self.cabin.state(Target::Vote(vote), self.heaters, &self.toward(self.guess, vote))
    }

    fn passive(&self, from: &State, curtain: bool) -> Option<State> {
        let (heat_w, slope_w_k) = self.cabin.air_unit_heat_w(&from.temperatures, &from.slopes, curtain);
        let vote = from.pmv - heat_w / slope_w_k * from.pmv_slope;
        self.cabin.state(Target::passive(self.cabin.door_loss_share(curtain)), self.heaters, &self.toward(from, vote))
    }

    /// A guess from a state; a rough one has no slopes to follow.
    fn toward(&self, from: &State, vote: f64) -> State {
        if from.pmv_slope > 0.0 { from.along(vote) } else { *from }
    }

    fn heat_w(&self, state: &State, curtain: bool) -> f64 {
        self.cabin.air_unit_heat_w(&state.temperatures, &state.slopes, curtain).0
    }
}
