//! What the choices of heaters and curtain cost, and which of them is the cheapest for a design.
//!
//! A choice costs the same for all designs with the same air unit, so that it is priced once for each unit.

use cabin::{Design, Devices, Infeasible, Supply};

use crate::choice::{Best, Choice};

/// What a choice takes with a unit: powers of the unit with its back-up heater, and of all devices together.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Powers {
    pub supply: Supply,
    pub total_w: f64,
}

/// A choice with a unit.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Offer {
    /// It meets the window.
    Powers(Powers),
    /// The unit cannot bring or take away the heat.
    Limited,
    /// No operation meets the window.
    Infeasible(Infeasible),
    /// An iteration did not settle.
    Lost,
    /// No design with the unit has what it needs, or another choice is known to be cheaper.
    LeftOut,
}

/// The distinct air units of some designs.
#[derive(Debug, Clone)]
pub(crate) struct Units {
    units: Vec<Unit>,
    /// Place of each design's unit, and which of the choices it has.
    designs: Vec<(usize, [bool; 4])>,
}

/// An air unit.
#[derive(Debug, Clone)]
struct Unit {
    /// The first design with it.
    design: usize,
    /// The choices that any design with it has.
    choices: [bool; 4],
    /// Those in the window at hand.
    offers: [Offer; 4],
    /// What they take in W: infinite where one does not meet the window, less than anything where it did not settle.
    total_w: [f64; 4],
}

/// What a design does in a window.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Cheapest<'u> {
    /// The choice at a place, what it takes, and how many W more the next one would.
    Choice {
        place: usize,
        powers: &'u Powers,
        runner_up_w: Option<f64>,
    },
    /// No choice meets the window within the design's limits.
    Limited,
    Infeasible(Infeasible),
    NotConverged,
}

impl Choice {
    /// What it takes with a design's air unit.
    #[inline]
    pub fn powers(&self, design: &Design) -> Powers {
        let supply = design.supply(self.mode, self.air_unit_heat_w.abs(), self.ambient_k, self.lift_k);
        Powers { supply, total_w: supply.power_w + self.radiant_heater_power_w + self.air_curtain_power_w }
    }
}

impl Units {
    pub fn new(designs: &[Design]) -> Self {
        let mut units: Vec<Unit> = Vec::new();
        let of_design = |(place, design): (usize, &Design)| {
            let choices = Devices::CHOICES.map(|choice| design.devices.include(choice));
            let unit =
                units.iter().position(|unit| designs[unit.design].has_air_unit_of(design)).unwrap_or_else(|| {
                    units.push(Unit {
                        design: place,
                        choices: [false; 4],
                        offers: [Offer::LeftOut; 4],
                        total_w: [f64::INFINITY; 4],
                    });
                    units.len() - 1
                });
            for (any, has) in units[unit].choices.iter_mut().zip(choices) {
                *any |= has;
            }
            (unit, choices)
        };
        let designs = designs.iter().enumerate().map(of_design).collect();
        Self { units, designs }
    }

    /// The choices that any of the designs has.
    pub fn wanted(&self) -> [bool; 4] {
        std::array::from_fn(|place| self.units.iter().any(|unit| unit.choices[place]))
    }

    /// Prices the choices of a window that have changed. `designs` are those that the units are of.
    pub fn price(&mut self, designs: &[Design], bests: &[Best; 4], changed: [bool; 4]) {
        for unit in &mut self.units {
            let design = &designs[unit.design];
            for (place, best) in bests.iter().enumerate().filter(|(place, _)| unit.choices[*place] && changed[*place]) {
                let offer = Offer::new(best, design);
                unit.total_w[place] = match &offer {
                    Offer::Powers(powers) => powers.total_w,
                    Offer::Lost => f64::NEG_INFINITY,
                    _ => f64::INFINITY,
                };
                unit.offers[place] = offer;
            }
        }
    }

    /// The cheapest of the priced choices that a design has, and how much more the next one costs.
    #[inline]
    pub fn cheapest(&self, design: usize) -> Cheapest<'_> {
        let (unit, has) = &self.designs[design];
        let unit = &self.units[*unit];
        let (mut cheapest, mut least_w, mut second_w) = (0, f64::INFINITY, f64::INFINITY);
        for (place, (has, total_w)) in has.iter().zip(unit.total_w).enumerate() {
            // Of numbers alone, so that no branch is needed.
            let total_w = if *has { total_w } else { f64::INFINITY };
            let is_cheaper = total_w < least_w;
            let dearer_w = if is_cheaper { least_w } else { total_w };
            second_w = if dearer_w < second_w { dearer_w } else { second_w };
            least_w = if is_cheaper { total_w } else { least_w };
            cheapest = if is_cheaper { place } else { cheapest };
        }
        match &unit.offers[cheapest] {
            Offer::Powers(powers) if least_w.is_finite() => {
                let runner_up_w = second_w.is_finite().then_some(second_w - least_w);
                Cheapest::Choice { place: cheapest, powers, runner_up_w }
            }
            _ => unit.none(*has),
        }
    }
}

impl Unit {
    /// Why a design with some of the choices has none that is known to be the cheapest.
    #[cold]
    fn none(&self, has: [bool; 4]) -> Cheapest<'_> {
        let mut failure = Cheapest::NotConverged;
        for offer in self.offers.iter().zip(has).filter(|(_, has)| *has).map(|(offer, _)| offer) {
            match (offer, &failure) {
                (Offer::Limited, _) => failure = Cheapest::Limited,
                // One that comes near the window is better than one that has no state.
                (Offer::Infeasible(_), Cheapest::Limited) | (Offer::Powers(_) | Offer::LeftOut, _) => {}
                (Offer::Infeasible(reason), _) => failure = Cheapest::Infeasible(*reason),
                // One choice that does not settle leaves the optimum unproven.
                (Offer::Lost, _) => return Cheapest::NotConverged,
            }
        }
        failure
    }
}

impl Offer {
    #[inline]
    fn new(best: &Best, design: &Design) -> Self {
        match best {
            Best::Found(choice) => match choice.powers(design) {
                powers if powers.supply.unmet_w > 0.0 => Self::Limited,
                powers => Self::Powers(powers),
            },
            Best::Infeasible(reason) => Self::Infeasible(*reason),
            Best::Lost => Self::Lost,
            Best::LeftOut => Self::LeftOut,
        }
    }
}
