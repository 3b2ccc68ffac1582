//! The dynamic model over one second, of all lanes.

use cabin::{Cabin, Cop, Design, Heating, Lanes, OperatingMode, Real, Temperatures};

use crate::Dynamics;

/// The states of the model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BusState {
    /// Temperatures of the five reservoirs.
    pub temperatures: Temperatures,
    /// Heat that the air unit's machine gives in W, negative when it cools: what lags behind its power.
    pub machine_heat_w: f64,
}

/// What the controllers ask for, held over a second.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Commands {
    /// Electric power of the air unit in W; negative where it cools.
    pub air_unit_power_w: f64,
    /// Electric power of the radiant heaters in W.
    pub radiant_heater_power_w: f64,
    /// Whether the air curtains run.
    pub air_curtain_on: bool,
}

/// Temperature of a bus that comes from the depot, in K (paper, eq. `depot-temperature`).
#[must_use]
pub fn depot_temperature_k(ambient_k: f64) -> f64 {
    const MILD_K: f64 = 293.15;
    (ambient_k - MILD_K) * 0.5 + MILD_K
}

/// Heaters, interior, cabin, inside and outside of the shell in K, heat of the machine in W; or what drives them, all in W.
pub(crate) type Vector<const W: usize> = [Lanes<W>; 6];

/// Places of cabin air and machine in it.
const AIR: usize = 2;
const MACHINE: usize = 5;

/// The temperatures of a vector.
#[inline(always)]
pub(crate) fn temperatures<const W: usize>(
    &[heater, interior, cabin, inside, outside, _]: &Vector<W>,
) -> Temperatures<Lanes<W>> {
    Temperatures {
        cabin_k: cabin,
        interior_k: interior,
        shell_inside_k: inside,
        shell_outside_k: outside,
        radiant_heater_k: heater,
    }
}

impl BusState {
    /// The states of a lane.
    pub(crate) fn of<const W: usize>(x: &Vector<W>, lane: usize) -> Self {
        let [heater, interior, cabin, inside, outside, machine_heat_w] = x.map(|x| x.0[lane]);
        let temperatures = Temperatures {
            cabin_k: cabin,
            interior_k: interior,
            shell_inside_k: inside,
            shell_outside_k: outside,
            radiant_heater_k: heater,
        };
        Self { temperatures, machine_heat_w }
    }

    pub(crate) fn put<const W: usize>(&self, x: &mut Vector<W>, lane: usize) {
        let t = &self.temperatures;
        let all =
            [t.radiant_heater_k, t.interior_k, t.cabin_k, t.shell_inside_k, t.shell_outside_k, self.machine_heat_w];
        for (x, value) in x.iter_mut().zip(all) {
            x.0[lane] = value;
        }
    }
}

