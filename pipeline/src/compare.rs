//! Two databases, or two runs of one: which settings, inputs and samples differ, and what that does to the annual averages.

use cabin::ComfortWindow;
use chrono::SecondsFormat;
use ingest::sample::Sample;
use std::collections::BTreeMap;
use std::path::Path;
use store::{Change, ChangeKind, PastAverage, Store};

use crate::PipelineError;

/// Samples that are named where more differ.
const NAMED: usize = 10;

/// What differs between two databases or runs.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    /// What is compared, and with what.
    pub sides: [String; 2],
    /// Settings and inputs that differ; between runs with the run that found it.
    pub changes: Vec<(Option<i64>, Change)>,
    /// The samples; not known between runs, which keep their number alone.
    pub samples: Option<SampleChanges>,
    /// Every annual average of either.
    pub averages: Vec<AverageChange>,
}

/// How the samples of two databases differ.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct SampleChanges {
    /// With the same disturbances.
    pub same: usize,
    /// With others.
    pub other: usize,
    /// Of each side alone.
    pub alone: [usize; 2],
    /// The first that differ, in words.
    pub first: Vec<String>,
}

/// An annual average on both sides.
#[derive(Debug, Clone, PartialEq)]
pub struct AverageChange {
    /// Design.
    pub design: String,
    /// Comfort window.
    pub window: ComfortWindow,
    /// Annual mean power in W; `None` where a side has none.
    pub hvac_power_w: [Option<f64>; 2],
    /// Samples behind it.
    pub sample_count: [u64; 2],
}

impl AverageChange {
    /// How much more the second side takes in W; `None` where one has no value.
    #[must_use]
    pub fn change_w(&self) -> Option<f64> {
        let [a, b] = self.hvac_power_w;
        Some(b? - a?)
    }
}

impl Comparison {
    /// Whether nothing differs.
    #[must_use]
    pub fn is_same(&self) -> bool {
        let samples = self.samples.as_ref().is_none_or(|s| s.other == 0 && s.alone == [0, 0]);
        self.changes.is_empty() && samples && self.averages.iter().all(|a| a.hvac_power_w[0] == a.hvac_power_w[1])
    }
}

/// Compares two databases.
///
/// # Errors
/// [`PipelineError::Store`].
pub fn compare(a: &Path, b: &Path) -> Result<Comparison, PipelineError> {
    let (mut one, mut other) = (Store::open_read_only(a)?, Store::open_read_only(b)?);
    let sides = [side(a, &mut one)?, side(b, &mut other)?];
    let changes = Change::between(&one.basis()?, &other.basis()?);
    let samples = samples(one.samples()?, other.samples()?);
    let averages = averages([one.averages_after(i64::MAX)?, other.averages_after(i64::MAX)?]);
    one.close()?;
    other.close()?;
    // The samples are compared one by one.
    let changes = changes.into_iter().filter(|c| c.kind != ChangeKind::Samples).map(|c| (None, c)).collect();
    Ok(Comparison { sides, changes, samples: Some(samples), averages })
}

/// Compares two runs of a database, of which the second is the later one.
///
/// # Errors
/// [`PipelineError::Request`] where there is no such run; [`PipelineError::Store`].
pub fn compare_runs(database: &Path, runs: [i64; 2]) -> Result<Comparison, PipelineError> {
    let mut store = Store::open_read_only(database)?;
    let last = store.last_run()?.map_or(0, |run| run.run_id);
    let [first, second] = runs;
    if first < 1 || second <= first || second > last {
        return Err(PipelineError::Request(format!(
            "runs {first} and {second}: name two of 1 … {last}, the earlier one first"
        )));
    }
    let changes = store.changes(first, second)?.into_iter().map(|(run, change)| (Some(run), change)).collect();
    let averages = averages([store.averages_after(first)?, store.averages_after(second)?]);
    store.close()?;
    let side = |run: i64| format!("run {run} of {}", database.display());
    Ok(Comparison { sides: [side(first), side(second)], changes, samples: None, averages })
}

/// A database in words.
fn side(path: &Path, store: &mut Store) -> Result<String, PipelineError> {
    let path = path.display();
    Ok(match store.last_run()? {
        Some(run) => {
            let started = run.started.to_rfc3339_opts(SecondsFormat::Secs, true);
            format!("{path}, run {} of {started}, busclimate {}", run.run_id, run.program_version)
        }
        None => format!("{path}, no run yet"),
    })
}

fn samples(one: Vec<Sample>, other: Vec<Sample>) -> SampleChanges {
    let mut others: BTreeMap<i64, Sample> = other.into_iter().map(|s| (s.id, s)).collect();
    let mut changes = SampleChanges::default();
    let mut name = |s: &Sample, how: &str| {
        if changes.first.len() < NAMED {
            let start = s.segment.start.to_rfc3339_opts(SecondsFormat::Secs, true);
            changes.first.push(format!("{} at {start}: {how}", s.segment.mission));
        }
    };
    let (mut same, mut differing, mut alone) = (0, 0, 0);
    for sample in &one {
        match others.remove(&sample.id) {
            Some(o) if o.disturbances == sample.disturbances && o.month == sample.month => same += 1,
            Some(_) => {
                differing += 1;
                name(sample, "other disturbances");
            }
            None => {
                alone += 1;
                name(sample, "only in the first");
            }
        }
    }
    others.values().for_each(|s| name(s, "only in the second"));
    SampleChanges { same, other: differing, alone: [alone, others.len()], first: changes.first }
}

fn averages(sides: [Vec<PastAverage>; 2]) -> Vec<AverageChange> {
    let mut rows: Vec<AverageChange> = Vec::new();
    for (side, averages) in sides.into_iter().enumerate() {
        for average in averages {
            let same = |row: &AverageChange| row.design == average.design && row.window == average.window;
            let place = rows.iter().position(same).unwrap_or_else(|| {
                rows.push(AverageChange {
                    design: average.design.clone(),
                    window: average.window,
                    hvac_power_w: [None; 2],
                    sample_count: [0; 2],
                });
                rows.len() - 1
            });
            rows[place].hvac_power_w[side] = average.hvac_power_w;
            rows[place].sample_count[side] = average.sample_count;
        }
    }
    rows
}
