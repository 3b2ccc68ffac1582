//! Whether irradiance agrees with the sun: light at night, or more than reaches the atmosphere, means wrong stamps, a wrong
//! unit or a wrong place.

use chrono::{DateTime, Datelike};
use chrono_tz::Tz;
use std::f64::consts::{PI, TAU};

use super::format::{Layout, TimeLabel};
use super::intervals::Interval;
use super::plausible::other_units;
use super::values::{Quantity, Values};
use crate::irradiance::extraterrestrial_w_m2;
use crate::stamp::Clock;
use crate::{Finding, FindingKind};

/// With the sun lower than this all through an interval it is night: beyond refraction, the sun's radius and this module's
/// approximation.
const NIGHT_SIN: f64 = -0.026_176_948_307_873_15;
/// So much light is none, in W/m².
const DARK_W_M2: f64 = 10.0;
/// Share of the intervals that may contradict the sun: sensors and hands have their moments.
const STRAY_SHARE: f64 = 0.005;
/// Intervals of sun from which a unit that makes it too dark is told, and the clearness that some of them must reach.
const DARK_UNIT: [(usize, f64); 2] = [(300, 0.4), (60, 0.05)];
/// No hour but a stray one is clearer.
const CLEAREST: f64 = 1.2;
/// Above this the clearness index says something (sine of 10°).
const HIGH_SIN: f64 = 0.173_648_177_666_930_33;

/// A place and the clocks that people use there.
pub(crate) struct Sky {
    pub latitude_rad: f64,
    pub longitude_rad: f64,
    pub zone: Tz,
}

/// The sun over an interval.
#[derive(Clone, Copy)]
struct SunOver {
    /// Mean of the sine of the altitude while the sun is up.
    mean_sin: f64,
    highest_sin: f64,
    outside_w_m2: f64,
}

/// How values agree with the sun.
#[derive(Clone, Copy, Default)]
struct Agreement {
    intervals: usize,
    /// Intervals with more light than can be, and the index of the first.
    contradictions: usize,
    first: usize,
    /// Correlation of light and sun.
    correlation: f64,
}

impl Agreement {
    fn is_fine(&self) -> bool {
        self.contradictions < 2 || self.contradictions as f64 <= STRAY_SHARE * self.intervals as f64
    }
}

impl Sky {
    /// The sine of the sun's altitude (Spencer 1971, Search 2(5):172), to some tenths of a degree.
    fn sin_altitude(&self, second: i64) -> f64 {
        let day = (second.rem_euclid(31_556_952)) as f64 / 86_400.0;
        let b = TAU * day / 365.242_5;
        let declination = 0.006_918 - 0.399_912 * b.cos() + 0.070_257 * b.sin() - 0.006_758 * (2.0 * b).cos()
            + 0.000_907 * (2.0 * b).sin()
            - 0.002_697 * (3.0 * b).cos()
            + 0.001_48 * (3.0 * b).sin();
        let equation_rad = 0.000_007_5 + 0.001_868 * b.cos()
            - 0.032_077 * b.sin()
            - 0.014_615 * (2.0 * b).cos()
            - 0.040_849 * (2.0 * b).sin();
        let hour_angle = TAU * second.rem_euclid(86_400) as f64 / 86_400.0 - PI + self.longitude_rad + equation_rad;
        self.latitude_rad.sin() * declination.sin() + self.latitude_rad.cos() * declination.cos() * hour_angle.cos()
    }

    fn over(&self, start_s: i64, length_s: i64) -> SunOver {
        let at = |part: i64| self.sin_altitude(start_s + length_s * part / 4);
        let sines = [at(0), at(1), at(2), at(3), at(4)];
        let up = sines.map(|sine| sine.max(0.0));
        let date = DateTime::from_timestamp(start_s, 0).unwrap_or_default();
        SunOver {
            mean_sin: (0.5 * (up[0] + up[4]) + up[1] + up[2] + up[3]) / 4.0,
            highest_sin: sines.into_iter().fold(-1.0, f64::max),
            outside_w_m2: extraterrestrial_w_m2(date.ordinal()),
        }
    }

