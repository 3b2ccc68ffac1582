//! Where missions are found, and which of them cannot be used.

use chrono::{DateTime, NaiveDateTime, TimeDelta, Utc};
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use super::table::{Index, Part, TelemetryMap, index};
use crate::walk::{Found, Place, walk};
use crate::{Content, FileKind, FileReader, FileRecord, FileStamp, Finding, FindingKind, IngestError};

/// No mission is longer; a name that says so is a misprint.
const MAX_DURATION: TimeDelta = TimeDelta::days(7);

/// A mission file that was found.
#[derive(Debug, Clone, PartialEq)]
pub struct MissionSource {
    /// Name of the mission: the file's name without its extension.
    pub name: String,
    /// Path as the study names it; the entry of an archive follows a `!`.
    pub path: String,
    /// Number of the bus.
    pub bus: u32,
    /// First second, from the name.
    pub start: DateTime<Utc>,
    /// Last second, from the name.
    pub end: DateTime<Utc>,
    place: Place,
    /// Which part of its file the mission is; `None` where it is all of it.
    part: Option<Arc<Part>>,
}

/// How mission files look.
#[derive(Debug, Clone, PartialEq)]
pub enum MissionFormat {
    /// ZTBus, a file for each mission.
    ZtBus,
    /// Tables with columns of other names.
    Csv(Arc<TelemetryMap>),
}

/// What was found where the study says that missions are.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Discovery {
    /// The missions of the wanted buses, by name.
    pub missions: Vec<MissionSource>,
    /// Files that look like missions and cannot be used, by path.
    pub refused: Vec<FileRecord>,
}

/// Finds missions in a folder with all below it, a glob, one file or a `.zip`, relative to `base`; each may be compressed
/// (`.csv.gz`). No `buses` means all of them.
///
/// The path must be there and hold at least one mission of the wanted buses. Files with the extension `csv` that are
/// no mission, archives that are not read and links that lead nowhere are refused with a finding; metadata and what
/// operating systems leave beside files are not looked at.
///
/// # Errors
/// [`IngestError`] where the path does not exist or holds no mission.
pub fn discover(base: &Path, pattern: &str, format: &MissionFormat, buses: &[u32]) -> Result<Discovery, IngestError> {
    let mut found = Discovery::default();
    let walked = walk(base, pattern, if *format == MissionFormat::ZtBus { &["csv"] } else { &["csv", "txt"] })?;
    walked.refused.into_iter().for_each(|(path, finding)| found.refuse(&path, finding));
    match format {
        MissionFormat::ZtBus => walked.found.into_iter().for_each(|file| found.take(file)),
        MissionFormat::Csv(map) => found.take_tables(walked.found, map),
    }
    let mut others: Vec<u32> = found.missions.iter().map(|m| m.bus).collect();
    found.missions.retain(|m| buses.is_empty() || buses.contains(&m.bus));
    found.missions.sort_by(|a, b| (&a.name, &a.path).cmp(&(&b.name, &b.path)));
    found.refuse_twins();
    found.refused.sort_by(|a, b| a.path.cmp(&b.path));
    if found.missions.is_empty() {
        others.sort_unstable();
        others.dedup();
        let detail = match (others.is_empty(), found.refused.first()) {
            (false, _) => format!("of the buses {buses:?}, but of {others:?}; change `buses`"),
            (true, Some(file)) => format!("that can be used; {}: {}", file.path, file.findings[0]),
            (true, None) => {
                "(files named B183_2021-07-26_03-53-27_2021-07-26_07-18-47.csv, a .zip of them, or, with format = \"csv\", tables)".to_owned()
            }
        };
        return Err(IngestError::NoMissions { path: base.join(pattern), detail });
    }
    Ok(found)
}

impl Discovery {
    fn take(&mut self, Found { label, name, place }: Found) {
        let stem = name.rsplit_once('.').map_or(name.as_str(), |(stem, _)| stem).to_owned();
        if stem.to_lowercase().starts_with("metadata") {
            return;
        }
        match parse_name(&stem) {
            Ok((bus, start, end)) => {
                self.missions.push(MissionSource { name: stem, path: label, bus, start, end, place, part: None });
            }
            Err(reason) => self.refuse(&label, Finding::whole(FindingKind::NotAMission, reason)),
        }
    }

    /// Tables; each is read to know its missions.
    fn take_tables(&mut self, files: Vec<Found>, map: &Arc<TelemetryMap>) {
        let mut reader = FileReader::default();
        for Found { label, name, place } in files {
            if name.to_lowercase().starts_with("metadata") {
                continue;
            }
            let indexed = place.read(&mut reader).and_then(|content| {
                let indexed = index(&content.bytes, map);
                reader.recycle(content);
                indexed
            });
            let Index { parts, note } = match indexed {
                Ok(indexed) => indexed,
                Err(finding) => {
                    self.refuse(&label, finding);
                    continue;
                }
            };
            if let Some(note) = note {
                self.refuse(&format!("{label}!"), note);
            }
            for part in parts {
                let time = |second| DateTime::from_timestamp(second, 0).unwrap_or_default();
                let (start, end) = (time(part.span.0), time(part.span.1));
                let form = "%Y-%m-%d_%H-%M-%S";
                let name = format!("B{}_{}_{}", part.bus, start.format(form), end.format(form));
                let (path, bus) = (format!("{label}!{name}"), part.bus);
                let place = place.clone();
                self.missions.push(MissionSource { name, path, bus, start, end, place, part: Some(Arc::new(part)) });
            }
        }
    }

