//! Coefficients of performance over the temperature lift.
//!
//! The paper's curves are fits to unpublished measurements, so every curve here is a substitute with its own source.
//! Each one falls, or stays level, as the lift grows: the search for the optimum relies on that, and a table that
//! breaks it is refused.

/// COP over the lift: the temperature of the warm side less that of the cold side, in K. For heating the lift is
/// `T_cab − T_amb`, for cooling `T_amb − T_cab`; a negative lift is one that nature would take without a machine.
#[derive(Debug, Clone, PartialEq)]
pub enum Cop {
    /// The same at every lift.
    Constant(f64),
    /// `numerator / (max(lift, 0) + offset)`, within `min … max`: Carnot with a pinch.
    Hyperbola {
        /// Numerator in K, above 0.
        numerator_k: f64,
        /// Offset in K, above 0.
        offset_k: f64,
        /// Least COP.
        min: f64,
        /// Largest COP.
        max: f64,
    },
    /// `scale · exp(−rate · max(lift, 0))`, within `min … max`.
    Exponential {
        /// COP without lift.
        scale: f64,
        /// Rate in 1/K, not negative.
        rate_per_k: f64,
        /// Least COP.
        min: f64,
        /// Largest COP.
        max: f64,
    },
    /// `at_zero − slope · lift`, within `min … max`.
    Linear {
        /// COP without lift.
        at_zero: f64,
        /// Fall in 1/K, not negative.
        slope_per_k: f64,
        /// Least COP.
        min: f64,
        /// Largest COP.
        max: f64,
    },
    /// Piecewise linear through `(lift in K, COP)`, constant beyond the ends. Made by [`Cop::table`].
    Table(Vec<(f64, f64)>),
    /// `scale · COP + shift` of another curve, which keeps it falling. Made by [`Cop::changed`].
    Changed {
        /// The other curve.
        of: Box<Cop>,
        /// Factor, above 0.
        scale: f64,
        /// What is added.
        shift: f64,
    },
}

/// A COP curve that the search for the optimum cannot use.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CopError {
    /// No rows.
    #[error("the COP table is empty; give at least one pair [lift in K, COP]")]
    Empty,
    /// A COP is not a positive number, or a lift is not a number.
    #[error("row {row} of the COP table is [{lift_k}, {cop}]; the lift must be a number and the COP one above 0")]
    Value {
        /// Row, from 1.
        row: usize,
        /// Lift in K.
        lift_k: f64,
        /// COP.
        cop: f64,
    },
    /// The lifts do not rise.
    #[error("row {row} of the COP table: its lift {lift_k} K is not above that of the row before; sort by lift")]
    Order {
        /// Row, from 1.
        row: usize,
        /// Lift in K.
        lift_k: f64,
    },
    /// The COP rises with the lift.
    #[error(
        "row {row} of the COP table: the COP {cop} at a lift of {lift_k} K is above that of the row before; a COP that \
         rises with the lift makes the power non-monotone in the cabin temperature, and the optimum would not be \
         proven: give values that fall or stay level"
    )]
    Rising {
        /// Row, from 1.
        row: usize,
        /// Lift in K.
        lift_k: f64,
        /// COP.
        cop: f64,
    },
}

impl Cop {
    /// A table of `(lift in K, COP)`, sorted by lift.
    ///
    /// # Errors
    /// [`CopError`] where the table is empty, not sorted, not positive, or its COP rises with the lift.
    pub fn table(rows: Vec<(f64, f64)>) -> Result<Self, CopError> {
        if rows.is_empty() {
            return Err(CopError::Empty);
        }
        for (i, &(lift_k, cop)) in rows.iter().enumerate() {
            let row = i + 1;
            if !lift_k.is_finite() || !cop.is_finite() || cop <= 0.0 {
                return Err(CopError::Value { row, lift_k, cop });
            }
            if i > 0 && lift_k <= rows[i - 1].0 {
                return Err(CopError::Order { row, lift_k });
            }
            if i > 0 && cop > rows[i - 1].1 {
                return Err(CopError::Rising { row, lift_k, cop });
            }
        }
        Ok(Self::Table(rows))
    }

    /// The curve times `scale`, which is above 0, plus `shift`; the very curve with 1 and 0. Whether it is positive at all
    /// lifts is for whoever uses it to check.
    #[must_use]
    pub fn changed(&self, scale: f64, shift: f64) -> Self {
        match self {
            same if scale == 1.0 && shift == 0.0 => same.clone(),
            Self::Constant(cop) => Self::Constant(cop * scale + shift),
            Self::Table(rows) => Self::Table(rows.iter().map(|(lift, cop)| (*lift, cop * scale + shift)).collect()),
            curve => Self::Changed { of: Box::new(curve.clone()), scale, shift },
        }
    }

