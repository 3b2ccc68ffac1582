//! [`Law::HourlyMode`](super::Law::HourlyMode).

use cabin::OperatingMode;

use super::{AirCurtain, Setting};
use crate::Segment;

pub(super) fn setting(segment: &Segment) -> Setting {
    let o = &segment.optimum;
    let cabin_k = o.temperatures.cabin_k;
    let (heat_below_k, cool_above_k) = match o.mode {
        OperatingMode::Heating => (f64::INFINITY, f64::INFINITY),
        OperatingMode::Passive => (f64::NEG_INFINITY, f64::INFINITY),
        OperatingMode::Cooling => (f64::NEG_INFINITY, f64::NEG_INFINITY),
    };
    Setting {
        heating_k: cabin_k,
        cooling_k: cabin_k,
        heat_below_k,
        cool_above_k,
        stop_beyond_k: f64::INFINITY,
        stops_idle: true,
        begins_anew: true,
        radiant_heater_k: o.devices.radiant_heaters.then_some(o.temperatures.radiant_heater_k),
        air_curtain: AirCurtain::held(o.devices.air_curtain),
    }
}
