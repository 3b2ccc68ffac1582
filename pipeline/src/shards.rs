//! Optima of a part of the samples, for batch clusters: each process solves its share into files, and `solve` takes them up.
//!
//! A file is of some samples with all designs and windows. Its name says what it was made from and what is in it, so that work that
//! is done is known as such, whoever did it, and a file that was damaged is not used. It is written beside its name and renamed.
//! No order and no number of processes shows in the result.

use cabin::{Disturbances, Outcome};
use export::{ChunkRow, chunk_bytes, chunk_rows};
use ingest::sample::Sample;
use solve::solve_blocks;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use store::{NewOptimum, Store, StoredGrid};
use study::{Study, keys};

use crate::files::{make_folder, write_whole};
use crate::optima::vote_form;
use crate::{PipelineError, Progress, open};

/// Samples of a file: some 0.7 MB with five designs and seventeen windows.
const SAMPLES: usize = 512;
const START: &str = "optima-";
const END: &str = ".parquet";

/// One of so many shares, from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shard {
    index: u32,
    of: u32,
}

impl Shard {
    /// A share; `None` where there is no such one.
    #[must_use]
    pub fn new(index: u32, of: u32) -> Option<Self> {
        (1..=of).contains(&index).then_some(Self { index, of })
    }

    /// Whether a sample is its own, by what it was made from: shares stay as they are when missions come.
    fn takes(self, sample: &Sample) -> bool {
        let start = sample.key.get(..8).and_then(|start| u32::from_str_radix(start, 16).ok());
        start.unwrap_or_default() % self.of == self.index - 1
    }
}

/// What a process has done.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ShardWork {
    /// Samples of its share.
    pub samples: usize,
    /// Files that hold them.
    pub files: usize,
    /// Files written now; the others were there.
    pub written: usize,
}

/// Solves a share of the samples that the database has into files of a folder. The database is only read.
///
/// # Errors
/// [`PipelineError::Request`] for methods other than the fast one; [`PipelineError::Store`], [`PipelineError::Write`],
/// [`PipelineError::Interrupted`]: what is written stays.
pub fn solve_shard(
    study: &Study,
    shard: Shard,
    folder: &Path,
    progress: &dyn Progress,
) -> Result<ShardWork, PipelineError> {
    if vote_form(study).is_some() {
        return Err(PipelineError::Request("shares are solved by the method fast; leave out --method".to_owned()));
    }
    let mut store = open::for_reading(study)?;
    let samples = store.samples()?;
    store.close()?;
    let own: Vec<&Sample> = samples.iter().filter(|sample| shard.takes(sample)).collect();
    make_folder(folder)?;
    let there = names(folder)?;
    progress.begin("samples", own.len() as u64);
    let mut work = ShardWork { samples: own.len(), files: 0, written: 0 };
    for part in own.chunks(SAMPLES) {
        work.files += 1;
        let inputs = inputs_hash(study, part);
        let start = format!("{START}{inputs}-");
        if !there.iter().any(|name| name.starts_with(&start)) {
            let rows = solved(study, part, progress)?;
            let bytes = chunk_bytes(&rows).map_err(|e| PipelineError::Request(format!("{start}: {e}")))?;
            write_whole(&folder.join(format!("{start}{}{END}", content_hash(&bytes))), &bytes)?;
            work.written += 1;
        }
        progress.advance(part.len() as u64);
    }
    progress.end();
    Ok(work)
}

fn solved(study: &Study, part: &[&Sample], progress: &dyn Progress) -> Result<Vec<ChunkRow>, PipelineError> {
    let disturbances: Vec<Disturbances> = part.iter().map(|sample| sample.disturbances).collect();
    let points = study.grid.points();
    let mut rows = Vec::with_capacity(part.len() * points);
    let whole = solve_blocks(&study.vehicle, &study.grid, &disturbances, |first, optima| {
        rows.extend(optima.iter().enumerate().map(|(i, optimum)| {
            let sample = part[first + i / points];
            ChunkRow {
                sample_id: sample.id,
                sample_key: sample.key.clone(),
                design_key: study.design_rows[optimum.design].design_key.clone(),
                window: study.grid.windows()[optimum.window],
                outcome: optimum.outcome,
            }
        }));
        !progress.stop()
    });
    if whole { Ok(rows) } else { Err(PipelineError::Interrupted) }
}