    /// The same mission twice would count twice: the first path is kept.
    fn refuse_twins(&mut self) {
        let mut kept: BTreeMap<String, String> = BTreeMap::new();
        for mission in std::mem::take(&mut self.missions) {
            if let Some(first) = kept.get(&mission.name) {
                let message = format!("the mission is there already as {first}; remove one of them");
                self.refuse(&mission.path, Finding::whole(FindingKind::Overlap, message));
                continue;
            }
            kept.insert(mission.name.clone(), mission.path.clone());
            self.missions.push(mission);
        }
    }

    fn refuse(&mut self, path: &str, finding: Finding) {
        self.refused.push(FileRecord::refused(path, FileKind::Mission, "", 0, finding));
    }
}

/// Name of the mission that a path of a [`MissionSource`] leads to: that of its file without the extension.
#[must_use]
pub fn mission_name(path: &str) -> &str {
    let file = path.rsplit(['/', '!']).next().unwrap_or(path);
    let file = file.strip_suffix(".gz").unwrap_or(file);
    file.rsplit_once('.').map_or(file, |(stem, _)| stem)
}

/// Bus, first and last second that the name of a mission says; `None` for other names.
#[must_use]
pub fn span_of_name(name: &str) -> Option<(u32, DateTime<Utc>, DateTime<Utc>)> {
    parse_name(name).ok()
}

/// Bus, first and last second from `B183_2021-07-26_03-53-27_2021-07-26_07-18-47`.
fn parse_name(stem: &str) -> Result<(u32, DateTime<Utc>, DateTime<Utc>), String> {
    let parsed = || {
        let (bus, times) = stem.strip_prefix('B')?.split_once('_')?;
        let (start, end) = (times.get(..19)?, times.get(20..)?);
        let time = |text| NaiveDateTime::parse_from_str(text, "%Y-%m-%d_%H-%M-%S").ok().map(|t| t.and_utc());
        Some((bus.parse().ok()?, time(start)?, time(end)?))
    };
    let form = "B<bus>_<first second>_<last second>.csv, such as B183_2021-07-26_03-53-27_2021-07-26_07-18-47.csv";
    let (bus, start, end) = parsed().ok_or_else(|| format!("the name is not that of a mission: {form}"))?;
    if end < start || end - start > MAX_DURATION {
        return Err(format!("the name says a mission from {start} to {end}; it must last from 1 s to 7 days"));
    }
    Ok((bus, start, end))
}

impl MissionSource {
    /// The mission that a file's name says, whether or not the file is there; `None` for other names.
    #[must_use]
    pub fn at(path: &Path) -> Option<Self> {
        let name = path.file_stem()?.to_string_lossy().into_owned();
        let (bus, start, end) = parse_name(&name).ok()?;
        let place = Place::File(path.to_owned());
        Some(Self { name, path: path.to_string_lossy().into_owned(), bus, start, end, place, part: None })
    }

    /// Reads the bytes; of a table with many missions, the header and its own records.
    ///
    /// # Errors
    /// The record of a refused file.
    pub fn load(&self, reader: &mut FileReader) -> Result<Content, Box<FileRecord>> {
        let content = match &self.part {
            None => self.place.read(reader),
            Some(part) => self.place.read_pieces(&part.pieces, reader),
        };
        content.map_err(|finding| Box::new(FileRecord::refused(&self.path, FileKind::Mission, "", 0, finding)))
    }

    /// Size of the content in bytes, as the system or the archive says; 0 where it does not.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.place.bytes()
    }

    pub(super) fn part(&self) -> Option<&Part> {
        self.part.as_deref()
    }

    /// The stamp of the file, or of the archive that it lies in.
    #[must_use]
    pub fn stamp(&self) -> Option<FileStamp> {
        self.place.stamp()
    }
}

/// Missions during which the bus is on another mission already, as (index, the other's path). Of two that overlap, the
/// one that starts later goes (of two that start together, the later name). `missions` are sorted by name.
#[must_use]
pub fn overlaps(missions: &[MissionSource]) -> Vec<(usize, FileRecord)> {
    let mut order: Vec<usize> = (0..missions.len()).collect();
    order.sort_by_key(|&i| (missions[i].bus, missions[i].start, i));
    let mut refused = Vec::new();
    let mut last: Option<&MissionSource> = None;
    for i in order {
        let mission = &missions[i];
        match last {
            Some(other) if other.bus == mission.bus && mission.start <= other.end => {
                let message = format!(
                    "bus {} is on the mission {} until {}; one of them is wrong: remove it",
                    mission.bus, other.path, other.end
                );
                let finding = Finding::whole(FindingKind::Overlap, message);
                refused.push((i, FileRecord::refused(&mission.path, FileKind::Mission, "", 0, finding)));
            }
            _ => last = Some(mission),
        }
    }
    refused.sort_by_key(|(i, _)| *i);
    refused
}
