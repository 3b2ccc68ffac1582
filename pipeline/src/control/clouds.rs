//! The optima as a controller sees them, and what it learns from all years or some.

use chrono::Datelike;
use ingest::sample::Sample;
use rayon::prelude::*;
use setpoints::{Hour, Setpoints, extract};
use std::collections::BTreeMap;
use store::{SetpointRow, Store, StoredGrid, StoredOptimum};
use study::Study;

use crate::PipelineError;
use crate::in_order::in_order;
use crate::readers::{Reader, blocks};

/// The optimum of an hour of a local year and month; it weighs nothing yet.
#[derive(Debug, Clone, Copy)]
struct Seen {
    year: i32,
    month: u8,
    hour: Hour,
}

/// The solved hours of every design and window.
pub(super) struct Clouds<'s> {
    study: &'s Study,
    cells: Vec<Vec<Seen>>,
    /// Share of a month in the year, by number of the month.
    shares: BTreeMap<u8, f64>,
    /// Samples by year and month.
    samples: BTreeMap<(i32, u8), u64>,
}

/// The local year of a sample.
pub(super) fn year(study: &Study, sample: &Sample) -> i32 {
    sample.segment.start.with_timezone(&study.zone).year()
}

/// A stored optimum of a block of samples, with the place of its design and window; `None` where there is no operation.
fn seen(study: &Study, block: &[&Sample], row: &StoredOptimum) -> Option<(usize, Seen)> {
    let o = row.outcome.as_ref()?.operation()?;
    let sample = block[block.binary_search_by_key(&row.sample_id, |s| s.id).ok()?];
    let hour = Hour {
        mode: o.mode,
        ambient_k: sample.disturbances.ambient_temperature_k,
        cabin_k: o.temperatures.cabin_k,
        curtain: o.devices.air_curtain,
        heaters_k: o.devices.radiant_heaters.then_some(o.temperatures.radiant_heater_k),
        weight: 0.0,
    };
    let cell = row.design * study.grid.windows().len() + row.window;
    Some((cell, Seen { year: year(study, sample), month: sample.month, hour }))
}

impl<'s> Clouds<'s> {
    /// Reads the optima of all samples; the stored grid is that of the study.
    pub fn read(
        study: &'s Study,
        store: &mut Store,
        grid: &StoredGrid,
        samples: &[Sample],
    ) -> Result<Self, PipelineError> {
        let shares = store.months()?.into_iter().map(|m| (m.month, m.sample_weight * m.sample_count as f64)).collect();
        let mut samples: Vec<&Sample> = samples.iter().collect();
        samples.sort_by_key(|s| s.id);
        let mut clouds = Self { study, cells: vec![Vec::new(); study.grid.points()], shares, samples: BTreeMap::new() };
        for sample in &samples {
            *clouds.samples.entry((year(study, sample), sample.month)).or_default() += 1;
        }
        let blocks: Vec<&[&Sample]> = blocks(&samples).collect();
        let read = |reader: &mut Reader, block: &&[&Sample]| -> Result<Vec<(usize, Seen)>, PipelineError> {
            let rows = reader.optima(study, grid, block)?;
            Ok(rows.iter().filter_map(|row| seen(study, block, row)).collect())
        };
        in_order(&blocks, rayon::current_num_threads(), read, |of_block| {
            for (cell, seen) in of_block? {
                clouds.cells[cell].push(seen);
            }
            Ok::<(), PipelineError>(())
        })?;
        Ok(clouds)
    }

    /// Years that have samples, in rising order.
    pub fn years(&self) -> Vec<i32> {
        let mut years: Vec<i32> = self.samples.keys().map(|(year, _)| *year).collect();
        years.dedup();
        years
    }

    /// The setpoints of every design and window, in the order of the study.
    pub fn all(&self) -> Vec<SetpointRow> {
        let windows = self.study.grid.windows();
        let row = |(n, _): (usize, &Vec<Seen>)| {
            let (design, window) = (n / windows.len(), n % windows.len());
            SetpointRow {
                design: self.study.design_rows[design].name.clone(),
                window: windows[window],
                setpoints: self.of_years(design, window, &|_| true),
            }
        };
        self.cells.par_iter().enumerate().map(row).collect()
    }

    /// The setpoints of a design and window from some years alone. A month weighs as in the year, whatever its samples.
    pub fn of_years(&self, design: usize, window: usize, taken: &dyn Fn(i32) -> bool) -> Setpoints {
        let mut counts: BTreeMap<u8, u64> = BTreeMap::new();
        for ((_, month), count) in self.samples.iter().filter(|((year, _), _)| taken(*year)) {
            *counts.entry(*month).or_default() += count;
        }
        let weight = |month: u8| {
            let count = counts.get(&month).copied().unwrap_or(0).max(1);
            self.shares.get(&month).copied().unwrap_or(0.0) / count as f64
        };
        let cell = &self.cells[design * self.study.grid.windows().len() + window];
        let taken = cell.iter().filter(|seen| taken(seen.year));
        let hours: Vec<Hour> = taken.map(|seen| Hour { weight: weight(seen.month), ..seen.hour }).collect();
        extract(&self.study.vehicle, &self.study.grid.designs()[design], &hours, self.study.control.coverage)
    }
}
