//! A mission in time, condensed to a value a minute.

use cabin::Cabin;

use crate::{Instant, Mission};

/// Means over a minute of a simulated mission.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TraceMinute {
    /// Minute since the start of the mission's first segment.
    pub minute: u32,
    /// Ambient temperature in K.
    pub ambient_k: f64,
    /// Passengers on board.
    pub passengers: f64,
    /// Fraction of the doors that is open.
    pub door_open_fraction: f64,
    /// Cabin air in K.
    pub cabin_k: f64,
    /// Interior in K.
    pub interior_k: f64,
    /// Inside of the shell in K.
    pub shell_inside_k: f64,
    /// Outside of the shell in K.
    pub shell_outside_k: f64,
    /// Radiant heaters in K.
    pub radiant_heater_k: f64,
    /// Mean vote of the passengers.
    pub pmv: f64,
    /// Its mean over the last 15 minutes.
    pub pmv_15min: f64,
    /// Electric power of the air unit in W; negative where it cools.
    pub air_unit_power_w: f64,
    /// Electric power of the radiant heaters in W.
    pub radiant_heater_power_w: f64,
    /// Electric power of the air curtains in W.
    pub air_curtain_power_w: f64,
    /// All electric power in W.
    pub hvac_power_w: f64,
}

/// Quantities of a second that are averaged.
const QUANTITIES: usize = 13;

/// Takes a mission's seconds and keeps its minutes.
#[derive(Debug, Clone, Default)]
pub struct Trace(Vec<Minute>);

/// A mean as the first value and how far the others are from it on average: a value that does not change stays itself.
#[derive(Debug, Clone, Copy, Default)]
struct Minute {
    first: [f64; QUANTITIES],
    beyond: [f64; QUANTITIES],
    seconds: u32,
}

impl Trace {
    /// Adds the second that follows.
    pub fn add(&mut self, now: &Instant) {
        let values = quantities(now);
        match self.0.last_mut().filter(|m| m.seconds < 60) {
            Some(minute) => {
                minute.seconds += 1;
                for ((beyond, value), first) in minute.beyond.iter_mut().zip(values).zip(minute.first) {
                    *beyond += value - first;
                }
            }
            None => self.0.push(Minute { first: values, seconds: 1, ..Minute::default() }),
        }
    }

    /// The means of all minutes, with the weather of the mission.
    #[must_use]
    pub fn finish(&self, mission: &Mission<'_, '_>) -> Vec<TraceMinute> {
        let minute = |(i, (minute, cabin)): (usize, (&Minute, &Cabin<'_>))| {
            let mean = |i: usize| minute.first[i] + minute.beyond[i] / f64::from(minute.seconds);
            TraceMinute {
                minute: i as u32,
                ambient_k: cabin.ambient_k(),
                passengers: mean(0),
                door_open_fraction: mean(1),
                cabin_k: mean(2),
                interior_k: mean(3),
                shell_inside_k: mean(4),
                shell_outside_k: mean(5),
                radiant_heater_k: mean(6),
                pmv: mean(7),
                pmv_15min: mean(8),
                air_unit_power_w: mean(9),
                radiant_heater_power_w: mean(10),
                air_curtain_power_w: mean(11),
                hvac_power_w: mean(12),
            }
        };
        self.0.iter().zip(mission.minutes).enumerate().map(minute).collect()
    }
}

/// In the order in which [`Trace::finish`] takes them.
fn quantities(now: &Instant) -> [f64; QUANTITIES] {
    let (t, c) = (&now.state.temperatures, &now.commands);
    [
        now.passengers,
        now.door_open_fraction,
        t.cabin_k,
        t.interior_k,
        t.shell_inside_k,
        t.shell_outside_k,
        t.radiant_heater_k,
        now.pmv,
        now.pmv_15min,
        c.air_unit_power_w,
        c.radiant_heater_power_w,
        now.air_curtain_power_w,
        now.hvac_power_w(),
    ]
}
