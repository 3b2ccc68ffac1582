//! The threshold that follows from the model.

use cabin::{Cop, Vehicle};

/// The difference of cabin and ambient temperature in K from which on an air curtain saves more power than it takes. The open
/// share of the doors cancels: the curtain saves `reduction · c · |ΔT|^1.5 / sqrt(T_amb) / COP(|ΔT|)` (eq. `qdoor`) and takes
/// its own power. `cop` is that of the mode, over the lift. `None` where it never pays below 100 K.
#[must_use]
pub fn curtain_threshold_k(vehicle: &Vehicle, cop: &Cop, ambient_k: f64) -> Option<f64> {
    let saved_w_k15 = vehicle.air_curtain_loss_reduction * vehicle.door_loss_w_k15(ambient_k);
    let gain_w =
        |difference_k: f64| saved_w_k15 * difference_k.powf(1.5) / cop.at(difference_k) - vehicle.air_curtain_power_w;
    let (mut low_k, mut high_k) = (0.0, 100.0);
    if gain_w(high_k) < 0.0 {
        return None;
    }
    // The gain rises: the COP never does.
    for _ in 0..60 {
        let middle_k = 0.5 * (low_k + high_k);
        if gain_w(middle_k) < 0.0 { low_k = middle_k } else { high_k = middle_k }
    }
    Some(high_k)
}
