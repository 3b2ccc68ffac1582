//! Control laws, a file each: what they prescribe is data, a [`Setting`] for each segment, on which one state machine runs.

mod causal;
mod comfort_band;
mod hourly_mode;
mod loops;

pub use causal::CausalController;
pub(crate) use loops::{Demand, Loops};

use crate::Segment;

/// What decides on operating mode and setpoints.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Law<'c> {
    /// The paper's validation: operating mode, curtain and heaters of the optimum are held within each segment, and its cabin
    /// temperature is tracked.
    HourlyMode,
    /// Curtain and heaters of the optimum, but heating below the band that its comfort window allows and cooling above it,
    /// whenever the cabin leaves it.
    ComfortBand,
    /// Setpoints over the ambient temperature, and nothing of what the optima or the hours to come are.
    Causal(&'c CausalController),
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
    /// Heating and cooling end with a cabin this far beyond the setpoint, in K; with infinity they never do.
    pub stop_beyond_k: f64,
    /// Whether they end only once the loop asks for nothing as well.
    pub stops_idle: bool,
    /// Whether the mode is chosen anew as the setting begins, whatever it was.
    pub begins_anew: bool,
    /// Setpoint of the radiant heaters in K; `None` while they are off.
    pub radiant_heater_k: Option<f64>,
    /// When the air curtains run.
    pub air_curtain: AirCurtain,
}

/// When air curtains run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum AirCurtain {
    /// Never.
    Off,
    /// Always.
    On,
    /// While the air unit heats a cabin that is so much warmer than outside, or cools one that is so much colder, in K.
    Above {
        /// Cabin over ambient temperature while heating.
        heating_k: f64,
        /// Ambient over cabin temperature while cooling.
        cooling_k: f64,
    },
}

impl AirCurtain {
    /// On or off for good.
    #[must_use]
    pub fn held(is_on: bool) -> Self {
        if is_on { Self::On } else { Self::Off }
    }
}

impl Law<'_> {
    /// What it prescribes while a segment begins at an ambient temperature in K, or while that changes.
    #[must_use]
    pub fn setting(self, segment: &Segment, ambient_k: f64) -> Setting {
        match self {
            Self::HourlyMode => hourly_mode::setting(segment),
            Self::ComfortBand => comfort_band::setting(segment),
            Self::Causal(controller) => controller.setting(ambient_k),
        }
    }

    /// Whether it follows the ambient temperature from minute to minute.
    #[must_use]
    pub fn is_causal(self) -> bool {
        matches!(self, Self::Causal(_))
    }
}
