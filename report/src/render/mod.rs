//! From sections to bytes, a file a format.

mod csv;
mod figures;
mod html;
mod markdown;

pub(crate) use csv::csv;
pub(crate) use figures::{data, svg};
pub(crate) use html::html;
pub(crate) use markdown::markdown;
