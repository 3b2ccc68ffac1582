//! Least squares on one side of points: a quadratic program with as many variables as a curve has coefficients.

use clarabel::algebra::CscMatrix;
use clarabel::solver::SupportedConeT::NonnegativeConeT;
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, SolverStatus};

/// A point of a fit.
#[derive(Debug, Clone)]
pub(crate) struct Row {
    /// The curve is this · coefficients.
    pub basis: Vec<f64>,
    pub value: f64,
    pub weight: f64,
}

impl Row {
    /// How far the point lies above a curve.
    pub fn beyond(&self, coefficients: &[f64]) -> f64 {
        self.value - self.basis.iter().zip(coefficients).map(|(x, c)| x * c).sum::<f64>()
    }
}

/// The coefficients c with the least Σ weight (basis · c − value)² over some rows; under basis · c ≥ value where the curve is to
/// lie `above` them, and under row · c ≥ 0 for those in `rising`. `None` where there are none.
pub(crate) fn least_squares(rows: &[&Row], above: bool, rising: &[Vec<f64>]) -> Option<Vec<f64>> {
    let size = rows.first()?.basis.len();
    let total: f64 = rows.iter().map(|row| row.weight).sum();
    let mut quadratic = vec![vec![0.0; size]; size];
    let mut linear = vec![0.0; size];
    for Row { basis, value, weight } in rows {
        for i in 0..size {
            linear[i] -= 2.0 * weight / total * basis[i] * value;
            for j in 0..size {
                quadratic[i][j] += 2.0 * weight / total * basis[i] * basis[j];
            }
        }
    }
    let limits = || {
        let above = rows.iter().filter(|_| above).map(|row| (&row.basis, row.value));
        above.chain(rising.iter().map(|row| (row, 0.0)))
    };
    // a c + s = b with s ≥ 0.
    let a: Vec<Vec<f64>> = limits().map(|(row, _)| row.iter().map(|x| -x).collect()).collect();
    let b: Vec<f64> = limits().map(|(_, value)| -value).collect();
    let a = if a.is_empty() { CscMatrix::zeros((0, size)) } else { CscMatrix::from(&a) };
    let upper: Vec<Vec<f64>> = quadratic
        .iter()
        .enumerate()
        .map(|(i, row)| row.iter().enumerate().map(|(j, x)| if j >= i { *x } else { 0.0 }).collect())
        .collect();
    let settings = DefaultSettings {
        verbose: false,
        max_threads: 1,
        tol_gap_abs: 1e-11,
        tol_gap_rel: 1e-11,
        tol_feas: 1e-11,
        ..DefaultSettings::default()
    };
    let cones = [NonnegativeConeT(b.len())];
    let mut solver = DefaultSolver::new(&CscMatrix::from(&upper), &linear, &a, &b, &cones, settings).ok()?;
    solver.solve();
    let solution = &solver.solution;
    matches!(solution.status, SolverStatus::Solved | SolverStatus::AlmostSolved).then(|| solution.x.clone())
}
