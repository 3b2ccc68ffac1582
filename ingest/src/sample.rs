//! Hourly samples: a segment of a mission with its weather, sun and shade.

use cabin::Disturbances;
use chrono::{DateTime, Datelike, TimeDelta, Timelike, Utc};
use chrono_tz::Tz;
use shading::{ShadowYear, Site};

use crate::ExcludedSegment;
use crate::mission::Segment;
use crate::weather::Weather;

/// Version of the join: it changes whenever a sample would come out differently.
const SAMPLE_VERSION: u32 = 1;

/// Disturbances of one segment, and where they come from.
#[derive(Debug, Clone, PartialEq)]
pub struct Sample {
    /// Bus × 10¹⁰ + start in seconds since 1970: a bus is at one place at a time.
    pub id: i64,
    /// The segment: mission, start, lines of the file.
    pub segment: Segment,
    /// Local month, 1 … 12.
    pub month: u8,
    /// Means over the segment; the sun stands where it stands in its middle.
    pub disturbances: Disturbances,
    /// Solar azimuth in the middle of the segment, in rad from north.
    pub solar_azimuth_rad: f64,
    /// Seconds whose weather is interpolated.
    pub interpolated_s: f64,
    /// Local time of its start; `None` where it was not noted.
    pub clock: Option<LocalClock>,
    /// What the sample was made from, as a hash: the reading of its mission, weather and shade of its hours, place and time zone.
    pub key: String,
}

/// When something begins, by the clock on the wall.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LocalClock {
    /// Hour, 0 … 23.
    pub hour: u8,
    /// 1 Monday … 7 Sunday.
    pub weekday: u8,
}

/// What segments are joined with.
#[derive(Debug, Clone, Copy)]
pub struct Surroundings<'a> {
    /// Weather.
    pub weather: &'a Weather,
    /// Shade.
    pub shadow: &'a ShadowYear,
    /// Where the sun is looked up.
    pub site: &'a Site,
    /// Whose months count.
    pub zone: Tz,
}

impl Surroundings<'_> {
    /// The sample of a segment, from a mission whose reading has a key.
    ///
    /// # Errors
    /// The segment with the reason why it gives none.
    pub fn sample(&self, segment: Segment, reading_key: &str) -> Result<Sample, ExcludedSegment> {
        let length = TimeDelta::seconds(i64::from(segment.duration_s));
        let (start, end) = (segment.start, segment.start + length);
        let mean = match self.weather.mean(start, end) {
            Ok(mean) => mean,
            Err(reason) => return Err(excluded(segment, reason.to_string())),
        };
        let sun = self.site.sun(start + length / 2);
        let disturbances = Disturbances {
            ambient_temperature_k: mean.ambient_temperature_k,
            dni_w_m2: mean.dni_w_m2,
            dhi_w_m2: mean.dhi_w_m2,
            solar_altitude_rad: sun.altitude_rad,
            shadow_fraction: self.shadow.mean(start, end),
            passengers: segment.passengers,
            door_open_fraction: segment.door_open_fraction,
        };
        if let Err(error) = disturbances.check() {
            return Err(excluded(segment, error.to_string()));
        }
        let local = start.with_timezone(&self.zone);
        Ok(Sample {
            id: sample_id(segment.bus, start),
            month: month(start, self.zone),
            disturbances,
            solar_azimuth_rad: sun.azimuth_rad,
            interpolated_s: mean.interpolated_s,
            clock: Some(LocalClock { hour: local.hour() as u8, weekday: local.weekday().number_from_monday() as u8 }),
            key: self.key(&segment, reading_key, start, end),
            segment,
        })
    }

    fn key(&self, segment: &Segment, reading_key: &str, start: DateTime<Utc>, end: DateTime<Utc>) -> String {
        let mut hasher = blake3::Hasher::new();
        hasher.update(reading_key.as_bytes());
        hasher.update(self.weather.key(start, end, 0).as_bytes());
        hasher.update(self.shadow.key(start, end).as_bytes());
        let place = format!("{} {:?} {} {SAMPLE_VERSION}", segment.segment, self.site, self.zone);
        hasher.update(place.as_bytes());
        hasher.finalize().to_hex().to_string()
    }
}

fn excluded(segment: Segment, reason: String) -> ExcludedSegment {
    ExcludedSegment {
        mission: segment.mission,
        bus: segment.bus,
        segment: segment.segment,
        start: segment.start,
        duration_s: segment.duration_s,
        reason,
    }
}

/// The month that an instant lies in by the clock on the wall, 1 … 12.
#[must_use]
pub fn month(instant: DateTime<Utc>, zone: Tz) -> u8 {
    instant.with_timezone(&zone).month() as u8
}

/// Bus × 10¹⁰ + start in seconds since 1970.
#[must_use]
pub fn sample_id(bus: u32, start: DateTime<Utc>) -> i64 {
    i64::from(bus) * 10_000_000_000 + start.timestamp()
}
