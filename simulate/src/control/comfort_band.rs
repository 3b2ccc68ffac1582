//! [`Law::ComfortBand`](super::Law::ComfortBand).

use super::{AirCurtain, Setting};
use crate::Segment;

pub(super) fn setting(segment: &Segment) -> Setting {
    let (o, [low_k, high_k]) = (&segment.optimum, segment.band_k);
    Setting {
        heating_k: low_k,
        cooling_k: high_k,
        heat_below_k: low_k,
        cool_above_k: high_k,
        stop_beyond_k: 0.0,
        stops_idle: true,
        begins_anew: false,
        radiant_heater_k: o.devices.radiant_heaters.then_some(o.temperatures.radiant_heater_k),
        air_curtain: AirCurtain::held(o.devices.air_curtain),
    }
}
