//! What comes out of a point: an operation, or why there is none.

use crate::{Devices, Heaters, StandardRange, Temperatures};

/// What the air unit does (paper, eq. operating-modes).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OperatingMode {
    /// −1: takes heat away.
    Cooling,
    /// 0: off.
    Passive,
    /// 1: brings heat.
    Heating,
}

impl OperatingMode {
    /// The paper's number: −1, 0 or 1.
    #[must_use]
    pub fn number(self) -> i8 {
        match self {
            Self::Cooling => -1,
            Self::Passive => 0,
            Self::Heating => 1,
        }
    }

    /// The temperature lift of the air unit in K, with ambient air and cabin in K: how much warmer the cabin is than the
    /// ambient air, in cooling how much colder.
    #[must_use]
    #[inline]
    pub fn lift_k(self, ambient_k: f64, cabin_k: f64) -> f64 {
        if self == Self::Cooling { ambient_k - cabin_k } else { cabin_k - ambient_k }
    }

    /// The mode of the paper's number.
    #[must_use]
    pub fn from_number(number: i64) -> Option<Self> {
        [Self::Cooling, Self::Passive, Self::Heating].into_iter().find(|mode| i64::from(mode.number()) == number)
    }
}

/// An HVAC operation in steady state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Operation {
    /// Mode of the air unit.
    pub mode: OperatingMode,
    /// The devices that run.
    pub devices: Devices,
    /// Electric power of the air unit in W, its back-up heater included.
    pub air_unit_power_w: f64,
    /// Electric power of the radiant heaters in W.
    pub radiant_heater_power_w: f64,
    /// Electric power of the air curtains in W.
    pub air_curtain_power_w: f64,
    /// Electric power of the back-up heater in W, a part of the air unit's.
    pub backup_heater_power_w: f64,
    /// Heat that the air unit brings in W, negative when cooling.
    pub air_unit_heat_w: f64,
    /// Heat in W that is missing at the limit of the window, because nothing on board can bring or take it away: 0 where the
    /// window is met. The state is the nearest to it.
    pub unmet_heat_w: f64,
    /// Temperatures of the reservoirs.
    pub temperatures: Temperatures,
    /// Mean radiant temperature of the average passenger in K.
    pub mean_radiant_temperature_k: f64,
    /// Mean over the passengers of the predicted mean vote.
    pub pmv: f64,
    /// Whether the state lies in the range of use of ISO 7730.
    pub standard_range: StandardRange,
}

impl Operation {
    /// State of the radiant heaters.
    #[must_use]
    pub fn heaters(&self) -> Heaters {
        self.devices.heaters()
    }

    /// Whether it misses the window, because nothing on board can bring or take away the heat.
    #[must_use]
    pub fn is_limited(&self) -> bool {
        self.unmet_heat_w > 0.0
    }

    /// Total power in W (paper, eq. phvactot).
    #[must_use]
    pub fn hvac_power_w(&self) -> f64 {
        self.air_unit_power_w + self.radiant_heater_power_w + self.air_curtain_power_w
    }
}

/// Why no operation meets a comfort window.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Infeasible {
    /// Even a cabin cooled to −60 °C is too warm, or the heaters' surroundings are hotter than they.
    TooWarm,
    /// Even a cabin heated to 60 °C is too cold.
    TooCold,
}

/// How a point ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Outcome {
    /// The global optimum, and by how many W the best other choice of heaters and curtain is more expensive
    /// (`None` where the design has no other feasible choice). Where no choice meets the window within the limits of the
    /// design, the operation that comes nearest to it.
    Solved(Operation, Option<f64>),
    /// No operation meets the window.
    Infeasible(Infeasible),
    /// An iteration did not settle.
    NotConverged,
}

impl Outcome {
    /// The operation, where there is one.
    #[must_use]
    pub fn operation(&self) -> Option<&Operation> {
        match self {
            Self::Solved(operation, _) => Some(operation),
            Self::Infeasible(_) | Self::NotConverged => None,
        }
    }

    /// The words of the view `optimum`.
    #[must_use]
    pub fn words(&self) -> &'static str {
        match self {
            Self::Solved(operation, _) if operation.is_limited() => "limited",
            Self::Solved(..) => "solved",
            Self::Infeasible(Infeasible::TooWarm) => "infeasible: too warm",
            Self::Infeasible(Infeasible::TooCold) => "infeasible: too cold",
            Self::NotConverged => "not converged",
        }
    }
}

/// The outcome of one design and one window, both by their place in the study.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Optimum {
    /// Place of the design.
    pub design: usize,
    /// Place of the window.
    pub window: usize,
    /// How it ended.
    pub outcome: Outcome,
}

impl Optimum {
    /// A place for an optimum that is not found yet.
    pub const UNSOLVED: Self = Self { design: 0, window: 0, outcome: Outcome::NotConverged };
}

/// One of the four choices of heaters and curtain, with its own best operation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Candidate {
    /// The devices that run.
    pub devices: Devices,
    /// Whether the design has what the choice needs.
    pub available: bool,
    /// The best operation with this choice, where one meets the window.
    pub operation: Option<Operation>,
}
