//! Missions into the database; one whose content is known is not parsed again.

use ingest::mission::{self, MissionReading, MissionSource};
use ingest::{FileKind, FileReader, FileRecord, FileStamp, Finding, FindingKind};
use std::collections::BTreeMap;
use store::Store;
use study::{Study, keys};

use crate::before::{Before, Standing};
use crate::budget::Budget;
use crate::in_order::in_order;
use crate::inputs::{Inputs, refusal_key};
use crate::missing::Gone;
use crate::{PipelineError, Progress, Work, freshness};

/// Missions that are read at a time, beside one a thread: while one is taken in, others are parsed.
const READERS_BESIDE: usize = 1;

/// Missions that are stored in one transaction, of which each ends with looking for rows without a check. What a kill takes are so
/// many readings at most.
const STORED_AT_ONCE: usize = 16;

/// What is recorded of a mission that is not there.
const MISSING: &str =
    "not there when it was last looked for; what came from it is kept: bring it back, or run with --forget-missing";

/// What a thread has found out about a mission.
struct Read {
    path: String,
    /// Where the mission of that content was before; its path, where it has not moved.
    known_as: Option<String>,
    blake3: String,
    outcome: Outcome,
}

/// A mission and its reading key.
type Reading = (MissionReading, String);

enum Outcome {
    /// Its content is as it was; with a stamp where it had to be read to know.
    Known(Option<FileStamp>),
    New(Box<Reading>),
    Unreadable(Box<FileRecord>),
}

pub(crate) fn ingest(
    study: &Study,
    inputs: &Inputs,
    store: &mut Store,
    progress: &dyn Progress,
) -> Result<Work, PipelineError> {
    let found = mission::discover(&study.base, &study.missions_path, &study.mission_format, &study.buses)?;
    let overlapping: BTreeMap<usize, FileRecord> = mission::overlaps(&found.missions).into_iter().collect();
    let known = store.known_files(FileKind::Mission)?;
    let wanted: Vec<&MissionSource> =
        found.missions.iter().enumerate().filter(|(i, _)| !overlapping.contains_key(i)).map(|(_, m)| m).collect();

    let before = Before::of(study, inputs, &known);
    let budget = Budget::new();
    progress.begin("missions", wanted.len() as u64);
    let read = |reader: &mut FileReader, source: &&MissionSource| {
        let path = source.path.clone();
        let of_before = before.find(source);
        let known_as = of_before.map(|(path, _)| path.clone());
        let of_before = of_before.map(|(_, file)| file);
        if let (Some(file), Standing::Same | Standing::Moved) = (of_before, before.standing(source)) {
            return Read { path, known_as, blake3: file.blake3.clone(), outcome: Outcome::Known(None) };
        }
        // Held until the content is parsed.
        let _taken = budget.take(source.bytes());
        let content = match source.load(reader) {
            Ok(content) => content,
            Err(record) => return Read { path, known_as, blake3: String::new(), outcome: Outcome::Unreadable(record) },
        };
        let key = keys::mission_key(study, &content.blake3);
        let outcome = if of_before.is_some_and(|f| f.reading_key == key) {
            Outcome::Known(content.stamp)
        } else {
            Outcome::New(Box::new((mission::read(source, &content, &study.missions), key)))
        };
        let blake3 = content.blake3.clone();
        reader.recycle(content);
        Read { path, known_as, blake3, outcome }
    };
    // The first path of every content.
    let mut contents: BTreeMap<String, String> = BTreeMap::new();
    let (mut new, mut read_now) = (Vec::new(), 0);
    in_order(
        &wanted,
        READERS_BESIDE + rayon::current_num_threads(),
        read,
        |Read { path, known_as, blake3, outcome }| {
            if progress.stop() {
                put(store, &mut new)?;
                return Err(PipelineError::Interrupted);
            }
            match (outcome, contents.get(&blake3)) {
                (Outcome::Unreadable(record), _) => {
                    put(store, &mut new)?;
                    store.put_file(&record, &refusal_key(&record))?;
                    read_now += 1;
                }
                (_, Some(first)) => {
                    let message = format!("the same content as {first}, under another name; remove one of them");
                    let finding = Finding::whole(FindingKind::Overlap, message);
                    let record = FileRecord::refused(&path, FileKind::Mission, &blake3, 0, finding);
                    put(store, &mut new)?;
                    store.put_file(&record, &refusal_key(&record))?;
                }
                (Outcome::New(reading), None) => {
                    new.push(*reading);
                    if new.len() == STORED_AT_ONCE {
                        put(store, &mut new)?;
                    }
                    read_now += 1;
                    contents.insert(blake3, path);
                }
                (Outcome::Known(stamp), None) => {
                    if let Some(from) = known_as.filter(|from| *from != path) {
                        store.move_file(&from, &path)?;
                    }
                    if let Some(stamp) = stamp {
                        store.put_stamp(&path, &stamp)?;
                    }
                    contents.insert(blake3, path);
                }
            }
            progress.advance(1);
            Ok(())
        },
    )?;
    put(store, &mut new)?;
    progress.end();
    let paths = found.missions.len() + found.refused.len();
    for record in overlapping.values().chain(&found.refused) {
        store.put_file(record, &refusal_key(record))?;
    }
    let gone = Gone::of(study, &found, &store.known_files(FileKind::Mission)?);
    if let Some(first) = gone.forgotten.first() {
        progress.warn(&format!("missions are no longer there, and what came from them goes; the first: {first}"));
    }
    store.forget_files(&gone.forgotten)?;
    store.put_missing(&gone.missing, MISSING)?;
    let (forgotten, missing) = (gone.forgotten.len() as u64, gone.missing.len());
    let total = (paths + missing) as u64;
    let kept = if missing == 0 { String::new() } else { format!(", {missing} missing and kept") };
    let message = format!("{total} missions: {read_now} read now, {forgotten} no longer there{kept}");
    Ok(Work { computed: read_now, withdrawn: forgotten, total, message })
}

/// Stores the readings that are new so far: before another file gets its row, so that rows stand in the order of missions, and
/// when nothing follows. Missions that are known have their rows already.
fn put(store: &mut Store, new: &mut Vec<Reading>) -> Result<(), PipelineError> {
    if !new.is_empty() {
        store.put_missions(new.iter().map(|(reading, key)| (reading, key.as_str())))?;
        new.clear();
    }
    Ok(())
}

/// Says that samples are to be joined anew, where `ingest` runs alone.
pub(crate) fn say_stale(inputs: &Inputs, store: &mut Store, progress: &dyn Progress) -> Result<(), PipelineError> {
    if let Some(stale) = freshness::samples(inputs, store)? {
        progress.warn(&format!("{}; `busclimate {}` comes next", stale.what, stale.remedy));
    }
    Ok(())
}
