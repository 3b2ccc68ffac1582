//! Sequential quadratic programming with a trust region on the cabin temperature and an exact penalty.
//!
//! The window is elastic in the subproblem, and the balances can follow any cabin temperature, so every subproblem has a
//! solution. A trial point is taken where an l1 merit function falls as the subproblem foresees; if it does not, a
//! second-order correction is tried before the trust region shrinks (Nocedal and Wright, Numerical Optimization, 2006,
//! sections 18.4 to 18.6).

use nalgebra::{SMatrix, SymmetricEigen};

use super::problem::{BALANCES, N, Problem, Values, Variable};
use super::quadratic::{Multipliers, Numbers, Quadratic, Step};

/// Largest scaled KKT residual of a solved program.
pub const KKT_TOLERANCE: f64 = 1e-8;

const MOST_STEPS: u32 = 100;
const FIRST_RADIUS_K: f64 = 60.0;
/// Cost of missing the window in kW per vote; raised where it does not suffice.
const FIRST_PENALTY: f64 = 100.0;
const LARGEST_PENALTY: f64 = 1e6;
/// Least curvature of the convexified Hessian.
const LEAST_CURVATURE: f64 = 1e-9;
/// Cabin temperatures within which a solution is looked for, in K: −60 … 60 °C.
const COLDEST_K: f64 = 213.15;
const HOTTEST_K: f64 = 333.15;

/// How a program ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ended {
    /// A KKT point was found.
    Solved,
    /// No cabin temperature meets the window; the point found misses it least.
    Infeasible,
    /// The steps ran out.
    NotConverged,
}

/// The end of a program.
#[derive(Debug, Clone, Copy)]
pub(crate) struct End {
    pub x: [f64; N],
    pub multipliers: Multipliers,
    pub ended: Ended,
    /// Largest scaled KKT residual.
    pub residual: f64,
    /// Quadratic subproblems that were solved.
    pub subproblems: u32,
    pub power_kw: f64,
    pub vote: f64,
}

/// A start that knows nothing: everything at 295 K, no heat.
pub(crate) fn cold_start(problem: &Problem<'_>) -> [f64; N] {
    let mut x = [295.0, 295.0, 295.0, problem.model.ambient_k, 295.0, 0.0, 0.0, 0.0];
    let (fixed, value) = problem.vanishing();
    x[fixed] = value;
    x
}

/// Solves a program from a start, with first multipliers where a neighbour gives them.
pub(crate) fn solve(
    problem: &Problem<'_>,
    quadratic: &mut Quadratic,
    mut x: [f64; N],
    mut multipliers: Multipliers,
) -> End {
    let (mut radius_k, mut penalty) = (FIRST_RADIUS_K, FIRST_PENALTY);
    let mut weight = 1.0;
    let mut subproblems = 0;
    let mut values = problem.values(&x);
    let mut residual = f64::INFINITY;
    let mut ended = Ended::NotConverged;
    while subproblems < MOST_STEPS {
        let numbers = numbers(problem, &x, &values, &multipliers, radius_k, penalty);
        subproblems += 1;
        let Some(step) = quadratic.solve(&numbers) else { break };
        weight = step.multipliers.balances.iter().fold(weight, |w: f64, m| w.max(1.5 * m.abs()));
        let merit = |x: &[f64; N], v: &Values| {
            v.power_kw + weight * off_balance(problem, x, v) + penalty * outside(problem, v.vote)
        };
        let before = merit(&x, &values);
        let foreseen = before - model(&values, &numbers, &step, penalty);
        let mut trial = add(&x, &step.d);
        let mut trial_values = problem.values(&trial);
        let gain = before - merit(&trial, &trial_values);
        // Below rounding of the merit function a gain says nothing, and the step is as good as the last one.
        let negligible = foreseen.abs() <= 1e-11 * before.abs().max(1.0);
        let mut taken = negligible || gain >= 1e-4 * foreseen;
        let mut multipliers_now = step.multipliers;
        if !taken {
            subproblems += 1;
            if let Some(corrected) = quadratic.solve(&correction(problem, &numbers, &trial_values, &step.d)) {
                let second = add(&x, &corrected.d);
                let second_values = problem.values(&second);
                if before - merit(&second, &second_values) >= 1e-4 * foreseen {
                    (trial, trial_values, taken) = (second, second_values, true);
                    multipliers_now = corrected.multipliers;
                }
            }
        }
        let length_k = step.d[Variable::Cabin as usize].abs();
        if !taken {
            radius_k = 0.25 * length_k.min(radius_k);
            if radius_k < 1e-10 {
                break;
            }
            continue;
        }
        if gain >= 0.75 * foreseen && length_k > 0.8 * radius_k {
            radius_k *= 2.0;
        } else if gain < 0.25 * foreseen && !negligible {
            radius_k = (0.5 * length_k).max(1e-6);
        }
        (x, values, multipliers) = (trial, trial_values, multipliers_now);
        residual = kkt(problem, &x, &values, &multipliers);
        if residual <= KKT_TOLERANCE {
            ended = Ended::Solved;
            break;
        }
        // A step that stays outside the window although it could go on: the penalty is too small, or there is no way in.
        if outside(problem, values.vote) > KKT_TOLERANCE && length_k < 1e-7 * radius_k.max(1.0) {
            if penalty >= LARGEST_PENALTY {
                ended = Ended::Infeasible;
                break;
            }
            penalty *= 100.0;
        }
    }
    let at_end = [COLDEST_K, HOTTEST_K].iter().any(|end| (x[Variable::Cabin as usize] - end).abs() < 1e-6);
    if ended == Ended::NotConverged && at_end && outside(problem, values.vote) > KKT_TOLERANCE {
        ended = Ended::Infeasible;
    }
    End { x, multipliers, ended, residual, subproblems, power_kw: values.power_kw, vote: values.vote }
}