/// What the rows of some samples depend on.
fn inputs_hash(study: &Study, part: &[&Sample]) -> String {
    let windows = study.grid.windows().iter().map(|w| format!("{} {}", w.pmv_min(), w.pmv_max()));
    let parts: Vec<String> = part
        .iter()
        .map(|sample| sample.key.clone())
        .chain(study.design_rows.iter().map(|row| row.design_key.clone()))
        .chain(windows)
        .collect();
    keys::hash(&parts.iter().map(String::as_str).collect::<Vec<_>>())[..32].to_owned()
}

fn content_hash(bytes: &[u8]) -> String {
    blake3::hash(bytes).to_hex()[..32].to_owned()
}

/// The names of all files of shares in a folder, in their order.
fn names(folder: &Path) -> Result<Vec<String>, PipelineError> {
    let unreadable = |e: std::io::Error| PipelineError::Request(format!("{} cannot be read: {e}", folder.display()));
    let mut names = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(unreadable)? {
        let name = entry.map_err(unreadable)?.file_name().to_string_lossy().into_owned();
        if name.starts_with(START) && name.ends_with(END) {
            names.push(name);
        }
    }
    names.sort();
    Ok(names)
}

/// Takes what is missing from the files of a folder, one file at a time. Files that are damaged are left and named; rows of other
/// samples, designs and windows are left.
pub(crate) fn take(
    study: &Study,
    store: &mut Store,
    grid: &StoredGrid,
    samples: &BTreeMap<i64, Sample>,
    folder: &Path,
    progress: &dyn Progress,
) -> Result<usize, PipelineError> {
    let mut missing: BTreeMap<i64, BTreeSet<(usize, usize)>> = BTreeMap::new();
    for gap in store.missing_optima(grid)? {
        let points: BTreeSet<(usize, usize)> = gap.points.iter().copied().collect();
        missing.extend(gap.samples.iter().map(|id| (*id, points.clone())));
    }
    let names = names(folder)?;
    progress.begin("files", names.len() as u64);
    let mut taken = 0;
    for name in names {
        match rows(&folder.join(&name)) {
            Err(what) => progress.warn(&format!("{} is left: {what}", folder.join(&name).display())),
            Ok(rows) => {
                let new: Vec<(i64, usize, usize, Outcome)> = rows
                    .into_iter()
                    .filter_map(|row| {
                        let sample = samples.get(&row.sample_id).filter(|sample| sample.key == row.sample_key)?;
                        let design = study.design_rows.iter().position(|d| d.design_key == row.design_key)?;
                        let window = study.grid.windows().iter().position(|w| *w == row.window)?;
                        missing.get_mut(&sample.id)?.remove(&(design, window)).then_some((
                            sample.id,
                            design,
                            window,
                            row.outcome,
                        ))
                    })
                    .collect();
                let optimum = |(sample_id, design, window, outcome)| NewOptimum {
                    sample_id,
                    design,
                    window,
                    outcome,
                    effort: None,
                };
                store.put_optima(grid, new.iter().map(|(id, d, w, outcome)| optimum((*id, *d, *w, outcome))))?;
                taken += new.len();
            }
        }
        progress.advance(1);
        if progress.stop() {
            return Err(PipelineError::Interrupted);
        }
    }
    progress.end();
    Ok(taken)
}

/// The rows of a file whose content is what its name says.
fn rows(path: &PathBuf) -> Result<Vec<ChunkRow>, String> {
    let bytes = std::fs::read(path).map_err(|e| e.to_string())?;
    let stem = path.file_stem().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    if stem.rsplit('-').next() != Some(content_hash(&bytes).as_str()) {
        return Err("its content is not what its name says".to_owned());
    }
    chunk_rows(bytes)
}
