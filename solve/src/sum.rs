//! Powers of many operations, added up without losing small numbers.

use cabin::OperatingMode;

/// HVAC powers of solved samples, in all and by what the air unit does.
#[derive(Debug, Clone, Copy, Default)]
pub struct PowerSums {
    solved: u64,
    all_w: Sum,
    heating_w: Sum,
    cooling_w: Sum,
}

impl PowerSums {
    /// Adds a solved sample, with its HVAC power in W. Heaters and curtain count to the side on which the air unit works; alone
    /// they heat.
    pub fn add(&mut self, mode: OperatingMode, hvac_power_w: f64) {
        self.solved += 1;
        self.all_w.add(hvac_power_w);
        match mode {
            OperatingMode::Heating | OperatingMode::Passive => self.heating_w.add(hvac_power_w),
            OperatingMode::Cooling => self.cooling_w.add(hvac_power_w),
        }
    }

    /// Solved samples.
    #[must_use]
    pub fn solved(&self) -> u64 {
        self.solved
    }

    /// Mean power over them in W, and its parts in heating and in cooling; `None` where there is none.
    #[must_use]
    pub fn means_w(&self) -> Option<[f64; 3]> {
        let sums = [self.all_w, self.heating_w, self.cooling_w];
        (self.solved > 0).then(|| sums.map(|sum| sum.value() / self.solved as f64))
    }
}

/// A compensated sum (Neumaier, DOI 10.1002/zamm.19740540106), to the last bit that of SQLite.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Sum {
    sum: f64,
    lost: f64,
}

impl Sum {
    pub fn add(&mut self, value: f64) {
        let next = self.sum + value;
        self.lost += if self.sum.abs() > value.abs() { (self.sum - next) + value } else { (value - next) + self.sum };
        self.sum = next;
    }

    pub fn value(self) -> f64 {
        self.sum + self.lost
    }
}

#[cfg(test)]
mod tests {
    use super::Sum;

    #[test]
    fn prop_a_sum_keeps_what_a_plain_one_loses() {
        let mut sum = Sum::default();
        for value in [1e16, 1.0, -1e16, 1.0] {
            sum.add(value);
        }
        assert_eq!(sum.value(), 2.0);
    }
}
