//! Axes: from what values to where, with ticks at round numbers.

use crate::numbers::month;

/// What an axis says at its ticks.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) enum Ticks {
    /// Round numbers.
    #[default]
    Numbers,
    /// The clock, the axis being in hours since the midnight before.
    Clock,
    /// Months 1 … 12.
    Months,
    /// None: the panel below has them.
    None,
}

/// An axis as a figure wants it.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Axis {
    /// Quantity with its unit.
    pub label: String,
    pub ticks: Ticks,
    /// Where it begins; at the least value where nobody says.
    pub from: Option<f64>,
    /// Where it ends.
    pub to: Option<f64>,
}

impl Axis {
    pub fn new(label: impl Into<String>) -> Self {
        Self { label: label.into(), ..Self::default() }
    }

    pub fn from(self, from: f64) -> Self {
        Self { from: Some(from), ..self }
    }

    pub fn to(self, to: f64) -> Self {
        Self { to: Some(to), ..self }
    }

    pub fn with(self, ticks: Ticks) -> Self {
        Self { ticks, ..self }
    }
}

/// An axis that holds all its values.
pub(super) struct Scale {
    low: f64,
    high: f64,
    step: f64,
}

impl Scale {
    /// Of the values on it and about so many ticks. Ends that nobody has set lie on ticks.
    pub fn of(axis: &Axis, values: impl Iterator<Item = f64>, ticks: f64) -> Self {
        let (least, most) = values
            .chain(axis.from)
            .chain(axis.to)
            .filter(|v| v.is_finite())
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, m), v| (l.min(v), m.max(v)));
        let (least, most) = if least <= most { (least, most) } else { (0.0, 1.0) };
        let (least, most) = match (axis.from, most - least < 1e-9 * most.abs().max(1e-3)) {
            (_, false) => (least, most),
            (Some(from), true) => (from, from + 1.0),
            (None, true) => (least - 1.0, most),
        };
        let step = match axis.ticks {
            Ticks::Clock => clock_step(most - least, ticks),
            Ticks::Months => 3.0,
            Ticks::Numbers | Ticks::None => step(most - least, ticks),
        };
        // A value that is a tick to rounding needs no further one.
        let low = axis.from.unwrap_or_else(|| (least / step + 1e-9).floor() * step);
        let high = axis.to.unwrap_or_else(|| (most / step - 1e-9).ceil() * step);
        Self { low, high: if high > low { high } else { low + step }, step }
    }

    /// Share of the way along the axis.
    pub fn share(&self, value: f64) -> f64 {
        (value - self.low) / (self.high - self.low)
    }

    /// Values with what stands there.
    pub fn ticks(&self, ticks: &Ticks) -> Vec<(f64, String)> {
        let first = if *ticks == Ticks::Months { 1.0 } else { (self.low / self.step - 1e-9).ceil() * self.step };
        let decimals = usize::try_from(-(self.step + 1e-12).log10().floor() as i64).unwrap_or(0);
        // Half steps of a power of ten, such as 0.25, have a digit more.
        let decimals =
            (decimals..decimals + 2).find(|d| is_whole(self.step * 10_f64.powi(*d as i32))).unwrap_or(decimals + 1);
        let label = |value: f64| match ticks {
            Ticks::Numbers => format!("{:.decimals$}", value + 0.0).replace('-', "−"),
            Ticks::Clock => clock(value),
            Ticks::Months => month(value.round() as u8).chars().take(3).collect(),
            Ticks::None => String::new(),
        };
        let count = ((self.high - first) / self.step + 1e-9).floor().max(0.0) as usize;
        (0..=count).map(|i| first + i as f64 * self.step).map(|value| (value, label(value))).collect()
    }
}

/// Hours since midnight as a clock shows them.
pub(super) fn clock(hours: f64) -> String {
    let minutes = (hours * 60.0).round() as i64;
    format!("{:02}:{:02}", minutes / 60 % 24, minutes % 60)
}

fn is_whole(value: f64) -> bool {
    (value - value.round()).abs() < 1e-6
}

/// Between ticks: 1, 2 or 5 times a power of ten.
fn step(range: f64, ticks: f64) -> f64 {
    let least = (range / ticks).max(1e-9);
    let power = 10_f64.powf(least.log10().floor());
    [1.0, 2.0, 2.5, 5.0, 10.0].map(|m| m * power).into_iter().find(|s| *s >= least * 0.999).unwrap_or(10.0 * power)
}

/// Hours between ticks of a clock.
fn clock_step(range: f64, ticks: f64) -> f64 {
    let least = range / ticks;
    [0.25, 0.5, 1.0, 2.0, 3.0, 6.0, 12.0, 24.0].into_iter().find(|s| *s >= least).unwrap_or(24.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(axis: &Axis, values: &[f64], ticks: f64) -> Vec<String> {
        Scale::of(axis, values.iter().copied(), ticks).ticks(&axis.ticks).into_iter().map(|t| t.1).collect()
    }

    #[test]
    fn prop_ticks_are_round_and_hold_all_values() {
        assert_eq!(labels(&Axis::new(""), &[0.0, 2.0], 4.0), ["0.0", "0.5", "1.0", "1.5", "2.0"]);
        assert_eq!(labels(&Axis::new(""), &[-3.0, 7683.0], 4.0), ["−2000", "0", "2000", "4000", "6000", "8000"]);
        assert_eq!(labels(&Axis::new(""), &[0.0, 0.9], 4.0), ["0.00", "0.25", "0.50", "0.75", "1.00"]);
        assert_eq!(
            labels(&Axis::new("").with(Ticks::Clock), &[4.9, 16.0], 4.0),
            ["03:00", "06:00", "09:00", "12:00", "15:00", "18:00"]
        );
        let day = Axis::new("").with(Ticks::Clock).from(4.87).to(25.5);
        assert_eq!(labels(&day, &[], 4.0), ["06:00", "12:00", "18:00", "00:00"]);
        assert_eq!(labels(&Axis::new("").with(Ticks::Months).from(0.5).to(12.5), &[], 6.0)[..2], ["Jan", "Apr"]);
    }
}
