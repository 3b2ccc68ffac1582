//! A mission: what acts on the bus in time.

use cabin::{Cabin, LoadChange};

use crate::Segment;

/// What acts on a bus on a mission, and the optima of its segments.
#[derive(Debug, Clone, Copy)]
pub struct Mission<'m, 'v> {
    /// Loads, in the order of time; before the first the bus is empty and closed.
    pub loads: &'m [LoadChange],
    /// The cabin under the weather of each minute, without load.
    pub minutes: &'m [Cabin<'v>],
    /// The segments, one after the other from the start.
    pub segments: &'m [Segment],
    /// Length of a segment in s, a multiple of 60.
    pub segment_s: u32,
    /// Share of the doors that open when a door is open.
    pub door_open_share: f64,
}
