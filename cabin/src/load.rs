//! How the load of a bus changes in time.

/// From a second of the mission on, so many passengers are on board and a door is open or not.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoadChange {
    /// Second since the start of the mission.
    pub second: u32,
    /// Passengers on board.
    pub passengers: f64,
    /// Whether at least one door is open.
    pub door_open: bool,
}
