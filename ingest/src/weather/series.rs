//! Weather as a series of intervals, and its mean over any segment.

use chrono::{DateTime, TimeZone, Utc};
use shading::hour_of_year;

use super::format::RowOrder;
use crate::ExclusionReason;

/// Longest span of a series: beyond it a stamp is wrong.
const MAX_YEARS: i64 = 60;
/// Most intervals of a series: twelve years of minutes, 300 MB.
const MOST_INTERVALS: i64 = 12 * 366 * 1440;
const YEAR_HOURS: usize = 8760;

/// Intervals of equal length, from the first to the last one in the files.
#[derive(Debug, Clone, PartialEq)]
pub struct Weather {
    pub(super) calendar: Calendar,
    pub(super) interval_s: i64,
    pub(super) max_gap_s: u32,
    pub(super) temperature_k: Vec<f64>,
    pub(super) dni_w_m2: Vec<f64>,
    pub(super) dhi_w_m2: Vec<f64>,
    /// Whether any quantity of the interval is interpolated.
    pub(super) interpolated: Vec<bool>,
}

/// Which interval an instant belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Calendar {
    /// Intervals counted from this second since 1970.
    Series { start_s: i64 },
    /// Hours of one reference year, repeated by calendar date; 29 February takes the 28th. They begin so many seconds after
    /// full hours.
    Year { phase_s: i64 },
}

/// Weather of a segment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WeatherMean {
    /// Ambient temperature in K.
    pub ambient_temperature_k: f64,
    /// Direct normal irradiance in W/m².
    pub dni_w_m2: f64,
    /// Diffuse horizontal irradiance in W/m².
    pub dhi_w_m2: f64,
    /// Seconds whose weather is interpolated.
    pub interpolated_s: f64,
}

impl Calendar {
    /// The calendar of files, and how many intervals it has.
    pub(super) fn of(
        order: RowOrder,
        interval_s: i64,
        phase_s: i64,
        starts: impl Iterator<Item = i64> + Clone,
    ) -> Result<(Self, usize), String> {
        if order == RowOrder::ReferenceYear {
            return Ok((Self::Year { phase_s }, YEAR_HOURS));
        }
        let (first, last) = (starts.clone().min().unwrap_or(0), starts.max().unwrap_or(0));
        if last - first > MAX_YEARS * 366 * 86_400 {
            return Err(format!("the stamps span more than {MAX_YEARS} years; one of them is wrong"));
        }
        let length = (last - first) / interval_s + 1;
        if length > MOST_INTERVALS {
            return Err(format!(
                "the stamps span {length} intervals of {interval_s} s, more than {MOST_INTERVALS}; one of them is wrong, or give \
                 fewer years"
            ));
        }
        Ok((Self::Series { start_s: first }, length as usize))
    }

    /// The interval that starts at, or holds, a second since 1970.
    pub(super) fn slot(self, second: i64, interval_s: i64, length: usize) -> Option<usize> {
        match self {
            Self::Series { start_s } => {
                usize::try_from((second - start_s).div_euclid(interval_s)).ok().filter(|&slot| slot < length)
            }
            Self::Year { phase_s } => Some(hour_of_year(DateTime::from_timestamp(second - phase_s, 0)?)),
        }
    }

    /// Start of an interval; hours of a reference year are those of 2023, which is no leap year.
    pub(super) fn start(self, slot: usize, interval_s: i64) -> i64 {
        let origin = match self {
            Self::Series { start_s } => start_s,
            Self::Year { phase_s } => {
                phase_s + Utc.with_ymd_and_hms(2023, 1, 1, 0, 0, 0).single().map_or(0, |t| t.timestamp())
            }
        };
        origin + slot as i64 * interval_s
    }
}

