//! A made-up weather with the climate of Zürich, in the format of MeteoSwiss.

use chrono::{DateTime, Datelike, TimeDelta, TimeZone, Timelike, Utc};
use shading::Site;
use std::f64::consts::TAU;
use std::fmt::Write as _;

use crate::random::Random;
use crate::{LATITUDE_DEG, LONGITUDE_DEG};

/// Monthly means in °C, rounded from the climate normals of Zürich/Fluntern 1991–2020 (MeteoSwiss).
const TEMPERATURE_C: [f64; 12] = [0.5, 1.5, 5.5, 9.5, 14.0, 17.5, 19.5, 19.0, 15.0, 10.0, 5.0, 1.5];
/// Share of the clear-sky irradiance by month; gives about 1150 kWh/m² a year.
const CLEARNESS: [f64; 12] = [0.46, 0.55, 0.62, 0.66, 0.66, 0.69, 0.73, 0.71, 0.66, 0.56, 0.45, 0.41];
/// Standard deviation and memory of the temperature anomaly.
const ANOMALY_K: f64 = 4.0;
const ANOMALY_HOURS: f64 = 72.0;
/// Standard deviations of the cloudiness, day by day and hour by hour, and its memory.
const CLOUD_DAY: f64 = 0.32;
const CLOUD_HOUR: f64 = 0.12;
const CLOUD_HOURS: f64 = 30.0;

/// Hourly temperature and global irradiance for whole years.
#[derive(Debug, Clone, PartialEq)]
pub struct SyntheticWeather {
    start: DateTime<Utc>,
    /// Temperature in °C and global horizontal irradiance in W/m² of each hour.
    hours: Vec<(f64, f64)>,
}

impl SyntheticWeather {
    /// The weather of all years from that of `first` to that of `last`.
    #[must_use]
    pub fn new(seed: u64, first: DateTime<Utc>, last: DateTime<Utc>) -> Self {
        let site = Site::new(LATITUDE_DEG, LONGITUDE_DEG).expect("the demo's place lies on the globe");
        let (start, end) = (new_year(first.year()), new_year(last.year() + 1));
        let mut random = Random::new(seed, u64::MAX);
        let (mut anomaly, mut cloud, mut ripple) = (random.normal(), random.normal(), random.normal());
        let step = |memory_hours: f64| {
            let keep = (-1.0 / memory_hours).exp();
            (keep, (1.0 - keep * keep).sqrt())
        };
        let (slow, day, hourly) = (step(ANOMALY_HOURS), step(CLOUD_HOURS), step(2.0));
        let mut hours = Vec::with_capacity((end - start).num_hours() as usize);
        let mut middle = start + TimeDelta::minutes(30);
        while middle < end {
            anomaly = slow.0 * anomaly + slow.1 * random.normal();
            cloud = day.0 * cloud + day.1 * random.normal();
            ripple = hourly.0 * ripple + hourly.1 * random.normal();
            let clearness = by_season(&CLEARNESS, middle) + CLOUD_DAY * cloud + CLOUD_HOUR * ripple;
            let clearness = clearness.clamp(0.08, 1.0);
            let sky = clear_sky_w_m2(site.sun(middle).altitude_rad.sin());
            // The day's swing grows with sun and season; it is largest in the early afternoon.
            let swing_k = (0.8 + 5.2 * clearness) * (0.55 + 0.45 * season(middle));
            let hour = f64::from(middle.hour()) + 0.5;
            let swing_k = swing_k * ((hour - 13.8) / 24.0 * TAU).cos();
            let temperature_c = by_season(&TEMPERATURE_C, middle) + ANOMALY_K * anomaly + swing_k;
            hours.push((temperature_c, sky * clearness));
            middle += TimeDelta::hours(1);
        }
        Self { start, hours }
    }

    /// Temperature in °C and global horizontal irradiance in W/m² of each hour from `start`.
    #[must_use]
    pub fn hours(&self) -> &[(f64, f64)] {
        &self.hours
    }

    /// Mean, least and largest hourly temperature in K from `start` to `end`.
    pub(crate) fn temperature_k(&self, start: DateTime<Utc>, end: DateTime<Utc>) -> [f64; 3] {
        let index = |t: DateTime<Utc>| ((t - self.start).num_hours().max(0) as usize).min(self.hours.len() - 1);
        let hours = &self.hours[index(start)..=index(end)];
        let kelvin = || hours.iter().map(|(celsius, _)| celsius + 273.15);
        [
            kelvin().sum::<f64>() / hours.len() as f64,
            kelvin().fold(f64::INFINITY, f64::min),
            kelvin().fold(f64::NEG_INFINITY, f64::max),
        ]
    }

    /// One hourly file a decade, as MeteoSwiss cuts them; the stamp is the end of the interval. Diffuse irradiance is
    /// not measured in Zürich, so that column is empty.
    pub(crate) fn files(&self) -> Vec<(String, Vec<u8>)> {
        let mut files: Vec<(String, String)> = Vec::new();
        for (i, (temperature_c, global_w_m2)) in self.hours.iter().enumerate() {
            let begin = self.start + TimeDelta::hours(i as i64);
            let decade = begin.year() / 10 * 10;
            let name = format!("ogd-smn_sma_h_historical_{decade}-{}.csv", decade + 9);
            if files.last().is_none_or(|(last, _)| *last != name) {
                files.push((name, "station_abbr;reference_timestamp;tre200h0;gre000h0;ods000h0\n".to_owned()));
            }
            if let Some((_, text)) = files.last_mut() {
                let stamp = (begin + TimeDelta::hours(1)).format("%d.%m.%Y %H:%M");
                let _ = writeln!(text, "SMA;{stamp};{temperature_c:.1};{global_w_m2:.0};");
            }
        }
        files.into_iter().map(|(name, text)| (name, text.into_bytes())).collect()
    }
}

/// Global irradiance under a clear sky (Haurwitz 1945, J. Meteorol. 2:154; doi
/// 10.1175/1520-0469(1945)002<0154:IIRTCA>2.0.CO;2), for the sine of the solar altitude.
fn clear_sky_w_m2(sine: f64) -> f64 {
    if sine <= 0.0 { 0.0 } else { 1098.0 * sine * (-0.057 / sine).exp() }
}

/// Linear between the middles of the months.
fn by_season(monthly: &[f64; 12], at: DateTime<Utc>) -> f64 {
    let position = f64::from(at.ordinal0()) / 365.25 * 12.0 - 0.5;
    let before = position.floor();
    let value = |month: f64| monthly[month.rem_euclid(12.0) as usize];
    value(before) + (position - before) * (value(before + 1.0) - value(before))
}

/// 0 at midwinter, 1 at midsummer.
fn season(at: DateTime<Utc>) -> f64 {
    0.5 - 0.5 * ((f64::from(at.ordinal0()) + 10.0) / 365.25 * TAU).cos()
}

fn new_year(year: i32) -> DateTime<Utc> {
    Utc.with_ymd_and_hms(year, 1, 1, 0, 0, 0).single().expect("every year that a mission can have begins once")
}
