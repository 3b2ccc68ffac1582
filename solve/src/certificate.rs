//! The proof, ahead of any run, that the power falls below and rises above the passive cabin temperature.
//!
//! Cooling: `|Q| / COP + P_rh` falls with the cabin temperature, since `|Q|` and `P_rh` fall and the COP does not (the
//! lift `T_amb − T_cab` shrinks). Heating without heaters: `Q / COP` rises, since `Q` rises and the COP does not.
//! Heating with heaters on: `dP/dT >= Q' / COP_max + P_rh'`, where a prime is the slope over the cabin temperature. With
//! x, y the slopes of interior and inner shell, `a = 4 σ A F T³` the radiation slopes and `U` the conductance from inner
//! shell to ambient, the balances (eq. odes) give
//!
//! ```text
//! P_rh' = −(h_rh A_rh + a_rh,int x + a_rh,s y)        Q' = −P_rh' + U A_s y + (door slope >= 0)
//! ```
//!
//! so the power rises if `U A_s y > (COP_max − 1) (h_rh A_rh + a_rh,int x + a_rh,s y)`. With `x, y <= 1` and
//! `y >= h_in A_s / (h_in A_s + a_rh,s + a_int,s + U A_s)`, both sides are bounded over all temperatures up to that of
//! the heaters. [`certify`] checks that inequality; the paper's bus fulfils it three times over.

use cabin::{CopError, Design, Vehicle, VehicleError};

/// The optimum of a study could not be proven to be global.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CertificateError {
    /// A constant of the vehicle is out of its range.
    #[error(transparent)]
    Vehicle(#[from] VehicleError),
    /// A COP curve rises with the lift or is not positive.
    #[error(transparent)]
    Cop(#[from] CopError),
    /// With heaters on, the power might not rise with the cabin temperature.
    #[error(
        "design {design:?}: with a COP of up to {largest_cop} and this vehicle, a warmer cabin could cost less while the \
         radiant heaters are on ({gain_w_k:.0} W/K of heater power saved against {loss_w_k:.0} W/K lost), so the \
         optimum would not be proven; lower the COP, the heater area, or insulate less"
    )]
    Heaters {
        /// Name of the design.
        design: String,
        /// Its largest COP in heating.
        largest_cop: f64,
        /// Upper bound of what a kelvin saves in heater power, times (COP − 1), in W/K.
        gain_w_k: f64,
        /// Lower bound of what a kelvin loses through the shell, in W/K.
        loss_w_k: f64,
    },
}

/// Checks that the optimum of every point of these designs in this vehicle is the global one.
///
/// # Errors
/// [`CertificateError`] says what breaks the proof.
pub fn certify(vehicle: &Vehicle, designs: &[Design]) -> Result<(), CertificateError> {
    vehicle.check()?;
    for design in designs {
        for cop in [&design.heating_cop, &design.cooling_cop] {
            check_falling(cop)?;
        }
        if design.devices.radiant_heaters {
            check_heaters(vehicle, design)?;
        }
    }
    Ok(())
}

fn check_falling(cop: &cabin::Cop) -> Result<(), CopError> {
    use cabin::Cop;
    // A table was checked when it was made; a curve is a table of its own values here.
    match cop {
        Cop::Table(rows) => Cop::table(rows.clone()).map(|_| ()),
        curve => Cop::table((-120..=120).map(|k| (f64::from(k), curve.at(f64::from(k)))).collect()).map(|_| ()),
    }
}

fn check_heaters(vehicle: &Vehicle, design: &Design) -> Result<(), CertificateError> {
    let v = vehicle;
    let hottest3 = v.radiant_heater_target_k.powi(3);
    let radiation = |area: f64, view: f64| 4.0 * v.stefan_boltzmann_w_m2_k4 * area * view * hottest3;
    let heater_shell = radiation(v.radiant_heater_area_m2, v.view_factor_heater_shell);
    let heater_interior = radiation(v.radiant_heater_area_m2, v.view_factor_heater_interior);
    let interior_shell = radiation(v.interior_area_m2, v.view_factor_interior_shell);
    let conductance = |outside_w_m2_k: f64| {
        v.shell_area_m2 * v.conduction_shell_w_m2_k * outside_w_m2_k / (v.conduction_shell_w_m2_k + outside_w_m2_k)
    };
    let outside_least = v.convection_outside_w_m2_k;
    let outside_most = outside_least + 4.0 * v.stefan_boltzmann_w_m2_k4 * hottest3;

    let inside = v.convection_inside_w_m2_k * v.shell_area_m2;
    let shell_slope = inside / (inside + heater_shell + interior_shell + conductance(outside_most));
    let loss_w_k = conductance(outside_least) * shell_slope;
    let heater_convection = v.convection_radiant_heater_w_m2_k * v.radiant_heater_area_m2;
    let largest_cop = design.heating_cop.largest();
    let gain_w_k = (largest_cop - 1.0) * (heater_convection + heater_interior + heater_shell);
    if loss_w_k > gain_w_k {
        return Ok(());
    }
    Err(CertificateError::Heaters { design: design.name.clone(), largest_cop, gain_w_k, loss_w_k })
}
