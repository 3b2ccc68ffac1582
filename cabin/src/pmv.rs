//! Predicted mean vote and predicted percentage dissatisfied: ISO 7730:2005, Annex D, solved to convergence.

use crate::Real;

/// The predicted mean vote of people with one clothing, activity, air speed and humidity.
///
/// Inside, temperatures are shifted by 273 as in the annex's program, so that its values are met to rounding.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PmvModel {
    clothing_clo: f64,
    metabolic_w_m2: f64,
    relative_humidity: f64,
    air_velocity_m_s: f64,
    /// Clothing insulation in m²K/W.
    insulation: f64,
    /// Ratio of clothed to naked surface.
    area_factor: f64,
    /// Forced convection coefficient in W/(m²K).
    forced_convection: f64,
    /// 0.303 exp(−0.036 M) + 0.028.
    sensitivity: f64,
    /// Sweat loss and its like: what does not depend on temperature, in W/m².
    fixed_loss_w_m2: f64,
    /// Air temperature in °C from which the vapour pressure is above [`MOST_VAPOUR_PA`].
    humid_from_c: f64,
}

/// A predicted mean vote with its slopes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PmvPoint {
    /// Predicted mean vote; the scale −3 … 3 is not enforced.
    pub pmv: f64,
    /// Slope over the air temperature in 1/K.
    pub per_air_k: f64,
    /// Slope over the mean radiant temperature in 1/K.
    pub per_radiant_k: f64,
    /// Surface temperature of the clothing less that of the air in K.
    pub surface_excess_k: f64,
}

/// A quantity to first order: with the air as warm as it is, and its slope over the air temperature.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Line<R = f64> {
    pub value: R,
    pub per_air_k: R,
}

/// Radiation and convection from the clothing's surface in W/m², and its slope in W/(m²K) over the surface's temperature.
struct DryLoss<R> {
    w_m2: R,
    per_surface: R,
}

/// Whether a state lies where ISO 7730 (clause 4.1) says that the index should be used.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StandardRange {
    /// All quantities inside.
    Inside,
    /// At least one outside: the value is computed as always, and to be read with care.
    Outside,
}

const W_M2_PER_MET: f64 = 58.15;
const M2_K_W_PER_CLO: f64 = 0.155;
/// Coefficient of natural convection in W/(m² K^1.25).
const NATURAL_CONVECTION: f64 = 2.38;
/// Largest vapour pressure in Pa for which the index should be used (ISO 7730, clause 4.1).
const MOST_VAPOUR_PA: f64 = 2700.0;

/// Partial pressure of water vapour in Pa at a relative humidity 0 … 1 and an air temperature in °C (Annex D).
#[must_use]
pub fn water_vapour_pressure_pa(relative_humidity: f64, air_c: f64) -> f64 {
    relative_humidity * 1000.0 * (16.6536 - 4030.183 / (air_c + 235.0)).exp()
}

/// The air temperature in °C of a partial pressure: the inverse of [`water_vapour_pressure_pa`]. Infinite in dry air.
fn air_of_vapour_pressure_c(relative_humidity: f64, vapour_pa: f64) -> f64 {
    let inverse = 16.6536 - (vapour_pa / (1000.0 * relative_humidity)).ln();
    if inverse > 0.0 { 4030.183 / inverse - 235.0 } else { f64::INFINITY }
}

/// Predicted percentage dissatisfied, 5 … 100 %, from the predicted mean vote (ISO 7730, eq. 5).
#[must_use]
pub fn predicted_percentage_dissatisfied(pmv: f64) -> f64 {
    100.0 - 95.0 * (-0.033_53 * pmv.powi(4) - 0.2179 * pmv.powi(2)).exp()
}

impl PmvModel {
    /// People in clothing of `clothing_clo` with `metabolic_met`, without external work, in air of `relative_humidity`
    /// (0 … 1) that moves at `air_velocity_m_s`.
    #[must_use]
    pub fn new(clothing_clo: f64, metabolic_met: f64, relative_humidity: f64, air_velocity_m_s: f64) -> Self {
        let insulation = M2_K_W_PER_CLO * clothing_clo;
        let metabolic_w_m2 = W_M2_PER_MET * metabolic_met;
        let area_factor = if insulation <= 0.078 { 1.0 + 1.29 * insulation } else { 1.05 + 0.645 * insulation };
        let m = metabolic_w_m2;
        let sweat = if m > W_M2_PER_MET { 0.42 * (m - W_M2_PER_MET) } else { 0.0 };
        Self {
            clothing_clo,
            metabolic_w_m2,
            relative_humidity,
            air_velocity_m_s,
            insulation,
            area_factor,
            forced_convection: 12.1 * air_velocity_m_s.sqrt(),
            sensitivity: 0.303 * (-0.036 * m).exp() + 0.028,
            humid_from_c: air_of_vapour_pressure_c(relative_humidity, MOST_VAPOUR_PA),
            fixed_loss_w_m2: 0.00305 * (5733.0 - 6.99 * m) + sweat + 1.7e-5 * m * 5867.0 + 0.0014 * m * 34.0,
        }
    }

