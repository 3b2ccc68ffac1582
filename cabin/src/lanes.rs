//! Several numbers abreast, in a form that compilers turn into vector instructions: every operation is a loop over an array,
//! every branch a choice between two numbers, and nothing calls a library.

use crate::Real;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A number of each of `W` lanes. No lane sees another.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(align(32))]
pub struct Lanes<const W: usize>(pub [f64; W]);

impl<const W: usize> Lanes<W> {
    /// 0 in every lane.
    pub const ZERO: Self = Self([0.0; W]);
    /// 1 in every lane.
    pub const ONE: Self = Self([1.0; W]);

    #[inline(always)]
    fn map(self, f: impl Fn(f64) -> f64) -> Self {
        let mut out = self;
        for x in &mut out.0 {
            *x = f(*x);
        }
        out
    }

    #[inline(always)]
    fn zip(self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        let mut out = self;
        for (x, y) in out.0.iter_mut().zip(other.0) {
            *x = f(*x, y);
        }
        out
    }

    /// The larger of two, lane by lane.
    #[must_use]
    #[inline(always)]
    pub fn max(self, other: Self) -> Self {
        self.zip(other, |x, y| if x > y { x } else { y })
    }

    /// The smaller of two, lane by lane.
    #[must_use]
    #[inline(always)]
    pub fn min(self, other: Self) -> Self {
        self.zip(other, |x, y| if x < y { x } else { y })
    }
}

macro_rules! operator {
    ($trait:ident, $name:ident, $op:tt) => {
        impl<const W: usize> $trait for Lanes<W> {
            type Output = Self;
            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                self.zip(other, |x, y| x $op y)
            }
        }

        impl<const W: usize> $trait<f64> for Lanes<W> {
            type Output = Self;
            #[inline(always)]
            fn $name(self, other: f64) -> Self {
                self.map(|x| x $op other)
            }
        }
    };
}

operator!(Add, add, +);
operator!(Sub, sub, -);
operator!(Mul, mul, *);
operator!(Div, div, /);

impl<const W: usize> From<f64> for Lanes<W> {
    #[inline(always)]
    fn from(value: f64) -> Self {
        Self([value; W])
    }
}

impl<const W: usize> Neg for Lanes<W> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.map(|x| -x)
    }
}

impl<const W: usize> Real for Lanes<W> {
    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self([value; W])
    }

    #[inline(always)]
    fn mul_add(self, factor: impl Into<Self>, term: impl Into<Self>) -> Self {
        let (factor, term) = (factor.into(), term.into());
        let mut out = self;
        for i in 0..W {
            out.0[i] = self.0[i].mul_add(factor.0[i], term.0[i]);
        }
        out
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        self.map(f64::sqrt)
    }

    #[inline(always)]
    fn abs(self) -> Self {
        self.map(f64::abs)
    }

    /// To 4e-16 of the value, from −700 to 700: 2ⁿ times Taylor's polynomial of the rest, which is at most ln 2 / 2.
    #[inline(always)]
    fn exp(self) -> Self {
        /// Adding it rounds to a whole number, which then stands in the lowest bits.
        const ROUND: f64 = 1.5 * (1_u64 << 52) as f64;
        /// ln 2 in two parts, the first with trailing zeros, so that n times it is exact.
        const LN_2: [f64; 2] = [6.931_471_803_691_238e-1, 1.908_214_929_270_587_7e-10];
        let rounded = self * std::f64::consts::LOG2_E + ROUND;
        let n = rounded - ROUND;
        let rest = n.mul_add(-LN_2[1], n.mul_add(-LN_2[0], self));
        let mut sum = Self::splat(TAYLOR[TAYLOR.len() - 1]);
        for coefficient in TAYLOR.iter().rev().skip(1) {
            sum = sum.mul_add(rest, *coefficient);
        }
        sum.zip(rounded, |sum, rounded| sum * f64::from_bits((rounded.to_bits() << 52).wrapping_add(1.0_f64.to_bits())))
    }

    #[inline(always)]
    fn above(self, limit: Self, then: Self, otherwise: Self) -> Self {
        let mut out = otherwise;
        for i in 0..W {
            out.0[i] = if self.0[i] > limit.0[i] { then.0[i] } else { otherwise.0[i] };
        }
        out
    }
    #[inline(always)]
    fn any(self) -> bool {
        self.0.iter().fold(0, |bits, x| bits | x.to_bits()) != 0
    }
}

/// 1/k! from k = 0.
const TAYLOR: [f64; 14] = {
    let mut terms = [1.0; 14];
    let mut k = 1;
    while k < terms.len() {
        terms[k] = terms[k - 1] / k as f64;
        k += 1;
    }
    terms
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prop_the_exponential_is_that_of_the_library() {
        for n in -7000..7000 {
            let x = f64::from(n) * 0.1 + 0.017;
            let ours = Lanes::<8>::splat(x).exp().0;
            assert!(ours.iter().all(|y| (y / x.exp() - 1.0).abs() < 4.5e-16), "{x}: {ours:?} {}", x.exp());
        }
    }
}
