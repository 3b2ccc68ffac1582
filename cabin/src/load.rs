//! How the load of a bus changes in time.

/// From a second of the mission on, so many passengers are on board and doors are open so far.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoadChange {
    /// Second since the start of the mission.
    pub second: u32,
    /// Passengers on board.
    pub passengers: f64,
    /// How far doors are open, against what they are when "a door is open": 1 while one is, 0 while none is; between where the
    /// telemetry says a share of the doors.
    pub door_open: f64,
}

impl LoadChange {
    /// Steps in which doors between shut and open are told apart: half a percent.
    pub const DOOR_STEPS: f64 = 200.0;

    /// A share of the doors, to the nearest step.
    #[must_use]
    pub fn in_steps(share: f64) -> f64 {
        (share * Self::DOOR_STEPS).round() / Self::DOOR_STEPS
    }
}
