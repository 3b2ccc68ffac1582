//! The optima of one sample for all designs and comfort windows.

use cabin::{Cabin, Design, Disturbances, Heaters, PassengerViews, Vehicle};

use crate::states::{Held, States};
use crate::{Candidate, Grid, Infeasible, OperatingMode, Operation, Optimum, Outcome};

/// Cabin temperatures that the air unit can be asked to hold, in K: −60 … 60 °C.
const COLDEST_K: f64 = 213.15;
const HOTTEST_K: f64 = 333.15;

/// A choice of devices: whether the radiant heaters are on, and whether the air curtains run. Fewer devices come first,
/// so that of equal choices the one with fewer wins.
type Choice = (bool, bool);
const CHOICES: [Choice; 4] = [(false, false), (false, true), (true, false), (true, true)];

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
    choice: Choice,
    held: &'s Held,
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

/// Whether a design has what a choice needs.
fn has(design: &Design, (heaters, curtain): Choice) -> bool {
    (design.radiant_heaters || !heaters) && (design.air_curtain || !curtain)
}

impl<'a> SampleSolver<'a> {
    /// A solver for a grid. `views` are the vehicle's passengers, computed once per study.
    #[must_use]
    pub fn new(vehicle: &'a Vehicle, views: &'a PassengerViews, grid: &'a Grid) -> Self {
        let states = [Heaters::Off, Heaters::On].map(|h| States::new(h, grid.limits().len()));
        let wanted = CHOICES.map(|choice| grid.designs().iter().any(|d| has(d, choice)));
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
                std::array::from_fn(|i| self.wanted[i].then(|| self.best(window, CHOICES[i])));
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
        CHOICES.map(|choice| {
            let operation = match self.best(window, choice) {
                Best::Found(found) => Some(found.operation(&found.powers(&cabin, design))),
                Best::Infeasible(_) | Best::Lost => None,
            };
            let (radiant_heaters_on, air_curtain_on) = choice;
            Candidate { air_curtain_on, radiant_heaters_on, available: has(design, choice), operation }
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
    fn best(&self, window: usize, choice: Choice) -> Best<'_> {
        let (heaters, curtain) = choice;
        let states = &self.states[usize::from(heaters)];
        let comfort = &self.grid.windows()[window];
        let (low, high) = self.grid.window_limits()[window];
        let Some(passive) = &states.passive[usize::from(curtain)] else { return Best::Lost };
        let (held, mode) = if passive.pmv < comfort.pmv_min() {
            let Some(held) = &states.limits[low] else { return Best::Lost };
            if held.temperatures.cabin_k > HOTTEST_K {
                return Best::Infeasible(Infeasible::TooCold);
            }
            (held, OperatingMode::Heating)
        } else if passive.pmv > comfort.pmv_max() {
            let Some(held) = &states.limits[high] else { return Best::Lost };
            if held.temperatures.cabin_k < COLDEST_K {
                return Best::Infeasible(Infeasible::TooWarm);
            }
            (held, OperatingMode::Cooling)
        } else {
            (passive, OperatingMode::Passive)
        };
        if held.radiant_heater_power_w < 0.0 {
            // Surroundings hotter than the panels' target: they cannot be held there by heating.
            return Best::Infeasible(Infeasible::TooWarm);
        }
        let heat_w = held.air_unit_heat_w[usize::from(curtain)];
        let (mode, air_unit_heat_w) = match mode {
            OperatingMode::Heating if heat_w > 0.0 => (mode, heat_w),
            OperatingMode::Cooling if heat_w < 0.0 => (mode, heat_w),
            // At the passive state, to rounding.
            _ => (OperatingMode::Passive, 0.0),
        };
        Best::Found(Found { choice, held, mode, air_unit_heat_w })
    }
}

/// The cheapest choice that the design has, and how much more the next one costs.
fn compare(cabin: &Cabin<'_>, design: &Design, bests: &[Option<Best<'_>>; 4]) -> Outcome {
    let mut cheapest: Option<(Found<'_>, Powers)> = None;
    let mut second_w = f64::INFINITY;
    let mut failure = Outcome::NotConverged;
    for (&choice, best) in CHOICES.iter().zip(bests) {
        if !has(design, choice) {
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
        let lift_k = self.held.temperatures.cabin_k - cabin.ambient_k();
        let air_unit_w = match self.mode {
            OperatingMode::Heating => self.air_unit_heat_w / design.heating_cop.at(lift_k),
            OperatingMode::Cooling => -self.air_unit_heat_w / design.cooling_cop.at(-lift_k),
            OperatingMode::Passive => 0.0,
        };
        let radiant_heater_w = self.held.radiant_heater_power_w;
        let air_curtain_w = if self.choice.1 { cabin.air_curtain_power_w() } else { 0.0 };
        Powers { air_unit_w, radiant_heater_w, air_curtain_w, total_w: air_unit_w + radiant_heater_w + air_curtain_w }
    }

    fn operation(&self, powers: &Powers) -> Operation {
        let (radiant_heaters_on, air_curtain_on) = self.choice;
        Operation {
            mode: self.mode,
            air_curtain_on,
            radiant_heaters_on,
            air_unit_power_w: powers.air_unit_w,
            radiant_heater_power_w: powers.radiant_heater_w,
            air_curtain_power_w: powers.air_curtain_w,
            air_unit_heat_w: self.air_unit_heat_w,
            temperatures: self.held.temperatures,
            mean_radiant_temperature_k: self.held.mean_radiant_k,
            pmv: self.held.pmv,
            standard_range: self.held.standard_range,
        }
    }
}
