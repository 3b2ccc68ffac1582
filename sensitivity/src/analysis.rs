//! The year of a bus under inputs that vary: one at a time, and all together.

use cabin::Vehicle;
use rayon::prelude::*;
use solve::{AnnualMean, Grid, YearSamples, YearStates};

use crate::indices::{Index, Resamples, indices};
use crate::variation::Passengers;
use crate::{Input, Quantified, Saltelli, Variation, VariationError};

/// A year with the bus that inputs vary about.
#[derive(Debug)]
pub struct Analysis<'y> {
    base: Variation,
    passengers: Passengers,
    states: YearStates<'y>,
    /// Place of the design that others save against.
    reference: Option<usize>,
    results: Vec<Quantified>,
}

/// What a result comes to where one input has its low or its high value, and all others have that of the bus.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Swing {
    /// Place of the result in [`Analysis::results`].
    pub result: usize,
    /// Place of the input.
    pub input: usize,
    /// The low and the high value of the input.
    pub values: [f64; 2],
    /// The result there; `None` where there is none.
    pub results: [Option<f64>; 2],
}

/// What a result comes to where all inputs vary.
#[derive(Debug, Clone, PartialEq)]
pub struct Spreading {
    /// Place of the result in [`Analysis::results`].
    pub result: usize,
    /// Mean over all points of A and B.
    pub mean: f64,
    /// Standard deviation there.
    pub sd: f64,
    /// Between which values nine tenths of the points lie.
    pub ends: [f64; 2],
    /// The indices of the inputs; `None` where the result does not vary.
    pub indices: Option<Vec<Index>>,
}

/// Sets that are solved between two looks at whether to go on.
const SETS_AT_ONCE: usize = 256;

/// The year in every set of a design.
#[derive(Debug, Clone, PartialEq)]
pub struct Solved {
    /// The results of every set of the design, set by set.
    pub values: Vec<Vec<f64>>,
    /// Points of samples, designs, windows and sets without an operation.
    pub unsolved: u64,
    /// Points of samples, windows and sets that miss the window, of each design by its place.
    pub limited: Vec<u64>,
}

/// Why a study of all inputs has no end.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum AnalysisError {
    /// An input, or a bus with inputs at some values.
    #[error("{at}: {error}")]
    Variation {
        /// Which set.
        at: String,
        /// What is wrong with it.
        error: VariationError,
    },
    /// A set without a result.
    #[error("{0}: no sample has an operation there; give inputs a smaller range")]
    NoResult(String),
    /// Somebody asked to stop.
    #[error("interrupted")]
    Stopped,
}

impl<'y> Analysis<'y> {
    /// The bus at all samples in the windows of a grid; `reference` is the place of the design that others save against.
    #[must_use]
    pub fn new(samples: &'y YearSamples, vehicle: &Vehicle, grid: &'y Grid, reference: Option<usize>) -> Self {
        Self {
            base: Variation::none(vehicle),
            passengers: Passengers::new(vehicle),
            states: YearStates::new(samples, vehicle, grid),
            reference,
            results: Quantified::all(grid, reference),
        }
    }

    /// What is looked at.
    #[must_use]
    pub fn results(&self) -> &[Quantified] {
        &self.results
    }

    /// The bus that inputs vary about.
    #[must_use]
    pub fn base(&self) -> &Variation {
        &self.base
    }

    /// The means of the year of a variation, point by point of the grid.
    ///
    /// # Errors
    /// [`VariationError`] where the bus cannot be.
    pub fn year(&self, variation: &Variation) -> Result<Vec<AnnualMean>, VariationError> {
        let bus = variation.bus(self.states.grid().designs(), &self.passengers)?;
        Ok(self.states.means(&bus, |sample| variation.disturbances(sample)))
    }

    /// The results of a year.
    #[must_use]
    pub fn values(&self, means: &[AnnualMean]) -> Vec<Option<f64>> {
        let windows = self.states.grid().windows().len();
        self.results.iter().map(|result| result.value(means, windows, self.reference)).collect()
    }

