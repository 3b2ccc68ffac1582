//! The paper's validation: operating mode, curtain and heaters of the optimum are held within each segment, and its cabin
//! temperature is tracked.

use super::loops::Setpoints;
use super::{Controller, Demand, Loops, Measurements};
use crate::Segment;

/// The law with its state.
#[derive(Debug, Clone, Copy)]
pub struct HourlyMode<'m> {
    segments: &'m [Segment],
    segment_s: u32,
    loops: Loops,
}

impl<'m> HourlyMode<'m> {
    /// Replays segments of `segment_s` seconds, one after the other.
    #[must_use]
    pub fn new(segments: &'m [Segment], segment_s: u32, loops: Loops) -> Self {
        Self { segments, segment_s, loops }
    }
}

impl Controller for HourlyMode<'_> {
    #[inline]
    fn command(&mut self, now: &Measurements) -> Demand {
        let o = &self.segments[(now.second / self.segment_s) as usize].optimum;
        self.loops.set_mode(o.mode);
        self.loops.set_heaters(o.devices.radiant_heaters);
        let setpoints = Setpoints {
            cabin_k: o.temperatures.cabin_k,
            radiant_heater_k: o.temperatures.radiant_heater_k,
            air_curtain_on: o.devices.air_curtain,
        };
        self.loops.command(&setpoints, now)
    }
}
