//! A second of a simulation.

use crate::{BusState, Commands};

/// What a second of a simulation looks like.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Instant {
    /// Second since the start of the mission.
    pub second: u32,
    /// The state at its end.
    pub state: BusState,
    /// The setpoint of the cabin that the air unit followed during it in K; `None` while it was at rest.
    pub setpoint_k: Option<f64>,
    /// The commands that held during it.
    pub commands: Commands,
    /// Power of the air curtains in W.
    pub air_curtain_power_w: f64,
    /// Passengers on board.
    pub passengers: f64,
    /// Fraction of the doors that is open.
    pub door_open_fraction: f64,
    /// Mean vote of the passengers.
    pub pmv: f64,
    /// Its mean over the last 15 minutes.
    pub pmv_15min: f64,
}

impl Instant {
    /// Electric power of air unit, radiant heaters and air curtains in W.
    #[must_use]
    #[inline]
    pub fn hvac_power_w(&self) -> f64 {
        let c = &self.commands;
        c.air_unit_power_w.abs() + c.radiant_heater_power_w + self.air_curtain_power_w
    }
}