impl Weather {
    /// Mean weather from `start` to `end`, each interval weighted by its overlap.
    ///
    /// # Errors
    /// Why there is none.
    pub fn mean(&self, start: DateTime<Utc>, end: DateTime<Utc>) -> Result<WeatherMean, ExclusionReason> {
        let (from, to) = (start.timestamp(), end.timestamp().max(start.timestamp() + 1));
        let origin = self.calendar.start(0, self.interval_s);
        let mut at = from;
        let mut sums = [0.0; 4];
        while at < to {
            let slot = self.calendar.slot(at, self.interval_s, self.temperature_k.len());
            let slot = slot.ok_or(ExclusionReason::OutsideWeather)?;
            let next = at + self.interval_s - (at - origin).rem_euclid(self.interval_s);
            let until = next.min(to);
            let seconds = (until - at) as f64;
            sums[0] += self.temperature_k[slot] * seconds;
            sums[1] += self.dni_w_m2[slot] * seconds;
            sums[2] += self.dhi_w_m2[slot] * seconds;
            sums[3] += if self.interpolated[slot] { seconds } else { 0.0 };
            at = until;
        }
        if sums.iter().any(|s| s.is_nan()) {
            return Err(ExclusionReason::WeatherGap { max_gap_s: self.max_gap_s });
        }
        let [temperature, dni, dhi, _] = sums.map(|s| s / (to - from) as f64);
        Ok(WeatherMean { ambient_temperature_k: temperature, dni_w_m2: dni, dhi_w_m2: dhi, interpolated_s: sums[3] })
    }

    /// Weather at an instant: linear between the middles of the intervals; beyond the first and the last middle, and beside
    /// a gap, that of the interval itself.
    ///
    /// # Errors
    /// Why there is none.
    pub fn at(&self, instant: DateTime<Utc>) -> Result<WeatherMean, ExclusionReason> {
        let second = instant.timestamp();
        let slot_at = |s: i64| self.calendar.slot(s, self.interval_s, self.temperature_k.len());
        let here = slot_at(second).ok_or(ExclusionReason::OutsideWeather)?;
        let into_s = (second - self.calendar.start(0, self.interval_s)).rem_euclid(self.interval_s);
        let from_middle = into_s as f64 / self.interval_s as f64 - 0.5;
        let beside =
            slot_at(second + if from_middle < 0.0 { -self.interval_s } else { self.interval_s }).unwrap_or(here);
        let value = |values: &[f64]| {
            let (a, b) = (values[here], values[beside]);
            if b.is_nan() { a } else { a + (b - a) * from_middle.abs() }
        };
        let found = WeatherMean {
            ambient_temperature_k: value(&self.temperature_k),
            dni_w_m2: value(&self.dni_w_m2),
            dhi_w_m2: value(&self.dhi_w_m2),
            interpolated_s: 0.0,
        };
        if [found.ambient_temperature_k, found.dni_w_m2, found.dhi_w_m2].iter().any(|v| v.is_nan()) {
            return Err(ExclusionReason::WeatherGap { max_gap_s: self.max_gap_s });
        }
        Ok(found)
    }

    /// What the weather from `start` to `end` is made of: a hash over the intervals that the span touches, and over
    /// `margin` more on each side. Weather elsewhere does not change it.
    #[must_use]
    pub fn key(&self, start: DateTime<Utc>, end: DateTime<Utc>, margin: i64) -> String {
        let origin = self.calendar.start(0, self.interval_s);
        let first = (start.timestamp() - origin).div_euclid(self.interval_s) - margin;
        let last = (end.timestamp() - 1 - origin).div_euclid(self.interval_s) + margin;
        let mut hasher = blake3::Hasher::new();
        hasher.update(&self.interval_s.to_le_bytes());
        for i in first..=last {
            match self.calendar.slot(origin + i * self.interval_s, self.interval_s, self.temperature_k.len()) {
                None => hasher.update(b"outside"),
                Some(slot) => {
                    for value in [self.temperature_k[slot], self.dni_w_m2[slot], self.dhi_w_m2[slot]] {
                        hasher.update(&value.to_le_bytes());
                    }
                    hasher.update(&[u8::from(self.interpolated[slot])])
                }
            };
        }
        hasher.finalize().to_hex().to_string()
    }
}
