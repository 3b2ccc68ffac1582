//! Direct and diffuse irradiance where a station measures less.

use std::f64::consts::TAU;

/// Solar constant of Spencer's series as pvlib uses it, in W/m².
const SOLAR_CONSTANT_W_M2: f64 = 1366.1;
/// Beyond this zenith a horizontal measurement says nothing about the beam.
const MAX_ZENITH_COS: f64 = 0.052_335_956_242_943_83;
/// Least cosine of the zenith in the clearness index.
const MIN_CLEARNESS_COS: f64 = 0.065;

/// Direct normal and diffuse horizontal irradiance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BeamAndDiffuse {
    /// Direct normal irradiance in W/m².
    pub dni_w_m2: f64,
    /// Diffuse horizontal irradiance in W/m².
    pub dhi_w_m2: f64,
}

/// Irradiance outside the atmosphere on a plane normal to the sun, in W/m², for a day of the year from 1
/// (Spencer 1971, as in pvlib's `get_extra_radiation`).
#[must_use]
pub fn extraterrestrial_w_m2(day_of_year: u32) -> f64 {
    let b = TAU * (f64::from(day_of_year) - 1.0) / 365.0;
    let series =
        1.00011 + 0.034221 * b.cos() + 0.00128 * b.sin() + 0.000719 * (2.0 * b).cos() + 7.7e-5 * (2.0 * b).sin();
    SOLAR_CONSTANT_W_M2 * series
}

/// Splits global horizontal irradiance by the clearness index (Erbs, Klein, Duffie 1982,
/// doi 10.1016/0038-092X(82)90302-4), in the form of pvlib's `irradiance.erbs`.
///
/// With the sun lower than 3° all of it is diffuse. The beam never exceeds what arrives outside the atmosphere, which
/// only matters where the global irradiance does.
#[must_use]
pub fn erbs(ghi_w_m2: f64, solar_altitude_rad: f64, day_of_year: u32) -> BeamAndDiffuse {
    let cos_zenith = solar_altitude_rad.sin();
    let outside = extraterrestrial_w_m2(day_of_year);
    let kt = (ghi_w_m2 / (outside * cos_zenith.max(MIN_CLEARNESS_COS))).clamp(0.0, 1.0);
    let diffuse_fraction = if kt <= 0.22 {
        1.0 - 0.09 * kt
    } else if kt <= 0.8 {
        0.9511 + kt * (-0.1604 + kt * (4.388 + kt * (-16.638 + kt * 12.336)))
    } else {
        0.165
    };
    closure(ghi_w_m2, diffuse_fraction * ghi_w_m2, solar_altitude_rad, day_of_year)
}

/// Direct normal irradiance from global and diffuse: `GHI = DNI · sin(altitude) + DHI`.
///
/// With the sun lower than 3°, or more diffuse than global irradiance, the beam is 0 and all of the global irradiance
/// is diffuse. The beam never exceeds what arrives outside the atmosphere; what it would is diffuse.
#[must_use]
pub fn closure(ghi_w_m2: f64, dhi_w_m2: f64, solar_altitude_rad: f64, day_of_year: u32) -> BeamAndDiffuse {
    let cos_zenith = solar_altitude_rad.sin();
    if cos_zenith < MAX_ZENITH_COS || dhi_w_m2 > ghi_w_m2 {
        return BeamAndDiffuse { dni_w_m2: 0.0, dhi_w_m2: ghi_w_m2 };
    }
    let dni_w_m2 = (ghi_w_m2 - dhi_w_m2) / cos_zenith;
    let outside = extraterrestrial_w_m2(day_of_year);
    if dni_w_m2 > outside {
        return BeamAndDiffuse { dni_w_m2: outside, dhi_w_m2: ghi_w_m2 - outside * cos_zenith };
    }
    BeamAndDiffuse { dni_w_m2, dhi_w_m2 }
}
