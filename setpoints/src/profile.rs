//! Setpoints that are fitted to the edge of a cloud.

use crate::Curve;
use crate::basis::{Basis, KNOTS};
use crate::fit::{Row, least_squares};

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
    let basis = Basis::of(points, edge);
    if points.len() < 2 * KNOTS || basis.width_c() < 1e-3 {
        return Err(FitError::TooFew(points.len()));
    }
    let row = |p: &Point| Row { basis: basis.at(p.ambient_c), value: basis.sign() * p.cabin_c, weight: p.weight };
    let rows: Vec<Row> = points.iter().map(row).collect();
    let rising = basis.rising();
    let plain = least_squares(&rows.iter().collect::<Vec<_>>(), false, &rising).ok_or(FitError::NotSettled)?;
    let kept = without_farthest(&rows, &plain, 1.0 - coverage);
    let mut coefficients = least_squares(&kept, true, &rising).ok_or(FitError::NotSettled)?;
    // What the solver leaves of its tolerance is taken away, so that the points are covered in truth.
    let short_k = kept.iter().map(|row| row.beyond(&coefficients)).fold(0.0, f64::max);
    basis.lift(&mut coefficients, short_k);
    let covered = rows.iter().filter(|row| row.beyond(&coefficients) <= ON_IT_K);
    let coverage = covered.map(|row| row.weight).sum::<f64>() / total(&rows);
    let curve = Curve { shape: basis.shape(&coefficients), valid_c: basis.ends_c };
    Ok(Profile { curve, coverage: coverage.min(1.0), points: points.len() })
}

fn total(rows: &[Row]) -> f64 {
    rows.iter().map(|row| row.weight).sum()
}

/// The rows but those that lie farthest beyond a curve, as many as have at most a share of the weight.
fn without_farthest<'r>(rows: &'r [Row], coefficients: &[f64], share: f64) -> Vec<&'r Row> {
    let mut order: Vec<&Row> = rows.iter().collect();
    // Stable: of two that lie as far beyond, the first one goes.
    order.sort_by(|a, b| b.beyond(coefficients).total_cmp(&a.beyond(coefficients)));
    let most = share * total(rows);
    let mut left_out = 0.0;
    let goes = |row: &&&Row| {
        let fits = left_out + row.weight <= most;
        left_out += row.weight;
        fits
    };
    let first = order.iter().take_while(goes).count();
    order.split_off(first)
}
