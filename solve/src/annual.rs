//! What designs and windows come to in a year, from samples that are solved and added up, none of them kept: for studies of more
//! points than anybody stores.

use cabin::{Disturbances, OperatingMode, Optimum, PassengerViews, Vehicle};
use rayon::prelude::*;

use crate::sum::Sum;
use crate::{Grid, PowerSums, SampleSolver};

/// Days of the months in a year without 29 February (paper, eq. meanPower).
pub const DAYS_OF_MONTH: [f64; 12] = [31.0, 28.0, 31.0, 30.0, 31.0, 30.0, 31.0, 31.0, 30.0, 31.0, 30.0, 31.0];

/// Samples of a year by their months, within one in the order given.
#[derive(Debug, Clone, Default)]
pub struct YearSamples {
    months: [Vec<Disturbances>; 12],
}

/// What a design and window come to in a year.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AnnualMean {
    /// Mean HVAC power in W; `None` where no sample has an operation, as the two parts of it.
    pub hvac_power_w: Option<f64>,
    /// Of that, in samples whose air unit heats or rests, in W.
    pub heating_power_w: Option<f64>,
    /// In samples whose air unit cools, in W.
    pub cooling_power_w: Option<f64>,
    /// Samples.
    pub samples: u64,
    /// Of these without an operation.
    pub unsolved: u64,
    /// Of these with one that misses the window, within the design's limits the nearest.
    pub limited: u64,
}

/// What a design does in a sample.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Used {
    pub mode: OperatingMode,
    pub hvac_power_w: f64,
    /// Whether it misses the window.
    pub is_limited: bool,
}

impl YearSamples {
    /// Adds a sample of a local month, 1 … 12; `false` where there is no such month.
    pub fn add(&mut self, month: u8, disturbances: Disturbances) -> bool {
        let place = usize::from(month).wrapping_sub(1);
        self.months.get_mut(place).map(|of_month| of_month.push(disturbances)).is_some()
    }

    /// Solves every sample and gives the means of the year, design by design, each with its windows in the grid's order: months by
    /// their days, within one all solved samples alike (paper, eq. meanPower); months without any do not weigh. Sums are
    /// compensated (Neumaier, DOI 10.1002/zamm.19740540106), as those of SQLite, and do not depend on the number of threads.
    #[must_use]
    pub fn means(&self, vehicle: &Vehicle, grid: &Grid) -> Vec<AnnualMean> {
        let views = PassengerViews::new(vehicle);
        let months: Vec<Vec<MonthSum>> =
            self.months.par_iter().map(|samples| month(vehicle, &views, grid, samples)).collect();
        year(grid.points(), &months)
    }

    /// The samples of each month.
    pub(crate) fn months(&self) -> &[Vec<Disturbances>; 12] {
        &self.months
    }
}

/// The means of the year of so many points from the sums of its months.
pub(crate) fn year(points: usize, months: &[Vec<MonthSum>]) -> Vec<AnnualMean> {
    (0..points).map(|point| annual(months.iter().map(|of_points| &of_points[point]))).collect()
}

/// Sums over the samples of a month.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct MonthSum {
    samples: u64,
    limited: u64,
    powers: PowerSums,
}

fn month(vehicle: &Vehicle, views: &PassengerViews, grid: &Grid, samples: &[Disturbances]) -> Vec<MonthSum> {
    let mut solver = SampleSolver::new(vehicle, views, grid);
    let mut optima = vec![Optimum::UNSOLVED; grid.points()];
    let mut sums = vec![MonthSum::default(); grid.points()];
    for sample in samples {
        solver.solve(sample, &mut optima);
        for (sum, optimum) in sums.iter_mut().zip(&optima) {
            sum.add(optimum.outcome.operation().map(|o| Used {
                mode: o.mode,
                hvac_power_w: o.hvac_power_w(),
                is_limited: o.is_limited(),
            }));
        }
    }
    sums
}

impl MonthSum {
    /// A sample with what the design does, where there is an operation.
    pub fn add(&mut self, used: Option<Used>) {
        self.samples += 1;
        let Some(used) = used else { return };
        self.limited += u64::from(used.is_limited);
        self.powers.add(used.mode, used.hvac_power_w);
    }
}

fn annual<'m>(months: impl Iterator<Item = &'m MonthSum>) -> AnnualMean {
    let (mut days, mut sums) = (Sum::default(), [Sum::default(); 3]);
    let (mut samples, mut unsolved, mut limited) = (0, 0, 0);
    for (of_month, days_of_month) in months.zip(DAYS_OF_MONTH) {
        samples += of_month.samples;
        unsolved += of_month.samples - of_month.powers.solved();
        limited += of_month.limited;
        let Some(means_w) = of_month.powers.means_w() else { continue };
        days.add(days_of_month);
        for (sum, mean_w) in sums.iter_mut().zip(means_w) {
            sum.add(mean_w * days_of_month);
        }
    }
    let [hvac_power_w, heating_power_w, cooling_power_w] =
        sums.map(|sum| (days.value() > 0.0).then(|| sum.value() / days.value()));
    AnnualMean { hvac_power_w, heating_power_w, cooling_power_w, samples, unsolved, limited }
}
