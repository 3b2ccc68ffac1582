//! What comes out of a point: an operation, or why there is none.

use cabin::{StandardRange, Temperatures};

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
}

/// An HVAC operation in steady state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Operation {
    /// Mode of the air unit.
    pub mode: OperatingMode,
    /// Whether the air curtains run.
    pub air_curtain_on: bool,
    /// Whether the radiant heaters are on.
    pub radiant_heaters_on: bool,
    /// Electric power of the air unit in W.
    pub air_unit_power_w: f64,
    /// Electric power of the radiant heaters in W.
    pub radiant_heater_power_w: f64,
    /// Electric power of the air curtains in W.
    pub air_curtain_power_w: f64,
    /// Heat that the air unit brings in W, negative when cooling.
    pub air_unit_heat_w: f64,
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
    /// (`None` where the design has no other feasible choice).
    Solved(Operation, Option<f64>),
    /// No operation meets the window.
    Infeasible(Infeasible),
    /// An iteration did not settle.
    NotConverged,
}

/// The outcome of one design and one window.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Optimum {
    /// Index of the design in the grid.
    pub design: usize,
    /// Index of the window in the grid.
    pub window: usize,
    /// How it ended.
    pub outcome: Outcome,
}

/// One of the four choices of heaters and curtain, with its own best operation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Candidate {
    /// Whether the air curtains run.
    pub air_curtain_on: bool,
    /// Whether the radiant heaters are on.
    pub radiant_heaters_on: bool,
    /// Whether the design has what the choice needs.
    pub available: bool,
    /// The best operation with this choice, where one meets the window.
    pub operation: Option<Operation>,
}