    fn agreement(
        &self,
        intervals: &[Interval],
        length_s: i64,
        start: impl Fn(&Interval) -> i64,
        factor: f64,
    ) -> Agreement {
        let mut found = Agreement::default();
        let mut sums = [0.0; 6];
        for (i, interval) in intervals.iter().enumerate() {
            let light = brightest(&interval.values) * factor;
            if light.is_nan() {
                continue;
            }
            let sun = self.over(start(interval), length_s);
            found.intervals += 1;
            let in_the_night = sun.highest_sin < NIGHT_SIN && light > DARK_W_M2;
            if in_the_night || sun.is_exceeded(&interval.values, factor) {
                found.first = if found.contradictions == 0 { i } else { found.first };
                found.contradictions += 1;
            }
            let (x, y) = (light, sun.mean_sin);
            for (sum, term) in sums.iter_mut().zip([1.0, x, y, x * x, y * y, x * y]) {
                *sum += term;
            }
        }
        let [n, x, y, xx, yy, xy] = sums;
        let spread = ((n * xx - x * x) * (n * yy - y * y)).sqrt();
        found.correlation = if spread > 0.0 { (n * xy - x * y) / spread } else { 0.0 };
        found
    }
}

/// The irradiance that says most of light: the global one, else the diffuse, else the direct one.
fn brightest(values: &Values) -> f64 {
    [values.global, values.diffuse, values.direct].into_iter().find(|v| !v.is_nan()).unwrap_or(f64::NAN)
}

impl SunOver {
    /// Whether more arrives than can: the physically possible limits of Long and Dutton, BSRN quality control V2.0 (2002);
    /// the beam at most what arrives outside the atmosphere.
    fn is_exceeded(&self, values: &Values, factor: f64) -> bool {
        let up = self.mean_sin.powf(1.2) * self.outside_w_m2;
        values.global * factor > 1.5 * up + 100.0
            || values.diffuse * factor > 0.95 * up + 50.0
            || values.direct * factor > self.outside_w_m2
    }
}

/// Refuses a file whose irradiances contradict the sun, and says what would fit. `bare` are stamps without an offset of their
/// own; `named` is a layout that the study names.
pub(crate) fn check(
    intervals: &[Interval],
    layout: &Layout,
    sky: &Sky,
    bare: bool,
    named: bool,
) -> Result<(), Finding> {
    let length_s = layout.interval_s;
    let as_read = sky.agreement(intervals, length_s, |i| i.start_s, 1.0);
    let at = |index: usize| {
        DateTime::from_timestamp(intervals[index].start_s, 0).unwrap_or_default().format("%Y-%m-%d %H:%M")
    };
    let column = [Quantity::Global, Quantity::Diffuse, Quantity::Direct].map(|q| layout.column(q));
    let column = column.into_iter().find(|name| !name.is_empty()).unwrap_or_default();
    let refused = |kind, message: String, index: usize| {
        Err(Finding::whole(kind, message).in_column(column).at_line(intervals[index].line))
    };
    let (clearness, count) = clearness(intervals, length_s, sky, 1.0);
    if !as_read.is_fine() {
        // A wrong unit shows at high sun too; wrong stamps only where the sun is low.
        let by_unit = if clearness > CLEAREST { fitting_unit(intervals, layout, sky) } else { None };
        let kind = if by_unit.is_some() { FindingKind::WrongUnit } else { FindingKind::WrongStamps };
        let message = format!(
            "{} of {} intervals have more light than the sun of their hour gives, the first from {} UTC; {}",
            as_read.contradictions,
            as_read.intervals,
            at(as_read.first),
            by_unit.unwrap_or_else(|| fitting_clock(intervals, layout, sky, bare, named))
        );
        return refused(kind, message, as_read.first);
    }
    if DARK_UNIT.iter().any(|&(least, dark)| count >= least && clearness < dark) {
        let message = format!(
            "no hour of {count} with the sun above 10° has more than {:.0} % of what arrives outside the atmosphere; {}",
            100.0 * clearness,
            fitting_unit(intervals, layout, sky).unwrap_or_else(|| "another unit or column".to_owned())
        );
        return refused(FindingKind::WrongUnit, message, 0);
    }
    Ok(())
}

