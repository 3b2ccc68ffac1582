//! A steady state of the cabin, found by one Newton iteration over everything at once.
//!
//! Unknowns are the temperatures of cabin and surfaces and the clothing temperature of the passengers. A step linearises
//! the balances and the clothing's heat balance, which makes everything follow the cabin temperature along a line; the
//! [`Target`] then says how far along it to go. No clothing iteration and no balance iteration is nested in another.

use crate::comfort::Nodes;
use crate::pmv::Line;
use crate::{Cabin, Design, Devices, Heaters, OperatingMode, Slopes, Temperatures};

/// What a steady state has to fulfil besides the surface balances.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Target {
    /// A cabin temperature in K.
    CabinTemperature(f64),
    /// A mean vote of the passengers.
    Vote(f64),
    /// Heat from the air unit along a line over the cabin temperature.
    Heat {
        /// Whether the air curtains run.
        curtain: bool,
        /// Heat in W at `at_k`.
        heat_w: f64,
        /// How much more for each kelvin of the cabin; less than the heat that a state takes.
        per_k: f64,
        /// Cabin temperature in K.
        at_k: f64,
    },
}

impl Target {
    /// No heat from the air unit, with the air curtains on or off.
    #[must_use]
    pub fn passive(curtain: bool) -> Self {
        Self::Heat { curtain, heat_w: 0.0, per_k: 0.0, at_k: 0.0 }
    }
}

/// A steady state, or the guess of one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct State {
    /// Temperatures of the reservoirs.
    pub temperatures: Temperatures,
    /// Slopes of the surfaces over the cabin temperature.
    pub slopes: Slopes,
    /// Mean over the passengers of the predicted mean vote.
    pub pmv: f64,
    /// Its slope over the cabin temperature in 1/K, above 0.
    pub pmv_slope: f64,
    /// Clothing of the two passengers of the quadrature, in the standard's kelvin (0 °C = 273 K).
    clothes: [Line; 2],
}

/// Steps after which the iteration is given up; four are usual from a rough guess.
const MOST_STEPS: usize = 60;
/// Convergence is quadratic: what a step below 10 µK leaves behind is below rounding.
const SETTLED_K: f64 = 1e-5;
/// Longest step of the cabin temperature in K.
const LONGEST_STEP_K: f64 = 50.0;
/// Over which the slope of a capacity is taken, in K.
const SLOPE_STEP_K: f64 = 1e-3;
/// Farthest prediction beyond two states, in units of their distance.
const FARTHEST: f64 = 3.0;

