//! What acts on the bus from outside.

use std::f64::consts::FRAC_PI_2;

/// The disturbances of one sample, held constant (paper, section 2.1, vector d).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Disturbances {
    /// Ambient air temperature in K.
    pub ambient_temperature_k: f64,
    /// Direct normal irradiance in W/m².
    pub dni_w_m2: f64,
    /// Diffuse horizontal irradiance in W/m².
    pub dhi_w_m2: f64,
    /// Solar altitude in rad; below the horizon there is no beam.
    pub solar_altitude_rad: f64,
    /// Share of time in the shade, 0 … 1.
    pub shadow_fraction: f64,
    /// Passengers on board, a mean and so not whole.
    pub passengers: f64,
    /// Fraction of the doors that are open, 0 … 1.
    pub door_open_fraction: f64,
}

/// A disturbance has a value that cannot be.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{name} = {value} is outside {low} … {high}")]
pub struct DisturbancesError {
    /// Name of the disturbance.
    pub name: &'static str,
    /// Its value.
    pub value: f64,
    /// Least value allowed.
    pub low: f64,
    /// Largest value allowed.
    pub high: f64,
}

impl Disturbances {
    /// Checks that every value is finite and physically possible.
    ///
    /// # Errors
    /// The first value outside its range.
    pub fn check(&self) -> Result<(), DisturbancesError> {
        let ranges = [
            ("ambient_temperature_k", self.ambient_temperature_k, 203.15, 333.15),
            ("dni_w_m2", self.dni_w_m2, 0.0, 1500.0),
            ("dhi_w_m2", self.dhi_w_m2, 0.0, 1500.0),
            ("solar_altitude_rad", self.solar_altitude_rad, -FRAC_PI_2, FRAC_PI_2),
            ("shadow_fraction", self.shadow_fraction, 0.0, 1.0),
            ("passengers", self.passengers, 0.0, 500.0),
            ("door_open_fraction", self.door_open_fraction, 0.0, 1.0),
        ];
        for (name, value, low, high) in ranges {
            if !(low..=high).contains(&value) {
                return Err(DisturbancesError { name, value, low, high });
            }
        }
        Ok(())
    }
}
