//! How easily heat passes between the reservoirs of a bus.

use crate::Vehicle;

/// Coefficients of a bus: heat by convection and conduction is one of them times a difference of temperatures, by radiation
/// times a difference of their fourth powers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeatTransfer {
    /// Cabin air and the inside of the shell, in W/K.
    pub convection_shell_inside_w_k: f64,
    /// Interior and cabin air, in W/K.
    pub convection_interior_w_k: f64,
    /// Radiant heaters and cabin air, in W/K.
    pub convection_radiant_heater_w_k: f64,
    /// Outside of the shell and ambient air, in W/K.
    pub convection_shell_outside_w_k: f64,
    /// Through the shell, in W/K.
    pub conduction_shell_w_k: f64,
    /// Radiant heaters and interior, in W/K⁴.
    pub radiation_heater_interior_w_k4: f64,
    /// Radiant heaters and shell, in W/K⁴.
    pub radiation_heater_shell_w_k4: f64,
    /// Interior and shell, in W/K⁴.
    pub radiation_interior_shell_w_k4: f64,
    /// Outside of the shell and its surroundings, in W/K⁴.
    pub radiation_shell_outside_w_k4: f64,
}

impl HeatTransfer {
    /// Of a bus (paper, appendix: areas, coefficients and view factors).
    #[must_use]
    pub fn of(v: &Vehicle) -> Self {
        let sigma = v.stefan_boltzmann_w_m2_k4;
        Self {
            convection_shell_inside_w_k: v.convection_inside_w_m2_k * v.shell_area_m2,
            convection_interior_w_k: v.convection_inside_w_m2_k * v.interior_area_m2,
            convection_radiant_heater_w_k: v.convection_radiant_heater_w_m2_k * v.radiant_heater_area_m2,
            convection_shell_outside_w_k: v.convection_outside_w_m2_k * v.shell_area_m2,
            conduction_shell_w_k: v.conduction_shell_w_m2_k * v.shell_area_m2,
            radiation_heater_interior_w_k4: sigma * v.radiant_heater_area_m2 * v.view_factor_heater_interior,
            radiation_heater_shell_w_k4: sigma * v.radiant_heater_area_m2 * v.view_factor_heater_shell,
            radiation_interior_shell_w_k4: sigma * v.interior_area_m2 * v.view_factor_interior_shell,
            radiation_shell_outside_w_k4: sigma * v.shell_area_m2,
        }
    }
}
