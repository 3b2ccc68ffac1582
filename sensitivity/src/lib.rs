//! What the year of a bus depends on: the same samples with a bus, or with what acts on it, that differs in named inputs.
//!
//! A [`Variation`] is such a bus. [`Analysis`] solves its year in all designs and some windows and keeps nothing of a single
//! sample: one input at a time between two values, and all of them together in [`Saltelli`]'s design, from which [`indices`]
//! says which share of the variance each input explains.
//!
//! Pure functions: no files, no clock, no database. Sets go abreast on rayon's current pool, each added up in a fixed order,
//! so that threads change no bit.

mod analysis;
mod indices;
mod input;
mod result;
mod saltelli;
mod variation;

pub use analysis::{Analysis, AnalysisError, Solved, Spreading, Swing};
pub use indices::{Index, RESAMPLES, Resamples, indices};
pub use input::{Input, Spread};
pub use result::{Quantified, Quantity};
pub use saltelli::{MOST_INPUTS, MOST_POINTS, Saltelli};
pub use variation::{Factors, Passengers, Variation, VariationError};

/// Version of the results: it changes whenever a stored one would, beyond rounding, come out differently.
pub const SENSITIVITY_VERSION: u32 = 1;
