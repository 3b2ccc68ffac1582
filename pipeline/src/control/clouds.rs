//! The optima as a controller sees them, and what it learns from all years or some.

use chrono::Datelike;
use ingest::sample::Sample;
use rayon::prelude::*;
use setpoints::{Hour, Setpoints, extract};
use std::collections::BTreeMap;
use store::{SetpointRow, Store, StoredGrid};
use study::Study;

use crate::PipelineError;

/// Samples whose optima are read at a time.
const BLOCK: usize = 128;

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
        for block in samples.chunks(BLOCK) {
            let of_id: BTreeMap<i64, (&Sample, i32)> = block.iter().map(|s| (s.id, (*s, year(study, s)))).collect();
            for (sample, year) in of_id.values() {
                *clouds.samples.entry((*year, sample.month)).or_default() += 1;
            }
            for row in store.optima(grid, block[0].id, block[block.len() - 1].id)? {
                let operation = row.outcome.as_ref().and_then(|outcome| outcome.operation());
                let (Some(o), Some((sample, year))) = (operation, of_id.get(&row.sample_id)) else { continue };
                let hour = Hour {
                    mode: o.mode,
                    ambient_k: sample.disturbances.ambient_temperature_k,
                    cabin_k: o.temperatures.cabin_k,
                    curtain: o.devices.air_curtain,
                    heaters_k: o.devices.radiant_heaters.then_some(o.temperatures.radiant_heater_k),
                    weight: 0.0,
                };
                let seen = Seen { year: *year, month: sample.month, hour };
                clouds.cells[row.design * grid.windows.len() + row.window].push(seen);
            }
        }
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
