//! Where the year's energy goes: solved samples by class and their heat flows, month by month, and what that is in a year.
//!
//! Only months whose optima have changed are read again; sums of the others are kept. A vote at a limit of its window counts
//! inside the window.

mod bins;
mod classes;
mod flows;
mod year;

use cabin::{Cabin, Design, HeatTransfer, PassengerViews};
use ingest::sample::Sample;
use simulate::{Limits, PowerLimits};
use std::collections::BTreeMap;
use store::{BusRow, Energy, MonthAverages, MonthDays, MonthFlows, MonthSums, Store, StoredGrid};
use study::Study;

use self::classes::Classes;
use self::flows::Flows;
use crate::in_order::in_order;
use crate::readers::{Reader, blocks};
use crate::uncertainty::{DaysOfMonth, day, uncertainty};
use crate::{PipelineError, Progress};

/// Electric power of the air unit in W that the vehicle can give in heating and in cooling, by design.
pub(crate) fn power_limits_w(study: &Study) -> Vec<[f64; 2]> {
    let of_design = |design: &Design| {
        let PowerLimits { heating_w, cooling_w, .. } = Limits::Rated.of(design, &study.dynamics);
        [heating_w, cooling_w]
    };
    study.grid.designs().iter().map(of_design).collect()
}

/// What the optima of a study are found with, and what the vehicle can give.
pub(crate) fn bus(study: &Study) -> BusRow {
    BusRow {
        transfer: HeatTransfer::of(&study.vehicle),
        passenger_heat_w: study.vehicle.passenger_heat_w,
        other_heat_w: study.vehicle.other_heat_w,
        limits_w: power_limits_w(study),
    }
}

/// Reads the optima of months that have changed, several months at a time, and adds up the year. Refuses an optimum that is not
/// as it was written.
pub(crate) fn energy(
    study: &Study,
    store: &mut Store,
    grid: &StoredGrid,
    samples: &BTreeMap<i64, Sample>,
    progress: &dyn Progress,
) -> Result<Energy, PipelineError> {
    let stale = store.stale_months()?;
    let all: Vec<&Sample> = samples.values().collect();
    let adder = Adder {
        study,
        grid,
        samples: &all,
        views: PassengerViews::new(&study.vehicle),
        limits_w: power_limits_w(study),
        progress,
    };
    let (mut averages, mut sums, mut flows, mut days) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let add = |reader: &mut Reader, month: &u8| adder.month(reader, *month);
    in_order(&stale, rayon::current_num_threads(), add, |of_month| {
        let of_month = of_month?;
        averages.push(of_month.averages);
        sums.push(of_month.sums);
        flows.extend(of_month.flows);
        days.push(of_month.days);
        Ok::<(), PipelineError>(())
    })?;
    let (points, windows) = (study.grid.points(), study.grid.windows().len());
    let months = store.months()?;
    let kept = store.month_sums(grid)?;
    let mut year: Vec<&MonthSums> = kept.iter().chain(&sums).collect();
    year.sort_by_key(|m| m.month);
    let classes = year::classes(&year, &months, windows);
    let bins = bins::bins(&all, &months);
    let ptc = study.design_rows.iter().position(|row| row.name == "ptc");
    let pmv_1 = grid.windows.iter().position(|w| w.is_plus_minus(1.0));
    let uncertainty = uncertainty(days, &store.month_days(grid)?, &year, [points, windows], ptc, pmv_1);
    Ok(Energy { averages, sums, flows, classes, bins, uncertainty })
}

/// What the months of a study are added up with.
struct Adder<'a> {
    study: &'a Study,
    grid: &'a StoredGrid,
    /// All samples in the order of their ids.
    samples: &'a [&'a Sample],
    views: PassengerViews,
    limits_w: Vec<[f64; 2]>,
    progress: &'a dyn Progress,
}

/// What a month adds up to.
struct OfMonth {
    averages: MonthAverages,
    sums: MonthSums,
    flows: Vec<MonthFlows>,
    days: MonthDays,
}

impl Adder<'_> {
    /// A month, in the order of the ids.
    fn month(&self, reader: &mut Reader, month: u8) -> Result<OfMonth, PipelineError> {
        let (points, windows) = (self.study.grid.points(), self.study.grid.windows().len());
        let (mut classes, mut flows, mut days) = (Classes::new(points), Flows::new(points), DaysOfMonth::new(points));
        let mut averages = MonthAverages::new(month, self.grid);
        // Samples between which none of another month lies.
        let runs = self.samples.chunk_by(|a, b| a.month == b.month).filter(|run| run[0].month == month);
        for block in runs.flat_map(blocks) {
            if self.progress.stop() {
                return Err(PipelineError::Interrupted);
            }
            let rows = reader.optima(self.study, self.grid, block)?;
            for of_sample in rows.chunk_by(|a, b| a.sample_id == b.sample_id) {
                let Ok(place) = block.binary_search_by_key(&of_sample[0].sample_id, |s| s.id) else { continue };
                let sample = block[place];
                let cabin = Cabin::new(&self.study.vehicle, &self.views, &sample.disturbances);
                let mut sums = classes.sample(sample);
                let day = days.place(day(sample, self.study.zone));
                for row in of_sample {
                    averages.add(row);
                    if let Some(o) = row.outcome.as_ref().and_then(|outcome| outcome.operation()) {
                        let point = row.design * windows + row.window;
                        sums.add(point, o);
                        days.add(point, day, sample, o);
                        flows.add(point, &cabin, o, self.limits_w[row.design]);
                    }
                }
            }
        }
        Ok(OfMonth {
            averages,
            sums: classes.finish(month),
            flows: flows.finish(month, windows),
            days: days.finish(month),
        })
    }
}
