//! Uniform numbers from random bits, the same on every machine.

/// A number in `0 … 1`, 1 excluded, from 64 random bits: the upper 53 fill the fraction of an f64.
#[must_use]
pub fn unit_interval(bits: u64) -> f64 {
    (bits >> 11) as f64 / (1_u64 << 53) as f64
}
