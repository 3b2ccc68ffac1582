//! The choices of heaters and curtain in a window, each at its best, and which of them is the cheapest for a design.

use cabin::{Cabin, ComfortWindow, Design, Devices, Infeasible, OperatingMode, State};

/// Cabin temperatures that the air unit can be asked to hold, in K: −60 … 60 °C.
const COLDEST_K: f64 = 213.15;
const HOTTEST_K: f64 = 333.15;

/// A choice at its best, before a design's COP turns its heat into power.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Choice {
    pub devices: Devices,
    pub mode: OperatingMode,
    pub air_unit_heat_w: f64,
    ambient_k: f64,
    /// That of the mode.
    lift_k: f64,
    radiant_heater_power_w: f64,
    air_curtain_power_w: f64,
}

/// What a choice comes to in a window.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Best {
    Found(Choice),
    Infeasible(Infeasible),
    /// An iteration did not settle.
    Lost,
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

/// The powers of a choice in W: air unit with what its back-up heater takes, radiant heaters, air curtains, all together; and
/// the heat that nothing can bring.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Powers {
    pub air_unit_w: f64,
    pub backup_w: f64,
    pub unmet_heat_w: f64,
    pub radiant_heater_w: f64,
    pub air_curtain_w: f64,
    pub total_w: f64,
}

impl Choice {
    /// What it takes with a design's COP and limits.
    #[inline]
    pub fn powers(&self, design: &Design) -> Powers {
        let supply = design.supply(self.mode, self.air_unit_heat_w.abs(), self.ambient_k, self.lift_k);
        let (radiant_heater_w, air_curtain_w) = (self.radiant_heater_power_w, self.air_curtain_power_w);
        Powers {
            air_unit_w: supply.power_w,
            backup_w: supply.backup_w,
            unmet_heat_w: supply.unmet_w,
            radiant_heater_w,
            air_curtain_w,
            total_w: supply.power_w + radiant_heater_w + air_curtain_w,
        }
    }
}

/// What a design does in a window.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Cheapest {
    /// The choice at a place, what it takes, and how many W more the next one would.
    Choice {
        place: usize,
        powers: Powers,
        runner_up_w: Option<f64>,
    },
    /// No choice meets the window within the design's limits.
    Limited,
    Infeasible(Infeasible),
    NotConverged,
}

/// The cheapest choice that the design has, and how much more the next one costs.
#[inline]
pub(crate) fn cheapest(design: &Design, bests: &[Option<Best>; 4]) -> Cheapest {
    let mut least: Option<(usize, Powers)> = None;
    let mut second_w = f64::INFINITY;
    let mut failure = Cheapest::NotConverged;
    for (place, (choice, best)) in Devices::CHOICES.iter().zip(bests).enumerate() {
        if !design.devices.include(*choice) {
            continue;
        }
        match best {
            Some(Best::Found(found)) => {
                let powers = found.powers(design);
                if powers.unmet_heat_w > 0.0 {
                    failure = Cheapest::Limited;
                    continue;
                }
                match &least {
                    Some((_, least)) if least.total_w <= powers.total_w => second_w = second_w.min(powers.total_w),
                    before => {
                        // What was the cheapest is now the second.
                        second_w = before.as_ref().map_or(second_w, |(_, least)| least.total_w);
                        least = Some((place, powers));
                    }
                }
            }
            Some(Best::Infeasible(reason)) => match failure {
                // One that comes near the window is better than one that has no state.
                Cheapest::Limited => {}
                _ => failure = Cheapest::Infeasible(*reason),
            },
            // One choice that does not settle leaves the optimum unproven.
            Some(Best::Lost) => return Cheapest::NotConverged,
            // Left out, because another one is known to be cheaper.
            None => {}
        }
    }
    match least {
        Some((place, powers)) => {
            let runner_up_w = second_w.is_finite().then_some(second_w - powers.total_w);
            Cheapest::Choice { place, powers, runner_up_w }
        }
        None => failure,
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
    bests: &[Option<Best>; 4],
    window: &ComfortWindow,
    guess: &State,
) -> Option<Nearest> {
    let mut found: Option<(f64, Nearest)> = None;
    for (devices, best) in Devices::CHOICES.into_iter().zip(bests).filter(|(d, _)| design.devices.include(*d)) {
        let Some(Best::Found(wanted)) = best else { continue };
        let unmet_heat_w = wanted.powers(design).unmet_heat_w;
        let state = cabin.capacity_state(design, devices, wanted.mode, guess)?;
        let t = &state.temperatures;
        let heat_w = cabin.air_unit_heat_w(t, &state.slopes, devices.air_curtain).0;
        let heater_w = if devices.radiant_heaters { cabin.radiant_heater_power_w(t) } else { 0.0 };
        let Best::Found(choice) = Best::at(cabin, devices, wanted.mode, t.cabin_k, heat_w, heater_w) else { continue };
        let powers = Powers { unmet_heat_w, ..choice.powers(design) };
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
