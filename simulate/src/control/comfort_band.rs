//! Curtain and heaters of the optimum, but heating below the band that its comfort window allows and cooling above it,
//! whenever the cabin leaves it.

use cabin::OperatingMode;

use super::loops::Setpoints;
use super::{Controller, Demand, Loops, Measurements};
use crate::Segment;

/// The law with its state.
#[derive(Debug, Clone, Copy)]
pub struct ComfortBand<'m> {
    segments: &'m [Segment],
    segment_s: u32,
    loops: Loops,
}

impl<'m> ComfortBand<'m> {
    /// Replays segments of `segment_s` seconds, one after the other.
    #[must_use]
    pub fn new(segments: &'m [Segment], segment_s: u32, loops: Loops) -> Self {
        Self { segments, segment_s, loops }
    }

    /// Heats below the band and cools above it; goes on until the loop has nothing left to do.
    fn choose_mode(&mut self, [low_k, high_k]: [f64; 2], cabin_k: f64) {
        let idle = match self.loops.mode() {
            OperatingMode::Passive => true,
            OperatingMode::Heating => self.loops.wanted_w(low_k - cabin_k) <= 0.0 && cabin_k > low_k,
            OperatingMode::Cooling => self.loops.wanted_w(high_k - cabin_k) >= 0.0 && cabin_k < high_k,
        };
        if !idle {
            return;
        }
        self.loops.set_mode(if cabin_k < low_k {
            OperatingMode::Heating
        } else if cabin_k > high_k {
            OperatingMode::Cooling
        } else {
            OperatingMode::Passive
        });
    }
}

impl Controller for ComfortBand<'_> {
    #[inline]
    fn command(&mut self, now: &Measurements) -> Demand {
        let segment = &self.segments[(now.second / self.segment_s) as usize];
        let o = &segment.optimum;
        self.loops.set_heaters(o.devices.radiant_heaters);
        self.choose_mode(segment.band_k, now.cabin_k);
        let setpoints = Setpoints {
            cabin_k: segment.band_k[usize::from(self.loops.mode() == OperatingMode::Cooling)],
            radiant_heater_k: o.temperatures.radiant_heater_k,
            air_curtain_on: o.devices.air_curtain,
        };
        self.loops.command(&setpoints, now)
    }
}