/// The clearness index that one of a hundred sunny intervals exceeds, and how many are sunny.
fn clearness(intervals: &[Interval], length_s: i64, sky: &Sky, factor: f64) -> (f64, usize) {
    let index = |interval: &Interval| {
        let sun = sky.over(interval.start_s, length_s);
        let v = &interval.values;
        let global = factor * if v.global.is_nan() { v.diffuse + v.direct * sun.mean_sin } else { v.global };
        (sun.mean_sin > HIGH_SIN && !global.is_nan()).then(|| global / (sun.outside_w_m2 * sun.mean_sin))
    };
    let mut known: Vec<f64> = intervals.iter().filter_map(index).collect();
    known.sort_unstable_by(f64::total_cmp);
    let place = known.len().saturating_sub(1 + known.len() / 100);
    (known.get(place).copied().unwrap_or(f64::NAN), known.len())
}

/// The unit that the values fit, as a remedy.
fn fitting_unit(intervals: &[Interval], layout: &Layout, sky: &Sky) -> Option<String> {
    let declared = layout.units.irradiance;
    let fits = |unit: &super::IrradianceUnit| {
        let factor = unit.watts(layout.interval_s) / declared.watts(layout.interval_s);
        let agreement = sky.agreement(intervals, layout.interval_s, |i| i.start_s, factor);
        let (clearness, sunny) = clearness(intervals, layout.interval_s, sky, factor);
        factor != 1.0 && agreement.is_fine() && (sunny == 0 || (0.3..CLEAREST).contains(&clearness))
    };
    let unit = other_units(declared).find(fits)?;
    Some(format!("the values fit another unit: `irradiance_unit = {:?}`", unit.name()))
}

/// The clocks and labels under which the values agree with the sun, as a remedy.
fn fitting_clock(intervals: &[Interval], layout: &Layout, sky: &Sky, bare: bool, named: bool) -> String {
    let length_s = layout.interval_s;
    let wall = |i: &Interval| i.start_s + layout.clock.offset_s(i.start_s);
    let by_clock = |clock: Clock| {
        let start = move |i: &Interval| {
            let wall_s = wall(i);
            wall_s - clock.offset_s(wall_s - clock.offset_s(wall_s))
        };
        sky.agreement(intervals, length_s, start, 1.0)
    };
    let mut fits: Vec<(f64, String)> = Vec::new();
    let mut offer = |agreement: Agreement, words: String| {
        if agreement.is_fine() {
            fits.push((agreement.correlation, words));
        }
    };
    if bare && named {
        offer(by_clock(Clock::Zone(sky.zone)), format!("`time_zone = {:?}`", sky.zone.name()));
    }
    if named {
        for label in TimeLabel::ALL.into_iter().filter(|label| *label != layout.label) {
            let later_s = layout.label.shift_s(length_s) - label.shift_s(length_s);
            let words = format!("`time_label = {:?}`", label.name());
            offer(sky.agreement(intervals, length_s, |i| i.start_s + later_s, 1.0), words);
        }
    }
    for half_hours in (-28..=24).filter(|n| *n != 0) {
        let earlier_s: i64 = 1800 * half_hours;
        let ahead_s = if bare && named { earlier_s + layout.clock.offset_s(intervals[0].start_s) } else { earlier_s };
        let sign = if ahead_s < 0 { '-' } else { '+' };
        let (hours, minutes) = (ahead_s.abs() / 3600, ahead_s.abs() / 60 % 60);
        let words = if bare && named {
            format!("`utc_offset = \"{sign}{hours:02}:{minutes:02}\"`")
        } else {
            format!("{hours:02}:{minutes:02} h {} than the stamps say", if ahead_s > 0 { "less" } else { "more" })
        };
        offer(sky.agreement(intervals, length_s, |i| i.start_s - earlier_s, 1.0), words);
    }
    let best = fits.iter().map(|(correlation, _)| *correlation).fold(0.0, f64::max);
    let said: Vec<String> = fits
        .into_iter()
        .filter(|(correlation, _)| *correlation >= best - 0.01)
        .map(|(_, words)| words)
        .take(3)
        .collect();
    if said.is_empty() {
        return "no other clock or label fits: check [location] and the columns".to_owned();
    }
    format!("wrong stamps, or another [location]; what fits: {}", said.join(" or "))
}
