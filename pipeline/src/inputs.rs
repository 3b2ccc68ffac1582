//! The inputs of a run besides missions, each read once.

use ingest::weather::{self, Weather};
use ingest::{Content, FileKind, FileRecord, FileStamp, Finding, check_lines};
use shading::ShadowYear;
use std::cell::OnceCell;
use std::collections::BTreeMap;
use store::Store;
use study::{Study, keys};

use crate::PipelineError;

/// Weather and shade, read when they are first asked for.
#[derive(Debug)]
pub struct Inputs<'s> {
    study: &'s Study,
    rehash: bool,
    weather: OnceCell<(Weather, Vec<FileRecord>)>,
    shadow: OnceCell<(ShadowYear, FileRecord)>,
}

impl<'s> Inputs<'s> {
    /// The inputs that a study names; nothing is read yet. With `rehash` a file is not believed to be as it was because its
    /// size, time and inode are.
    #[must_use]
    pub fn new(study: &'s Study, rehash: bool) -> Self {
        Self { study, rehash, weather: OnceCell::new(), shadow: OnceCell::new() }
    }

    /// The weather, with what there is to say of its files.
    ///
    /// # Errors
    /// [`PipelineError::Ingest`].
    pub fn weather(&self) -> Result<&(Weather, Vec<FileRecord>), PipelineError> {
        if let Some(weather) = self.weather.get() {
            return Ok(weather);
        }
        let s = self.study;
        let files = weather::discover(&s.base, &s.weather_path, &s.weather.format)?;
        let read = weather::read(&files, &s.weather)?;
        Ok(self.weather.get_or_init(|| read))
    }

    /// The shadow fractions and the record of their file.
    ///
    /// # Errors
    /// [`PipelineError::InputFile`], [`PipelineError::Shadow`].
    pub fn shadow(&self) -> Result<&(ShadowYear, FileRecord), PipelineError> {
        if let Some(shadow) = self.shadow.get() {
            return Ok(shadow);
        }
        let read = read_shadow(self.study)?;
        Ok(self.shadow.get_or_init(|| read))
    }

    /// Whether all files are read, however they look.
    pub(crate) fn rehash(&self) -> bool {
        self.rehash
    }

    /// The reading keys of all files that samples are joined with. Files that look as they did when they were stored are not
    /// read for it.
    pub(crate) fn keys(&self, store: &mut Store) -> Result<BTreeMap<String, String>, PipelineError> {
        if self.weather.get().is_none()
            && !self.rehash
            && let Some(keys) = self.unchanged(store)?
        {
            return Ok(keys);
        }
        Ok(self.records()?.into_iter().map(|(record, key)| (record.path, key)).collect())
    }

    fn unchanged(&self, store: &mut Store) -> Result<Option<BTreeMap<String, String>>, PipelineError> {
        let s = self.study;
        let found = weather::discover(&s.base, &s.weather_path, &s.weather.format)?;
        let mut files: Vec<_> = found.files.iter().map(|file| (file.path().to_owned(), file.stamp())).collect();
        files.push((s.shadow_path.clone(), FileStamp::of(&s.base.join(&s.shadow_path))));
        let mut known = store.known_files(FileKind::Weather)?;
        known.append(&mut store.known_files(FileKind::Shadow)?);
        let key = |(label, stamp): (String, Option<FileStamp>)| {
            let file = known.get(&label)?;
            let same = file.stamp.is_some() && file.stamp == stamp;
            same.then(|| (label, keys::surroundings_key(s, &file.blake3)))
        };
        let refused = found.refused.iter().map(|record| Some((record.path.clone(), refusal_key(record))));
        Ok(files.into_iter().map(key).chain(refused).collect())
    }

    /// Records how files look now that were read only to find that their content is as it was.
    pub(crate) fn restamp(&self, store: &mut Store) -> Result<(), PipelineError> {
        if self.weather.get().is_none() {
            return Ok(());
        }
        for (record, _) in self.records()? {
            if let Some(stamp) = record.stamp {
                store.put_stamp(&record.path, &stamp)?;
            }
        }
        Ok(())
    }

    /// The records of all files that samples are joined with, each with its reading key.
    pub(crate) fn records(&self) -> Result<Vec<(FileRecord, String)>, PipelineError> {
        let (_, weather) = self.weather()?;
        let (_, shadow) = self.shadow()?;
        let keyed = |record: &FileRecord| {
            let key = match (record.accepted, record.blake3.is_empty()) {
                (false, true) => refusal_key(record),
                _ => keys::surroundings_key(self.study, &record.blake3),
            };
            (record.clone(), key)
        };
        Ok(weather.iter().chain([shadow]).map(keyed).collect())
    }
}

/// Key of a file that was never read.
pub(crate) fn refusal_key(record: &FileRecord) -> String {
    let reason = record.findings.first().map(Finding::to_string).unwrap_or_default();
    keys::refusal_key(&record.path, &reason)
}

/// Ten years of hours: which of them stand twice is said by line.
const MOST_SHADOW_ROWS: usize = 87_840;

fn read_shadow(study: &Study) -> Result<(ShadowYear, FileRecord), PipelineError> {
    let path = study.base.join(&study.shadow_path);
    let content = Content::read(&path).map_err(|finding| PipelineError::InputFile { path: path.clone(), finding })?;
    check_lines(&content.bytes, b',', MOST_SHADOW_ROWS)
        .map_err(|finding| PipelineError::InputFile { path: path.clone(), finding })?;
    let shadow = ShadowYear::read(content.bytes.as_slice())
        .map_err(|source| PipelineError::Shadow { path: study.shadow_path.clone(), source })?;
    let record = FileRecord {
        path: study.shadow_path.clone(),
        kind: FileKind::Shadow,
        bytes: content.bytes.len() as u64,
        stamp: content.stamp,
        blake3: content.blake3,
        rows: shadow.hourly().len() as u64,
        first: None,
        last: None,
        accepted: true,
        findings: Vec::new(),
    };
    Ok((shadow, record))
}
