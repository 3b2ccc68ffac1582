//! Control laws, a file each: what they prescribe is data, a [`Setting`] for each segment, on which one state machine runs.

mod comfort_band;
mod hourly_mode;
mod loops;

pub(crate) use loops::{Demand, Loops};

use crate::Segment;

/// What decides on operating mode and setpoints.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Law {
    /// The paper's validation: operating mode, curtain and heaters of the optimum are held within each segment, and its cabin
    /// temperature is tracked.
    HourlyMode,
    /// Curtain and heaters of the optimum, but heating below the band that its comfort window allows and cooling above it,
    /// whenever the cabin leaves it.
    ComfortBand,
}

/// Setpoints and thresholds for a while.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Setting {
    /// Setpoint of the cabin while the air unit heats, in K.
    pub heating_k: f64,
    /// Setpoint of the cabin while it cools, in K.
    pub cooling_k: f64,
    /// Heating begins with a cabin below this, in K.
    pub heat_below_k: f64,
    /// Cooling begins with a cabin above this, in K.
    pub cool_above_k: f64,
    /// Heating and cooling end with a cabin this far beyond the setpoint, in K, once the loop asks for nothing; with infinity
    /// they never do.
    pub stop_beyond_k: f64,
    /// Whether the mode is chosen anew as the setting begins, whatever it was.
    pub begins_anew: bool,
    /// Setpoint of the radiant heaters in K; `None` while they are off.
    pub radiant_heater_k: Option<f64>,
    /// Whether the air curtains run.
    pub air_curtain: bool,
}

impl Law {
    /// What it prescribes for a segment.
    #[must_use]
    pub fn setting(self, segment: &Segment) -> Setting {
        match self {
            Self::HourlyMode => hourly_mode::setting(segment),
            Self::ComfortBand => comfort_band::setting(segment),
        }
    }
}
