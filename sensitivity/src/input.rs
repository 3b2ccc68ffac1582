//! Inputs that are uncertain, or a matter of choice: between which values, and how likely.

use statrs::distribution::{ContinuousCDF, Normal};

use crate::VariationError;

/// How an input varies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Spread {
    /// Every value between the two equally likely.
    Uniform {
        /// Least value.
        low: f64,
        /// Largest value.
        high: f64,
    },
    /// Normal about the mean.
    Normal {
        /// Mean.
        mean: f64,
        /// Standard deviation, above 0.
        sd: f64,
    },
    /// Likeliest at the mode, falling along straight lines to the ends.
    Triangular {
        /// Least value.
        low: f64,
        /// Likeliest value.
        mode: f64,
        /// Largest value.
        high: f64,
    },
}

/// An input by its name in a study file, and how it varies.
#[derive(Debug, Clone, PartialEq)]
pub struct Input {
    /// Its name.
    pub name: String,
    /// How it varies.
    pub spread: Spread,
}

/// Share of values below the lower end that a tornado shows, and above the upper one, of distributions without ends.
const TAIL: f64 = 0.05;

impl Spread {
    /// The value below which a share of all values lies, 0 … 1 (exclusive for a normal distribution).
    #[must_use]
    pub fn quantile(&self, share: f64) -> f64 {
        match *self {
            Self::Uniform { low, high } => low + (high - low) * share,
            // Checked by `Input::check`; a spread that is none stays at its mean.
            Self::Normal { mean, sd } => Normal::new(mean, sd).map_or(mean, |normal| normal.inverse_cdf(share)),
            Self::Triangular { low, mode, high } => {
                let (width, rise, fall) = (high - low, mode - low, high - mode);
                if share * width < rise {
                    low + (share * width * rise).sqrt()
                } else {
                    high - ((1.0 - share) * width * fall).sqrt()
                }
            }
        }
    }

    /// The values that stand for a low and a high input: the ends, or the quantiles of 5 and 95 % where there are none.
    #[must_use]
    pub fn ends(&self) -> [f64; 2] {
        match *self {
            Self::Uniform { low, high } | Self::Triangular { low, high, .. } => [low, high],
            Self::Normal { .. } => [TAIL, 1.0 - TAIL].map(|share| self.quantile(share)),
        }
    }
}

impl Input {
    /// An input within ±`share` of its value in a bus; of one that is 0 there, within ±`share` itself.
    #[must_use]
    pub fn around(name: &str, value: f64, share: f64) -> Self {
        let half = if value == 0.0 { share } else { value.abs() * share };
        // As it would be typed, without the rounding error of a product.
        let typed = |value: f64| format!("{value:.12e}").parse().unwrap_or(value);
        Self { name: name.to_owned(), spread: Spread::Uniform { low: typed(value - half), high: typed(value + half) } }
    }

    /// Checks that the spread is one.
    ///
    /// # Errors
    /// [`VariationError::Spread`].
    pub fn check(&self) -> Result<(), VariationError> {
        let fine = match self.spread {
            Spread::Uniform { low, high } => low.is_finite() && high.is_finite() && low < high,
            Spread::Normal { mean, sd } => mean.is_finite() && sd.is_finite() && sd > 0.0,
            Spread::Triangular { low, mode, high } => {
                low.is_finite() && high.is_finite() && low < high && (low..=high).contains(&mode)
            }
        };
        if fine { Ok(()) } else { Err(VariationError::Spread { name: self.name.clone(), spread: self.spread }) }
    }
}
