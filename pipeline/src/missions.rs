//! A mission as a simulation sees it: loads and weather in time, and the optima of its segments.

use cabin::{Cabin, ComfortWindow, Disturbances, LoadChange, Operation, PassengerViews, kelvin};
use chrono::{DateTime, TimeDelta, Utc};
use ingest::sample::Sample;
use simulate::{Mission, Segment};
use std::collections::BTreeMap;
use study::Study;

use crate::{Inputs, PipelineError};

/// The samples of each mission, up to the first segment that gave none; by mission.
pub(crate) fn missions(samples: Vec<Sample>) -> Vec<Vec<Sample>> {
    let mut by_mission: BTreeMap<String, Vec<Sample>> = BTreeMap::new();
    for sample in samples {
        by_mission.entry(sample.segment.mission.clone()).or_default().push(sample);
    }
    let mut missions: Vec<Vec<Sample>> = by_mission.into_values().collect();
    for samples in &mut missions {
        samples.sort_by_key(|s| s.segment.segment);
        let (first, duration_s) = (samples[0].segment.segment, samples[0].segment.duration_s);
        let unbroken =
            |(i, s): &(usize, &Sample)| s.segment.segment == first + *i as u32 && s.segment.duration_s == duration_s;
        let count = samples.iter().enumerate().take_while(unbroken).count();
        samples.truncate(count);
    }
    missions
}

/// From the first to the last second of a mission's samples.
pub(crate) fn span(samples: &[Sample]) -> (DateTime<Utc>, DateTime<Utc>) {
    let (first, last) = (&samples[0].segment, &samples[samples.len() - 1].segment);
    (first.start, last.start + TimeDelta::seconds(i64::from(last.duration_s)))
}

/// The loads of a mission from the start of its first sample on; what happened before holds there.
pub(crate) fn from_first(loads: &[LoadChange], first: &ingest::mission::Segment) -> Vec<LoadChange> {
    let offset_s = first.segment * first.duration_s;
    loads.iter().map(|l| LoadChange { second: l.second.saturating_sub(offset_s), ..*l }).collect()
}

/// A mission's loads and weather in time.
pub(crate) struct MissionInTime<'v> {
    loads: Vec<LoadChange>,
    minutes: Vec<Cabin<'v>>,
    /// The cabin under the mean disturbances of each segment.
    segments: Vec<Cabin<'v>>,
    segment_s: u32,
    door_open_share: f64,
}

impl<'v> MissionInTime<'v> {
    /// `Err` says why the mission cannot be simulated.
    pub fn new(
        study: &'v Study,
        views: &'v PassengerViews,
        inputs: &WeatherAndShade<'_>,
        samples: &[Sample],
        loads: &[LoadChange],
    ) -> Result<Self, String> {
        let first = &samples[0].segment;
        let segment_s = first.duration_s;
        let minutes = inputs.minutes(study, first.start, segment_s * samples.len() as u32)?;
        let cabin = |d: &Disturbances| Cabin::new(&study.vehicle, views, d);
        Ok(Self {
            loads: from_first(loads, first),
            minutes: minutes.iter().map(cabin).collect(),
            segments: samples.iter().map(|s| cabin(&s.disturbances)).collect(),
            segment_s,
            door_open_share: study.missions.door_open_share,
        })
    }

    /// The segments with their optima in one comfort window.
    pub fn segments(&self, optima: &[Operation], window: ComfortWindow) -> Vec<Segment> {
        optima.iter().zip(&self.segments).map(|(optimum, cabin)| Segment::new(cabin, optimum, window)).collect()
    }

    /// The mission as the simulation sees it.
    pub fn mission(&self) -> Mission<'_, 'v> {
        Mission {
            loads: &self.loads,
            minutes: &self.minutes,
            segments: self.segments.len(),
            segment_s: self.segment_s,
            door_open_share: self.door_open_share,
        }
    }
}

/// What the minutes of missions are made of.
#[derive(Clone, Copy)]
pub(crate) struct WeatherAndShade<'i> {
    weather: &'i ingest::weather::Weather,
    shadow: &'i shading::ShadowYear,
}

impl<'i> WeatherAndShade<'i> {
    pub fn of(inputs: &'i Inputs<'_>) -> Result<Self, PipelineError> {
        Ok(Self { weather: &inputs.weather()?.0, shadow: &inputs.shadow()?.0 })
    }

    /// Key of weather and shade from `start` to `end`, and of the intervals beside, from which is interpolated.
    pub fn key(&self, (start, end): (DateTime<Utc>, DateTime<Utc>)) -> String {
        format!("{} {}", self.weather.key(start, end, 1), self.shadow.key(start, end))
    }

    /// Weather and shade in the middle of each minute, with nobody on board and doors shut.
    pub fn minutes(&self, study: &Study, start: DateTime<Utc>, seconds: u32) -> Result<Vec<Disturbances>, String> {
        (0..seconds.div_ceil(60))
            .map(|minute| {
                let at = start + TimeDelta::seconds(60 * i64::from(minute) + 30);
                let here = self.weather.at(at).map_err(|reason| format!("minute {minute}: {reason}"))?;
                Ok(Disturbances {
                    ambient_temperature_k: here.ambient_temperature_k.clamp(kelvin(-70.0), kelvin(60.0)),
                    dni_w_m2: here.dni_w_m2,
                    dhi_w_m2: here.dhi_w_m2,
                    solar_altitude_rad: study.site.sun(at).altitude_rad,
                    shadow_fraction: self.shadow.at(at),
                    passengers: 0.0,
                    door_open_fraction: 0.0,
                })
            })
            .collect()
    }
}
