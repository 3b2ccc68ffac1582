//! The cheapest steady-state HVAC operation of one sample, and of a whole study in parallel.
//!
//! The optimum is global by construction; [`certify`] says why, and refuses what it cannot prove.
//!
//! Given the cabin temperature and the heater state, the balances fix everything else ([`cabin::Cabin::state`]). Three
//! facts then leave nothing to search:
//!
//! 1. The mean vote rises with the cabin temperature, so a comfort window is an interval `[T_lo, T_hi]`.
//! 2. The heat that the air unit has to bring rises with it, so it is zero at one temperature `T_0` only.
//! 3. The power falls below `T_0` (cooling) and rises above it (heating), so its least value over the interval lies at
//!    the point of `[T_lo, T_hi]` that is nearest to `T_0`.
//!
//! What is left is a comparison of the binary choices: heaters on or off, curtain on or off. `T_lo` and `T_hi` do not
//! depend on curtain and heat source, `T_0` does not depend on the window: the work is shared between designs and
//! windows, and a point costs a few multiplications.

mod abreast;
mod annual;
mod blocks;
mod certificate;
mod choice;
mod grid;
mod method;
mod near;
pub mod nlp;
mod offer;
mod sample;
mod states;
mod steady;
mod sum;

pub use annual::{AnnualMean, DAYS_OF_MONTH, YearSamples};
pub use certificate::{CertificateError, certify};
pub use grid::{Grid, GridError};
pub use method::Method;
pub use near::{Bus, YearStates};
pub use sample::{SampleSolver, solve_blocks};
pub use sum::PowerSums;

/// Version of the method: it changes whenever a bit of a stored optimum would come out differently.
pub const METHOD_VERSION: u32 = 9;