impl Cabin<'_> {
    /// A guess that needs no knowledge: everything as warm as the cabin, at `cabin_k` in K.
    #[must_use]
    pub fn rough_state(&self, cabin_k: f64) -> State {
        let temperatures = Temperatures {
            cabin_k,
            interior_k: cabin_k,
            shell_inside_k: cabin_k,
            shell_outside_k: self.ambient_k,
            radiant_heater_k: cabin_k,
        };
        let slopes = Slopes { interior: 0.0, shell_inside: 0.0, shell_outside: 0.0, radiant_heater: 0.0 };
        // Clothing is some kelvin warmer than the air.
        let clothes = [Line { value: cabin_k + 5.0, per_air_k: 0.0 }; 2];
        State { temperatures, slopes, pmv: 0.0, pmv_slope: 0.0, clothes }
    }

    /// The steady state that fulfils a target, from a guess. The panels are off, or held at their target.
    ///
    /// `None` where the iteration does not settle, which no physical input has been seen to cause.
    #[must_use]
    pub fn state(&self, target: Target, heaters: Heaters, guess: &State) -> Option<State> {
        let mut state = *guess;
        self.settle_state(target, heaters, &mut state).then_some(state)
    }

    /// As [`Cabin::state`], with the guess in place; `false` where the iteration does not settle.
    pub fn settle_state(&self, target: Target, heaters: Heaters, state: &mut State) -> bool {
        if let Target::CabinTemperature(cabin_k) = target {
            state.temperatures.cabin_k = cabin_k;
        }
        if heaters == Heaters::On {
            state.temperatures.radiant_heater_k = self.heater_target_k;
        }
        let mut clothes = state.clothes;
        if !self.settle(state, &self.views.nodes(), &mut clothes, heaters, target) {
            return false;
        }
        state.clothes = clothes;
        // The kink moves a little as the state settles on the split quadrature.
        for _ in 0..2 {
            let Some(view) = self.kink_view(&state.temperatures, &clothes) else { break };
            let (nodes, mut split) = self.split(view, &clothes);
            if !self.settle(state, &nodes, &mut split, heaters, target) {
                return false;
            }
        }
        if let Target::Vote(pmv) = target {
            // As it is to rounding: a window of no width then has votes of 0, not of 1e-27.
            state.pmv = pmv;
        }
        true
    }

    /// The state in which the air unit gives all that a design has in a mode: there the heat that the cabin takes, which rises
    /// with its temperature, meets what there is, which does not. Newton's method on both.
    ///
    /// `None` where the iteration does not settle, or the mode is passive.
    #[must_use]
    pub fn capacity_state(
        &self,
        design: &Design,
        devices: Devices,
        mode: OperatingMode,
        guess: &State,
    ) -> Option<State> {
        let sign = match mode {
            OperatingMode::Heating => 1.0,
            OperatingMode::Cooling => -1.0,
            OperatingMode::Passive => return None,
        };
        let most_w =
            |cabin_k: f64| sign * design.capacity_w(mode, self.ambient_k, mode.lift_k(self.ambient_k, cabin_k));
        let mut state = *guess;
        for _ in 0..MOST_STEPS {
            let at_k = state.temperatures.cabin_k;
            let heat_w = most_w(at_k);
            // What rises with the temperature here is a rounding error.
            let per_k = ((most_w(at_k + SLOPE_STEP_K) - heat_w) / SLOPE_STEP_K).min(0.0);
            let target = Target::Heat { curtain: devices.air_curtain, heat_w, per_k, at_k };
            if !self.settle_state(target, devices.heaters(), &mut state) {
                return None;
            }
            if (state.temperatures.cabin_k - at_k).abs() < SETTLED_K {
                return Some(state);
            }
        }
        None
    }

    fn settle<const N: usize>(
        &self,
        state: &mut State,
        nodes: &Nodes<N>,
        clothes: &mut [Line; N],
        heaters: Heaters,
        target: Target,
    ) -> bool {
        (0..MOST_STEPS).any(|_| self.step(state, nodes, clothes, heaters, target) < SETTLED_K)
    }

    /// One Newton step; returns by how many K all temperatures change together.
    #[inline]
    fn step<const N: usize>(
        &self,
        state: &mut State,
        nodes: &Nodes<N>,
        clothes: &mut [Line; N],
        heaters: Heaters,
        target: Target,
    ) -> f64 {
        let t = &mut state.temperatures;
        let cubes = [t.radiant_heater_k, t.interior_k, t.shell_inside_k, t.shell_outside_k].map(|k| k * k * k);
        let (balanced, slopes) = self.balanced(t, cubes, heaters);
        let (vote, lines) = self.vote_line(t, cubes, (&balanced, &slopes), nodes, clothes);
        let cabin_step_k = match target {
            Target::CabinTemperature(_) => 0.0,
            Target::Vote(pmv) => (pmv - vote.value) / vote.per_air_k,
            Target::Heat { curtain, heat_w, per_k, at_k } => {
                let (taken_w, slope_w_k) = self.air_unit_heat_w(&balanced, &slopes, curtain);
                let brought_w = heat_w + per_k * (t.cabin_k - at_k);
                (brought_w - taken_w) / (slope_w_k - per_k)
            }
        };
        let cabin_step_k = cabin_step_k.clamp(-LONGEST_STEP_K, LONGEST_STEP_K);
        // A sum, not the largest: it is no number as soon as one of them is none.
        let mut moved_k = cabin_step_k.abs();
        let mut follow = |k: &mut f64, balanced_k: f64, slope: f64| {
            let next_k = balanced_k + slope * cabin_step_k;
            moved_k += (next_k - *k).abs();
            *k = next_k;
        };
        t.cabin_k += cabin_step_k;
        follow(&mut t.interior_k, balanced.interior_k, slopes.interior);
        follow(&mut t.shell_inside_k, balanced.shell_inside_k, slopes.shell_inside);
        follow(&mut t.shell_outside_k, balanced.shell_outside_k, slopes.shell_outside);
        follow(&mut t.radiant_heater_k, balanced.radiant_heater_k, slopes.radiant_heater);
        for (clothing, line) in clothes.iter_mut().zip(lines) {
            follow(&mut clothing.value, line.value, line.per_air_k);
            clothing.per_air_k = line.per_air_k;
        }
        state.slopes = slopes;
        state.pmv = vote.value + vote.per_air_k * cabin_step_k;
        state.pmv_slope = vote.per_air_k;
        moved_k
    }
}

impl State {
    /// A guess of the state with the vote `pmv`, from this state and another one on the way: Hermite's cubic through both with
    /// their slopes, where it leads not much farther than their distance, or else the tangent.
    #[must_use]
    pub fn toward(&self, pmv: f64, other: Option<&Self>) -> Self {
        let step = pmv - self.pmv;
        let last = self.unknowns();
        let values = match other {
            Some(other) if step.abs() < FARTHEST * (self.pmv - other.pmv).abs() => {
                let width = self.pmv - other.pmv;
                let s = step / width;
                // Hermite's basis at 1 + s.
                let (first_value, first_slope) = (s * s * (3.0 + 2.0 * s), s * s * (1.0 + s) * width);
                let last_slope = s * (1.0 + s) * (1.0 + s) * width;
                let first = other.unknowns();
                std::array::from_fn(|i| {
                    let ((x0, slope0), (x1, slope1)) = (first[i], last[i]);
                    x1 + (x0 - x1) * first_value + slope0 * first_slope + slope1 * last_slope
                })
            }
            _ => last.map(|(x, slope)| x + slope * step),
        };
        self.with(values)
    }

    /// All unknowns with their slopes over the vote.
    fn unknowns(&self) -> [(f64, f64); 7] {
        let (t, slopes) = (&self.temperatures, &self.slopes);
        let [a, b] = &self.clothes;
        let per_vote_k = 1.0 / self.pmv_slope;
        [
            (t.cabin_k, 1.0),
            (t.interior_k, slopes.interior),
            (t.shell_inside_k, slopes.shell_inside),
            (t.shell_outside_k, slopes.shell_outside),
            (t.radiant_heater_k, slopes.radiant_heater),
            (a.value, a.per_air_k),
            (b.value, b.per_air_k),
        ]
        .map(|(x, slope)| (x, slope * per_vote_k))
    }

    fn with(&self, [cabin_k, interior_k, shell_inside_k, shell_outside_k, radiant_heater_k, a, b]: [f64; 7]) -> Self {
        let mut guess = *self;
        guess.temperatures = Temperatures { cabin_k, interior_k, shell_inside_k, shell_outside_k, radiant_heater_k };
        (guess.clothes[0].value, guess.clothes[1].value) = (a, b);
        guess
    }
}
