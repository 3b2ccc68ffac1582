//! The optima of one sample for all designs and comfort windows.

use cabin::{
    Cabin, Candidate, Devices, Disturbances, OperatingMode, Operation, Optimum, Outcome, PassengerViews, Vehicle,
};

use crate::Grid;
use crate::blocks::{Block, in_blocks};
use crate::choice::{Best, Choice, Nearest, nearest};
use crate::offer::{Cheapest, Powers, Units};
use crate::states::{START_K, States};
use crate::steady::{Seen, SteadyState};

/// Solves all points of a sample, with buffers that are kept from sample to sample.
#[derive(Debug)]
pub struct SampleSolver<'a> {
    vehicle: &'a Vehicle,
    views: &'a PassengerViews,
    grid: &'a Grid,
    states: States,
    units: Units,
    wanted: [bool; 4],
}

impl<'a> SampleSolver<'a> {
    /// A solver for a grid. `views` are the vehicle's passengers, computed once per study.
    #[must_use]
    pub fn new(vehicle: &'a Vehicle, views: &'a PassengerViews, grid: &'a Grid) -> Self {
        let states = States::new(grid.limits().len());
        let units = Units::new(grid.designs());
        let wanted = units.wanted();
        Self { vehicle, views, grid, states, units, wanted }
    }

    /// Solves every design and window for one sample; `optima` has [`Grid::points`] places and is filled design by
    /// design, each with its windows in the grid's order. Allocates nothing.
    pub fn solve(&mut self, disturbances: &Disturbances, optima: &mut [Optimum]) {
        let cabin = Cabin::new(self.vehicle, self.views, disturbances);
        self.find_states(&cabin);
        let windows = self.grid.windows().len();
        let mut bests = Bests::NONE;
        for window in 0..windows {
            let changed = bests.find(&self.states, self.grid.window_limits()[window], &cabin, self.wanted);
            self.units.price(self.grid.designs(), &bests.choices, changed);
            for design in 0..self.grid.designs().len() {
                let optimum = &mut optima[design * windows + window];
                (optimum.design, optimum.window) = (design, window);
                let outcome = &mut optimum.outcome;
                // Each is written where it stays, since to move one costs as much as to find it.
                match self.units.cheapest(design) {
                    Cheapest::Choice { place, powers, runner_up_w } => {
                        match (&bests.choices[place], bests.states[place]) {
                            (Best::Found(choice), Some((state, _))) => {
                                *outcome = Outcome::Solved(operation(choice, powers, state), runner_up_w);
                            }
                            _ => *outcome = Outcome::NotConverged,
                        }
                    }
                    Cheapest::Limited => *outcome = self.limited(&cabin, design, window, &bests.choices),
                    Cheapest::Infeasible(reason) => *outcome = Outcome::Infeasible(reason),
                    Cheapest::NotConverged => *outcome = Outcome::NotConverged,
                }
            }
        }
    }

    /// The four choices of heaters and curtain for one design and window, by their index in the grid.
    pub fn candidates(&mut self, disturbances: &Disturbances, design: usize, window: usize) -> [Candidate; 4] {
        self.wanted = [true; 4];
        let cabin = Cabin::new(self.vehicle, self.views, disturbances);
        self.find_states(&cabin);
        let design = &self.grid.designs()[design];
        let mut bests = Bests::NONE;
        bests.find(&self.states, self.grid.window_limits()[window], &cabin, self.wanted);
        std::array::from_fn(|place| {
            let devices = Devices::CHOICES[place];
            let operation = match (&bests.choices[place], bests.states[place]) {
                (Best::Found(choice), Some((state, _))) => {
                    let powers = choice.powers(design);
                    (powers.supply.unmet_w == 0.0).then(|| operation(choice, &powers, state))
                }
                _ => None,
            };
            Candidate { devices, available: design.devices.include(devices), operation }
        })
    }

    /// The operation that comes nearest to a window that no choice of a design meets within its limits.
    fn limited(&self, cabin: &Cabin<'_>, design: usize, window: usize, bests: &[Best; 4]) -> Outcome {
        let (design, window) = (&self.grid.designs()[design], &self.grid.windows()[window]);
        match nearest(cabin, design, bests, window, &cabin.rough_state(START_K)) {
            Some(Nearest { choice, state, powers }) => {
                let state = SteadyState::new(cabin, choice.devices.heaters(), &state);
                Outcome::Solved(operation(&choice, &powers, &state), None)
            }
            None => Outcome::NotConverged,
        }
    }

