//! The optima of one sample for all designs and comfort windows.

use cabin::{Cabin, Design, Disturbances, Heaters, PassengerViews, Slopes, StandardRange, Temperatures, Vehicle};

use crate::Grid;
use crate::root::{Root, rising_root};

/// Cabin temperatures within which an operation is looked for, in K: −60 … 60 °C.
const COLDEST_K: f64 = 213.15;
const HOTTEST_K: f64 = 333.15;

/// What the air unit does (paper, eq. operating-modes).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OperatingMode {
    /// −1: takes heat away.
    Cooling,
    /// 0: off.
    Passive,
    /// 1: brings heat.
    Heating,
}

impl OperatingMode {
    /// The paper's number: −1, 0 or 1.
    #[must_use]
    pub fn number(self) -> i8 {
        match self {
            Self::Cooling => -1,
            Self::Passive => 0,
            Self::Heating => 1,
        }
    }
}

/// An HVAC operation in steady state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Operation {
    /// Mode of the air unit.
    pub mode: OperatingMode,
    /// Whether the air curtains run.
    pub air_curtain_on: bool,
    /// Whether the radiant heaters are on.
    pub radiant_heaters_on: bool,
    /// Electric power of the air unit in W.
    pub air_unit_power_w: f64,
    /// Electric power of the radiant heaters in W.
    pub radiant_heater_power_w: f64,
    /// Electric power of the air curtains in W.
    pub air_curtain_power_w: f64,
    /// Heat that the air unit brings in W, negative when cooling.
    pub air_unit_heat_w: f64,
    /// Temperatures of the reservoirs.
    pub temperatures: Temperatures,
    /// Mean radiant temperature of the average passenger in K.
    pub mean_radiant_temperature_k: f64,
    /// Mean over the passengers of the predicted mean vote.
    pub pmv: f64,
    /// Whether the state lies in the range of use of ISO 7730.
    pub standard_range: StandardRange,
}

impl Operation {
    /// Total power in W (paper, eq. phvactot).
    #[must_use]
    pub fn hvac_power_w(&self) -> f64 {
        self.air_unit_power_w + self.radiant_heater_power_w + self.air_curtain_power_w
    }
}

/// Why no operation meets a comfort window.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Infeasible {
    /// Even a cabin at −60 °C is too warm.
    TooWarm,
    /// Even a cabin at 60 °C is too cold.
    TooCold,
}

/// How a point ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Outcome {
    /// The global optimum, and by how many W the best other choice of heaters and curtain is more expensive
    /// (`None` where the design has no other feasible choice).
    Solved(Operation, Option<f64>),
    /// No operation meets the window.
    Infeasible(Infeasible),
    /// An iteration did not settle.
    NotConverged,
}

/// The outcome of one design and one window.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Optimum {
    /// Index of the design in the grid.
    pub design: usize,
    /// Index of the window in the grid.
    pub window: usize,
    /// How it ended.
    pub outcome: Outcome,
}

/// One of the four choices of heaters and curtain, with its own best operation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Candidate {
    /// Whether the air curtains run.
    pub air_curtain_on: bool,
    /// Whether the radiant heaters are on.
    pub radiant_heaters_on: bool,
    /// Whether the design has what the choice needs.
    pub available: bool,
    /// The best operation with this choice, where one meets the window.
    pub operation: Option<Operation>,
}

/// A cabin state with everything that the comparison of designs needs.
#[derive(Debug, Clone, Copy)]
struct State {
    temperatures: Temperatures,
    slopes: Slopes,
    pmv: f64,
    pmv_slope: f64,
}

/// Where a limit of the vote lies on the axis of the cabin temperature.
#[derive(Debug, Clone, Copy)]
enum Place {
    At(State),
    /// Colder than the coldest cabin.
    Below,
    /// Warmer than the hottest cabin.
    Above,
    Lost,
}

/// Solves all points of a sample, with buffers that are kept from sample to sample.
#[derive(Debug)]
pub struct SampleSolver<'a> {
    vehicle: &'a Vehicle,
    views: &'a PassengerViews,
    grid: &'a Grid,
    heater_states: usize,
    /// For each heater state, the place of each limit of the grid.
    limits: [Vec<Place>; 2],
}

const HEATERS: [Heaters; 2] = [Heaters::Off, Heaters::On];

impl<'a> SampleSolver<'a> {
    /// A solver for a grid. `views` are the vehicle's passengers, computed once per study.
    #[must_use]
    pub fn new(vehicle: &'a Vehicle, views: &'a PassengerViews, grid: &'a Grid) -> Self {
        let heater_states = if grid.designs().iter().any(|d| d.radiant_heaters) { 2 } else { 1 };
        let places = || vec![Place::Lost; grid.limits().len()];
        Self { vehicle, views, grid, heater_states, limits: [places(), places()] }
    }

