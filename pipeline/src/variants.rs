//! The year of buses that differ from the study's, beside that of the bus itself.

use cabin::Design;
use ingest::sample::Sample;
use sensitivity::{Passengers, Variation};
use solve::{AnnualMean, Grid, YearSamples};
use std::collections::BTreeMap;
use store::NewVariant;
use study::{Study, Variant};

use crate::PipelineError;

/// The samples of a study as a bus meets them, month by month.
pub(crate) fn year(samples: &BTreeMap<i64, Sample>, variation: &Variation) -> YearSamples {
    let mut year = YearSamples::default();
    for sample in samples.values() {
        // Months of samples are those of a calendar.
        year.add(sample.month, variation.disturbances(&sample.disturbances));
    }
    year
}

/// Every variant of a study in all of its windows, by the same search as the stored optima.
pub(crate) fn variants(study: &Study, samples: &BTreeMap<i64, Sample>) -> Result<Vec<NewVariant>, PipelineError> {
    if study.variants.is_empty() {
        return Ok(Vec::new());
    }
    let none = Variation::none(&study.vehicle);
    let passengers = Passengers::new(&study.vehicle);
    let means = |variation: &Variation| -> Result<Vec<AnnualMean>, PipelineError> {
        let bus =
            variation.bus(study.grid.designs(), &passengers).map_err(|e| PipelineError::Request(e.to_string()))?;
        let grid = with_designs(&study.grid, bus.designs);
        Ok(year(samples, variation).means(&bus.vehicle, &grid))
    };
    let base = means(&none)?;
    let windows = study.grid.windows().len();
    let of = |variant: &Variant| {
        let own = means(&variant.variation)?;
        let points = variant.designs.iter().flat_map(|design| (0..windows).map(move |window| [*design, window]));
        let years = points.map(|[d, w]| ([d, w], [own[d * windows + w], base[d * windows + w]])).collect();
        let setting = |(name, value): &(String, f64)| (name.clone(), *value, none.get(name));
        Ok(NewVariant { name: variant.name.clone(), settings: variant.overrides.iter().map(setting).collect(), years })
    };
    study.variants.iter().map(of).collect()
}

/// The windows of a grid with other designs, which have the same names.
fn with_designs(grid: &Grid, designs: Vec<Design>) -> Grid {
    Grid::new(designs, grid.windows().to_vec()).expect("the names are those of a grid")
}
