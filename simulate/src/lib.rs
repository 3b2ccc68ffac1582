//! The bus in time: the dynamic model, and the controllers that drive it.
//!
//! The five balances (paper, eq. `odes`) with their heat capacities, and the first-order lag of the air unit (eq. `vcc-ode`).
//! [`simulate`](fn@simulate) drives a mission in many [`Variant`]s at once, eight abreast, [`simulate_distinct`] those that can
//! come out differently; a [`Scenario`] says where it starts
//! and what limits hold, a law of [`control`] prescribes setpoints and thresholds. The paper's validation (section "Validation
//! of the Steady-State Assumption") and three less bound ways to drive are [`Replay`]s of the steady-state optima.
//!
//! Pure functions of a mission's loads and weather: no files, no clock, no database, and nothing allocated per second.

mod alike;
mod average;
mod constants;
pub mod control;
mod drive;
mod instant;
mod judge;
mod lanes;
mod mission;
mod model;
mod replay;
mod scenario;
mod segment;
mod summary;
mod trace;

pub use alike::{Used, simulate_distinct};
pub use constants::{Dynamics, DynamicsError};
pub use drive::{Record, simulate, simulate_with};
pub use instant::Instant;
pub use judge::Rides;
pub use lanes::LANES;
pub use mission::{Mission, Variant};
pub use model::{BusState, Commands, depot_temperature_k};
pub use replay::Replay;
pub use scenario::{Limits, PowerLimits, Scenario, Start};
pub use segment::Segment;
pub use summary::Summary;
pub use trace::{Trace, TraceMinute};

/// Version of the model: it changes whenever a stored simulation would, beyond rounding, come out differently.
pub const SIMULATION_VERSION: u32 = 5;
