//! Missions and weather files into the database; a mission whose content is known is not parsed again.

use ingest::mission::{self, MissionSource};
use ingest::weather::{self, Weather};
use ingest::{FileKind, FileRecord, Finding, FindingKind};
use std::collections::BTreeMap;
use store::{FileRow, FindingRow, LoadRow, SegmentRow, Store};

use crate::console::{Console, Stop};
use crate::failure::Failure;
use crate::study::{Study, hash};

/// Missions that are read at a time, per thread: while one is hashed and taken in, polars parses another.
const READERS_A_THREAD: usize = 2;

pub fn ingest(study: &Study, store: &mut Store, console: &Console, stop: Stop) -> Result<(), Failure> {
    missions(study, store, console, stop)?;
    read_weather(study, store).map(|_| ())
}

fn missions(study: &Study, store: &mut Store, console: &Console, stop: Stop) -> Result<(), Failure> {
    let found = mission::discover(&study.base, &study.missions_path, &study.buses)?;
    let overlapping: BTreeMap<usize, FileRecord> = mission::overlaps(&found.missions).into_iter().collect();
    let known: BTreeMap<String, String> =
        store.known_files("mission")?.into_iter().map(|f| (f.path, f.reading_key)).collect();
    let wanted: Vec<&MissionSource> =
        found.missions.iter().enumerate().filter(|(i, _)| !overlapping.contains_key(i)).map(|(_, m)| m).collect();

    let options = &study.missions;
    let settings = format!("{} {} {}", options.segment_s, options.door_open_share, options.keep_partial);
    let bar = console.bar("missions", wanted.len() as u64);
    let mut read_now = 0;
    let read = |buffer: &mut Vec<u8>, source: &&MissionSource| {
        let content = match source.load(std::mem::take(buffer)) {
            Ok(content) => content,
            Err(record) => {
                return (String::new(), source.path.clone(), Some((refused_row(record), Vec::new(), Vec::new())));
            }
        };
        let key = study.reading_key(&content.blake3, &settings);
        let reading = (known.get(&source.path) != Some(&key)).then(|| {
            let reading = mission::read(source, &content, options);
            let segments = segment_rows(source.bus, &reading);
            let load =
                |l: &mission::Load| LoadRow { second: l.second, passengers: l.passengers, door_open: l.door_open };
            let loads: Vec<LoadRow> = reading.loads.iter().map(load).collect();
            (file_row(reading.file, key), segments, loads)
        });
        let blake3 = content.blake3.clone();
        *buffer = content.bytes;
        (blake3, source.path.clone(), reading)
    };
    // The first path of every content.
    let mut contents: BTreeMap<String, String> = BTreeMap::new();
    ingest::in_order(&wanted, READERS_A_THREAD * rayon::current_num_threads(), read, |(blake3, path, reading)| {
        if stop() {
            return Err(Failure::Interrupted);
        }
        if let Some(first) = contents.get(&blake3).filter(|_| !blake3.is_empty()) {
            let message = format!("the same content as {first}, under another name; remove one of them");
            let finding = Finding::whole(FindingKind::Overlap, message);
            let record = FileRecord::refused(&path, FileKind::Mission, &blake3, 0, finding);
            store.put_file(&refused_row(record), &[])?;
        } else {
            contents.insert(blake3, path);
            if let Some((file, segments, loads)) = reading {
                store.put_mission(&file, &segments, &loads)?;
                read_now += 1;
            }
        }
        bar.inc(1);
        Ok(())
    })?;
    bar.finish_and_clear();
    let mut paths: Vec<String> = found.missions.iter().map(|m| m.path.clone()).collect();
    for record in overlapping.into_values().chain(found.refused) {
        paths.push(record.path.clone());
        store.put_file(&refused_row(record), &[])?;
    }
    let forgotten = store.keep_files("mission", &paths)?;
    console.info(&format!("{} missions: {read_now} read now, {forgotten} no longer there", paths.len()));
    Ok(())
}

/// Reads the weather, and what there is to say of its files.
pub fn weather_of(study: &Study) -> Result<(Weather, Vec<FileRecord>), Failure> {
    let files = weather::discover(&study.base, &study.weather_path, &study.weather.format)?;
    Ok(weather::read(&files, &study.weather)?)
}

/// Reads the weather and records its files.
pub fn read_weather(study: &Study, store: &mut Store) -> Result<Weather, Failure> {
    let (weather, records) = weather_of(study)?;
    let mut paths = Vec::new();
    for record in records {
        paths.push(record.path.clone());
        let key = study.reading_key(&record.blake3, "weather");
        store.put_file(&file_row(record, key), &[])?;
    }
    store.keep_files("weather", &paths)?;
    Ok(weather)
}

/// The record of a file that was never read: known again by its reason.
fn refused_row(record: FileRecord) -> FileRow {
    let reason = record.findings.first().map(Finding::to_string).unwrap_or_default();
    let key = hash(&["refused", &record.path, &reason]);
    file_row(record, key)
}

pub fn file_row(record: FileRecord, reading_key: String) -> FileRow {
    let time = |t: Option<chrono::DateTime<chrono::Utc>>| t.map(rfc3339);
    FileRow {
        path: record.path,
        kind: record.kind.name().to_owned(),
        blake3: record.blake3,
        bytes: record.bytes,
        rows: record.rows,
        first_utc: time(record.first),
        last_utc: time(record.last),
        accepted: record.accepted,
        reading_key,
        findings: record
            .findings
            .into_iter()
            .map(|f| FindingRow {
                kind: f.kind.name().to_owned(),
                count: f.count,
                line: f.line,
                column: f.column,
                message: f.message,
            })
            .collect(),
    }
}

fn segment_rows(bus: u32, reading: &mission::MissionReading) -> Vec<SegmentRow> {
    let kept = reading.segments.iter().map(|s| SegmentRow {
        mission: s.mission.clone(),
        bus,
        segment: s.segment,
        start_utc: rfc3339(s.start),
        duration_s: s.duration_s,
        content: Ok((s.passengers, s.door_open_fraction, s.first_line, s.last_line)),
    });
    let excluded = reading.excluded.iter().map(|e| SegmentRow {
        mission: e.mission.clone(),
        bus,
        segment: e.segment,
        start_utc: rfc3339(e.start),
        duration_s: 0,
        content: Err(e.reason.to_string()),
    });
    let mut rows: Vec<SegmentRow> = kept.chain(excluded).collect();
    rows.sort_by_key(|r| r.segment);
    rows
}

pub fn rfc3339(time: chrono::DateTime<chrono::Utc>) -> String {
    time.to_rfc3339_opts(chrono::SecondsFormat::Secs, true)
}