    /// COP at a lift in K. Positive, and never rising with the lift.
    #[must_use]
    #[inline]
    pub fn at(&self, lift_k: f64) -> f64 {
        match self {
            Self::Constant(cop) => *cop,
            Self::Hyperbola { numerator_k, offset_k, min, max } => {
                (numerator_k / (lift_k.max(0.0) + offset_k)).clamp(*min, *max)
            }
            Self::Exponential { scale, rate_per_k, min, max } => {
                (scale * (-rate_per_k * lift_k.max(0.0)).exp()).clamp(*min, *max)
            }
            Self::Linear { at_zero, slope_per_k, min, max } => (at_zero - slope_per_k * lift_k).clamp(*min, *max),
            Self::Table(rows) => interpolate(rows, lift_k),
            Self::Changed { of, scale, shift } => of.at(lift_k) * scale + shift,
        }
    }

    /// The largest COP that the curve can give.
    #[must_use]
    pub fn largest(&self) -> f64 {
        match self {
            Self::Constant(cop) => *cop,
            Self::Hyperbola { .. } | Self::Exponential { .. } => self.at(0.0),
            Self::Linear { max, .. } => *max,
            Self::Table(rows) => rows[0].1,
            Self::Changed { of, scale, shift } => of.largest() * scale + shift,
        }
    }
}

fn interpolate(rows: &[(f64, f64)], lift_k: f64) -> f64 {
    let after = rows.partition_point(|&(lift, _)| lift <= lift_k);
    match (after.checked_sub(1).map(|i| rows[i]), rows.get(after)) {
        (Some((x0, y0)), Some(&(x1, y1))) => y0 + (y1 - y0) * (lift_k - x0) / (x1 - x0),
        (Some((_, y)), None) => y,
        (None, _) => rows[0].1,
    }
}

const VECTO: &str =
    "fit to VECTO 5.1.3 DefaultClimatic.aenv (EU declaration data for buses), cabin 18 °C heating, 25 °C cooling";
const VECTO_ROWS: &str = "rows of VECTO 5.1.3 DefaultClimatic.aenv, cabin 18 °C heating, 25 °C cooling";
const CARCULATOR: &str = "carculator_bus, citing doi 10.1016/j.energy.2014.12.038";
const EFLIPS: &str = "eFLIPS vehicle.py (TU Berlin), citing Färber, VDV-Akademie 2019";

/// The heating curves that a study can name, with their sources; the first is the default.
#[must_use]
pub fn named_heating_cops() -> Vec<(&'static str, Cop, &'static str)> {
    let hyperbola = |numerator_k, offset_k| Cop::Hyperbola { numerator_k, offset_k, min: 1.0, max: 4.5 };
    let exponential = Cop::Exponential { scale: 4.090, rate_per_k: 0.036_32, min: 1.0, max: 4.5 };
    let rows = vec![(4.0, 3.50), (10.0, 2.94), (16.0, 2.22), (23.0, 1.78)];
    let rows_r744 = vec![(4.0, 3.38), (10.0, 2.98), (16.0, 2.50), (23.0, 2.04), (38.0, 1.80)];
    vec![
        ("vecto-continuous", hyperbola(74.13, 16.79), VECTO),
        ("vecto-continuous-exponential", exponential, VECTO),
        ("vecto-2stage", hyperbola(62.66, 14.93), VECTO),
        ("vecto-r744", hyperbola(115.81, 30.05), VECTO),
        ("vecto-continuous-rows", Cop::Table(rows), VECTO_ROWS),
        ("vecto-r744-rows", Cop::Table(rows_r744), VECTO_ROWS),
        ("carculator", Cop::Constant(2.3), CARCULATOR),
        ("eflips", Cop::Constant(2.0), EFLIPS),
    ]
}

/// The cooling curves that a study can name, with their sources; the first is the default.
#[must_use]
pub fn named_cooling_cops() -> Vec<(&'static str, Cop, &'static str)> {
    let linear = |at_zero, slope_per_k| Cop::Linear { at_zero, slope_per_k, min: 1.0, max: 4.0 };
    let rows = vec![(-4.5, 3.88), (1.0, 3.36), (8.0, 2.74)];
    let rows_r744 = vec![(-4.5, 3.80), (1.0, 2.82), (8.0, 2.14)];
    let own = "linear fit to the five summer values that can be read off the paper's dynamic comparison";
    vec![
        ("linear", linear(3.05, 0.09), own),
        ("vecto-continuous", linear(3.463, 0.0911), VECTO),
        ("vecto-2stage", linear(3.214, 0.0896), VECTO),
        ("vecto-3stage", linear(3.323, 0.0911), VECTO),
        ("vecto-r744", Cop::Hyperbola { numerator_k: 60.90, offset_k: 20.54, min: 1.0, max: 4.0 }, VECTO),
        ("vecto-continuous-rows", Cop::Table(rows), VECTO_ROWS),
        ("vecto-r744-rows", Cop::Table(rows_r744), VECTO_ROWS),
        ("carculator", Cop::Constant(1.3), CARCULATOR),
        ("eflips", Cop::Constant(2.0), EFLIPS),
    ]
}
