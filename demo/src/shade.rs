//! Shadow fractions of the streets of a town.

use chrono::{TimeDelta, TimeZone, Utc};
use shading::{ShadowYear, Site, canyon_shadow_fraction};
use std::f64::consts::PI;
use std::fmt::Write as _;

use crate::{LATITUDE_DEG, LONGITUDE_DEG};

/// Streets run in these many directions, evenly spread.
const DIRECTIONS: u32 = 8;
/// Height-to-width ratios and the share of the streets that has them; a fifth of the way is open.
const CANYONS: [(f64, f64); 4] = [(0.0, 0.20), (0.5, 0.20), (1.0, 0.35), (1.5, 0.25)];

/// `time_utc,shadow_fraction` for every full hour of 2022.
pub(crate) fn file() -> Vec<u8> {
    let site = Site::new(LATITUDE_DEG, LONGITUDE_DEG).expect("the demo's place lies on the globe");
    let start = Utc.with_ymd_and_hms(2022, 1, 1, 0, 0, 0).single().expect("1 January 2022 exists");
    let instant = |hour: usize| start + TimeDelta::hours(hour as i64);
    let year = ShadowYear::from_fn(|hour| {
        let sun = site.sun(instant(hour));
        let mean = |ratio| {
            let street = |i| PI * f64::from(i) / f64::from(DIRECTIONS);
            (0..DIRECTIONS).map(|i| canyon_shadow_fraction(sun, street(i), ratio)).sum::<f64>() / f64::from(DIRECTIONS)
        };
        CANYONS.iter().map(|&(ratio, share)| share * mean(ratio)).sum()
    });
    let mut text = "time_utc,shadow_fraction\n".to_owned();
    for (hour, fraction) in year.hourly().iter().enumerate() {
        let time = instant(hour).format("%Y-%m-%dT%H:%M:%SZ");
        let _ = writeln!(text, "{time},{fraction:.4}");
    }
    text.into_bytes()
}