    fn find_states(&mut self, cabin: &Cabin<'_>) {
        let [neither, curtain, heaters, both] = self.wanted;
        self.states.find(cabin, self.grid.limits(), [[neither, curtain], [heaters, both]]);
    }
}

/// The four choices at their best in a window.
struct Bests<'s> {
    choices: [Best; 4],
    /// The state of each, and what the unit does there.
    states: [Option<(&'s SteadyState, OperatingMode)>; 4],
}

impl<'s> Bests<'s> {
    const NONE: Self = Self { choices: [Best::LeftOut; 4], states: [None; 4] };

    /// Finds every wanted choice between two limits, and says which of them are not as they were before: a passive state is the
    /// same in every window that holds it.
    #[inline]
    fn find(&mut self, states: &'s States, limits: (usize, usize), cabin: &Cabin<'_>, wanted: [bool; 4]) -> [bool; 4] {
        let mut changed = [false; 4];
        for place in (0..4).filter(|place| wanted[*place]) {
            let devices = Devices::CHOICES[place];
            let found = best(states, limits, devices);
            if let (Some((state, end)), Some((before, end_before))) = (found, self.states[place])
                && std::ptr::eq(state, before)
                && end == end_before
            {
                continue;
            }
            changed[place] = true;
            self.states[place] = found;
            self.choices[place] = found.map_or(Best::Lost, |(state, end)| {
                let heat_w = state.air_unit_heat_w[usize::from(devices.air_curtain)];
                Best::at(cabin, devices, end, state.temperatures.cabin_k, heat_w, state.radiant_heater_power_w)
            });
        }
        changed
    }
}

/// The best state with a choice, and what the unit does there: the passive state moved into the window between two limits. `None`
/// where a state that it takes was not found.
#[inline]
fn best(states: &States, (low, high): (usize, usize), devices: Devices) -> Option<(&SteadyState, OperatingMode)> {
    let (on, curtain) = (usize::from(devices.radiant_heaters), usize::from(devices.air_curtain));
    let (limits, passive) = (&states.limits[on], &states.passive[on][curtain]);
    match (&limits[low], &limits[high], passive) {
        (Seen::Lost, _, _) => None,
        (Seen::Settled(low), _, _) if low.air_unit_heat_w[curtain] >= 0.0 => Some((low, OperatingMode::Heating)),
        (_, Seen::Lost, _) => None,
        (_, Seen::Settled(high), _) if high.air_unit_heat_w[curtain] < 0.0 => Some((high, OperatingMode::Cooling)),
        (_, _, Seen::Settled(passive)) => Some((passive, OperatingMode::Passive)),
        (_, _, Seen::Lost | Seen::Needless) => None,
    }
}

#[inline(always)]
fn operation(choice: &Choice, powers: &Powers, state: &SteadyState) -> Operation {
    Operation {
        mode: choice.mode,
        devices: choice.devices,
        air_unit_power_w: powers.supply.power_w,
        radiant_heater_power_w: choice.radiant_heater_power_w,
        air_curtain_power_w: choice.air_curtain_power_w,
        backup_heater_power_w: powers.supply.backup_w,
        air_unit_heat_w: choice.air_unit_heat_w,
        unmet_heat_w: powers.supply.unmet_w,
        temperatures: state.temperatures,
        mean_radiant_temperature_k: state.mean_radiant_k,
        pmv: state.pmv,
        standard_range: state.standard_range,
    }
}

/// A tenth of a millisecond a task: long enough that to hand it over costs nothing.
const BLOCK: Block = Block { samples: 8, a_thread: 32 };

/// Solves every sample for every point of the grid on rayon's current pool and hands the results over in blocks, in the
/// order of the samples whatever the thread count: `consume(first_sample, optima)`, with [`Grid::points`] optima a
/// sample. It stops early when `consume` returns `false`, and then returns `false` itself.
pub fn solve_blocks(
    vehicle: &Vehicle,
    grid: &Grid,
    samples: &[Disturbances],
    consume: impl FnMut(usize, &[Optimum]) -> bool,
) -> bool {
    let views = PassengerViews::new(vehicle);
    let solver = || SampleSolver::new(vehicle, &views, grid);
    in_blocks(samples, grid.points(), BLOCK, Optimum::UNSOLVED, solver, SampleSolver::solve, consume)
}
