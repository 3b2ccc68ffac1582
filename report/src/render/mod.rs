//! From sections to bytes, a file a format.

mod csv;
mod markdown;

pub(crate) use csv::csv;
pub(crate) use markdown::markdown;
