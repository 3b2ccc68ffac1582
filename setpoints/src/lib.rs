//! What a controller without foresight can learn from a year of optima (paper, section "Case Study 2: Causal Online Control").
//!
//! The optima of a design in a comfort window are a cloud of cabin over ambient temperatures, by operating mode. A heating
//! [`Profile`] runs along its upper edge, a cooling profile along its lower edge: who tracks them meets the window in the share
//! of the year that they cover. [`Threshold`]s say from which temperature difference on the air curtains pay, beside the one
//! that follows from the model ([`curtain_threshold_k`]); beside the profiles those that others have [`published`].
//!
//! Pure functions of plain structs: no files, no clock, no database.

mod analytic;
mod basis;
mod curve;
mod extract;
mod fit;
mod own;
mod profile;
mod published;
mod threshold;

pub use analytic::curtain_threshold_k;
pub use curve::{Curve, Shape};
pub use extract::{CurtainThreshold, HeaterThreshold, Hour, Setpoints, extract};
pub use own::{Own, OwnError};
pub use profile::{Edge, FitError, Point, Profile, fit};
pub use published::{Published, published};
pub use threshold::{Switch, Threshold, threshold};
