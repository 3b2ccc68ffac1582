//! The optima of one sample for all designs and comfort windows.

use cabin::{
    Cabin, Candidate, Devices, Disturbances, Heaters, OperatingMode, Operation, Optimum, Outcome, PassengerViews,
    Vehicle,
};

use crate::Grid;
use crate::blocks::{Block, in_blocks};
use crate::choice::{Best, Cheapest, Choice, Nearest, Powers, cheapest, nearest};
use crate::states::{START_K, Seen, States, SteadyState};

/// Solves all points of a sample, with buffers that are kept from sample to sample.
#[derive(Debug)]
pub struct SampleSolver<'a> {
    vehicle: &'a Vehicle,
    views: &'a PassengerViews,
    grid: &'a Grid,
    /// With the heaters off and on.
    states: [States; 2],
    wanted: [bool; 4],
}

impl<'a> SampleSolver<'a> {
    /// A solver for a grid. `views` are the vehicle's passengers, computed once per study.
    #[must_use]
    pub fn new(vehicle: &'a Vehicle, views: &'a PassengerViews, grid: &'a Grid) -> Self {
        let states = [Heaters::Off, Heaters::On].map(|h| States::new(h, grid.limits().len()));
        let wanted = Devices::CHOICES.map(|choice| grid.designs().iter().any(|d| d.devices.include(choice)));
        Self { vehicle, views, grid, states, wanted }
    }

    /// Solves every design and window for one sample; `optima` has [`Grid::points`] places and is filled design by
    /// design, each with its windows in the grid's order. Allocates nothing.
    pub fn solve(&mut self, disturbances: &Disturbances, optima: &mut [Optimum]) {
        let cabin = Cabin::new(self.vehicle, self.views, disturbances);
        self.find_states(&cabin);
        let windows = self.grid.windows().len();
        for window in 0..windows {
            let (bests, states) = self.bests(&cabin, window);
            for (design, spec) in self.grid.designs().iter().enumerate() {
                let outcome = match cheapest(spec, &bests) {
                    Cheapest::Choice { place, powers, runner_up_w } => match (&bests[place], states[place]) {
                        (Some(Best::Found(choice)), Some(state)) => {
                            Outcome::Solved(operation(choice, &powers, state), runner_up_w)
                        }
                        _ => Outcome::NotConverged,
                    },
                    Cheapest::Limited => self.limited(&cabin, design, window, &bests),
                    Cheapest::Infeasible(reason) => Outcome::Infeasible(reason),
                    Cheapest::NotConverged => Outcome::NotConverged,
                };
                optima[design * windows + window] = Optimum { design, window, outcome };
            }
        }
    }

    /// The four choices of heaters and curtain for one design and window, by their index in the grid.
    pub fn candidates(&mut self, disturbances: &Disturbances, design: usize, window: usize) -> [Candidate; 4] {
        self.wanted = [true; 4];
        let cabin = Cabin::new(self.vehicle, self.views, disturbances);
        self.find_states(&cabin);
        let design = &self.grid.designs()[design];
        let (bests, states) = self.bests(&cabin, window);
        std::array::from_fn(|place| {
            let devices = Devices::CHOICES[place];
            let operation = match (&bests[place], states[place]) {
                (Some(Best::Found(choice)), Some(state)) => {
                    let powers = choice.powers(design);
                    (powers.unmet_heat_w == 0.0).then(|| operation(choice, &powers, state))
                }
                _ => None,
            };
            Candidate { devices, available: design.devices.include(devices), operation }
        })
    }

    /// The operation that comes nearest to a window that no choice of a design meets within its limits.
    fn limited(&self, cabin: &Cabin<'_>, design: usize, window: usize, bests: &[Option<Best>; 4]) -> Outcome {
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
        let wanted = [[neither, curtain], [heaters, both]];
        for (states, curtains) in self.states.iter_mut().zip(wanted) {
            if curtains.contains(&true) {
                states.find(cabin, self.grid.limits(), curtains);
            }
        }
    }

    /// Every wanted choice in a window at its best, and the states of them.
    fn bests(&self, cabin: &Cabin<'_>, window: usize) -> ([Option<Best>; 4], [Option<&SteadyState>; 4]) {
        let (mut bests, mut states) = ([None; 4], [None; 4]);
        for place in (0..4).filter(|place| self.wanted[*place]) {
            let (best, state) = self.best(cabin, window, Devices::CHOICES[place]);
            (bests[place], states[place]) = (Some(best), state);
        }
        (bests, states)
    }

    /// The best operation with a choice: the passive state moved into the window.
    fn best(&self, cabin: &Cabin<'_>, window: usize, devices: Devices) -> (Best, Option<&SteadyState>) {
        let states = &self.states[usize::from(devices.radiant_heaters)];
        let curtain = usize::from(devices.air_curtain);
        let (low, high) = self.grid.window_limits()[window];
        let (state, end) = match (&states.limits[low], &states.limits[high], &states.passive[curtain]) {
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
}

fn operation(choice: &Choice, powers: &Powers, state: &SteadyState) -> Operation {
    Operation {
        mode: choice.mode,
        devices: choice.devices,
        air_unit_power_w: powers.air_unit_w,
        radiant_heater_power_w: powers.radiant_heater_w,
        air_curtain_power_w: powers.air_curtain_w,
        backup_heater_power_w: powers.backup_w,
        air_unit_heat_w: choice.air_unit_heat_w,
        unmet_heat_w: powers.unmet_heat_w,
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