    /// The vote at an air and a mean radiant temperature in °C, with its slopes by implicit differentiation.
    ///
    /// The clothing surface temperature solves the annex's heat balance by Newton's method, to rounding; the balance
    /// rises and is convex in it, so that a start above the root converges. Finite for every physical input.
    #[must_use]
    pub fn at(&self, air_c: f64, radiant_c: f64) -> PmvPoint {
        let m = self.metabolic_w_m2;
        let vapour_pa = water_vapour_pressure_pa(self.relative_humidity, air_c);
        let vapour_per_k = vapour_pa * 4030.183 / (air_c + 235.0).powi(2);

        let (air, radiant) = (air_c + 273.0, radiant_c + 273.0);
        let radiant3 = radiant * radiant * radiant;
        let resistance = self.insulation * self.area_factor;
        let radiative = 3.96e-8 * resistance;
        let skin = self.skin_k();

        // Surface temperature t of the clothing, in the annex's kelvin:
        // t + radiative (t⁴ − t_r⁴) + resistance · h_c(t) (t − t_a) = skin.
        let mut t = skin.max(air).max(radiant);
        let mut convection = (0.0, 0.0);
        let mut slope = 1.0;
        for _ in 0..50 {
            convection = self.convection(t - air);
            let t3 = t * t * t;
            let excess = t + radiative * (t3 * t - radiant3 * radiant) + resistance * convection.0 - skin;
            slope = 1.0 + 4.0 * radiative * t3 + resistance * convection.1;
            let step = excess / slope;
            t -= step;
            if step.abs() < 1e-11 * t {
                break;
            }
        }
        let t3 = t * t * t;
        let t_per_radiant = 4.0 * radiative * radiant3 / slope;
        let t_per_air = resistance * convection.1 / slope;

        let radiation = 3.96e-8 * self.area_factor;
        let loss_w_m2 = self.fixed_loss_w_m2 - (0.00305 + 1.7e-5 * m) * vapour_pa - 0.0014 * m * air_c
            + radiation * (t3 * t - radiant3 * radiant)
            + self.area_factor * convection.0;
        let per_surface = 4.0 * radiation * t3 + self.area_factor * convection.1;
        let loss_per_air = per_surface * t_per_air
            - (0.00305 + 1.7e-5 * m) * vapour_per_k
            - 0.0014 * m
            - self.area_factor * convection.1;
        let loss_per_radiant = per_surface * t_per_radiant - 4.0 * radiation * radiant3;
        PmvPoint {
            pmv: self.sensitivity * (m - loss_w_m2),
            per_air_k: -self.sensitivity * loss_per_air,
            per_radiant_k: -self.sensitivity * loss_per_radiant,
            surface_excess_k: t - air,
        }
    }

    /// The clothing's surface temperature and its dry loss in W/m² where its heat balance holds to first order about a surface
    /// and a mean radiant temperature, all in the annex's kelvin; `radiant` is how the latter follows the air.
    ///
    /// With the dry loss L(t) = f_cl (3.96e-8 (t⁴ − t_r⁴) + h_c(t) (t − t_a)) the balance is t + I_cl L = 35.7 °C − 0.028 M.
    #[inline(always)]
    pub(crate) fn clothing<R: Real>(
        &self,
        surface_k: R,
        air_k: R,
        radiant_k: R,
        radiant: Line<R>,
    ) -> (Line<R>, Line<R>) {
        let t = surface_k;
        let (t3, radiant3) = (t * t * t, radiant_k * radiant_k * radiant_k);
        let difference = t - air_k;
        let (coefficient, slope) = self.convection_coefficients(difference);
        let radiation = 4.0 * 3.96e-8 * self.area_factor;
        let (per_surface, per_radiant) = (t3 * radiation, radiant3 * radiation);
        let (convection, per_air) = (coefficient * self.area_factor * difference, slope * self.area_factor);
        // L = fixed + own t' − per_radiant t_r' − per_air t_a', with t' = skin − I_cl L.
        let skin_k = self.skin_k();
        let radiation_w_m2 = per_radiant.mul_add(radiant_k, -per_surface * t);
        let fixed = radiation_w_m2.mul_add(0.75, per_air.mul_add(-difference, convection));
        let own = per_surface + per_air;
        let inverse = R::splat(1.0) / own.mul_add(self.insulation, 1.0);
        let of_surroundings = per_radiant.mul_add(radiant.value, per_air * air_k);
        let dry = Line {
            value: (own.mul_add(skin_k, fixed) - of_surroundings) * inverse,
            per_air_k: -per_radiant.mul_add(radiant.per_air_k, per_air) * inverse,
        };
        let surface =
            Line { value: dry.value.mul_add(-self.insulation, skin_k), per_air_k: dry.per_air_k * -self.insulation };
        (surface, dry)
    }

