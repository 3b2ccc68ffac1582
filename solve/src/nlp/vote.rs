//! The mean vote of the passengers with first and second derivatives, exact or by the paper's surrogate.

use nalgebra::{U1, U2};
use num_dual::{Derivative, Dual2SVec64, DualNum};

use super::surrogate::Surrogate;
use cabin::{PassengerViews, Vehicle, ZERO_CELSIUS_K, clothing_insulation_clo};

/// How the vote of a passenger is computed inside the program.
#[derive(Debug, Clone)]
pub enum VoteForm {
    /// ISO 7730 Annex D, the clothing temperature as an implicit function.
    Exact,
    /// The paper's network of five neurons (eq. `pmv-approx`).
    Surrogate(Surrogate),
}

/// A second-order number in air temperature and mean radiant temperature.
type Jet = Dual2SVec64<2>;

/// The vote of one passenger over air and mean radiant temperature in K, under one clothing.
#[derive(Debug, Clone)]
pub(crate) enum Vote {
    Exact(Iso7730),
    Surrogate(Box<super::surrogate::Network>),
}

impl Vote {
    pub fn new(form: &VoteForm, vehicle: &Vehicle, ambient_k: f64) -> Self {
        let clothing_clo = clothing_insulation_clo(ambient_k, vehicle.clothing_floor_clo);
        match form {
            VoteForm::Exact => Self::Exact(Iso7730::new(vehicle, clothing_clo)),
            VoteForm::Surrogate(surrogate) => Self::Surrogate(Box::new(surrogate.network(clothing_clo))),
        }
    }

    fn at<D: DualNum<Primitive = f64> + Copy>(&self, air_k: D, radiant_k: D) -> D {
        match self {
            Self::Exact(iso) => iso.vote(air_k, radiant_k),
            Self::Surrogate(network) => network.vote(air_k - ZERO_CELSIUS_K, radiant_k - ZERO_CELSIUS_K),
        }
    }
}

/// ISO 7730:2005, Annex D, for one clothing and the vehicle's activity, air speed and humidity.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Iso7730 {
    metabolic_w_m2: f64,
    relative_humidity: f64,
    insulation_m2k_w: f64,
    area_factor: f64,
    forced: f64,
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

    /// Surface temperature of the clothing: the root by fixed-point-free bisection and Newton's method in plain numbers,
    /// then two Newton steps in `D`, of which each makes one more order of derivatives exact.
    fn clothing_k<D: DualNum<Primitive = f64> + Copy>(&self, air: D, radiant: D) -> D {
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

/// The mean vote with its derivatives over cabin air `c`, and over the two parts of `T_mr⁴ = base + view · heater`.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct MeanVote {
    pub vote: f64,
    /// Over c, base, heater.
    pub gradient: [f64; 3],
    /// Symmetric, over the same.
    pub hessian: [[f64; 3]; 3],
}

impl MeanVote {
    /// Second derivatives over base and heater part.
    pub fn radiant_hessian(&self) -> [[f64; 2]; 2] {
        let h = &self.hessian;
        [[h[1][1], h[1][2]], [h[2][1], h[2][2]]]
    }

    /// The mean over the passengers. Two nodes of a quadrature serve unless the vote's kink between forced and natural
    /// convection lies between the passengers; then all of them are counted.
    pub fn new(vote: &Vote, views: &PassengerViews, cabin_k: f64, base_k4: f64, heater_k4: f64) -> Self {
        let mut mean = Self::default();
        if vote.kink_between(views.all(), cabin_k, base_k4, heater_k4) {
            let weight = 1.0 / views.all().len() as f64;
            for &view in views.all() {
                mean.add(vote, weight, view, cabin_k, base_k4, heater_k4);
            }
        } else {
            for (view, weight) in views.nodes() {
                mean.add(vote, weight, view, cabin_k, base_k4, heater_k4);
            }
        }
        mean
    }

    fn add(&mut self, vote: &Vote, weight: f64, view: f64, cabin_k: f64, base_k4: f64, heater_k4: f64) {
        let fourth_power = base_k4 + view * heater_k4;
        let radiant_k = fourth_power.sqrt().sqrt();
        let jet =
            vote.at(Jet::new(cabin_k, unit(0), Derivative::none()), Jet::new(radiant_k, unit(1), Derivative::none()));
        let gradient = jet.v1.unwrap_generic(U1, U2);
        let hessian = jet.v2.unwrap_generic(U2, U2);
        // T_mr over its fourth power: first and second derivative.
        let first = radiant_k / (4.0 * fourth_power);
        let second = -0.75 * first / fourth_power;
        let (per_cabin, per_power) = (gradient[0], gradient[1] * first);
        let (cabin2, mixed) = (hessian[(0, 0)], hessian[(0, 1)] * first);
        let power2 = hessian[(1, 1)] * first * first + gradient[1] * second;
        let parts = [1.0, view];
        self.vote += weight * jet.re;
        self.gradient[0] += weight * per_cabin;
        self.hessian[0][0] += weight * cabin2;
        for i in 0..2 {
            self.gradient[i + 1] += weight * per_power * parts[i];
            self.hessian[0][i + 1] += weight * mixed * parts[i];
            self.hessian[i + 1][0] += weight * mixed * parts[i];
            for j in 0..2 {
                self.hessian[i + 1][j + 1] += weight * power2 * parts[i] * parts[j];
            }
        }
    }
}

impl Vote {
    /// Whether natural convection starts between the passenger who sees least and the one who sees most of the heaters.
    fn kink_between(&self, views: &[f64], cabin_k: f64, base_k4: f64, heater_k4: f64) -> bool {
        let Self::Exact(iso) = self else { return false };
        let kink_k = (iso.forced / 2.38).powi(4);
        let excess = |view: f64| {
            let radiant = (base_k4 + view * heater_k4).sqrt().sqrt() - 0.15;
            iso.clothing_k(cabin_k - 0.15, radiant) - (cabin_k - 0.15)
        };
        let least = views.iter().copied().fold(f64::INFINITY, f64::min);
        let most = views.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let (a, b) = (excess(least), excess(most));
        let (low, high) = (a.min(b), a.max(b));
        let spare = 0.1 * (high - low);
        [kink_k, -kink_k].iter().any(|&k| low - spare < k && k < high + spare)
    }
}

fn unit(index: usize) -> Derivative<f64, U1, U2> {
    Derivative::derivative_generic(U1, U2, index)
}
