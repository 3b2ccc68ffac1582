//! The mean vote of the passengers with first and second derivatives, exact or by the paper's surrogate.

use nalgebra::{U1, U2};
use num_dual::{Derivative, Dual2SVec64, DualNum};

use super::iso7730::Iso7730;
use super::surrogate::{Network, Surrogate};
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
    Surrogate(Box<Network>),
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
