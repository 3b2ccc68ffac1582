//! The optima of a mission replayed: four pairs of scenario and law, each with one habit of the paper's validation less.
//! Taking them away one after the other tells what each one costs.

use cabin::Design;

use crate::control::Law;
use crate::{Limits, Scenario, Segment, Start, Variant};

/// A scenario with a law, and the name that both have together.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Replay {
    /// The `controller` in the database.
    pub name: &'static str,
    /// The conditions.
    pub scenario: Scenario,
    /// Who decides on the operating mode.
    pub law: Law<'static>,
}

impl Replay {
    /// As in the paper: from the depot, with power limits, the operating mode held within each segment.
    pub const PAPER: Self =
        Self { name: "paper", scenario: Scenario { start: Start::Depot, limits: Limits::Rated }, law: Law::HourlyMode };
    /// From the steady state of the first segment instead.
    pub const WARM_START: Self = Self {
        name: "warm-start",
        scenario: Scenario { start: Start::SteadyState, limits: Limits::Rated },
        law: Law::HourlyMode,
    };
    /// And without power limits.
    pub const UNLIMITED: Self = Self {
        name: "unlimited",
        scenario: Scenario { start: Start::SteadyState, limits: Limits::Unlimited },
        law: Law::HourlyMode,
    };
    /// And with the operating mode that the cabin asks for.
    pub const FREE_MODE: Self = Self {
        name: "free-mode",
        scenario: Scenario { start: Start::SteadyState, limits: Limits::Unlimited },
        law: Law::ComfortBand,
    };
    /// All of them, each one less bound than the one before.
    pub const ALL: [Self; 4] = [Self::PAPER, Self::WARM_START, Self::UNLIMITED, Self::FREE_MODE];

    /// The variant of a mission in which this replays the optima of a design.
    #[must_use]
    pub fn of<'m>(&self, design: &'m Design, segments: &'m [Segment]) -> Variant<'m> {
        Variant { design, scenario: self.scenario, law: self.law, segments, windows: &[] }
    }
}
