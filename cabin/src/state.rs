//! A steady state of the cabin: what it has to fulfil, how it is found from a guess, and how it leads to the next guess.

use crate::newton::{MOST_STEPS, Newton, SETTLED_K};
use crate::pmv::Line;
use crate::{Cabin, Design, Devices, Heaters, Lanes, OperatingMode, Real, Slopes, Temperatures};

/// What a steady state has to fulfil besides the surface balances; of one state, or of several abreast.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Target<R = f64> {
    /// A cabin temperature in K.
    CabinTemperature(R),
    /// A mean vote of the passengers.
    Vote(R),
    /// Heat from the air unit along a line over the cabin temperature.
    Heat {
        /// [`Cabin::door_loss_share`].
        door_loss_share: R,
        /// Heat in W at `at_k`.
        heat_w: R,
        /// How much more for each kelvin of the cabin; less than the heat that a state takes.
        per_k: R,
        /// Cabin temperature in K.
        at_k: R,
    },
}

impl<R: Real> Target<R> {
    /// No heat from the air unit, where so much of the door loss is left as [`Cabin::door_loss_share`] says.
    #[must_use]
    pub fn passive(door_loss_share: R) -> Self {
        let zero = R::splat(0.0);
        Self::Heat { door_loss_share, heat_w: zero, per_k: zero, at_k: zero }
    }
}

/// A steady state, or the guess of one; or several abreast.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct State<R = f64> {
    /// Temperatures of the reservoirs.
    pub temperatures: Temperatures<R>,
    /// Slopes of the surfaces over the cabin temperature.
    pub slopes: Slopes<R>,
    /// Mean over the passengers of the predicted mean vote.
    pub pmv: R,
    /// Its slope over the cabin temperature in 1/K, above 0.
    pub pmv_slope: R,
    /// Clothing of the two passengers of the quadrature, in the standard's kelvin (0 °C = 273 K).
    pub(crate) clothes: [Line<R>; 2],
}

/// Over which the slope of a capacity is taken, in K.
const SLOPE_STEP_K: f64 = 1e-3;

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
        let held = heaters.held();
        let moving = self.settle_whole(&target, held, state);
        !moving.any() && (!self.near_kink(state).any() || self.settle_split(&target, held, state))
    }

    /// As [`Cabin::settle_state`], of several states abreast, each with its heaters; says which of them settle. It is compiled
    /// with the instructions of whoever calls it.
    #[inline(always)]
    pub fn settle_abreast<const W: usize>(
        &self,
        target: &Target<Lanes<W>>,
        heaters: [Heaters; W],
        state: &mut State<Lanes<W>>,
    ) -> [bool; W] {
        let held = Lanes(heaters.map(Heaters::held));
        let moving = self.settle_whole(target, held, state);
        let mut settles = moving.0.map(|moving| moving == 0.0);
        let near = self.near_kink(state);
        for lane in (0..W).filter(|lane| near.0[*lane] > 0.0) {
            let mut own = state.lane(lane);
            settles[lane] &= self.settle_split(&target.lane(lane), held.0[lane], &mut own);
            state.set_lane(lane, &own);
        }
        settles
    }

    /// Settles on the quadrature of all passengers; 0 where it does, 1 where it does not.
    #[inline(always)]
    fn settle_whole<R: Real>(&self, target: &Target<R>, held: R, state: &mut State<R>) -> R {
        if let Target::CabinTemperature(cabin_k) = *target {
            state.temperatures.cabin_k = cabin_k;
        }
        let heater_k = &mut state.temperatures.radiant_heater_k;
        *heater_k = held.above(R::splat(0.5), R::splat(self.heater_target_k), *heater_k);
        let mut clothes = state.clothes;
        let nodes = &self.views.nodes();
        let moving = Newton { cabin: self, target, held, nodes, state, clothes: &mut clothes }.run();
        state.clothes = clothes;
        moving
    }

    /// Settles a state that is settled on the quadrature of all passengers on a split one where they need it; `false` where the
    /// iteration does not settle.
    #[inline(never)]
    fn settle_split(&self, target: &Target, held: f64, state: &mut State) -> bool {
        let clothes = state.clothes;
        // The kink moves a little as the state settles on the split quadrature.
        for _ in 0..2 {
            let Some(view) = self.kink_view(state) else { break };
            let (nodes, mut split) = self.split(view, &clothes);
            let newton = Newton { cabin: self, target, held, nodes: &nodes, state, clothes: &mut split };
            if newton.run().any() {
                return false;
            }
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
            let door_loss_share = self.door_loss_share(devices.air_curtain);
            let target = Target::Heat { door_loss_share, heat_w, per_k, at_k };
            if !self.settle_state(target, devices.heaters(), &mut state) {
                return None;
            }
            if (state.temperatures.cabin_k - at_k).abs() < SETTLED_K {
                return Some(state);
            }
        }
        None
    }
}

impl<R: Real> State<R> {
    /// All unknowns, and their slopes over the cabin temperature.
    #[inline(always)]
    fn unknowns(&self) -> ([R; 7], [R; 7]) {
        let (t, slopes) = (&self.temperatures, &self.slopes);
        let [a, b] = &self.clothes;
        let values =
            [t.cabin_k, t.interior_k, t.shell_inside_k, t.shell_outside_k, t.radiant_heater_k, a.value, b.value];
        let one = R::splat(1.0);
        let Slopes { interior, shell_inside, shell_outside, radiant_heater } = *slopes;
        (values, [one, interior, shell_inside, shell_outside, radiant_heater, a.per_air_k, b.per_air_k])
    }

    #[inline(always)]
    fn with(&self, [cabin_k, interior_k, shell_inside_k, shell_outside_k, radiant_heater_k, a, b]: [R; 7]) -> Self {
        let mut guess = *self;
        guess.temperatures = Temperatures { cabin_k, interior_k, shell_inside_k, shell_outside_k, radiant_heater_k };
        (guess.clothes[0].value, guess.clothes[1].value) = (a, b);
        guess
    }

    /// A guess of the state with the vote `pmv`, along the tangent.
    #[must_use]
    #[inline(always)]
    pub fn along(&self, pmv: R) -> Self {
        let step_k = (pmv - self.pmv) / self.pmv_slope;
        let (mut values, slopes) = self.unknowns();
        for (value, slope) in values.iter_mut().zip(slopes) {
            *value = slope.mul_add(step_k, *value);
        }
        self.with(values)
    }

    /// A guess of the state with the vote `pmv`, from this state and another one on the way: Hermite's cubic through both with
    /// their slopes. It is good where it leads not much farther than their distance.
    #[must_use]
    #[inline(always)]
    pub fn beyond(&self, pmv: R, other: &Self) -> Self {
        let width = self.pmv - other.pmv;
        let s = (pmv - self.pmv) / width;
        let next = s + 1.0;
        // Hermite's basis at 1 + s.
        let other_value = s * s * (s * 2.0 + 3.0);
        let other_slope = s * s * next * width / other.pmv_slope;
        let own_slope = s * next * next * width / self.pmv_slope;
        let ((others, other_slopes), (mut values, slopes)) = (other.unknowns(), self.unknowns());
        for i in 0..values.len() {
            let value = (others[i] - values[i]).mul_add(other_value, values[i]);
            values[i] = slopes[i].mul_add(own_slope, other_slopes[i].mul_add(other_slope, value));
        }
        self.with(values)
    }
}
