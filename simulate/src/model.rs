//! The dynamic model over one second.

use cabin::{Cabin, Design, Temperatures};

use crate::Dynamics;

/// The states of the model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BusState {
    /// Temperatures of the five reservoirs.
    pub temperatures: Temperatures,
    /// Heat that the air unit gives in W, negative when it cools.
    pub air_unit_heat_w: f64,
}

/// What the controllers ask for, held over the step.
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

/// Heaters, interior, cabin, inside and outside of the shell in K, heat of the air unit in W; or their slopes.
type Vector = [f64; 6];

impl BusState {
    fn vector(&self) -> Vector {
        let t = &self.temperatures;
        [t.radiant_heater_k, t.interior_k, t.cabin_k, t.shell_inside_k, t.shell_outside_k, self.air_unit_heat_w]
    }

    fn from_vector([heater, interior, cabin, inside, outside, air_unit_heat_w]: Vector) -> Self {
        let temperatures = Temperatures {
            cabin_k: cabin,
            interior_k: interior,
            shell_inside_k: inside,
            shell_outside_k: outside,
            radiant_heater_k: heater,
        };
        Self { temperatures, air_unit_heat_w }
    }
}

/// The state after `seconds`, with loads, weather and commands held: the classical Runge-Kutta method of fourth order. Over
/// one second, the step of the telemetry, its error is far below a millikelvin.
#[must_use]
#[inline]
pub fn step(
    cabin: &Cabin<'_>,
    design: &Design,
    dynamics: &Dynamics,
    state: &BusState,
    commands: &Commands,
    seconds: f64,
) -> BusState {
    let slope = |x: &Vector| derivative(cabin, design, dynamics, x, commands);
    let x = state.vector();
    let along = |k: &Vector, h: f64| std::array::from_fn(|i| x[i] + h * k[i]);
    let k1 = slope(&x);
    let k2 = slope(&along(&k1, 0.5 * seconds));
    let k3 = slope(&along(&k2, 0.5 * seconds));
    let k4 = slope(&along(&k3, seconds));
    BusState::from_vector(std::array::from_fn(|i| x[i] + seconds / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i])))
}

#[inline]
fn derivative(cabin: &Cabin<'_>, design: &Design, d: &Dynamics, x: &Vector, c: &Commands) -> Vector {
    let BusState { temperatures: t, air_unit_heat_w } = BusState::from_vector(*x);
    // Eq. `odes`.
    let net_w = cabin.flows(&t, c.air_curtain_on, air_unit_heat_w, c.radiant_heater_power_w).net_w();
    // Eq. `steady-state-hc` and its first-order lag, eq. `vcc-ode`.
    let lift_k = t.cabin_k - cabin.ambient_k();
    let cop = if c.air_unit_power_w >= 0.0 { design.heating_cop.at(lift_k) } else { design.cooling_cop.at(-lift_k) };
    [
        net_w[0] / d.radiant_heater_capacity_j_k,
        net_w[1] / d.interior_capacity_j_k,
        net_w[2] / d.cabin_capacity_j_k,
        net_w[3] / d.shell_inside_capacity_j_k,
        net_w[4] / d.shell_outside_capacity_j_k,
        (cop * c.air_unit_power_w - air_unit_heat_w) / d.air_unit_time_constant_s,
    ]
}
