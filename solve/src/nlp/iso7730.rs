//! The vote of ISO 7730 in numbers that carry their derivatives.

use cabin::Vehicle;
use num_dual::DualNum;

/// ISO 7730:2005, Annex D, for one clothing and the vehicle's activity, air speed and humidity.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Iso7730 {
    metabolic_w_m2: f64,
    relative_humidity: f64,
    insulation_m2k_w: f64,
    area_factor: f64,
    pub forced: f64,
}

impl Iso7730 {
    pub fn new(vehicle: &Vehicle, clothing_clo: f64) -> Self {
        let insulation_m2k_w = 0.155 * clothing_clo;
        Self {
            metabolic_w_m2: 58.15 * vehicle.metabolic_rate_met,
            relative_humidity: vehicle.relative_humidity,
            insulation_m2k_w,
            area_factor: if insulation_m2k_w <= 0.078 {
                1.0 + 1.29 * insulation_m2k_w
            } else {
                1.05 + 0.645 * insulation_m2k_w
            },
            forced: 12.1 * vehicle.air_velocity_m_s.sqrt(),
        }
    }

    /// Eq. 1 of the standard, with the annex's 273 for 0 °C.
    pub fn vote<D: DualNum<Primitive = f64> + Copy>(&self, air_k: D, radiant_k: D) -> D {
        let m = self.metabolic_w_m2;
        let (air, radiant) = (air_k - 0.15, radiant_k - 0.15);
        let air_c = air - 273.0;
        let vapour_pa = ((air_c + 235.0).recip() * -4030.183 + 16.6536).exp() * (1000.0 * self.relative_humidity);
        let clothing = self.clothing_k(air, radiant);
        let radiation = (fourth(clothing) - fourth(radiant)) * (3.96e-8 * self.area_factor);
        let convection = self.convection_w_m2(clothing - air) * self.area_factor;
        let sweat_w_m2 = (0.42 * (m - 58.15)).max(0.0);
        let skin = -(vapour_pa - (5733.0 - 6.99 * m)) * 0.00305 + sweat_w_m2;
        let breath = -(vapour_pa - 5867.0) * (1.7e-5 * m) - (air_c - 34.0) * (0.0014 * m);
        -(skin + breath + radiation + convection - m) * (0.303 * (-0.036 * m).exp() + 0.028)
    }

    /// Surface temperature of the clothing: the root by Newton's method in plain numbers, then two Newton steps
    /// in `D`, of which each makes one more order of derivatives exact.
    pub fn clothing_k<D: DualNum<Primitive = f64> + Copy>(&self, air: D, radiant: D) -> D {
        let (plain_air, plain_radiant) = (air.re(), radiant.re());
        let mut t = (308.7 - 0.028 * self.metabolic_w_m2).max(plain_air).max(plain_radiant);
        for _ in 0..50 {
            let (excess, slope) = self.excess(t, plain_air, plain_radiant);
            let step = excess / slope;
            t -= step;
            if step.abs() < 1e-11 * t {
                break;
            }
        }
        let slope = self.excess(t, plain_air, plain_radiant).1;
        let mut clothing = D::from(t);
        for _ in 0..2 {
            clothing -= self.excess(clothing, air, radiant).0 * (1.0 / slope);
        }
        clothing
    }

    /// What the heat balance of the clothing has left over in K, and its slope in plain numbers.
    fn excess<D: DualNum<Primitive = f64> + Copy>(&self, clothing: D, air: D, radiant: D) -> (D, f64) {
        let resistance = self.insulation_m2k_w * self.area_factor;
        let convection = self.convection_w_m2(clothing - air);
        let radiation = (fourth(clothing) - fourth(radiant)) * 3.96e-8;
        let left = clothing + (radiation + convection) * resistance - (308.7 - 0.028 * self.metabolic_w_m2);
        let difference = clothing.re() - air.re();
        let natural = 2.38 * difference.abs().sqrt().sqrt();
        let per_k = if natural > self.forced { 1.25 * natural } else { self.forced };
        (left, 1.0 + resistance * (4.0 * 3.96e-8 * clothing.re().powi(3) + per_k))
    }

    /// `h_c · d`, natural or forced, whichever is larger.
    fn convection_w_m2<D: DualNum<Primitive = f64> + Copy>(&self, difference: D) -> D {
        if 2.38 * difference.re().abs().sqrt().sqrt() > self.forced {
            difference * difference.abs().sqrt().sqrt() * 2.38
        } else {
            difference * self.forced
        }
    }
}

fn fourth<D: DualNum<Primitive = f64> + Copy>(x: D) -> D {
    let square = x * x;
    square * square
}
