//! What a simulation comes to, added up second by second.

use cabin::OperatingMode;

use crate::average::MovingAverage;
use crate::{BusState, Instant, Mission, Segment};

/// What a simulation comes to, beside what the steady-state optima foresee.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Summary {
    /// Simulated seconds.
    pub seconds: u32,
    /// Mean HVAC power in W (eq. `power-time-average`).
    pub mean_hvac_power_w: f64,
    /// The same of the steady-state optima in W.
    pub static_mean_hvac_power_w: f64,
    /// Largest absolute value of the 15-minute mean vote while at least one passenger is on board; `None` where none ever is.
    pub max_abs_pmv_15min: Option<f64>,
    /// Largest absolute vote of the steady-state optima.
    pub static_max_abs_pmv: f64,
    /// Share of the time in which the air unit wants more than its limit allows.
    pub saturated_fraction: f64,
    /// Root mean square of cabin temperature less setpoint in K, while the air unit is on.
    pub tracking_error_k: f64,
    /// Temperatures and air unit at the end.
    pub end: BusState,
}

/// What is added up over a mission.
pub(crate) struct Sums {
    pub average: MovingAverage,
    seconds: u32,
    energy_j: f64,
    saturated_s: u32,
    max_abs_pmv: Option<f64>,
    tracked_s: u32,
    square_error: f64,
}

impl Sums {
    pub fn new() -> Self {
        Self {
            average: MovingAverage::new(),
            seconds: 0,
            energy_j: 0.0,
            saturated_s: 0,
            max_abs_pmv: None,
            tracked_s: 0,
            square_error: 0.0,
        }
    }

    pub fn add(&mut self, now: &Instant, segment: &Segment, held_back: bool) {
        self.seconds += 1;
        self.energy_j += now.hvac_power_w();
        self.saturated_s += u32::from(held_back);
        if now.passengers >= 1.0 {
            let pmv = now.pmv_15min.abs();
            self.max_abs_pmv = Some(self.max_abs_pmv.map_or(pmv, |m| m.max(pmv)));
        }
        if segment.optimum.mode != OperatingMode::Passive {
            let error_k = now.state.temperatures.cabin_k - segment.optimum.temperatures.cabin_k;
            self.tracked_s += 1;
            self.square_error += error_k * error_k;
        }
    }

    pub fn summary(&self, mission: &Mission<'_, '_>, end: BusState) -> Summary {
        let count = mission.segments.len() as f64;
        let share = |part: u32, of: u32| if of > 0 { f64::from(part) / f64::from(of) } else { 0.0 };
        let tracked = f64::from(self.tracked_s.max(1));
        Summary {
            seconds: self.seconds,
            mean_hvac_power_w: self.energy_j / f64::from(self.seconds.max(1)),
            static_mean_hvac_power_w: mission.segments.iter().map(|s| s.optimum.hvac_power_w()).sum::<f64>() / count,
            max_abs_pmv_15min: self.max_abs_pmv,
            static_max_abs_pmv: mission.segments.iter().map(|s| s.optimum.pmv.abs()).fold(0.0, f64::max),
            saturated_fraction: share(self.saturated_s, self.seconds),
            tracking_error_k: (self.square_error / tracked).sqrt(),
            end,
        }
    }
}
