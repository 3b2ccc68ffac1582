//! Setpoints that are fitted to the edge of a cloud.

use crate::fit::{Row, least_squares};
use crate::{Curve, Shape};

/// An optimum in one operating mode.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// Ambient temperature in °C.
    pub ambient_c: f64,
    /// Cabin temperature in °C.
    pub cabin_c: f64,
    /// Share in the year, above 0.
    pub weight: f64,
}

/// The side of a cloud along which a profile runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Edge {
    /// Warmer than the points: heating.
    Upper,
    /// Colder: cooling.
    Lower,
}

/// A curve along an edge of the points that it was fitted to.
#[derive(Debug, Clone, PartialEq)]
pub struct Profile {
    /// The setpoint; its range is that of the points.
    pub curve: Curve,
    /// Weighted share of the points on its side of comfort: at least what was asked for.
    pub coverage: f64,
    /// How many points it was fitted to.
    pub points: usize,
}

/// Why there is no profile.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FitError {
    /// Fewer points than a curve has coefficients, or all at one temperature.
    #[error("{0} hours in this mode are too few for a profile")]
    TooFew(usize),
    /// The coverage is no share.
    #[error("a coverage of {0} is not between 0.5 and 1")]
    Coverage(f64),
    /// The quadratic program ends without a solution.
    #[error("the fit does not settle")]
    NotSettled,
}

/// Knots of a piecewise linear profile.
const KNOTS: usize = 4;
/// A point so close to a profile lies on it, in K.
const ON_IT_K: f64 = 1e-6;

/// Fits a profile that covers at least the given share of the points' weight: along the upper edge a quadratic that does not
/// fall where points are (the colder it is, the warmer people dress, and the less warm a cabin satisfies them), along the
/// lower edge a piecewise linear curve with knots at equal distances.
///
/// What may stay uncovered are the points that lie farthest beyond a plain fit of all. Of the curves that cover the others,
/// it is the one with the least weighted squares.
///
/// # Errors
/// [`FitError`].
pub fn fit(points: &[Point], edge: Edge, coverage: f64) -> Result<Profile, FitError> {
    if !(0.5..=1.0).contains(&coverage) {
        return Err(FitError::Coverage(coverage));
    }
    let least = points.iter().map(|p| p.ambient_c).fold(f64::INFINITY, f64::min);
    let largest = points.iter().map(|p| p.ambient_c).fold(f64::NEG_INFINITY, f64::max);
    if points.len() < 2 * KNOTS || largest - least < 1e-3 {
        return Err(FitError::TooFew(points.len()));
    }
    let width = largest - least;
    // Coefficients over a temperature that runs from −1 to 1; the sign turns the lower edge into an upper one.
    let sign = if edge == Edge::Upper { 1.0 } else { -1.0 };
    let basis = |ambient_c: f64| match edge {
        Edge::Upper => {
            let u = 2.0 * (ambient_c - least) / width - 1.0;
            vec![1.0, u, u * u]
        }
        Edge::Lower => {
            let place = (ambient_c - least) / width * (KNOTS - 1) as f64;
            (0..KNOTS).map(|knot| (1.0 - (place - knot as f64).abs()).max(0.0)).collect()
        }
    };
    let row = |p: &Point| Row { basis: basis(p.ambient_c), value: sign * p.cabin_c, weight: p.weight };
    let rows: Vec<Row> = points.iter().map(row).collect();
    // Slopes at both ends: a quadratic that rises at both rises in between.
    let rising = if edge == Edge::Upper { vec![vec![0.0, 1.0, -2.0], vec![0.0, 1.0, 2.0]] } else { Vec::new() };
    let beyond = |row: &Row, coefficients: &[f64]| -> f64 {
        row.value - row.basis.iter().zip(coefficients).map(|(x, c)| x * c).sum::<f64>()
    };

    let plain = least_squares(&rows.iter().collect::<Vec<_>>(), false, &rising).ok_or(FitError::NotSettled)?;
    let mut order: Vec<&Row> = rows.iter().collect();
    // Stable: of two that lie as far beyond, the first one goes.
    order.sort_by(|a, b| beyond(b, &plain).total_cmp(&beyond(a, &plain)));
    let total: f64 = rows.iter().map(|row| row.weight).sum();
    let (mut left_out, mut first) = (0.0, 0);
    while first < order.len() && left_out + order[first].weight <= (1.0 - coverage) * total {
        left_out += order[first].weight;
        first += 1;
    }
    let kept = &order[first..];
    let mut coefficients = least_squares(kept, true, &rising).ok_or(FitError::NotSettled)?;
    // What the solver leaves of its tolerance is taken away, so that the points are covered in truth.
    let short = kept.iter().map(|row| beyond(row, &coefficients)).fold(0.0, f64::max);
    match edge {
        Edge::Upper => coefficients[0] += short,
        Edge::Lower => coefficients.iter_mut().for_each(|c| *c += short),
    }
    let covered = rows.iter().filter(|row| beyond(row, &coefficients) <= ON_IT_K);
    let coverage = covered.map(|row| row.weight).sum::<f64>() / total;
    let shape = match edge {
        Edge::Upper => {
            // Back to degrees Celsius: u = scale · t + shift.
            let (scale, shift) = (2.0 / width, -2.0 * least / width - 1.0);
            let (c0, c1, c2) = (coefficients[0], coefficients[1], coefficients[2]);
            Shape::Quadratic([
                c0 + c1 * shift + c2 * shift * shift,
                c1 * scale + 2.0 * c2 * scale * shift,
                c2 * scale * scale,
            ])
        }
        Edge::Lower => {
            let knot = |n: usize| least + width * n as f64 / (KNOTS - 1) as f64;
            Shape::PiecewiseLinear(coefficients.iter().enumerate().map(|(n, c)| (knot(n), sign * c)).collect())
        }
    };
    Ok(Profile { curve: Curve { shape, valid_c: [least, largest] }, coverage: coverage.min(1.0), points: points.len() })
}
