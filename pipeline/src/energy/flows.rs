//! Mean heat flows of a month, and what is asked above the vehicle's power limits.

use cabin::{Cabin, HeatFlows, OperatingMode, Operation};
use store::{AirUnitSide, MonthFlows};

/// Sums of a month that is being added up, by design and window.
pub struct Flows(Vec<Sum>);

#[derive(Clone)]
struct Sum {
    samples: u64,
    flows: HeatFlows,
    heating: Side,
    cooling: Side,
    over_limit: u64,
    unmet_heat_w: f64,
}

#[derive(Clone, Default)]
struct Side {
    samples: u64,
    lift_k: f64,
    heat_w: f64,
    power_w: f64,
}

impl Flows {
    pub fn new(points: usize) -> Self {
        let none = Sum {
            samples: 0,
            flows: HeatFlows::ZERO,
            heating: Side::default(),
            cooling: Side::default(),
            over_limit: 0,
            unmet_heat_w: 0.0,
        };
        Self(vec![none; points])
    }

    /// Counts an optimum; limits in heating and cooling in W of electric power.
    pub fn add(&mut self, point: usize, cabin: &Cabin<'_>, o: &Operation, [heating_w, cooling_w]: [f64; 2]) {
        let flows = cabin.flows(&o.temperatures, o.devices.air_curtain, o.air_unit_heat_w, o.radiant_heater_power_w);
        let sum = &mut self.0[point];
        sum.samples += 1;
        sum.flows = sum.flows.plus(1.0, &flows);
        let warmer_k = o.temperatures.cabin_k - cabin.ambient_k();
        let (side, lift_k, limit_w) = match o.mode {
            OperatingMode::Heating => (&mut sum.heating, warmer_k, heating_w),
            OperatingMode::Cooling => (&mut sum.cooling, -warmer_k, cooling_w),
            OperatingMode::Passive => return,
        };
        let heat_w = o.air_unit_heat_w.abs();
        side.samples += 1;
        side.lift_k += lift_k;
        side.heat_w += heat_w;
        side.power_w += o.air_unit_power_w;
        if o.air_unit_power_w > limit_w {
            sum.over_limit += 1;
            sum.unmet_heat_w += heat_w * (1.0 - limit_w / o.air_unit_power_w);
        }
    }

    /// The means of those with solved samples.
    pub fn finish(self, month: u8, windows: usize) -> Vec<MonthFlows> {
        let mean = |(point, sum): (usize, Sum)| MonthFlows {
            month,
            design: point / windows,
            window: point % windows,
            samples: sum.samples,
            flows: HeatFlows::ZERO.plus(1.0 / sum.samples as f64, &sum.flows),
            heating: sum.heating.mean(),
            cooling: sum.cooling.mean(),
            over_limit: sum.over_limit,
            unmet_heat_w: sum.unmet_heat_w / sum.samples as f64,
        };
        self.0.into_iter().enumerate().filter(|(_, sum)| sum.samples > 0).map(mean).collect()
    }
}

impl Side {
    fn mean(&self) -> Option<AirUnitSide> {
        let runs = self.samples > 0 && self.power_w > 0.0;
        runs.then(|| AirUnitSide { lift_k: self.lift_k / self.samples as f64, cop: self.heat_w / self.power_w })
    }
}
