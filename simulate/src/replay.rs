//! The optima of a mission replayed: four pairs of scenario and law, each with one habit of the paper's validation less.
//! Taking them away one after the other tells what each one costs.

use cabin::Design;

use crate::control::{ComfortBand, HourlyMode, Loops};
use crate::{Dynamics, Instant, Limits, Mission, Scenario, Start, Summary, simulate};

/// A scenario with a law, and the name that both have together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Replay {
    /// The `controller` in the database.
    pub name: &'static str,
    /// The conditions.
    pub scenario: Scenario,
    /// Who decides on the operating mode.
    pub law: Law,
}

/// The law that follows the optima.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Law {
    /// [`HourlyMode`].
    HourlyMode,
    /// [`ComfortBand`].
    ComfortBand,
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

    /// Simulates a mission; `record` sees every second. `None` as of [`simulate`].
    pub fn run(
        &self,
        mission: &Mission<'_, '_>,
        design: &Design,
        dynamics: &Dynamics,
        record: impl FnMut(&Instant),
    ) -> Option<Summary> {
        let Scenario { start, .. } = self.scenario;
        let mut loops = Loops::new(design, dynamics, self.scenario);
        if start == Start::SteadyState {
            loops = loops.settled(&mission.segments.first()?.optimum);
        }
        let (segments, segment_s) = (mission.segments, mission.segment_s);
        match self.law {
            Law::HourlyMode => {
                simulate(mission, design, dynamics, start, &mut HourlyMode::new(segments, segment_s, loops), record)
            }
            Law::ComfortBand => {
                simulate(mission, design, dynamics, start, &mut ComfortBand::new(segments, segment_s, loops), record)
            }
        }
    }
}
