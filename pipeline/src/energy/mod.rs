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
use store::{BusRow, Energy, MonthSums, Store, StoredGrid};
use study::Study;

use self::classes::Classes;
use self::flows::Flows;
use crate::uncertainty::{DaysOfMonth, day, uncertainty};
use crate::{PipelineError, Progress};

/// Samples whose optima are read at once.
const BLOCK: usize = 64;

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

/// Reads the optima of months that have changed, and adds up the year. Refuses an optimum that is not as it was written.
pub(crate) fn energy(
    study: &Study,
    store: &mut Store,
    grid: &StoredGrid,
    samples: &BTreeMap<i64, Sample>,
    progress: &dyn Progress,
) -> Result<Energy, PipelineError> {
    let stale = store.stale_months()?;
    let points = study.grid.points();
    let mut classes: BTreeMap<u8, Classes> = BTreeMap::new();
    let mut flows: BTreeMap<u8, Flows> = BTreeMap::new();
    let mut days: BTreeMap<u8, DaysOfMonth> = BTreeMap::new();
    let views = PassengerViews::new(&study.vehicle);
    let windows = study.grid.windows().len();
    let limits_w = power_limits_w(study);
    let all: Vec<&Sample> = samples.values().collect();
    let is_stale = |s: &Sample| stale.contains(&s.month);
    // Runs of stale months in the order of the ids.
    for block in
        all.chunk_by(|a, b| is_stale(a) == is_stale(b)).filter(|run| is_stale(run[0])).flat_map(|r| r.chunks(BLOCK))
    {
        if progress.stop() {
            return Err(PipelineError::Interrupted);
        }
        let rows = store.optima(grid, block[0].id, block[block.len() - 1].id)?;
        for of_sample in rows.chunk_by(|a, b| a.sample_id == b.sample_id) {
            let Some(sample) = samples.get(&of_sample[0].sample_id) else { continue };
            let cabin = Cabin::new(&study.vehicle, &views, &sample.disturbances);
            let mut sums = classes.entry(sample.month).or_insert_with(|| Classes::new(points)).sample(sample);
            let flows = flows.entry(sample.month).or_insert_with(|| Flows::new(points));
            let days = days.entry(sample.month).or_insert_with(|| DaysOfMonth::new(points));
            let day = days.place(day(sample, study.zone));
            for row in of_sample {
                if let Some(o) = row.outcome.as_ref().and_then(|outcome| outcome.operation()) {
                    let point = row.design * windows + row.window;
                    sums.add(point, o);
                    days.add(point, day, sample, o);
                    flows.add(point, &cabin, o, limits_w[row.design]);
                }
            }
        }
    }
    let sums: Vec<MonthSums> = classes.into_iter().map(|(month, classes)| classes.finish(month)).collect();
    let flows = flows.into_iter().flat_map(|(month, flows)| flows.finish(month, windows)).collect();
    let months = store.months()?;
    let kept = store.month_sums(grid)?;
    let mut year: Vec<&MonthSums> = kept.iter().chain(&sums).collect();
    year.sort_by_key(|m| m.month);
    let classes = year::classes(&year, &months, windows);
    let bins = bins::bins(&all, &months);
    let days = days.into_iter().map(|(month, days)| days.finish(month)).collect();
    let ptc = study.design_rows.iter().position(|row| row.name == "ptc");
    let pmv_1 = grid.windows.iter().position(|w| w.is_symmetric() && w.pmv_limit() == 1.0);
    let uncertainty = uncertainty(days, &store.month_days(grid)?, &year, [points, windows], ptc, pmv_1);
    Ok(Energy { sums, flows, classes, bins, uncertainty })
}
