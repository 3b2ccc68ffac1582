//! Hourly samples: a segment of a mission with its weather, sun and shade.

use chrono::{DateTime, Datelike, TimeDelta, Utc};
use chrono_tz::Tz;
use shading::{ShadowYear, Site};

use crate::mission::Segment;
use crate::weather::Weather;
use crate::{ExcludedSegment, ExclusionReason};

/// Disturbances of one segment, and where they come from.
#[derive(Debug, Clone, PartialEq)]
pub struct Sample {
    /// Bus × 10¹⁰ + start in seconds since 1970: a bus is at one place at a time.
    pub id: i64,
    /// The segment: mission, start, passengers, doors, lines of the file.
    pub segment: Segment,
    /// Local month, 1 … 12.
    pub month: u8,
    /// Mean ambient temperature in K.
    pub ambient_temperature_k: f64,
    /// Mean direct normal irradiance in W/m².
    pub dni_w_m2: f64,
    /// Mean diffuse horizontal irradiance in W/m².
    pub dhi_w_m2: f64,
    /// Solar altitude in the middle of the segment, in rad.
    pub solar_altitude_rad: f64,
    /// Solar azimuth in the middle of the segment, in rad from north.
    pub solar_azimuth_rad: f64,
    /// Mean shadow fraction.
    pub shadow_fraction: f64,
    /// Seconds whose weather is interpolated.
    pub interpolated_s: f64,
}

/// The sample of a segment.
///
/// # Errors
/// Why the segment gives none.
pub fn assemble(
    segment: Segment,
    weather: &Weather,
    site: &Site,
    shadow: &ShadowYear,
    zone: Tz,
) -> Result<Sample, ExcludedSegment> {
    let length = TimeDelta::seconds(i64::from(segment.duration_s));
    let (start, end) = (segment.start, segment.start + length);
    match weather.mean(start, end) {
        Ok(mean) => {
            let sun = site.sun(start + length / 2);
            Ok(Sample {
                id: sample_id(segment.bus, start),
                month: start.with_timezone(&zone).month() as u8,
                ambient_temperature_k: mean.ambient_temperature_k,
                dni_w_m2: mean.dni_w_m2,
                dhi_w_m2: mean.dhi_w_m2,
                solar_altitude_rad: sun.altitude_rad,
                solar_azimuth_rad: sun.azimuth_rad,
                shadow_fraction: shadow.mean(start, end),
                interpolated_s: mean.interpolated_s,
                segment,
            })
        }
        Err(reason) => Err(excluded(segment, reason)),
    }
}

fn excluded(segment: Segment, reason: ExclusionReason) -> ExcludedSegment {
    ExcludedSegment { mission: segment.mission, segment: segment.segment, start: segment.start, reason }
}

/// Bus × 10¹⁰ + start in seconds since 1970.
#[must_use]
pub fn sample_id(bus: u32, start: DateTime<Utc>) -> i64 {
    i64::from(bus) * 10_000_000_000 + start.timestamp()
}
