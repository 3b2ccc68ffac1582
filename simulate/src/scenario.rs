//! Under which conditions a mission is driven: where it starts, and whether power is limited.

use cabin::{Design, Heating, PowerLimit};

use crate::Dynamics;

/// The conditions of a simulation, whatever controls the bus.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Scenario {
    /// State of the bus at the first second.
    pub start: Start,
    /// What the devices can give.
    pub limits: Limits,
}

/// State of the bus at the first second.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Start {
    /// Depot temperature (paper, eq. `depot-temperature`), controllers without memory.
    Depot,
    /// The steady state of the first segment's optimum, controllers as after a long time in it.
    SteadyState,
}

/// What the devices can give.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Limits {
    /// The limits of [`Dynamics`].
    Rated,
    /// Any power of the air unit.
    Unlimited,
}

/// Largest electric powers in W.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PowerLimits {
    /// Of the air unit in heating.
    pub heating_w: f64,
    /// Of the air unit in cooling.
    pub cooling_w: f64,
    /// Of the radiant heaters.
    pub radiant_heaters_w: f64,
}

impl Limits {
    /// The limits of a design.
    #[must_use]
    pub fn of(self, design: &Design, dynamics: &Dynamics) -> PowerLimits {
        let rated_w = match design.heating {
            Heating::Ptc => dynamics.ptc_limit_w,
            Heating::HeatPump => dynamics.heat_pump_limit_w,
        };
        let (heating_w, cooling_w) = match self {
            // Of a limit over the ambient temperature the largest: a mission has one.
            Self::Rated => (
                rated_w.min(most_electric_w(design.heating_limit.as_ref())),
                dynamics.cooling_limit_w.min(most_electric_w(design.cooling_limit.as_ref())),
            ),
            Self::Unlimited => (f64::MAX, f64::MAX),
        };
        PowerLimits { heating_w, cooling_w, radiant_heaters_w: dynamics.heater_limit_w }
    }
}

/// The electric power in W that a limit lets in at most; one of heat lets in any.
fn most_electric_w(limit: Option<&PowerLimit>) -> f64 {
    limit.and_then(PowerLimit::most_electric_w).unwrap_or(f64::MAX)
}
