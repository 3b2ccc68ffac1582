//! How warmly people dress.

/// Clothing insulation in clo at an ambient temperature, not below `floor_clo`.
///
/// Cubic of the UTCI clothing model: Havenith et al. 2012, doi 10.1007/s00484-011-0451-4. The paper's clothing figure
/// (1.13 clo at 10 °C, 0.30 clo at 35 °C) confirms coefficients and floor.
#[must_use]
pub fn clothing_insulation_clo(ambient_temperature_k: f64, floor_clo: f64) -> f64 {
    let t = crate::celsius(ambient_temperature_k);
    (1.372 + t * (-0.01866 + t * (-0.000_484_9 + t * -0.000_009_333))).max(floor_clo)
}
