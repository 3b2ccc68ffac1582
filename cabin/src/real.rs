//! What the equations are computed with: one number, or several abreast.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// A real number, or several that go through the same equations abreast; every operation acts on each of them alone.
pub trait Real:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
    + From<f64>
{
    /// The same number for all.
    fn splat(value: f64) -> Self;
    /// `self · factor + term`. Abreast it is rounded once, which is one instruction where machines have one and the same number
    /// to the bit where they do not.
    fn mul_add(self, factor: impl Into<Self>, term: impl Into<Self>) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// Absolute value.
    fn abs(self) -> Self;
    /// Exponential.
    fn exp(self) -> Self;
    /// `then` where this is above `limit`, `otherwise` elsewhere.
    fn above(self, limit: Self, then: Self, otherwise: Self) -> Self;
    /// Whether any is not zero.
    fn any(self) -> bool;
}

impl Real for f64 {
    #[inline(always)]
    fn splat(value: f64) -> Self {
        value
    }

    #[inline(always)]
    fn mul_add(self, factor: impl Into<Self>, term: impl Into<Self>) -> Self {
        self * factor.into() + term.into()
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }

    #[inline(always)]
    fn abs(self) -> Self {
        f64::abs(self)
    }

    #[inline(always)]
    fn exp(self) -> Self {
        f64::exp(self)
    }

    #[inline(always)]
    fn above(self, limit: Self, then: Self, otherwise: Self) -> Self {
        if self > limit { then } else { otherwise }
    }

    #[inline(always)]
    fn any(self) -> bool {
        self != 0.0
    }
}
