//! The bus in time: the dynamic model, and the controller that drives it.
//!
//! The five balances (paper, eq. `odes`) with their heat capacities, the first-order lag of the air unit (eq. `vcc-ode`),
//! and the control of the paper's validation (section "Validation of the Steady-State Assumption"): operating mode, curtain and
//! heaters of the steady-state optimum are held within each segment, its cabin temperature is tracked by a PI controller.
//!
//! Pure functions of a mission's loads and weather: [`simulate`] knows no files, no clock and no database, and allocates
//! nothing.

mod average;
mod constants;
mod control;
mod mission;
mod model;

pub use constants::{Dynamics, DynamicsError};
pub use control::PiController;
pub use mission::{Change, Conduct, Hour, Instant, Mission, Summary, simulate};
pub use model::{BusState, Commands, depot_temperature_k, step};

/// Version of the model: it changes whenever a stored simulation would, beyond rounding, come out differently.
pub const SIMULATION_VERSION: u32 = 1;
