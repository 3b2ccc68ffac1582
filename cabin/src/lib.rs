//! The bus: constants, heat flows, balances, doors, sun on the shell, COP and thermal comfort.
//!
//! Pure functions on plain structs. The model is that of Widmer, van Dooren and Onder, "Optimization of the
//! Energy-Comfort Trade-Off of HVAC Systems in Electric City Buses Based on a Steady-State Model" (Control Engineering
//! Practice 2025, 106158), called *the paper* here; equations are cited by their label in its source. Temperatures are
//! in kelvin, heat flows in watt, positive in the direction that their name says.
//!
//! The vocabulary of the whole program lives here too: [`Disturbances`] of a sample, a [`Design`] with its [`Devices`], a
//! [`ComfortWindow`], the [`Operation`] that is found for them, and the [`Outcome`] of looking for one.

mod abreast;
mod balance;
mod clothing;
mod comfort;
mod cop;
mod design;
mod devices;
mod disturbances;
mod flows;
mod lanes;
mod limits;
mod load;
mod net;
mod newton;
mod operation;
mod passengers;
mod pmv;
mod random;
mod real;
mod solar;
mod state;
mod transfer;
mod vehicle;
pub mod view_factor;
mod window;

pub use balance::{Cabin, Heaters};
pub use clothing::clothing_insulation_clo;
pub use comfort::Clothes;
pub use cop::{Cop, CopError, named_cooling_cops, named_heating_cops};
pub use design::{Design, Heating};
pub use devices::Devices;
pub use disturbances::{Disturbances, DisturbancesError};
pub use flows::{HeatFlows, Slopes, Temperatures};
pub use lanes::Lanes;
pub use limits::{LimitOf, PowerLimit, PowerLimitError, Supply};
pub use load::LoadChange;
pub use operation::{Candidate, Infeasible, OperatingMode, Operation, Optimum, Outcome};
pub use passengers::{
    Panel, PassengerViews, ceiling_panels, panel_view_factor, passenger_positions_m, place_passengers,
};
pub use pmv::{PmvModel, PmvPoint, StandardRange, predicted_percentage_dissatisfied, water_vapour_pressure_pa};
pub use random::unit_interval;
pub use real::Real;
pub use solar::{SolarGains, roof_irradiance_w_m2, wall_irradiance_w_m2};
pub use state::{State, Target};
pub use transfer::HeatTransfer;
pub use vehicle::{Vehicle, VehicleError};
pub use window::{ComfortWindow, WindowError};

/// 0 °C in kelvin.
pub const ZERO_CELSIUS_K: f64 = 273.15;

/// Kelvin from degrees Celsius.
#[must_use]
pub fn kelvin(celsius: f64) -> f64 {
    celsius + ZERO_CELSIUS_K
}

/// Degrees Celsius from kelvin.
#[must_use]
pub fn celsius(kelvin: f64) -> f64 {
    kelvin - ZERO_CELSIUS_K
}
