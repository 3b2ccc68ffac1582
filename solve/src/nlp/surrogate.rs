//! The paper's surrogate of the vote (eq. `pmv-approx`): one hidden layer of five tanh neurons over cabin and mean radiant
//! temperature, fitted for a clothing value by Levenberg and Marquardt's method.

use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt};
use nalgebra_0_34::storage::Owned;
use nalgebra_0_34::{Const, Dyn, OMatrix, OVector};
use num_dual::DualNum;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

use super::iso7730::Iso7730;
use cabin::{Vehicle, kelvin, unit_interval};

/// Changes whenever fits would come out differently.
pub const SURROGATE_VERSION: u32 = 1;

/// Range of both temperatures that a fit covers, in °C.
pub const FIT_RANGE_C: (f64, f64) = (0.0, 45.0);

const NEURONS: usize = 5;
const PARAMETERS: usize = 4 * NEURONS + 1;
const GRID_STEP_K: f64 = 2.5;
const SEED: u64 = 1;
/// Starts of a fit; the best one is kept.
const STARTS: u32 = 4;
/// Evaluations of a fit, per parameter: what more of them gain is far below the error that five neurons leave.
const PATIENCE: usize = 10;
/// Clothing values that are fitted, in clo; between them the two neighbouring networks are blended.
const CLOTHING_STEP_CLO: f64 = 0.05;
const MOST_CLOTHING_CLO: f64 = 2.5;

/// One fit: weights over air and radiant temperature, bias and output weight of each neuron, then the output bias.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fit {
    /// Clothing in clo.
    pub clothing_clo: f64,
    /// The parameters.
    pub parameters: [f64; PARAMETERS],
    /// Mean absolute error over the grid of the fit, in votes.
    pub mean_absolute_error: f64,
}

/// Fits for all clothing values of a vehicle's passengers, in rising order.
#[derive(Debug, Clone, PartialEq)]
pub struct Surrogate {
    fits: Vec<Fit>,
}

/// The surrogate at one clothing: two fits and the share of the second.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Network {
    fits: [[f64; PARAMETERS]; 2],
    share: f64,
}

impl Surrogate {
    /// Fits every clothing value from the vehicle's floor upwards: some seconds of work, the same result every time.
    #[must_use]
    pub fn fit(vehicle: &Vehicle) -> Self {
        let count = ((MOST_CLOTHING_CLO - vehicle.clothing_floor_clo) / CLOTHING_STEP_CLO).ceil().max(1.0) as u32;
        let mut fits: Vec<Fit> = Vec::new();
        for i in 0..=count {
            let clothing_clo = vehicle.clothing_floor_clo + f64::from(i) * CLOTHING_STEP_CLO;
            fits.push(fit(vehicle, clothing_clo, fits.last().map(|f| &f.parameters)));
        }
        Self { fits }
    }

    /// The surrogate for a vehicle: the stored fits where its passengers are those of the paper, else fitted now.
    #[must_use]
    pub fn of(vehicle: &Vehicle) -> Self {
        let comfort = |v: &Vehicle| {
            [v.clothing_floor_clo, v.metabolic_rate_met, v.relative_humidity, v.air_velocity_m_s].map(f64::to_bits)
        };
        if comfort(vehicle) == comfort(&Vehicle::default()) { Self::stored() } else { Self::fit(vehicle) }
    }

    /// The fits for the paper's passengers, of version [`SURROGATE_VERSION`]: what [`Surrogate::fit`] gives for them.
    #[must_use]
    pub fn stored() -> Self {
        let number = |text: &str| text.parse::<f64>().expect("the stored fits are numbers, as a test checks");
        let fits = include_str!("surrogate.csv").lines().skip(1).map(|line| {
            let mut numbers = line.split(',').map(number);
            let mut next = || numbers.next().expect("every stored fit is complete, as a test checks");
            Fit { clothing_clo: next(), mean_absolute_error: next(), parameters: std::array::from_fn(|_| next()) }
        });
        Self { fits: fits.collect() }
    }

    /// The fits as comma-separated values, as they are stored.
    #[must_use]
    pub fn to_csv(&self) -> String {
        let mut text = "clothing_clo,mean_absolute_error".to_owned();
        for n in 1..=NEURONS {
            text += &format!(",air_{n},radiant_{n},bias_{n},output_{n}");
        }
        text += ",output_bias\n";
        for fit in &self.fits {
            let parameters: Vec<String> = fit.parameters.iter().map(f64::to_string).collect();
            text += &format!("{},{},{}\n", fit.clothing_clo, fit.mean_absolute_error, parameters.join(","));
        }
        text
    }

    /// The fits.
    #[must_use]
    pub fn fits(&self) -> &[Fit] {
        &self.fits
    }

    /// The surrogate's vote at cabin and mean radiant temperature in °C and a clothing in clo.
    #[must_use]
    pub fn vote(&self, clothing_clo: f64, air_c: f64, radiant_c: f64) -> f64 {
        self.network(clothing_clo).vote(air_c, radiant_c)
    }

    pub(crate) fn network(&self, clothing_clo: f64) -> Network {
        let place = (clothing_clo - self.fits[0].clothing_clo) / CLOTHING_STEP_CLO;
        let first = (place.max(0.0) as usize).min(self.fits.len() - 2);
        Network {
            fits: [self.fits[first].parameters, self.fits[first + 1].parameters],
            share: (place - first as f64).clamp(0.0, 1.0),
        }
    }
}

