//! How many variants are simulated abreast.

/// Variants that are simulated abreast.
pub const LANES: usize = 8;

/// A number of each of them.
pub(crate) type Lanes = cabin::Lanes<LANES>;