/// The air units in their present modes. A resistive heater gives its heat at once; a heat pump and the air conditioning lag
/// (paper, eq. `vcc-ode`).
#[derive(Debug, Clone)]
pub(crate) struct AirUnits<'d, const W: usize> {
    designs: [&'d Design; W],
    modes: [OperatingMode; W],
    /// Whether any curve has no formula of its own here.
    any_other: bool,
    others: [Option<&'d Cop>; W],
    /// 1 where the lift is that of heating, −1 where it is that of cooling.
    warms: Lanes<W>,
    /// COP = clamp(constant − slope · lift + numerator / (max(lift, 0) + offset)).
    constant: Lanes<W>,
    slope_per_k: Lanes<W>,
    numerator_k: Lanes<W>,
    offset_k: Lanes<W>,
    least: Lanes<W>,
    largest: Lanes<W>,
    /// 1 where heat comes at once, 0 where it lags; and the other way round.
    at_once: Lanes<W>,
    lags: Lanes<W>,
}

impl<'d, const W: usize> AirUnits<'d, W> {
    pub fn new(designs: [&'d Design; W], modes: [OperatingMode; W]) -> Self {
        let mut units = Self {
            designs,
            modes,
            any_other: false,
            others: [None; W],
            warms: Lanes::ONE,
            constant: Lanes::ZERO,
            slope_per_k: Lanes::ZERO,
            numerator_k: Lanes::ZERO,
            offset_k: Lanes::ONE,
            least: Lanes::ZERO,
            largest: Lanes::ZERO,
            at_once: Lanes::ZERO,
            lags: Lanes::ZERO,
        };
        units.refresh();
        units
    }

    /// Follows the modes.
    pub fn follow(&mut self, modes: &[OperatingMode; W]) {
        if self.modes != *modes {
            self.modes = *modes;
            self.refresh();
        }
    }

    fn refresh(&mut self) {
        for lane in 0..W {
            let design = self.designs[lane];
            let cools = self.modes[lane] == OperatingMode::Cooling;
            let cop = if cools { &design.cooling_cop } else { &design.heating_cop };
            let unbounded = [f64::NEG_INFINITY, f64::INFINITY];
            let (formula, [least, largest]) = match cop {
                Cop::Constant(cop) => (Some([*cop, 0.0, 0.0, 1.0]), unbounded),
                Cop::Linear { at_zero, slope_per_k, min, max } => {
                    (Some([*at_zero, *slope_per_k, 0.0, 1.0]), [*min, *max])
                }
                Cop::Hyperbola { numerator_k, offset_k, min, max } => {
                    (Some([0.0, 0.0, *numerator_k, *offset_k]), [*min, *max])
                }
                Cop::Exponential { .. } | Cop::Table(_) | Cop::Changed { .. } => (None, unbounded),
            };
            let [constant, slope_per_k, numerator_k, offset_k] = formula.unwrap_or([0.0, 0.0, 0.0, 1.0]);
            self.others[lane] = if formula.is_none() { Some(cop) } else { None };
            self.warms.0[lane] = if cools { -1.0 } else { 1.0 };
            self.constant.0[lane] = constant;
            self.slope_per_k.0[lane] = slope_per_k;
            self.numerator_k.0[lane] = numerator_k;
            self.offset_k.0[lane] = offset_k;
            self.least.0[lane] = least;
            self.largest.0[lane] = largest;
            let at_once = !cools && design.heating == Heating::Ptc;
            self.at_once.0[lane] = f64::from(u8::from(at_once));
            self.lags.0[lane] = f64::from(u8::from(!at_once));
        }
        self.any_other = self.others.iter().any(Option::is_some);
    }

    /// COP over cabin temperature less ambient temperature in K.
    #[inline(always)]
    fn cop(&self, above_ambient_k: Lanes<W>) -> Lanes<W> {
        let lift_k = self.warms * above_ambient_k;
        let inverse = Lanes::ONE / (lift_k.max(Lanes::ZERO) + self.offset_k);
        let linear = self.slope_per_k.mul_add(-lift_k, self.constant);
        let mut cop = self.numerator_k.mul_add(inverse, linear).max(self.least).min(self.largest);
        if self.any_other {
            for (lane, other) in self.others.iter().enumerate() {
                if let Some(curve) = other {
                    cop.0[lane] = curve.at(lift_k.0[lane]);
                }
            }
        }
        cop
    }

    /// Slope of the COP over cabin temperature in 1/K; 0 at its bounds.
    #[inline(always)]
    fn cop_slope(&self, above_ambient_k: Lanes<W>) -> Lanes<W> {
        let lift_k = self.warms * above_ambient_k;
        let inverse = Lanes::ONE / (lift_k.max(Lanes::ZERO) + self.offset_k);
        let hyperbola = self.numerator_k * inverse;
        let cop = self.numerator_k.mul_add(inverse, self.slope_per_k.mul_add(-lift_k, self.constant));
        let of_hyperbola = lift_k.above(Lanes::ZERO, hyperbola * inverse, Lanes::ZERO);
        let slope = -self.warms * (self.slope_per_k + of_hyperbola);
        let below_largest = self.largest.above(cop, slope, Lanes::ZERO);
        cop.above(self.least, below_largest, Lanes::ZERO)
    }
}

/// One over the heat capacities and the time constant, in the order of a [`Vector`].
#[derive(Debug, Clone, Copy)]
pub(crate) struct Rates([f64; 6]);

impl Rates {
    pub fn new(d: &Dynamics) -> Self {
        Self(
            [
                d.radiant_heater_capacity_j_k,
                d.interior_capacity_j_k,
                d.cabin_capacity_j_k,
                d.shell_inside_capacity_j_k,
                d.shell_outside_capacity_j_k,
                d.air_unit_time_constant_s,
            ]
            .map(f64::recip),
        )
    }

    /// Where net heats bring the states in so many seconds.
    #[inline(always)]
    fn along<const W: usize>(&self, x: &Vector<W>, net_w: &Vector<W>, seconds: f64) -> Vector<W> {
        let mut out = *x;
        for (i, rate) in self.0.iter().enumerate() {
            out[i] = net_w[i].mul_add(rate * seconds, x[i]);
        }
        out
    }
}

/// What acts on the states during a second.
pub(crate) struct Second<'s, const W: usize> {
    pub cabin: &'s Cabin<'s>,
    pub air_units: &'s AirUnits<'s, W>,
    pub air_unit_power_w: Lanes<W>,
    pub radiant_heater_power_w: Lanes<W>,
    /// [`Cabin::door_loss_share`] of each lane.
    pub door_loss_share: Lanes<W>,
}

impl<const W: usize> Second<'_, W> {
    /// The states a second later. Two looks at the net heats, at its start and two thirds into it (Ralston's method), are all
    /// that third order needs but for how slopes bring about slopes, which the Jacobian tells as in Rosenbrock's methods;
    /// applied twice, it makes the method one of fourth order where the equations are linear (Hairer, Nørsett, Wanner, Solving
    /// Ordinary Differential Equations I, section II.1, and II, section IV.7).
    ///
    /// Of the Jacobian it takes the columns of cabin air and machine. The other reservoirs are slow: what their changes would
    /// bring about within a second is left out, on both sides of each flow, so that no heat is lost.
    #[inline(always)]
    pub fn step(&self, rates: &Rates, x: &Vector<W>) -> Vector<W> {
        let start = self.net_w(x);
        let later = self.net_w(&rates.along(x, &start, 2.0 / 3.0));
        let mut bend = later;
        for (bend, start) in bend.iter_mut().zip(start) {
            *bend = *bend - start;
        }
        let [heater, interior, air, inside, machine] = self.net_per_air_w_k(x);
        // What changes of air and machine bring about in these two; the machine's heat goes into the air.
        let turn =
            |[air_k, machine_w]: [Lanes<W>; 2]| [air_k.mul_add(air, machine_w), air_k.mul_add(machine, -machine_w)];
        let change = |[air_w, machine_w]: [Lanes<W>; 2]| [air_w * rates.0[AIR], machine_w * rates.0[MACHINE]];
        let first = change([bend[AIR], bend[MACHINE]]);
        let second_w = turn(first);
        let second = change(second_w);
        let third_w = turn(second);
        let both = |once: Lanes<W>, twice: Lanes<W>| twice.mul_add(0.0625, once * 0.25);
        let air_k = both(first[0], second[0]);
        let turns = [
            air_k * heater,
            air_k * interior,
            both(second_w[0], third_w[0]),
            air_k * inside,
            Lanes::ZERO,
            both(second_w[1], third_w[1]),
        ];
        let mut mean_w = start;
        for i in 0..mean_w.len() {
            mean_w[i] = start[i] + bend[i].mul_add(0.75, turns[i]);
        }
        rates.along(x, &mean_w, 1.0)
    }

    /// Net heat of each reservoir (eq. `odes` with eq. `steady-state-hc`), and what the machine takes up, in W (its first-order
    /// lag, eq. `vcc-ode`).
    #[inline(always)]
    fn net_w(&self, x: &Vector<W>) -> Vector<W> {
        let t = temperatures(x);
        let machine_w = x[MACHINE];
        let given_w = self.air_units.cop(t.cabin_k - self.cabin.ambient_k()) * self.air_unit_power_w;
        let air_unit_w = given_w.mul_add(self.air_units.at_once, machine_w);
        let [heater, interior, cabin, inside, outside] =
            self.cabin.net_w(&t, self.door_loss_share, air_unit_w, self.radiant_heater_power_w);
        [heater, interior, cabin, inside, outside, given_w.mul_add(self.air_units.lags, -machine_w)]
    }

    /// How these change with the cabin air, in W/K: of all but the outside of the shell. COP curves without a formula of their
    /// own here count as level.
    #[inline(always)]
    fn net_per_air_w_k(&self, x: &Vector<W>) -> [Lanes<W>; 5] {
        let cabin_k = x[AIR];
        let given_w_k = self.air_units.cop_slope(cabin_k - self.cabin.ambient_k()) * self.air_unit_power_w;
        let door_slope_w_k = self.cabin.door_slope_w_k(cabin_k, self.door_loss_share);
        let [heater, interior, cabin, inside] = self.cabin.net_per_air_w_k(door_slope_w_k);
        let cabin = given_w_k.mul_add(self.air_units.at_once, cabin);
        [heater, interior, cabin, inside, given_w_k * self.air_units.lags]
    }
}
