//! Where the sun stands, and how much of the road lies in the shade.
//!
//! Pure functions of place and time: [`Site::sun`] gives solar altitude and azimuth, [`ShadowYear`] the share of the
//! road that is shaded, taken from an hourly series of one reference year; [`canyon_year`] makes such a series for street canyons.

mod calendar;
mod canyon;
mod shadow;
mod sun;

pub use calendar::hour_of_year;
pub use canyon::{Street, Streets, canyon_shadow_fraction, canyon_year, even_azimuths_rad, in_directions};
pub use shadow::{ShadowError, ShadowYear};
pub use sun::{Site, SiteError, SunPosition};