    /// The results of the bus itself, and those with one input at its low and its high value, in the order of the inputs.
    ///
    /// # Errors
    /// [`AnalysisError::Variation`] names the input.
    pub fn one_at_a_time(&self, inputs: &[Input]) -> Result<(Vec<Option<f64>>, Vec<Swing>), AnalysisError> {
        let at = |input: &Input, value: f64| {
            let wrong = |error| AnalysisError::Variation { at: format!("{} = {value}", input.name), error };
            let variation = self.base.with([(input.name.as_str(), value)]).map_err(wrong)?;
            Ok(self.values(&self.year(&variation).map_err(wrong)?))
        };
        let wrong = |error| AnalysisError::Variation { at: "the bus itself".to_owned(), error };
        let base = self.values(&self.year(&self.base).map_err(wrong)?);
        let ends: Vec<[f64; 2]> = inputs.iter().map(|input| input.spread.ends()).collect();
        let both: Vec<[Vec<Option<f64>>; 2]> = inputs
            .par_iter()
            .zip(&ends)
            .map(|(input, [low, high])| Ok([at(input, *low)?, at(input, *high)?]))
            .collect::<Result<_, _>>()?;
        let swing = |result: usize, input: usize| {
            let [low, high] = &both[input];
            Swing { result, input, values: ends[input], results: [low[result], high[result]] }
        };
        let swings =
            (0..self.results.len()).flat_map(|result| (0..inputs.len()).map(move |input| swing(result, input)));
        Ok((base, swings.collect()))
    }

    /// Solves the year in every set of a design. `solved` hears how many sets are done, and says whether to go on.
    ///
    /// # Errors
    /// [`AnalysisError`] names the set by its inputs.
    pub fn solve(
        &self,
        inputs: &[Input],
        design: &Saltelli,
        mut solved: impl FnMut(usize) -> bool,
    ) -> Result<Solved, AnalysisError> {
        let grid = self.states.grid();
        let of_set = |set: usize| {
            let values: Vec<f64> = inputs.iter().zip(design.set(set)).map(|(i, u)| i.spread.quantile(u)).collect();
            let named = || inputs.iter().map(|i| i.name.as_str()).zip(values.iter().copied());
            let at = || named().map(|(name, value)| format!("{name} = {value}")).collect::<Vec<_>>().join(", ");
            let wrong = |error| AnalysisError::Variation { at: at(), error };
            let means = self.year(&self.base.with(named()).map_err(wrong)?).map_err(wrong)?;
            let results: Option<Vec<f64>> = self.values(&means).into_iter().collect();
            let unsolved: u64 = means.iter().map(|mean| mean.unsolved).sum();
            let limited: Vec<u64> =
                means.chunks(grid.windows().len()).map(|of| of.iter().map(|mean| mean.limited).sum()).collect();
            Ok((results.ok_or_else(|| AnalysisError::NoResult(at()))?, unsolved, limited))
        };
        let limited = vec![0; grid.designs().len()];
        let mut all = Solved { values: Vec::with_capacity(design.sets()), unsolved: 0, limited };
        while all.values.len() < design.sets() {
            let from = all.values.len();
            let to = (from + SETS_AT_ONCE).min(design.sets());
            let results: Vec<(Vec<f64>, u64, Vec<u64>)> =
                (from..to).into_par_iter().map(of_set).collect::<Result<_, _>>()?;
            for (values, unsolved, limited) in results {
                all.values.push(values);
                all.unsolved += unsolved;
                all.limited.iter_mut().zip(limited).for_each(|(all, of_set)| *all += of_set);
            }
            if !solved(to) {
                return Err(AnalysisError::Stopped);
            }
        }
        Ok(all)
    }

    /// What solved sets say of every result.
    #[must_use]
    pub fn spreadings(&self, design: &Saltelli, solved: &Solved, resamples: &Resamples) -> Vec<Spreading> {
        let of_result = |result: usize| {
            let values: Vec<f64> = solved.values.iter().map(|of_set| of_set[result]).collect();
            let of_both = |row: &[f64]| [row[0], row[row.len() - 1]];
            let mut independent: Vec<f64> = values.chunks(design.sets_a_point()).flat_map(of_both).collect();
            let n = independent.len() as f64;
            let mean = independent.iter().sum::<f64>() / n;
            let variance = independent.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / n;
            independent.sort_by(f64::total_cmp);
            let cut = (independent.len() - 1) * 5 / 100;
            let ends = [independent[cut], independent[independent.len() - 1 - cut]];
            let indices = indices(design, &values, resamples);
            Spreading { result, mean, sd: variance.sqrt(), ends, indices }
        };
        (0..self.results.len()).into_par_iter().map(of_result).collect()
    }
}
