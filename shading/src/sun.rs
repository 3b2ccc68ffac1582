//! Solar altitude and azimuth of a place on Earth.

use chrono::{DateTime, Utc};
use spa::{StdFloatOps, solar_position};

/// A place on Earth whose coordinates have been checked.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Site {
    latitude_deg: f64,
    longitude_deg: f64,
}

/// Where the sun's centre stands, without atmospheric refraction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SunPosition {
    /// Angle above the horizon in rad, −π/2 … π/2.
    pub altitude_rad: f64,
    /// Angle from north, clockwise, in rad, 0 … 2π.
    pub azimuth_rad: f64,
}

/// The coordinates do not lie on Earth.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum SiteError {
    /// The latitude is outside −90 … 90°.
    #[error("latitude_deg = {0} is outside -90 … 90")]
    Latitude(f64),
    /// The longitude is outside −180 … 180°.
    #[error("longitude_deg = {0} is outside -180 … 180")]
    Longitude(f64),
}

impl Site {
    /// A site from its WGS 84 coordinates in degrees, north and east positive.
    ///
    /// # Errors
    /// [`SiteError`] where a coordinate is not a number on the globe.
    pub fn new(latitude_deg: f64, longitude_deg: f64) -> Result<Self, SiteError> {
        if !(-90.0..=90.0).contains(&latitude_deg) {
            return Err(SiteError::Latitude(latitude_deg));
        }
        if !(-180.0..=180.0).contains(&longitude_deg) {
            return Err(SiteError::Longitude(longitude_deg));
        }
        Ok(Self { latitude_deg, longitude_deg })
    }

    /// Latitude in degrees, north positive.
    #[must_use]
    pub fn latitude_deg(&self) -> f64 {
        self.latitude_deg
    }

    /// Longitude in degrees, east positive.
    #[must_use]
    pub fn longitude_deg(&self) -> f64 {
        self.longitude_deg
    }

    /// The sun's position at an instant, by the PSA algorithm (Blanco-Muriel et al. 2001,
    /// doi 10.1016/S0038-092X(00)00156-0) of the `spa` crate. Its error against NREL's SPA is measured in the tests of
    /// this crate and stays below 0.05° above the horizon between 1990 and 2050.
    #[must_use]
    pub fn sun(&self, instant: DateTime<Utc>) -> SunPosition {
        let position = solar_position::<StdFloatOps>(instant, self.latitude_deg, self.longitude_deg)
            .expect("the coordinates were checked when the site was made");
        SunPosition {
            altitude_rad: (90.0 - position.zenith_angle).to_radians(),
            azimuth_rad: position.azimuth.to_radians(),
        }
    }
}
