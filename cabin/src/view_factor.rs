//! View factors between rectangles with parallel edges, in closed form.
//!
//! Gross, Spindler and Hahne 1981; Howell's catalogue of radiation configuration factors, C-13 and C-16.

use std::f64::consts::PI;

/// View factor from rectangle 1 to rectangle 2 in parallel planes a distance `height` apart (Howell C-13).
///
/// Rectangle 1 spans `x` and `y` in the plane z = 0 and faces up, rectangle 2 spans `xi` and `eta` in the plane
/// z = `height` and faces down; x and xi, y and eta run in the same directions. Lengths in one unit, `height > 0`.
#[must_use]
pub fn parallel(x: [f64; 2], y: [f64; 2], xi: [f64; 2], eta: [f64; 2], height: f64) -> f64 {
    let g = |u: f64, v: f64| {
        let (a, b) = (u.hypot(height), v.hypot(height));
        v * a * (v / a).atan() + u * b * (u / b).atan() - 0.5 * height * height * (u * u + b * b).ln()
    };
    signed_sum(x, y, xi, eta, |x, y, xi, eta| g(x - xi, y - eta)) / (2.0 * PI * area(x, y))
}

/// View factor from rectangle 1 to rectangle 2 in perpendicular planes (Howell C-16).
///
/// Rectangle 1 spans `x` along the line in which the planes meet and `y >= 0` away from it, rectangle 2 spans `xi` along
/// the same line and `eta >= 0` away from it. A rectangle that crosses the other's plane has to be cut there first.
#[must_use]
pub fn perpendicular(x: [f64; 2], y: [f64; 2], xi: [f64; 2], eta: [f64; 2]) -> f64 {
    let h = |u: f64, y: f64, eta: f64| {
        let c2 = y * y + eta * eta;
        let r2 = u * u + c2;
        // Both terms tend to 0 where their logarithm or arc tangent loses its meaning.
        let first = if c2 > 0.0 { 0.5 * u * c2.sqrt() * (u / c2.sqrt()).atan() } else { 0.0 };
        let second = if r2 > 0.0 { 0.125 * (u * u - c2) * r2.ln() } else { 0.0 };
        first + second
    };
    signed_sum(x, y, xi, eta, |x, y, xi, eta| h(x - xi, y, eta)) / (PI * area(x, y))
}

fn area(x: [f64; 2], y: [f64; 2]) -> f64 {
    (x[1] - x[0]) * (y[1] - y[0])
}

/// Sum over all corners with the sign (−1)^(i+j+k+l).
fn signed_sum(x: [f64; 2], y: [f64; 2], xi: [f64; 2], eta: [f64; 2], term: impl Fn(f64, f64, f64, f64) -> f64) -> f64 {
    let mut sum = 0.0;
    for corner in 0..16_usize {
        let [i, j, k, l] = [corner & 1, corner >> 1 & 1, corner >> 2 & 1, corner >> 3 & 1];
        let value = term(x[i], y[j], xi[k], eta[l]);
        sum += if corner.count_ones() % 2 == 0 { value } else { -value };
    }
    sum
}
