//! A mission, and the variants in which it is driven.

use cabin::{Cabin, ComfortWindow, Design, LoadChange};

use crate::control::Law;
use crate::{Scenario, Segment};

/// What acts on a bus on a mission, whatever its design and whoever drives it.
#[derive(Debug, Clone, Copy)]
pub struct Mission<'m, 'v> {
    /// Loads, in the order of time; before the first the bus is empty and closed.
    pub loads: &'m [LoadChange],
    /// The cabin under the weather of each minute, without load.
    pub minutes: &'m [Cabin<'v>],
    /// Segments, one after the other from the start; at least one, and the minutes reach to the end of the last.
    pub segments: usize,
    /// Length of a segment in s: a multiple of 60 where there is more than one.
    pub segment_s: u32,
    /// Share of the doors that open when a door is open.
    pub door_open_share: f64,
}

/// A way to drive a mission.
#[derive(Debug, Clone, Copy)]
pub struct Variant<'m> {
    /// What is on board.
    pub design: &'m Design,
    /// Where the mission starts, and what limits hold.
    pub scenario: Scenario,
    /// Who decides.
    pub law: Law<'m>,
    /// The optima of the mission's segments.
    pub segments: &'m [Segment],
    /// The windows by which passengers judge it; none where nobody asks.
    pub windows: &'m [ComfortWindow],
}
