//! What is known of a cabin state that might be an optimum.

use cabin::{Cabin, Heaters, StandardRange, State, Temperatures};

/// A cabin state with everything that the comparison of designs needs.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SteadyState {
    pub temperatures: Temperatures,
    pub mean_radiant_k: f64,
    pub pmv: f64,
    pub standard_range: StandardRange,
    /// Heat that the air unit has to bring, without and with air curtain.
    pub air_unit_heat_w: [f64; 2],
    /// 0 while the heaters are off.
    pub radiant_heater_power_w: f64,
}

impl SteadyState {
    pub fn new(cabin: &Cabin<'_>, heaters: Heaters, state: &State) -> Self {
        let t = state.temperatures;
        let mean_radiant_k = cabin.mean_radiant_temperature_k(&t);
        let heat_w = |curtain| cabin.air_unit_heat_w(&t, &state.slopes, curtain).0;
        Self {
            temperatures: t,
            mean_radiant_k,
            pmv: state.pmv,
            standard_range: cabin.standard_range(t.cabin_k, mean_radiant_k, state.pmv),
            air_unit_heat_w: [heat_w(false), heat_w(true)],
            radiant_heater_power_w: match heaters {
                Heaters::Off => 0.0,
                Heaters::On => cabin.radiant_heater_power_w(&t),
            },
        }
    }
}

/// What is known of a state that might be an optimum.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Seen {
    /// It is none: the unit is not needed there.
    Needless,
    /// The iteration did not settle.
    Lost,
    /// The state.
    Settled(SteadyState),
}
