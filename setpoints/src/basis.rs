//! The curves that a profile is chosen from, as coefficients over the range of its points.

use crate::{Edge, Point, Shape};

/// Knots of a piecewise linear profile.
pub(crate) const KNOTS: usize = 4;

/// A family of curves along an edge. Along the lower one it is that of the negative points: their upper edge.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Basis {
    edge: Edge,
    /// Least and largest ambient temperature of the points in °C.
    pub ends_c: [f64; 2],
}

impl Basis {
    pub fn of(points: &[Point], edge: Edge) -> Self {
        let least = points.iter().map(|p| p.ambient_c).fold(f64::INFINITY, f64::min);
        let largest = points.iter().map(|p| p.ambient_c).fold(f64::NEG_INFINITY, f64::max);
        Self { edge, ends_c: [least, largest] }
    }

    pub fn width_c(&self) -> f64 {
        self.ends_c[1] - self.ends_c[0]
    }

    /// What turns points into those of an upper edge.
    pub fn sign(&self) -> f64 {
        if self.edge == Edge::Upper { 1.0 } else { -1.0 }
    }

    /// The curve there is this · coefficients.
    pub fn at(&self, ambient_c: f64) -> Vec<f64> {
        let place = (ambient_c - self.ends_c[0]) / self.width_c() * (KNOTS - 1) as f64;
        match self.edge {
            // Over a temperature that runs from −1 to 1.
            Edge::Upper => {
                let u = 2.0 * (ambient_c - self.ends_c[0]) / self.width_c() - 1.0;
                vec![1.0, u, u * u]
            }
            Edge::Lower => (0..KNOTS).map(|knot| (1.0 - (place - knot as f64).abs()).max(0.0)).collect(),
        }
    }

    /// What must not be negative times the coefficients, so that a curve that may not fall does not: its slopes at both ends, for
    /// a quadratic that rises at both rises in between.
    pub fn rising(&self) -> Vec<Vec<f64>> {
        match self.edge {
            Edge::Upper => vec![vec![0.0, 1.0, -2.0], vec![0.0, 1.0, 2.0]],
            Edge::Lower => Vec::new(),
        }
    }

    /// Lifts the whole curve.
    pub fn lift(&self, coefficients: &mut [f64], by_k: f64) {
        match self.edge {
            Edge::Upper => coefficients[0] += by_k,
            Edge::Lower => coefficients.iter_mut().for_each(|c| *c += by_k),
        }
    }

    /// The curve of coefficients, in degrees Celsius.
    pub fn shape(&self, coefficients: &[f64]) -> Shape {
        let (least, width) = (self.ends_c[0], self.width_c());
        match self.edge {
            Edge::Upper => {
                // u = scale · t + shift.
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
                let pair = |(n, c): (usize, &f64)| (knot(n), self.sign() * c);
                Shape::PiecewiseLinear(coefficients.iter().enumerate().map(pair).collect())
            }
        }
    }
}
