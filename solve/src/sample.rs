//! The optima of one sample for all designs and comfort windows.

use cabin::{
    Cabin, Candidate, Design, Devices, Disturbances, Heaters, Infeasible, OperatingMode, Operation, Optimum, Outcome,
    PassengerViews, Vehicle,
};

use crate::Grid;
use crate::blocks::in_blocks;
use crate::states::{States, SteadyState};

/// Cabin temperatures that the air unit can be asked to hold, in K: −60 … 60 °C.
const COLDEST_K: f64 = 213.15;
const HOTTEST_K: f64 = 333.15;

/// What a choice comes to in a window.
#[derive(Debug, Clone, Copy)]
enum Best<'s> {
    Found(Found<'s>),
    Infeasible(Infeasible),
    Lost,
}

/// The best operation with a choice of devices, before a design's COP turns its heat into power.
#[derive(Debug, Clone, Copy)]
struct Found<'s> {
    devices: Devices,
    state: &'s SteadyState,
    mode: OperatingMode,
    air_unit_heat_w: f64,
}

/// The powers of a choice in W: air unit, radiant heaters, air curtains, all together.
#[derive(Debug, Clone, Copy)]
struct Powers {
    air_unit_w: f64,
    radiant_heater_w: f64,
    air_curtain_w: f64,
    total_w: f64,
}

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
            let bests: [Option<Best>; 4] =
                std::array::from_fn(|i| self.wanted[i].then(|| self.best(window, Devices::CHOICES[i])));
            for (design, spec) in self.grid.designs().iter().enumerate() {
                let outcome = compare(&cabin, spec, &bests);
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
        Devices::CHOICES.map(|devices| {
            let operation = match self.best(window, devices) {
                Best::Found(found) => Some(found.operation(&found.powers(&cabin, design))),
                Best::Infeasible(_) | Best::Lost => None,
            };
            Candidate { devices, available: design.devices.include(devices), operation }
        })
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

    /// The best operation with a choice: the passive state moved into the window.
    fn best(&self, window: usize, devices: Devices) -> Best<'_> {
        let states = &self.states[usize::from(devices.radiant_heaters)];
        let curtain = devices.air_curtain;
        let comfort = &self.grid.windows()[window];
        let (low, high) = self.grid.window_limits()[window];
        let Some(passive) = &states.passive[usize::from(curtain)] else { return Best::Lost };
        let (state, mode) = if passive.pmv < comfort.pmv_min() {
            let Some(state) = &states.limits[low] else { return Best::Lost };
            if state.temperatures.cabin_k > HOTTEST_K {
                return Best::Infeasible(Infeasible::TooCold);
            }
            (state, OperatingMode::Heating)
        } else if passive.pmv > comfort.pmv_max() {
            let Some(state) = &states.limits[high] else { return Best::Lost };
            if state.temperatures.cabin_k < COLDEST_K {
                return Best::Infeasible(Infeasible::TooWarm);
            }
            (state, OperatingMode::Cooling)
        } else {
            (passive, OperatingMode::Passive)
        };
        if state.radiant_heater_power_w < 0.0 {
            // Surroundings hotter than the panels' target: they cannot be held there by heating.
            return Best::Infeasible(Infeasible::TooWarm);
        }
        let heat_w = state.air_unit_heat_w[usize::from(curtain)];
        let (mode, air_unit_heat_w) = match mode {
            OperatingMode::Heating if heat_w > 0.0 => (mode, heat_w),
            OperatingMode::Cooling if heat_w < 0.0 => (mode, heat_w),
            // At the passive state, to rounding.
            _ => (OperatingMode::Passive, 0.0),
        };
        Best::Found(Found { devices, state, mode, air_unit_heat_w })
    }
}

/// The cheapest choice that the design has, and how much more the next one costs.
fn compare(cabin: &Cabin<'_>, design: &Design, bests: &[Option<Best<'_>>; 4]) -> Outcome {
    let mut cheapest: Option<(Found<'_>, Powers)> = None;
    let mut second_w = f64::INFINITY;
    let mut failure = Outcome::NotConverged;
    for (&choice, best) in Devices::CHOICES.iter().zip(bests) {
        if !design.devices.include(choice) {
            continue;
        }
        match *best {
            Some(Best::Found(found)) => {
                let powers = found.powers(cabin, design);
                match &cheapest {
                    Some((_, least)) if least.total_w <= powers.total_w => second_w = second_w.min(powers.total_w),
                    before => {
                        // What was the cheapest is now the second.
                        second_w = before.as_ref().map_or(second_w, |(_, least)| least.total_w);
                        cheapest = Some((found, powers));
                    }
                }
            }
            Some(Best::Infeasible(reason)) => failure = Outcome::Infeasible(reason),
            // One choice that does not settle leaves the optimum unproven.
            Some(Best::Lost) | None => return Outcome::NotConverged,
        }
    }
    match cheapest {
        Some((found, powers)) => {
            let runner_up_w = second_w.is_finite().then_some(second_w - powers.total_w);
            Outcome::Solved(found.operation(&powers), runner_up_w)
        }
        None => failure,
    }
}

impl Found<'_> {
    fn powers(&self, cabin: &Cabin<'_>, design: &Design) -> Powers {
        let lift_k = self.state.temperatures.cabin_k - cabin.ambient_k();
        let air_unit_w = match self.mode {
            OperatingMode::Heating => self.air_unit_heat_w / design.heating_cop.at(lift_k),
            OperatingMode::Cooling => -self.air_unit_heat_w / design.cooling_cop.at(-lift_k),
            OperatingMode::Passive => 0.0,
        };
        let radiant_heater_w = self.state.radiant_heater_power_w;
        let air_curtain_w = if self.devices.air_curtain { cabin.air_curtain_power_w() } else { 0.0 };
        Powers { air_unit_w, radiant_heater_w, air_curtain_w, total_w: air_unit_w + radiant_heater_w + air_curtain_w }
    }

    fn operation(&self, powers: &Powers) -> Operation {
        Operation {
            mode: self.mode,
            devices: self.devices,
            air_unit_power_w: powers.air_unit_w,
            radiant_heater_power_w: powers.radiant_heater_w,
            air_curtain_power_w: powers.air_curtain_w,
            air_unit_heat_w: self.air_unit_heat_w,
            temperatures: self.state.temperatures,
            mean_radiant_temperature_k: self.state.mean_radiant_k,
            pmv: self.state.pmv,
            standard_range: self.state.standard_range,
        }
    }
}

/// Samples that one task solves before it hands over: large enough that the hand-over costs nothing.
const BLOCK: usize = 64;

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