fn numbers(
    problem: &Problem<'_>,
    x: &[f64; N],
    v: &Values,
    multipliers: &Multipliers,
    radius_k: f64,
    penalty: f64,
) -> Numbers {
    let of_vote = multipliers.vote_upper - multipliers.vote_lower;
    let (fixed, value) = problem.vanishing();
    let cabin_k = x[Variable::Cabin as usize];
    Numbers {
        hessian: convex(&problem.hessian(x, v, &multipliers.balances, of_vote)),
        gradient: v.power_gradient,
        penalty,
        balance_rows: v.balance_rows,
        balances: v.balances_kw.map(|kw| -kw),
        vanishing: (fixed, value - x[fixed]),
        heat_room: x[Variable::Heat as usize],
        cool_room: -x[Variable::Cool as usize],
        vote_gradient: v.vote_gradient,
        vote_rise: problem.window.pmv_max() - v.vote,
        vote_fall: v.vote - problem.window.pmv_min(),
        cabin_rise: radius_k.min(HOTTEST_K - cabin_k),
        cabin_fall: radius_k.min(cabin_k - COLDEST_K),
    }
}

/// The second-order correction: the same subproblem with the curvature that the trial point has shown.
fn correction(problem: &Problem<'_>, numbers: &Numbers, v: &Values, d: &[f64; N]) -> Numbers {
    let along = |row: &[f64; N]| row.iter().zip(d).map(|(a, d)| a * d).sum::<f64>();
    let vote_along = along(&numbers.vote_gradient);
    Numbers {
        balances: std::array::from_fn(|i| along(&numbers.balance_rows[i]) - v.balances_kw[i]),
        vote_rise: problem.window.pmv_max() - v.vote + vote_along,
        vote_fall: v.vote - problem.window.pmv_min() - vote_along,
        ..*numbers
    }
}

/// What the subproblem foresees for the merit function.
fn model(v: &Values, numbers: &Numbers, step: &Step, penalty: f64) -> f64 {
    let mut power_kw = v.power_kw;
    for i in 0..N {
        let curvature: f64 = (0..N).map(|j| numbers.hessian[i][j] * step.d[j]).sum();
        power_kw += step.d[i] * (v.power_gradient[i] + 0.5 * curvature);
    }
    power_kw + penalty * step.elastic.max(0.0)
}

fn off_balance(problem: &Problem<'_>, x: &[f64; N], v: &Values) -> f64 {
    let (fixed, value) = problem.vanishing();
    v.balances_kw.iter().map(|kw| kw.abs()).sum::<f64>() + (x[fixed] - value).abs()
}

fn outside(problem: &Problem<'_>, vote: f64) -> f64 {
    (vote - problem.window.pmv_max()).max(problem.window.pmv_min() - vote).max(0.0)
}

/// Largest residual of the Karush-Kuhn-Tucker conditions, scaled as in Ipopt (Wächter and Biegler 2006, eq. 5).
fn kkt(problem: &Problem<'_>, x: &[f64; N], v: &Values, m: &Multipliers) -> f64 {
    let (fixed, value) = problem.vanishing();
    let mut gradient = v.power_gradient;
    for (row, multiplier) in v.balance_rows.iter().zip(&m.balances) {
        for (g, a) in gradient.iter_mut().zip(row) {
            *g += multiplier * a;
        }
    }
    for (g, a) in gradient.iter_mut().zip(&v.vote_gradient) {
        *g += (m.vote_upper - m.vote_lower) * a;
    }
    gradient[fixed] += m.vanishing;
    gradient[Variable::Heat as usize] -= m.heat_sign;
    gradient[Variable::Cool as usize] += m.cool_sign;

    let inequalities = [m.heat_sign, m.cool_sign, m.vote_upper, m.vote_lower];
    let sum = m.balances.iter().chain(&inequalities).map(|z| z.abs()).sum::<f64>() + m.vanishing.abs();
    let scale = (sum / (BALANCES as f64 + 5.0)).max(100.0) / 100.0;
    let room = [
        x[Variable::Heat as usize],
        -x[Variable::Cool as usize],
        problem.window.pmv_max() - v.vote,
        v.vote - problem.window.pmv_min(),
    ];
    let stationarity = gradient.iter().map(|g| g.abs());
    let complementarity = inequalities.iter().zip(&room).map(|(z, s)| (z * s).abs());
    let signs = room.iter().map(|s| (-s).max(0.0));
    let balances = v.balances_kw.iter().map(|kw| kw.abs()).chain([(x[fixed] - value).abs()]);
    stationarity.chain(complementarity).map(|r| r / scale).chain(signs).chain(balances).fold(0.0, f64::max)
}

/// The nearest matrix without negative curvature.
fn convex(hessian: &[[f64; N]; N]) -> [[f64; N]; N] {
    let eigen = SymmetricEigen::new(SMatrix::<f64, N, N>::from_fn(|i, j| hessian[i][j]));
    let clipped = eigen.eigenvalues.map(|value| value.max(LEAST_CURVATURE));
    let matrix = eigen.eigenvectors * SMatrix::<f64, N, N>::from_diagonal(&clipped) * eigen.eigenvectors.transpose();
    std::array::from_fn(|i| std::array::from_fn(|j| 0.5 * (matrix[(i, j)] + matrix[(j, i)])))
}

fn add(x: &[f64; N], d: &[f64; N]) -> [f64; N] {
    std::array::from_fn(|i| x[i] + d[i])
}