    /// Solves every design and window for one sample; `optima` has [`Grid::points`] places and is filled design by
    /// design, each with its windows in the grid's order. Allocates nothing.
    pub fn solve(&mut self, disturbances: &Disturbances, optima: &mut [Optimum]) {
        let cabin = Cabin::new(self.vehicle, self.views, disturbances);
        let passive = self.prepare(&cabin);
        let mut points = optima.iter_mut();
        for (d, design) in self.grid.designs().iter().enumerate() {
            for w in 0..self.grid.windows().len() {
                let outcome = self.compare(&cabin, &passive, design, w);
                if let Some(point) = points.next() {
                    *point = Optimum { design: d, window: w, outcome };
                }
            }
        }
    }

    /// The four choices of heaters and curtain for one design and window, by their index in the grid.
    pub fn candidates(&mut self, disturbances: &Disturbances, design: usize, window: usize) -> [Candidate; 4] {
        self.heater_states = 2;
        let cabin = Cabin::new(self.vehicle, self.views, disturbances);
        let passive = self.prepare(&cabin);
        let design = &self.grid.designs()[design];
        [(false, false), (true, false), (false, true), (true, true)].map(|(curtain, heaters)| {
            let operation = match self.best(&cabin, &passive, design, window, curtain, heaters) {
                Outcome::Solved(operation, _) => Some(operation),
                Outcome::Infeasible(_) | Outcome::NotConverged => None,
            };
            let available = (design.air_curtain || !curtain) && (design.radiant_heaters || !heaters);
            Candidate { air_curtain_on: curtain, radiant_heaters_on: heaters, available, operation }
        })
    }

    /// Finds the places of all limits, and the passive states by heaters and curtain.
    fn prepare(&mut self, cabin: &Cabin) -> [[Option<State>; 2]; 2] {
        let mut passive = [[None; 2]; 2];
        for (h, &heaters) in HEATERS.iter().enumerate().take(self.heater_states) {
            let start = cabin.rough_guess(295.0, heaters);
            let without = passive_state(cabin, heaters, false, &start);
            let with = passive_state(cabin, heaters, true, &without.map_or(start, |s| s.temperatures));
            passive[h] = [without, with];
            let from = without.map_or(start, |s| s.temperatures);
            place_limits(cabin, heaters, self.grid.limits(), from, &mut self.limits[h]);
        }
        passive
    }

    /// The cheapest choice of heaters and curtain; of equal ones the one with fewer devices.
    fn compare(&self, cabin: &Cabin<'_>, passive: &[[Option<State>; 2]; 2], design: &Design, window: usize) -> Outcome {
        let mut best: Option<Operation> = None;
        let mut second_w: Option<f64> = None;
        let mut failure = Outcome::NotConverged;
        for (h, c) in [(false, false), (false, true), (true, false), (true, true)] {
            if (h && !design.radiant_heaters) || (c && !design.air_curtain) {
                continue;
            }
            match self.best(cabin, passive, design, window, c, h) {
                Outcome::Solved(operation, _) => {
                    let power_w = operation.hvac_power_w();
                    match best {
                        Some(b) if b.hvac_power_w() <= power_w => {
                            second_w = Some(second_w.map_or(power_w, |s| s.min(power_w)));
                        }
                        _ => {
                            second_w = best.map(|b| b.hvac_power_w());
                            best = Some(operation);
                        }
                    }
                }
                // One choice that does not settle leaves the optimum unproven.
                Outcome::NotConverged => return Outcome::NotConverged,
                infeasible @ Outcome::Infeasible(_) => failure = infeasible,
            }
        }
        match best {
            Some(operation) => Outcome::Solved(operation, second_w.map(|second| second - operation.hvac_power_w())),
            None => failure,
        }
    }

