//! Where the sun stands, and how much of the road lies in the shade.
//!
//! Pure functions of place and time: [`Site::sun`] gives solar altitude and azimuth, [`ShadowYear`] the share of the
//! road that is shaded, taken from an hourly series of one reference year.

mod shadow;
mod sun;

pub use shadow::{ShadowError, ShadowYear, canyon_shadow_fraction};
pub use sun::{Site, SiteError, SunPosition};
