//! [`Law::Causal`](super::Law::Causal): the paper's controller (section "Case Study 2: Causal Online Control").

use cabin::celsius;
use setpoints::{Curve, Published};

use super::{AirCurtain, Setting};

/// A controller that knows the temperatures of now and nothing else.
///
/// The paper's state machine: heating begins below the heating setpoint and ends so much above it, cooling begins above the
/// cooling setpoint and ends so much below it.
#[derive(Debug, Clone, PartialEq)]
pub struct CausalController {
    /// Setpoint while heating.
    pub heating: Curve,
    /// Setpoint while cooling. Where it lies below that of heating, the middle serves both modes.
    pub cooling: Curve,
    /// How far on the wrong side of its setpoint the cabin is as a mode begins, in K: 0 in the paper, whose two setpoints lie
    /// apart. With one setpoint for both modes it keeps them from working against each other.
    pub dead_band_k: f64,
    /// Below this ambient temperature in °C no cooling begins; minus infinity in the paper.
    pub cools_above_c: f64,
    /// How far beyond its setpoint the cabin is as a mode ends, in K; 1 in the paper.
    pub hysteresis_k: f64,
    /// When the air curtains run.
    pub air_curtain: AirCurtain,
    /// The radiant heaters run below this ambient temperature in °C; `None` where they never do.
    pub heaters_below_c: Option<f64>,
    /// Their setpoint in K.
    pub radiant_heater_k: f64,
}

/// How far from a setpoint that is meant for both modes each of them begins, in K. A substitute, since the sources do not say
/// how they keep the two apart: at 1 K, where the other mode ends, what one overshoots starts the other again and again.
const DEAD_BAND_K: f64 = 2.0;
/// Hysteresis of the paper's state machine (figure `state-machine`) in K.
const HYSTERESIS_K: f64 = 1.0;

impl CausalController {
    /// The paper's state machine with two setpoints, and without curtains and radiant heaters.
    #[must_use]
    pub fn new(heating: Curve, cooling: Curve) -> Self {
        Self {
            dead_band_k: if heating == cooling { DEAD_BAND_K } else { 0.0 },
            heating,
            cooling,
            cools_above_c: f64::NEG_INFINITY,
            hysteresis_k: HYSTERESIS_K,
            air_curtain: AirCurtain::Off,
            heaters_below_c: None,
            radiant_heater_k: 0.0,
        }
    }

    /// The same with published setpoints.
    #[must_use]
    pub fn published(published: &Published) -> Self {
        let of = Self::new(published.heating.clone(), published.cooling.clone());
        Self { cools_above_c: published.cools_above_c, ..of }
    }

    /// Setpoints and thresholds at an ambient temperature in K.
    pub(super) fn setting(&self, ambient_k: f64) -> Setting {
        let ambient_c = celsius(ambient_k);
        let [heating_k, cooling_k] = [&self.heating, &self.cooling].map(|curve| cabin::kelvin(curve.at(ambient_c)));
        let middle_k = 0.5 * (heating_k + cooling_k);
        let (heating_k, cooling_k, dead_band_k) = if cooling_k < heating_k {
            (middle_k, middle_k, DEAD_BAND_K)
        } else {
            (heating_k, cooling_k, self.dead_band_k)
        };
        Setting {
            heating_k,
            cooling_k,
            heat_below_k: heating_k - dead_band_k,
            cool_above_k: if ambient_c < self.cools_above_c { f64::INFINITY } else { cooling_k + dead_band_k },
            stop_beyond_k: self.hysteresis_k,
            stops_idle: false,
            begins_anew: false,
            radiant_heater_k: self.heaters_below_c.filter(|limit| ambient_c < *limit).map(|_| self.radiant_heater_k),
            air_curtain: self.air_curtain,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cabin::kelvin;

    #[test]
    fn prop_where_setpoints_cross_their_middle_serves_both_modes_with_a_dead_band() {
        let heating = Curve::through(&[(0.0, 20.0), (30.0, 26.0)]).unwrap();
        let controller = CausalController::new(heating, Curve::constant(23.0));
        let apart = controller.setting(kelvin(0.0));
        assert_eq!([apart.heat_below_k, apart.cool_above_k], [kelvin(20.0), kelvin(23.0)]);
        let crossed = controller.setting(kelvin(30.0));
        assert_eq!([crossed.heating_k, crossed.cooling_k], [kelvin(24.5); 2]);
        assert_eq!([crossed.heat_below_k, crossed.cool_above_k], [kelvin(22.5), kelvin(26.5)]);
        // What ends one mode does not begin the other.
        assert!(crossed.heating_k + crossed.stop_beyond_k < crossed.cool_above_k);
    }
}
