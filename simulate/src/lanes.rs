//! How many variants are simulated abreast.

/// Variants that are simulated abreast.
pub const LANES: usize = 8;

/// As many where few are left over, which takes less than eight do.
pub(crate) const FEW: usize = 4;