    /// The best operation with given heaters and curtain: the passive state moved into the window.
    fn best(
        &self,
        cabin: &Cabin<'_>,
        passive: &[[Option<State>; 2]; 2],
        design: &Design,
        window: usize,
        curtain: bool,
        heaters: bool,
    ) -> Outcome {
        let Some(passive) = passive[usize::from(heaters)][usize::from(curtain)] else {
            return Outcome::NotConverged;
        };
        let (low, high) = self.grid.window_limits()[window];
        let limits = &self.limits[usize::from(heaters)];
        let passive_k = passive.temperatures.cabin_k;
        let (state, mode) = match (limits[low], limits[high]) {
            (Place::Lost, _) | (_, Place::Lost) => return Outcome::NotConverged,
            (Place::Above, _) => return Outcome::Infeasible(Infeasible::TooCold),
            (_, Place::Below) => return Outcome::Infeasible(Infeasible::TooWarm),
            (Place::At(low), _) if passive_k < low.temperatures.cabin_k => (low, OperatingMode::Heating),
            (_, Place::At(high)) if passive_k > high.temperatures.cabin_k => (high, OperatingMode::Cooling),
            _ => (passive, OperatingMode::Passive),
        };
        let t = &state.temperatures;
        let air_unit_heat_w = match mode {
            OperatingMode::Passive => 0.0,
            _ => cabin.air_unit_heat_w(t, &state.slopes, curtain).0,
        };
        let lift_k = t.cabin_k - cabin.ambient_k();
        let air_unit_power_w = match mode {
            OperatingMode::Heating => air_unit_heat_w / design.heating_cop.at(lift_k),
            OperatingMode::Cooling => -air_unit_heat_w / design.cooling_cop.at(-lift_k),
            OperatingMode::Passive => 0.0,
        };
        let radiant_heater_power_w = if heaters { cabin.radiant_heater_power_w(t) } else { 0.0 };
        if radiant_heater_power_w < 0.0 {
            // Surroundings hotter than the panels' target: they cannot be held there by heating.
            return Outcome::Infeasible(Infeasible::TooWarm);
        }
        let operation = Operation {
            mode,
            air_curtain_on: curtain,
            radiant_heaters_on: heaters,
            air_unit_power_w,
            radiant_heater_power_w,
            air_curtain_power_w: if curtain { cabin.air_curtain_power_w() } else { 0.0 },
            air_unit_heat_w,
            temperatures: *t,
            mean_radiant_temperature_k: cabin.mean_radiant_temperature_k(t),
            pmv: state.pmv,
            standard_range: cabin.standard_range(t, state.pmv),
        };
        Outcome::Solved(operation, None)
    }
}

/// The state at a cabin temperature, from a neighbouring one.
fn state_at(cabin: &Cabin<'_>, cabin_k: f64, heaters: Heaters, near: &Temperatures) -> Option<State> {
    let (temperatures, slopes) = cabin.settle(cabin_k, heaters, near)?;
    let (pmv, pmv_slope) = cabin.mean_pmv(&temperatures, &slopes);
    Some(State { temperatures, slopes, pmv, pmv_slope })
}

/// The state in which the air unit has nothing to do, wherever on the temperature axis it lies.
fn passive_state(cabin: &Cabin<'_>, heaters: Heaters, curtain: bool, start: &Temperatures) -> Option<State> {
    let mut near = *start;
    // No bus is 200 K from the weather; the bracket only keeps Newton's steps sane.
    let (low, high) = (cabin.ambient_k() - 100.0, cabin.ambient_k() + 200.0);
    let root = rising_root(low.max(100.0), high, start.cabin_k, |cabin_k| {
        let (temperatures, slopes) = cabin.settle(cabin_k, heaters, &near)?;
        near = temperatures;
        Some(cabin.air_unit_heat_w(&temperatures, &slopes, curtain))
    });
    match root {
        Root::At(cabin_k) => state_at(cabin, cabin_k, heaters, &near),
        Root::Below | Root::Above | Root::Lost => None,
    }
}

/// Finds the state at every limit of the vote; the limits rise, so each starts from the one before.
fn place_limits(cabin: &Cabin<'_>, heaters: Heaters, limits: &[f64], start: Temperatures, places: &mut [Place]) {
    let mut near = start;
    let mut guess_k = near.cabin_k;
    let mut last: Option<State> = None;
    for (&limit, place) in limits.iter().zip(places) {
        if let Some(state) = last {
            guess_k = state.temperatures.cabin_k + (limit - state.pmv) / state.pmv_slope;
        }
        let root = rising_root(COLDEST_K, HOTTEST_K, guess_k, |cabin_k| {
            let state = state_at(cabin, cabin_k, heaters, &near)?;
            near = state.temperatures;
            Some((state.pmv - limit, state.pmv_slope))
        });
        *place = match root {
            Root::At(cabin_k) => match state_at(cabin, cabin_k, heaters, &near) {
                Some(state) => {
                    last = Some(state);
                    Place::At(state)
                }
                None => Place::Lost,
            },
            Root::Below => Place::Below,
            Root::Above => Place::Above,
            Root::Lost => Place::Lost,
        };
    }
}
