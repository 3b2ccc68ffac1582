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
        let (mut bests, mut states) = ([Best::LeftOut; 4], [None; 4]);
        for window in 0..windows {
            find_bests(&self.states, self.grid.window_limits()[window], &cabin, self.wanted, (&mut bests, &mut states));
            self.units.price(self.grid.designs(), &bests);
            for design in 0..self.grid.designs().len() {
                let optimum = &mut optima[design * windows + window];
                (optimum.design, optimum.window) = (design, window);
                let outcome = &mut optimum.outcome;
                // Each is written where it stays, since to move one costs as much as to find it.
                match self.units.cheapest(design) {
                    Cheapest::Choice { place, powers, runner_up_w } => match (&bests[place], states[place]) {
                        (Best::Found(choice), Some(state)) => {
                            *outcome = Outcome::Solved(operation(choice, powers, state), runner_up_w);
                        }
                        _ => *outcome = Outcome::NotConverged,
                    },
                    Cheapest::Limited => *outcome = self.limited(&cabin, design, window, &bests),
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
        let (mut bests, mut states) = ([Best::LeftOut; 4], [None; 4]);
        find_bests(&self.states, self.grid.window_limits()[window], &cabin, self.wanted, (&mut bests, &mut states));
        std::array::from_fn(|place| {
            let devices = Devices::CHOICES[place];
            let operation = match (&bests[place], states[place]) {
                (Best::Found(choice), Some(state)) => {
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

/// Puts every wanted choice between two limits at its best in its place, and the state of it.
#[inline]
fn find_bests<'s>(
    states: &'s States,
    limits: (usize, usize),
    cabin: &Cabin<'_>,
    wanted: [bool; 4],
    (bests, at): (&mut [Best; 4], &mut [Option<&'s SteadyState>; 4]),
) {
    for place in (0..4).filter(|place| wanted[*place]) {
        (bests[place], at[place]) = best(states, limits, cabin, Devices::CHOICES[place]);
    }
}

/// The best operation with a choice: the passive state moved into the window between two limits.
#[inline]
fn best<'s>(
    states: &'s States,
    (low, high): (usize, usize),
    cabin: &Cabin<'_>,
    devices: Devices,
) -> (Best, Option<&'s SteadyState>) {
    let (on, curtain) = (usize::from(devices.radiant_heaters), usize::from(devices.air_curtain));
    let (limits, passive) = (&states.limits[on], &states.passive[on][curtain]);
    let (state, end) = match (&limits[low], &limits[high], passive) {
        (Seen::Lost, _, _) => return (Best::Lost, None),
        (Seen::Settled(low), _, _) if low.air_unit_heat_w[curtain] >= 0.0 => (low, OperatingMode::Heating),
        (_, Seen::Lost, _) => return (Best::Lost, None),
        (_, Seen::Settled(high), _) if high.air_unit_heat_w[curtain] < 0.0 => (high, OperatingMode::Cooling),
        (_, _, Seen::Settled(passive)) => (passive, OperatingMode::Passive),
        (_, _, Seen::Lost | Seen::Needless) => return (Best::Lost, None),
    };
    let heat_w = state.air_unit_heat_w[curtain];
    let best = Best::at(cabin, devices, end, state.temperatures.cabin_k, heat_w, state.radiant_heater_power_w);
    (best, Some(state))
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
