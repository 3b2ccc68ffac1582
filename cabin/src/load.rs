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