impl Network {
    pub fn vote<D: DualNum<Primitive = f64> + Copy>(&self, air_c: D, radiant_c: D) -> D {
        let [a, b] = self.fits.map(|parameters| evaluate(&parameters, air_c, radiant_c));
        a * (1.0 - self.share) + b * self.share
    }
}

fn evaluate<D: DualNum<Primitive = f64> + Copy>(p: &[f64; PARAMETERS], air_c: D, radiant_c: D) -> D {
    let (a, r) = (scaled(air_c), scaled(radiant_c));
    let mut vote = D::from(p[PARAMETERS - 1]);
    for n in p[..PARAMETERS - 1].chunks_exact(4) {
        vote += (a * n[0] + r * n[1] + n[2]).tanh() * n[3];
    }
    vote
}

/// Temperatures of the range become −1 … 1.
fn scaled<D: DualNum<Primitive = f64> + Copy>(celsius: D) -> D {
    let (low, high) = FIT_RANGE_C;
    (celsius - 0.5 * (low + high)) * (2.0 / (high - low))
}

/// A grid of exact votes, and the parameters that are being fitted.
struct Residuals<'a> {
    points: &'a [(f64, f64, f64)],
    p: OVector<f64, Const<PARAMETERS>>,
}

impl LeastSquaresProblem<f64, Dyn, Const<PARAMETERS>> for Residuals<'_> {
    type ResidualStorage = Owned<f64, Dyn>;
    type JacobianStorage = Owned<f64, Dyn, Const<PARAMETERS>>;
    type ParameterStorage = Owned<f64, Const<PARAMETERS>>;

    fn set_params(&mut self, p: &OVector<f64, Const<PARAMETERS>>) {
        self.p = *p;
    }

    fn params(&self) -> OVector<f64, Const<PARAMETERS>> {
        self.p
    }

    fn residuals(&self) -> Option<OVector<f64, Dyn>> {
        let parameters: [f64; PARAMETERS] = self.p.into();
        let off = self.points.iter().map(|&(air_c, radiant_c, vote)| evaluate(&parameters, air_c, radiant_c) - vote);
        Some(OVector::<f64, Dyn>::from_iterator(self.points.len(), off))
    }

    fn jacobian(&self) -> Option<OMatrix<f64, Dyn, Const<PARAMETERS>>> {
        let mut jacobian = OMatrix::<f64, Dyn, Const<PARAMETERS>>::zeros(self.points.len());
        for (i, &(air_c, radiant_c, _)) in self.points.iter().enumerate() {
            let (a, r) = (scaled(air_c), scaled(radiant_c));
            for n in 0..NEURONS {
                let k = 4 * n;
                let out = (self.p[k] * a + self.p[k + 1] * r + self.p[k + 2]).tanh();
                let slope = self.p[k + 3] * (1.0 - out * out);
                jacobian[(i, k)] = slope * a;
                jacobian[(i, k + 1)] = slope * r;
                jacobian[(i, k + 2)] = slope;
                jacobian[(i, k + 3)] = out;
            }
            jacobian[(i, PARAMETERS - 1)] = 1.0;
        }
        Some(jacobian)
    }
}

/// Fits one clothing value, from random starts and from the fit of a neighbouring clothing.
fn fit(vehicle: &Vehicle, clothing_clo: f64, neighbour: Option<&[f64; PARAMETERS]>) -> Fit {
    let iso = Iso7730::new(vehicle, clothing_clo);
    let (low, high) = FIT_RANGE_C;
    let steps = ((high - low) / GRID_STEP_K).round() as u32;
    let axis = |i: u32| low + f64::from(i) * GRID_STEP_K;
    let grid = (0..=steps).flat_map(|i| (0..=steps).map(move |j| (axis(i), axis(j))));
    let points: Vec<(f64, f64, f64)> =
        grid.map(|(air_c, radiant_c)| (air_c, radiant_c, iso.vote(kelvin(air_c), kelvin(radiant_c)))).collect();

    let mut random = ChaCha8Rng::seed_from_u64(SEED);
    let mut uniform = || 2.0 * unit_interval(random.next_u64()) - 1.0;
    let random_starts = (0..STARTS).map(|_| std::array::from_fn(|_| uniform()));
    let starts: Vec<[f64; PARAMETERS]> = match neighbour {
        Some(parameters) => vec![*parameters],
        None => random_starts.collect(),
    };
    let mut best: Option<Fit> = None;
    for start in starts {
        let problem = Residuals { points: &points, p: start.into() };
        let (problem, _) = LevenbergMarquardt::new().with_patience(PATIENCE).minimize(problem);
        let parameters: [f64; PARAMETERS] = problem.p.into();
        let error = points.iter().map(|&(a, r, vote)| (evaluate(&parameters, a, r) - vote).abs()).sum::<f64>();
        let mean_absolute_error = error / points.len() as f64;
        if best.is_none_or(|b| mean_absolute_error < b.mean_absolute_error) {
            best = Some(Fit { clothing_clo, parameters, mean_absolute_error });
        }
    }
    best.expect("there is at least one start")
}
