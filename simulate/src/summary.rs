//! What a simulation comes to, added up second by second.

use cabin::{Lanes, OperatingMode, Real};

use crate::control::Demand;
use crate::{BusState, Rides, Segment, Used};

/// What a simulation comes to, beside what the steady-state optima foresee.
#[derive(Debug, Clone, PartialEq)]
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
    /// Root mean square of cabin temperature less setpoint in K, while the optimum, or a causal controller, has the air unit on.
    pub tracking_error_k: f64,
    /// How its passengers fare.
    pub rides: Rides,
    /// What it has used of its design.
    pub used: Used,
    /// Temperatures and air unit at the end.
    pub end: BusState,
}

impl Summary {
    /// The same drive, beside other optima.
    pub(crate) fn beside(&self, segments: &[Segment]) -> Self {
        Self {
            static_mean_hvac_power_w: mean_power_w(segments),
            static_max_abs_pmv: max_abs_vote(segments),
            ..self.clone()
        }
    }
}

fn mean_power_w(segments: &[Segment]) -> f64 {
    segments.iter().map(|s| s.optimum.hvac_power_w()).sum::<f64>() / segments.len() as f64
}

fn max_abs_vote(segments: &[Segment]) -> f64 {
    segments.iter().map(|s| s.optimum.pmv.abs()).fold(0.0, f64::max)
}

/// What is added up over a mission.
#[derive(Debug, Clone)]
pub(crate) struct Sums<const W: usize> {
    energy_j: Lanes<W>,
    saturated_s: Lanes<W>,
    square_error: Lanes<W>,
    /// Seconds in which the optimum has the air unit on.
    tracked_s: Lanes<W>,
    /// For now: 1 where it has, and the cabin temperature that it prescribes in K.
    tracked: Lanes<W>,
    prescribed_k: Lanes<W>,
}

impl<const W: usize> Sums<W> {
    pub fn new() -> Self {
        Self {
            energy_j: Lanes::ZERO,
            saturated_s: Lanes::ZERO,
            square_error: Lanes::ZERO,
            tracked_s: Lanes::ZERO,
            tracked: Lanes::ZERO,
            prescribed_k: Lanes::ZERO,
        }
    }

    /// A lane begins a segment.
    pub fn begin(&mut self, lane: usize, segment: &Segment) {
        self.tracked.0[lane] = f64::from(u8::from(segment.optimum.mode != OperatingMode::Passive));
        self.prescribed_k.0[lane] = segment.optimum.temperatures.cabin_k;
    }

    /// A lane follows a setpoint of its own: the sign of its mode, and the setpoint in K.
    pub fn track(&mut self, lane: usize, (sign, setpoint_k): (f64, f64)) {
        self.tracked.0[lane] = sign.abs();
        self.prescribed_k.0[lane] = setpoint_k;
    }

    /// Adds a second: its demand, the power of the air curtains in W, and the cabin at its end.
    #[inline(always)]
    pub fn add(&mut self, demand: &Demand<W>, air_curtain_power_w: Lanes<W>, cabin: Lanes<W>) {
        let power_w = demand.air_unit_power_w.abs() + demand.radiant_heater_power_w + air_curtain_power_w;
        self.energy_j = self.energy_j + power_w;
        self.saturated_s = self.saturated_s + demand.held_back;
        let error_k = cabin - self.prescribed_k;
        self.square_error = (error_k * error_k).mul_add(self.tracked, self.square_error);
        self.tracked_s = self.tracked_s + self.tracked;
    }

    /// What a lane comes to.
    pub fn summary(
        &self,
        lane: usize,
        seconds: u32,
        segments: &[Segment],
        (max_abs_pmv_15min, rides): (Option<f64>, Rides),
        (used, end): (Used, BusState),
    ) -> Summary {
        debug_assert!(lane < W);
        let of = |sum: &Lanes<W>| sum.0[lane];
        Summary {
            seconds,
            mean_hvac_power_w: of(&self.energy_j) / f64::from(seconds),
            static_mean_hvac_power_w: mean_power_w(segments),
            max_abs_pmv_15min,
            static_max_abs_pmv: max_abs_vote(segments),
            saturated_fraction: of(&self.saturated_s) / f64::from(seconds),
            tracking_error_k: (of(&self.square_error) / of(&self.tracked_s).max(1.0)).sqrt(),
            rides,
            used: Used { limit: of(&self.saturated_s) > 0.0, ..used },
            end,
        }
    }
}
