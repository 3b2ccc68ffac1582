//! A setpoint over the ambient temperature.

/// The form of a curve.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    /// constant + linear · t + quadratic · t², t the ambient temperature in °C.
    Quadratic([f64; 3]),
    /// Linear between the pairs of ambient and cabin temperature in °C, at least two, in rising order.
    PiecewiseLinear(Vec<(f64, f64)>),
}

impl Shape {
    /// What it is called in files and tables.
    #[must_use]
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Quadratic(_) => "quadratic",
            Self::PiecewiseLinear(_) => "piecewise-linear",
        }
    }

    /// Its numbers as JSON: the three coefficients, or pairs of ambient and cabin temperature in °C.
    #[must_use]
    pub fn parameters(&self) -> String {
        match self {
            Self::Quadratic(coefficients) => format!("{coefficients:?}"),
            Self::PiecewiseLinear(pairs) => {
                let pairs: Vec<[f64; 2]> = pairs.iter().map(|(x, y)| [*x, *y]).collect();
                format!("{pairs:?}")
            }
        }
    }
}

/// A setpoint in °C over the ambient temperature in °C; beyond its range it stays as it is at the end.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// Its form.
    pub shape: Shape,
    /// Least and largest ambient temperature of its range in °C.
    pub valid_c: [f64; 2],
}

impl Curve {
    /// The same setpoint at all ambient temperatures, in °C.
    #[must_use]
    pub fn constant(setpoint_c: f64) -> Self {
        Self { shape: Shape::Quadratic([setpoint_c, 0.0, 0.0]), valid_c: [0.0, 0.0] }
    }

    /// Linear between pairs of ambient and cabin temperature in °C, in rising order; one pair is a constant. `None` without any.
    #[must_use]
    pub fn through(pairs: &[(f64, f64)]) -> Option<Self> {
        let (first, last) = (pairs.first()?, pairs.last()?);
        let pairs = if pairs.len() > 1 { pairs.to_vec() } else { vec![*first, (first.0 + 1.0, first.1)] };
        Some(Self { shape: Shape::PiecewiseLinear(pairs), valid_c: [first.0, last.0] })
    }

    /// The setpoint in °C.
    #[must_use]
    pub fn at(&self, ambient_c: f64) -> f64 {
        let t = ambient_c.clamp(self.valid_c[0], self.valid_c[1]);
        match &self.shape {
            Shape::Quadratic([constant, linear, quadratic]) => constant + t * (linear + t * quadratic),
            Shape::PiecewiseLinear(pairs) => {
                let after = pairs.partition_point(|(x, _)| *x <= t).clamp(1, pairs.len() - 1);
                let ((x0, y0), (x1, y1)) = (pairs[after - 1], pairs[after]);
                y0 + (y1 - y0) * (t - x0) / (x1 - x0)
            }
        }
    }
}
