//! Sobol' indices: which share of the variance of a result each input explains, alone and with all others.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

use crate::Saltelli;

/// The indices of an input, each with the ends of an interval of 90 %.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Index {
    /// Of first order: the share of the variance that goes where the input is known.
    pub first: f64,
    /// Its interval.
    pub first_ends: [f64; 2],
    /// Total: the share that stays where all but the input are known.
    pub total: f64,
    /// Its interval.
    pub total_ends: [f64; 2],
}

/// Drawn years of which an interval is made.
pub const RESAMPLES: usize = 400;

/// Base points drawn anew, of which intervals are made.
#[derive(Debug, Clone)]
pub struct Resamples(Vec<Vec<u32>>);

impl Resamples {
    /// So many draws of as many base points as there are, with replacement.
    #[must_use]
    pub fn new(points: u32, count: usize, seed: u64) -> Self {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        // The high half of the product is even enough for 65,536 points.
        let mut draw = || ((u64::from(random.next_u32()) * u64::from(points)) >> 32) as u32;
        Self((0..count).map(|_| (0..points).map(|_| draw()).collect()).collect())
    }
}

/// The indices of every input for one result, from its value in every set of the design; `None` where it does not vary.
///
/// Values are centred and scaled first. First order after Saltelli et al. 2010 (Table 2 b), total after Jansen 1999 (Table 2 f),
/// DOI 10.1016/j.cpc.2009.09.018, divided by the variance over A and B.
#[must_use]
pub fn indices(design: &Saltelli, values: &[f64], resamples: &Resamples) -> Option<Vec<Index>> {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let sd = (values.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / count).sqrt();
    if !(sd.is_finite() && sd > 1e-12 * mean.abs()) {
        return None;
    }
    let scaled: Vec<f64> = values.iter().map(|v| (v - mean) / sd).collect();
    let all: Vec<u32> = (0..design.points).collect();
    let rows = Rows { values: &scaled, width: design.sets_a_point() };
    let estimates = rows.estimates(&all);
    let drawn: Vec<Vec<[f64; 2]>> = resamples.0.iter().map(|points| rows.estimates(points)).collect();
    let ends = |input: usize, order: usize| {
        let mut of: Vec<f64> = drawn.iter().map(|estimates| estimates[input][order]).collect();
        of.sort_by(f64::total_cmp);
        match of.len() {
            0 => [estimates[input][order]; 2],
            n => [of[(n - 1) * 5 / 100], of[(n - 1) - (n - 1) * 5 / 100]],
        }
    };
    let index = |(input, [first, total]): (usize, &[f64; 2])| Index {
        first: *first,
        first_ends: ends(input, 0),
        total: *total,
        total_ends: ends(input, 1),
    };
    Some(estimates.iter().enumerate().map(index).collect())
}

/// The values of all sets, a row of them for each base point.
struct Rows<'v> {
    values: &'v [f64],
    width: usize,
}

impl Rows<'_> {
    /// First order and total of every input over some base points.
    fn estimates(&self, points: &[u32]) -> Vec<[f64; 2]> {
        let inputs = self.width - 2;
        let (mut sum, mut squares) = (0.0, 0.0);
        let mut sums = vec![[0.0; 2]; inputs];
        for point in points {
            let row = &self.values[*point as usize * self.width..][..self.width];
            let (a, b) = (row[0], row[self.width - 1]);
            sum += a + b;
            squares += a * a + b * b;
            for (sums, ab) in sums.iter_mut().zip(&row[1..]) {
                sums[0] += b * (ab - a);
                sums[1] += (a - ab) * (a - ab);
            }
        }
        let n = points.len() as f64;
        let mean = sum / (2.0 * n);
        let variance = squares / (2.0 * n) - mean * mean;
        sums.iter().map(|[first, total]| [first / n / variance, total / (2.0 * n) / variance]).collect()
    }
}
