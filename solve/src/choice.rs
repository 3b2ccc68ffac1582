//! The choices of heaters and curtain in a window, each at its best.

use cabin::{Cabin, ComfortWindow, Design, Devices, Infeasible, OperatingMode, State};

use crate::offer::Powers;

/// Cabin temperatures that the air unit can be asked to hold, in K: −60 … 60 °C.
const COLDEST_K: f64 = 213.15;
const HOTTEST_K: f64 = 333.15;

/// A choice at its best, before a design's COP turns its heat into power.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Choice {
    pub devices: Devices,
    pub mode: OperatingMode,
    pub air_unit_heat_w: f64,
    pub ambient_k: f64,
    /// That of the mode.
    pub lift_k: f64,
    pub radiant_heater_power_w: f64,
    pub air_curtain_power_w: f64,
}

/// What a choice comes to in a window.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Best {
    Found(Choice),
    Infeasible(Infeasible),
    /// An iteration did not settle.
    Lost,
    /// No design has what it needs, or another choice is known to be cheaper.
    LeftOut,
}

impl Best {
    /// A choice at the state that is the best in its window, with the unit at work as `end` says.
    pub fn at(
        cabin: &Cabin<'_>,
        devices: Devices,
        end: OperatingMode,
        cabin_k: f64,
        air_unit_heat_w: f64,
        radiant_heater_power_w: f64,
    ) -> Self {
        match end {
            OperatingMode::Heating if cabin_k > HOTTEST_K => return Self::Infeasible(Infeasible::TooCold),
            OperatingMode::Cooling if cabin_k < COLDEST_K => return Self::Infeasible(Infeasible::TooWarm),
            _ => {}
        }
        if radiant_heater_power_w < 0.0 {
            // Surroundings hotter than the panels' target: they cannot be held there by heating.
            return Self::Infeasible(Infeasible::TooWarm);
        }
        let (mode, air_unit_heat_w) = match end {
            OperatingMode::Heating if air_unit_heat_w > 0.0 => (end, air_unit_heat_w),
            OperatingMode::Cooling if air_unit_heat_w < 0.0 => (end, air_unit_heat_w),
            // At the passive state, to rounding.
            _ => (OperatingMode::Passive, 0.0),
        };
        Self::Found(Choice {
            devices,
            mode,
            air_unit_heat_w,
            ambient_k: cabin.ambient_k(),
            lift_k: mode.lift_k(cabin.ambient_k(), cabin_k),
            radiant_heater_power_w,
            air_curtain_power_w: if devices.air_curtain { cabin.air_curtain_power_w() } else { 0.0 },
        })
    }
}

/// The operation that comes nearest to a window that no choice of a design meets.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Nearest {
    pub choice: Choice,
    pub state: State,
    /// Those of the choice at its state; what is unmet there is what the window lacks.
    pub powers: Powers,
}

/// Of the choices that lack heat in a window, the one whose vote comes nearest to it where all that the design has is given;
/// of equally near ones the cheapest. The window is given by its limits.
pub(crate) fn nearest(
    cabin: &Cabin<'_>,
    design: &Design,
    bests: &[Best; 4],
    window: &ComfortWindow,
    guess: &State,
) -> Option<Nearest> {
    let mut found: Option<(f64, Nearest)> = None;
    for (devices, best) in Devices::CHOICES.into_iter().zip(bests).filter(|(d, _)| design.devices.include(*d)) {
        let Best::Found(wanted) = best else { continue };
        let unmet_w = wanted.powers(design).supply.unmet_w;
        let state = cabin.capacity_state(design, devices, wanted.mode, guess)?;
        let t = &state.temperatures;
        let heat_w = cabin.air_unit_heat_w(t, &state.slopes, devices.air_curtain).0;
        let heater_w = if devices.radiant_heaters { cabin.radiant_heater_power_w(t) } else { 0.0 };
        let Best::Found(choice) = Best::at(cabin, devices, wanted.mode, t.cabin_k, heat_w, heater_w) else { continue };
        let mut powers = choice.powers(design);
        powers.supply.unmet_w = unmet_w;
        let miss = (window.pmv_min() - state.pmv).max(state.pmv - window.pmv_max());
        let is_better = found
            .as_ref()
            .is_none_or(|(least, other)| miss < *least || miss == *least && powers.total_w < other.powers.total_w);
        if is_better {
            found = Some((miss, Nearest { choice, state, powers }));
        }
    }
    found.map(|(_, nearest)| nearest)
}
