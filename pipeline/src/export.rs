//! The database as files for other tools, in a folder that appears whole or not at all.

use ::export::{Format, Loading, PACKAGE, Provenance};
use std::cell::RefCell;
use std::io::ErrorKind;
use std::ops::RangeInclusive;
use std::path::Path;
use store::{dictionary, questions};
use study::Study;

use crate::record::input_hash;
use crate::{Inputs, PROGRAM_VERSION, PipelineError, Progress, folder, open, report};

/// What is exported.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Export {
    /// All tables and views that others build on.
    Tables(Format),
    /// Look-up tables for fleet planners.
    LookUpTables(Loading),
}

/// How the dictionary is said.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Words {
    /// Tables, views and columns as Markdown.
    Markdown,
    /// Questions with their queries as Markdown.
    Questions,
    /// Everything as JSON.
    Json,
    /// Metadata for Datasette.
    Datasette,
}

/// People that a full bus may hold.
const PEOPLE: RangeInclusive<f64> = 1.0..=500.0;

/// Writes files of a study's database into a folder: a new one, an empty one, or one that holds an export, which is replaced.
///
/// # Errors
/// [`PipelineError::Request`] where the folder holds something else or the bus no people; [`PipelineError::Store`], [`PipelineError::Export`],
/// [`PipelineError::Write`].
pub fn export(study: &Study, wanted: Export, to: &Path, progress: &dyn Progress) -> Result<(), PipelineError> {
    if let Export::LookUpTables(Loading { capacity }) = wanted
        && !PEOPLE.contains(&capacity)
    {
        let (least, most) = (PEOPLE.start(), PEOPLE.end());
        return Err(PipelineError::Request(format!("--capacity {capacity}: give {least} to {most} people")));
    }
    let cannot = |source| PipelineError::Write { path: to.to_owned(), source };
    let is_empty = match std::fs::read_dir(to) {
        Ok(mut entries) => entries.next().is_none(),
        Err(error) if error.kind() == ErrorKind::NotFound => true,
        Err(error) => return Err(cannot(error)),
    };
    if !is_empty && !to.join(PACKAGE).is_file() {
        return Err(PipelineError::Request(format!(
            "{} holds files that are no export (it has no {PACKAGE}); name a new folder, or an empty one",
            to.display()
        )));
    }
    let mut store = open::for_reading(study)?;
    report::say_stale(study, &Inputs::new(study, false), &mut store, progress)?;
    let relations = dictionary()?;
    let written = store.at_one_moment(|store| {
        let last = store.last_run()?;
        let provenance = Provenance {
            study: study.name.clone(),
            study_hash: last.as_ref().map_or_else(|| study.hash.clone(), |run| run.study_hash.clone()),
            input_hash: input_hash(store)?,
            program_version: last.map_or_else(|| PROGRAM_VERSION.to_owned(), |run| run.program_version),
        };
        let (store, failed) = (RefCell::new(store), RefCell::new(None));
        let write = |new: &Path| {
            let (store, p) = (&mut **store.borrow_mut(), &provenance);
            let done = match wanted {
                Export::Tables(format) => ::export::tables(store, &relations, format, p, new),
                Export::LookUpTables(loading) => ::export::look_up_tables(store, study, loading, p, new),
            };
            done.map_err(|error| {
                failed.replace(Some(error));
                std::io::Error::other("nothing is exported")
            })
        };
        let filled = folder::fill(to, &::export::names(&relations), &write);
        match (filled, failed.into_inner()) {
            (_, Some(error)) => Err(PipelineError::from(error)),
            (filled, None) => filled.map_err(cannot),
        }
    });
    store.close()?;
    written
}

/// What the database's tables, views and columns are, and what people ask of them. `database` is the name that Datasette gives the
/// database.
///
/// # Errors
/// [`PipelineError::Store`].
pub fn words(wanted: Words, database: &str) -> Result<String, PipelineError> {
    let (relations, questions) = (dictionary()?, questions()?);
    Ok(match wanted {
        Words::Markdown => ::export::markdown(&relations),
        Words::Questions => ::export::questions_markdown(&questions),
        Words::Json => format!("{:#}\n", ::export::json(&relations, &questions)),
        Words::Datasette => format!("{:#}\n", ::export::datasette(&relations, &questions, database)),
    })
}
