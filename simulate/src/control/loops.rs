//! The PI loops of air unit and radiant heaters that every law drives.

use cabin::{Design, OperatingMode, Operation};

use super::{Demand, Measurements, PiController};
use crate::{Commands, Dynamics, PowerLimits, Scenario};

/// Setpoints of a second.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Setpoints {
    /// Of the cabin in K.
    pub cabin_k: f64,
    /// Of the radiant heaters in K, while they are on.
    pub radiant_heater_k: f64,
    /// Whether the air curtains run.
    pub air_curtain_on: bool,
}

/// Both loops with their states: operating mode, whether the heaters are on, and the integrals.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Loops {
    cabin: PiController,
    heaters: PiController,
    limits: PowerLimits,
    mode: OperatingMode,
    heaters_on: bool,
    cabin_integral_w: f64,
    heater_integral_w: f64,
}

impl Loops {
    /// Loops without memory, everything off.
    #[must_use]
    pub fn new(design: &Design, dynamics: &Dynamics, scenario: Scenario) -> Self {
        Self {
            cabin: PiController { gain_w_k: dynamics.controller_gain_w_k, integral_s: dynamics.controller_integral_s },
            heaters: PiController { gain_w_k: dynamics.heater_gain_w_k, integral_s: dynamics.heater_integral_s },
            limits: scenario.limits.of(design, dynamics),
            mode: OperatingMode::Passive,
            heaters_on: false,
            cabin_integral_w: 0.0,
            heater_integral_w: 0.0,
        }
    }

    /// The loops as they stand after a long time in an optimum.
    #[must_use]
    pub fn settled(mut self, o: &Operation) -> Self {
        self.mode = o.mode;
        self.heaters_on = o.devices.radiant_heaters;
        self.cabin_integral_w = match o.mode {
            OperatingMode::Cooling => -o.air_unit_power_w,
            OperatingMode::Passive | OperatingMode::Heating => o.air_unit_power_w,
        };
        self.heater_integral_w = o.radiant_heater_power_w;
        self
    }

    pub(super) fn mode(&self) -> OperatingMode {
        self.mode
    }

    /// What the air unit would be asked for with this error in K, without limits.
    pub(super) fn wanted_w(&self, error_k: f64) -> f64 {
        self.cabin_integral_w + self.cabin.gain_w_k * error_k
    }

    /// Sets the operating mode; a new one starts without memory.
    pub(super) fn set_mode(&mut self, mode: OperatingMode) {
        if mode != self.mode {
            self.mode = mode;
            self.cabin_integral_w = 0.0;
        }
    }

    /// Switches the radiant heaters; switched on they start without memory.
    pub(super) fn set_heaters(&mut self, on: bool) {
        if on != self.heaters_on {
            self.heaters_on = on;
            self.heater_integral_w = 0.0;
        }
    }

    /// The commands of a second.
    #[inline]
    pub(super) fn command(&mut self, setpoints: &Setpoints, now: &Measurements) -> Demand {
        let (low_w, high_w) = match self.mode {
            OperatingMode::Heating => (0.0, self.limits.heating_w),
            OperatingMode::Cooling => (-self.limits.cooling_w, 0.0),
            OperatingMode::Passive => (0.0, 0.0),
        };
        let (air_unit_power_w, beyond_w) = if self.mode == OperatingMode::Passive {
            (0.0, 0.0)
        } else {
            self.cabin.command_w(setpoints.cabin_k - now.cabin_k, &mut self.cabin_integral_w, low_w, high_w)
        };
        let held_back = match self.mode {
            OperatingMode::Heating => beyond_w > 0.0,
            OperatingMode::Cooling => beyond_w < 0.0,
            OperatingMode::Passive => false,
        };
        let radiant_heater_power_w = if self.heaters_on {
            let error_k = setpoints.radiant_heater_k - now.radiant_heater_k;
            self.heaters.command_w(error_k, &mut self.heater_integral_w, 0.0, self.limits.radiant_heaters_w).0
        } else {
            0.0
        };
        let air_curtain_on = setpoints.air_curtain_on;
        Demand { commands: Commands { air_unit_power_w, radiant_heater_power_w, air_curtain_on }, held_back }
    }
}
