//! The sun on roof, walls and windows.

use crate::{Disturbances, Vehicle};

/// Solar heat gains in W (paper, section 2.1.3).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SolarGains {
    /// Absorbed by the interior, Q_sol,int.
    pub interior_w: f64,
    /// Absorbed by the inside of the shell, Q_sol,s,i.
    pub shell_inside_w: f64,
    /// Absorbed by the outside of the shell, Q_sol,s,o.
    pub shell_outside_w: f64,
}

/// Irradiance on the roof in W/m²: `sin(altitude) · DNI + DHI`, without beam where the sun is below the horizon.
#[must_use]
pub fn roof_irradiance_w_m2(disturbances: &Disturbances) -> f64 {
    disturbances.solar_altitude_rad.sin().max(0.0) * disturbances.dni_w_m2 + disturbances.dhi_w_m2
}

/// Mean irradiance on the walls of a bus that drives in all directions alike, in W/m²:
/// `cos(altitude) / π · DNI + DHI / 2`, without beam where the sun is below the horizon.
#[must_use]
pub fn wall_irradiance_w_m2(disturbances: &Disturbances) -> f64 {
    let altitude = disturbances.solar_altitude_rad;
    let beam = if altitude > 0.0 { altitude.cos() / std::f64::consts::PI * disturbances.dni_w_m2 } else { 0.0 };
    beam + 0.5 * disturbances.dhi_w_m2
}

impl SolarGains {
    /// The gains of a vehicle under the given disturbances.
    #[must_use]
    pub fn new(vehicle: &Vehicle, disturbances: &Disturbances) -> Self {
        let roof_w_m2 = roof_irradiance_w_m2(disturbances);
        let wall_w = vehicle.wall_area_m2 * wall_irradiance_w_m2(disturbances);
        let lit = 1.0 - disturbances.shadow_fraction;
        let transmitted_w = lit * wall_w * vehicle.window_fraction * vehicle.window_transmissivity;
        let roof_w = vehicle.roof_area_m2 * roof_w_m2 * (1.0 - vehicle.roof_coverage_fraction);
        Self {
            interior_w: transmitted_w * vehicle.interior_solar_fraction,
            shell_inside_w: transmitted_w * (1.0 - vehicle.interior_solar_fraction),
            shell_outside_w: lit * vehicle.shell_absorptivity * (roof_w + wall_w * (1.0 - vehicle.window_fraction)),
        }
    }
}
