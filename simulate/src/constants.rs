//! What the dynamic model needs beyond the constants of the bus.

use serde::{Deserialize, Serialize};

/// Heat capacities, time constants, controller and power limits; [`Dynamics::default`] is the bus of the paper (section "Model
/// Constants"). Values marked *substitute* are not printed there.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Dynamics {
    /// Heat capacity of the cabin air C_cab in J/K.
    pub cabin_capacity_j_k: f64,
    /// Heat capacity of the interior C_int in J/K.
    pub interior_capacity_j_k: f64,
    /// Heat capacity of the inside of the shell C_s,i in J/K.
    pub shell_inside_capacity_j_k: f64,
    /// Heat capacity of the outside of the shell C_s,o in J/K.
    pub shell_outside_capacity_j_k: f64,
    /// Heat capacity of the radiant heaters C_rh in J/K.
    pub radiant_heater_capacity_j_k: f64,
    /// Time constant of the air unit τ_vcc in s.
    pub air_unit_time_constant_s: f64,
    /// Gain of the cabin controller in W/K (of electric power).
    pub controller_gain_w_k: f64,
    /// Integral time of the cabin controller in s.
    pub controller_integral_s: f64,
    /// Largest electric power of a heat pump in W.
    pub heat_pump_limit_w: f64,
    /// Largest power of a resistive heater in W (*substitute*: none is stated).
    pub ptc_limit_w: f64,
    /// Largest electric power of the air conditioning in W (*substitute*: that of the heat pump, which is the same machine).
    pub cooling_limit_w: f64,
    /// Gain of the radiant heaters' controller in W/K (*substitute*).
    pub heater_gain_w_k: f64,
    /// Integral time of the radiant heaters' controller in s (*substitute*).
    pub heater_integral_s: f64,
    /// Largest power of the radiant heaters in W (*substitute*).
    pub heater_limit_w: f64,
}

impl Default for Dynamics {
    fn default() -> Self {
        Self {
            cabin_capacity_j_k: 146_600.0,
            interior_capacity_j_k: 78_000.0,
            shell_inside_capacity_j_k: 856_100.0,
            shell_outside_capacity_j_k: 856_100.0,
            radiant_heater_capacity_j_k: 4_800.0,
            air_unit_time_constant_s: 20.0,
            controller_gain_w_k: 2_000.0,
            controller_integral_s: 100.0,
            heat_pump_limit_w: 12_000.0,
            ptc_limit_w: 60_000.0,
            cooling_limit_w: 12_000.0,
            heater_gain_w_k: 100.0,
            heater_integral_s: 100.0,
            heater_limit_w: 6_000.0,
        }
    }
}

/// A constant lies outside the range in which the model has a meaning.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("dynamics.{name} = {value} must be a number of at least {least}")]
pub struct DynamicsError {
    /// Name of the constant.
    pub name: &'static str,
    /// Its value.
    pub value: f64,
    /// The least that the integrator's step of one second stands.
    pub least: f64,
}

impl Dynamics {
    /// Checks every constant.
    ///
    /// # Errors
    /// The first that is out of its range.
    pub fn check(&self) -> Result<(), DynamicsError> {
        let all = [
            ("cabin_capacity_j_k", self.cabin_capacity_j_k, 20_000.0),
            ("interior_capacity_j_k", self.interior_capacity_j_k, 5_000.0),
            ("shell_inside_capacity_j_k", self.shell_inside_capacity_j_k, 20_000.0),
            ("shell_outside_capacity_j_k", self.shell_outside_capacity_j_k, 20_000.0),
            ("radiant_heater_capacity_j_k", self.radiant_heater_capacity_j_k, 500.0),
            ("air_unit_time_constant_s", self.air_unit_time_constant_s, 2.0),
            ("controller_gain_w_k", self.controller_gain_w_k, 0.0),
            ("controller_integral_s", self.controller_integral_s, 1.0),
            ("heat_pump_limit_w", self.heat_pump_limit_w, 0.0),
            ("ptc_limit_w", self.ptc_limit_w, 0.0),
            ("cooling_limit_w", self.cooling_limit_w, 0.0),
            ("heater_gain_w_k", self.heater_gain_w_k, 0.0),
            ("heater_integral_s", self.heater_integral_s, 1.0),
            ("heater_limit_w", self.heater_limit_w, 0.0),
        ];
        match all.into_iter().find(|(_, value, least)| !(value.is_finite() && value >= least)) {
            Some((name, value, least)) => Err(DynamicsError { name, value, least }),
            None => Ok(()),
        }
    }
}
