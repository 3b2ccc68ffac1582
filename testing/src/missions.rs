//! Missions of a year: hours of [`year`] in time, with stops, and the optima of all designs in the simulated windows.

use cabin::{Cabin, ComfortWindow, Design, Disturbances, LoadChange, PassengerViews, Vehicle};
use simulate::{Mission, Replay, Segment, Variant};

use crate::{optimum, year};

/// The limits of the windows that a study simulates by default.
pub const SIMULATED_LIMITS: [f64; 5] = [0.0, 0.5, 1.0, 1.5, 2.0];

/// A mission with the optima of its hours.
pub struct TestMission<'v> {
    loads: Vec<LoadChange>,
    minutes: Vec<Cabin<'v>>,
    hours: usize,
    /// Place of the design, and its optima in one of the windows.
    points: Vec<(usize, Vec<Segment>)>,
}

impl<'v> TestMission<'v> {
    /// The mission of some hours that begins with an hour of the year.
    ///
    /// # Panics
    /// Where the year ends before it.
    #[must_use]
    pub fn new(vehicle: &Vehicle, views: &'v PassengerViews, designs: &[Design], first: usize, hours: usize) -> Self {
        let days = &year()[first..first + hours];
        let minute = |minute: usize| {
            // Between the middles of the hours the weather is linear.
            let place = ((minute as f64 + 0.5) / 60.0 - 0.5).clamp(0.0, (hours - 1) as f64);
            let before = (place as usize).min(hours.saturating_sub(2));
            let (a, b) = (&days[before], &days[(before + 1).min(hours - 1)]);
            let mix = |f: fn(&Disturbances) -> f64| f(a) + (place - before as f64) * (f(b) - f(a));
            let disturbances = Disturbances {
                ambient_temperature_k: mix(|d| d.ambient_temperature_k),
                dni_w_m2: mix(|d| d.dni_w_m2),
                dhi_w_m2: mix(|d| d.dhi_w_m2),
                solar_altitude_rad: mix(|d| d.solar_altitude_rad),
                shadow_fraction: mix(|d| d.shadow_fraction),
                passengers: 0.0,
                door_open_fraction: 0.0,
            };
            Cabin::new(vehicle, views, &disturbances)
        };
        let points = (0..designs.len()).flat_map(|d| SIMULATED_LIMITS.map(|limit| (d, limit)));
        let point = |(d, limit): (usize, f64)| {
            let window = ComfortWindow::symmetric(limit).expect("a limit on the scale");
            let segment = |day: &Disturbances| {
                let optimum = optimum(vehicle, views, &designs[d], day, limit);
                Segment::new(&Cabin::new(vehicle, views, day), &optimum, window)
            };
            (d, days.iter().map(segment).collect())
        };
        Self {
            loads: stops(days),
            minutes: (0..60 * hours).map(minute).collect(),
            hours,
            points: points.map(point).collect(),
        }
    }

    /// As the simulation sees it.
    #[must_use]
    pub fn mission(&self) -> Mission<'_, 'v> {
        Mission {
            loads: &self.loads,
            minutes: &self.minutes,
            segments: self.hours,
            segment_s: 3600,
            door_open_share: 0.6,
        }
    }

    /// Every design in every window in every replay.
    #[must_use]
    pub fn variants<'m>(&'m self, designs: &'m [Design]) -> Vec<Variant<'m>> {
        self.points.iter().flat_map(|(d, segments)| Replay::ALL.map(|r| r.of(&designs[*d], segments))).collect()
    }
}

/// Some thirty stops an hour, of 7 to 40 seconds; the hours have on average what their disturbances say.
fn stops(days: &[Disturbances]) -> Vec<LoadChange> {
    let mut loads = Vec::new();
    for (hour, day) in days.iter().enumerate() {
        let (mut second, mut n) = (0.0, 0_u32);
        while second < 3600.0 {
            let spread = 0.5 + f64::from((n * 7 + hour as u32 * 5) % 11) / 11.0;
            let open_s = (120.0 * day.door_open_fraction / 0.6 * spread).max(7.0);
            let at = |s: f64| (hour as f64 * 3600.0 + s).round() as u32;
            let passengers = (day.passengers * (0.5 + f64::from((n * 5) % 7) / 6.0)).round();
            loads.push(LoadChange { second: at(second), passengers, door_open: 1.0 });
            loads.push(LoadChange { second: at(second + open_s), passengers, door_open: 0.0 });
            second += 120.0 * (0.7 + f64::from((n * 3) % 7) / 10.0);
            n += 1;
        }
    }
    loads.sort_by_key(|l| l.second);
    loads
}