    /// One Newton step of the clothing's surface: by how many K it moves, and the dry loss in W/m² after that.
    #[inline(always)]
    pub(crate) fn step_surface<R: Real>(&self, surface_k: R, air_k: R, radiant_k: R) -> (R, R) {
        let loss = self.dry_loss(surface_k, air_k, radiant_k);
        let inverse = R::splat(1.0) / loss.per_surface.mul_add(self.insulation, 1.0);
        let excess = loss.w_m2.mul_add(self.insulation, surface_k - self.skin_k());
        let shift = -excess * inverse;
        (shift, loss.per_surface.mul_add(shift, loss.w_m2))
    }

    #[inline(always)]
    fn dry_loss<R: Real>(&self, surface_k: R, air_k: R, radiant_k: R) -> DryLoss<R> {
        let t = surface_k;
        let (t3, radiant3) = (t * t * t, radiant_k * radiant_k * radiant_k);
        let (convection, convection_slope) = self.convection(t - air_k);
        let radiation = 3.96e-8 * self.area_factor;
        DryLoss {
            w_m2: t3.mul_add(t, -radiant3 * radiant_k).mul_add(radiation, convection * self.area_factor),
            per_surface: t3.mul_add(4.0 * radiation, convection_slope * self.area_factor),
        }
    }

    /// The mean radiant temperature at which the clothing's surface has a temperature, all in the annex's kelvin. `None`
    /// where no radiation does that, and for naked people, whose surface does not depend on it.
    pub(crate) fn radiant_of_surface_k(&self, surface_k: f64, air_k: f64) -> Option<f64> {
        let t = surface_k;
        let loss_w_m2 = (self.skin_k() - t) / self.insulation;
        let radiation = loss_w_m2 / self.area_factor - self.convection(t - air_k).0;
        let fourth = t * t * t * t - radiation / 3.96e-8;
        (fourth > 0.0 && fourth.is_finite()).then(|| fourth.sqrt().sqrt())
    }

    /// The vote of a dry loss in W/m², and its slope in 1/K, in air of `air_c`; `dry_slope` is the loss's own slope over
    /// the air temperature.
    #[inline(always)]
    pub(crate) fn vote<R: Real>(&self, dry_w_m2: R, dry_slope: R, air_c: R) -> (R, R) {
        let m = self.metabolic_w_m2;
        let inverse = R::splat(1.0) / (air_c + 235.0);
        let vapour_pa = inverse.mul_add(-4030.183, 16.6536).exp() * (self.relative_humidity * 1000.0);
        let vapour_slope = vapour_pa * 4030.183 * inverse * inverse;
        let per_pa = 0.00305 + 1.7e-5 * m;
        let moist_w_m2 = air_c.mul_add(-0.0014 * m, vapour_pa.mul_add(-per_pa, self.fixed_loss_w_m2));
        let moist_slope = vapour_slope.mul_add(-per_pa, -0.0014 * m);
        ((R::splat(m) - moist_w_m2 - dry_w_m2) * self.sensitivity, (moist_slope + dry_slope) * -self.sensitivity)
    }

    /// From which difference between clothing surface and air in K, up or down, natural convection exceeds the forced
    /// one: there the vote has a kink.
    #[must_use]
    pub fn natural_convection_from_k(&self) -> f64 {
        (self.forced_convection / NATURAL_CONVECTION).powi(4)
    }

    /// Whether the state lies in the standard's range of use: 0.8 … 4 met, 0 … 2 clo, air 10 … 30 °C, radiant
    /// 10 … 40 °C, air speed up to 1 m/s, vapour pressure up to 2700 Pa and a vote within −2 … 2.
    #[must_use]
    pub fn standard_range(&self, air_c: f64, radiant_c: f64, pmv: f64) -> StandardRange {
        let met = self.metabolic_w_m2 / W_M2_PER_MET;
        let inside = (0.8..=4.0).contains(&met)
            && (0.0..=2.0).contains(&self.clothing_clo)
            && (10.0..=30.0).contains(&air_c)
            && (10.0..=40.0).contains(&radiant_c)
            && (0.0..=1.0).contains(&self.air_velocity_m_s)
            && air_c <= self.humid_from_c
            && pmv.abs() <= 2.0 + 1e-9;
        if inside { StandardRange::Inside } else { StandardRange::Outside }
    }

    /// Mean skin temperature in the annex's kelvin: 35.7 °C − 0.028 M.
    #[inline]
    fn skin_k(&self) -> f64 {
        308.7 - 0.028 * self.metabolic_w_m2
    }

    /// Convective loss per clothed area `h_c · d` in W/m², and its slope over the difference `d` in K.
    #[inline(always)]
    fn convection<R: Real>(&self, difference: R) -> (R, R) {
        let (coefficient, slope) = self.convection_coefficients(difference);
        (coefficient * difference, slope)
    }

    /// `h_c` over a difference `d` in K, and the slope of `h_c · d`, in W/(m²K).
    #[inline(always)]
    fn convection_coefficients<R: Real>(&self, difference: R) -> (R, R) {
        let natural = difference.abs().sqrt().sqrt() * NATURAL_CONVECTION;
        let forced = R::splat(self.forced_convection);
        (natural.above(forced, natural, forced), natural.above(forced, natural * 1.25, forced))
    }
}
