//! Controllers: what they see, what they ask for, and the laws, a file each.

mod comfort_band;
mod hourly_mode;
mod loops;
mod pi;

pub use comfort_band::ComfortBand;
pub use hourly_mode::HourlyMode;
pub use loops::Loops;
pub use pi::PiController;

use crate::Commands;

/// What a controller sees: present measurements, nothing of the future.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measurements {
    /// Second since the start of the mission.
    pub second: u32,
    /// Ambient temperature in K.
    pub ambient_k: f64,
    /// Cabin temperature in K.
    pub cabin_k: f64,
    /// Temperature of the radiant heaters in K.
    pub radiant_heater_k: f64,
}

/// What a controller asks for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Demand {
    /// The commands of the next second.
    pub commands: Commands,
    /// Whether a limit keeps the air unit from giving what is wanted.
    pub held_back: bool,
}

/// A control law with its state. It is asked once a second, in the order of time.
pub trait Controller {
    /// The commands for the second that begins.
    fn command(&mut self, now: &Measurements) -> Demand;
}
