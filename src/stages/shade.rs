//! Segments, weather, sun and shade into hourly samples.

use anyhow::{Context, anyhow};
use cabin::Disturbances;
use chrono::DateTime;
use ingest::mission::Segment;
use ingest::sample::{Sample, assemble};
use ingest::{Content, FileKind, FileRecord};
use shading::ShadowYear;
use std::path::Path;
use store::{ExclusionRow, SampleRow, SegmentRow, Store};

use super::ingest::{file_row, read_weather, rfc3339};
use crate::console::Console;
use crate::failure::Failure;
use crate::study::Study;

pub fn shade(study: &Study, store: &mut Store, console: &Console) -> Result<(), Failure> {
    let weather = read_weather(study, store)?;
    let (shadow, record) = read_shadow(&study.base, &study.shadow_path)?;
    let key = study.reading_key(&record.blake3, "shadow");
    let path = record.path.clone();
    store.put_file(&file_row(record, key), &[])?;
    store.keep_files("shadow", &[path])?;

    let (mut samples, mut exclusions) = (Vec::new(), Vec::new());
    for (source_path, row) in store.segments()? {
        let mut exclude = |reason: String| {
            exclusions.push(ExclusionRow {
                mission: row.mission.clone(),
                segment: row.segment,
                start_utc: row.start_utc.clone(),
                reason,
            });
        };
        match segment(&row)? {
            Err(reason) => exclude(reason),
            Ok(segment) => match assemble(segment, &weather, &study.site, &shadow, study.zone) {
                Err(excluded) => exclude(excluded.reason.to_string()),
                Ok(sample) => {
                    let sample = sample_row(sample, source_path);
                    match disturbances(&sample).check() {
                        Ok(()) => samples.push(sample),
                        Err(error) => exclude(error.to_string()),
                    }
                }
            },
        }
    }
    let excluded = exclusions.len();
    let (changed, withdrawn) = store.put_samples(&samples, &exclusions)?;
    if samples.is_empty() {
        let reason = exclusions.first().map_or("there are no segments", |e| &e.reason);
        return Err(Failure::Inputs(anyhow!("no samples: {excluded} segments are excluded, the first one: {reason}")));
    }
    console.info(&format!(
        "{} samples: {changed} new or changed, {withdrawn} withdrawn; {excluded} segments excluded",
        samples.len()
    ));
    Ok(())
}

/// The shadow fractions and the record of their file.
pub fn read_shadow(base: &Path, path: &str) -> Result<(ShadowYear, FileRecord), Failure> {
    let full = base.join(path);
    let content = Content::read(&full).map_err(|finding| Failure::Inputs(anyhow!("{}: {finding}", full.display())))?;
    let shadow =
        ShadowYear::read(content.bytes.as_slice()).with_context(|| path.to_owned()).map_err(Failure::Inputs)?;
    let record = FileRecord {
        path: path.to_owned(),
        kind: FileKind::Shadow,
        bytes: content.bytes.len() as u64,
        blake3: content.blake3,
        rows: shadow.hourly().len() as u64,
        first: None,
        last: None,
        accepted: true,
        findings: Vec::new(),
    };
    Ok((shadow, record))
}

fn segment(row: &SegmentRow) -> Result<Result<Segment, String>, Failure> {
    let start = DateTime::parse_from_rfc3339(&row.start_utc)
        .with_context(|| format!("the database holds the time {:?}", row.start_utc))
        .map_err(Failure::Inputs)?;
    Ok(row.content.clone().map(|(passengers, door_open_fraction, first_line, last_line)| Segment {
        mission: row.mission.clone(),
        bus: row.bus,
        segment: row.segment,
        start: start.to_utc(),
        duration_s: row.duration_s,
        passengers,
        door_open_fraction,
        first_line,
        last_line,
    }))
}

fn sample_row(sample: Sample, source_path: String) -> SampleRow {
    let segment = sample.segment;
    SampleRow {
        sample_id: sample.id,
        mission: segment.mission,
        source_path,
        bus: segment.bus,
        segment: segment.segment,
        first_line: segment.first_line,
        last_line: segment.last_line,
        start_utc: rfc3339(segment.start),
        duration_s: segment.duration_s,
        month: sample.month,
        ambient_temperature_k: sample.ambient_temperature_k,
        dni_w_m2: sample.dni_w_m2,
        dhi_w_m2: sample.dhi_w_m2,
        passengers: segment.passengers,
        door_open_fraction: segment.door_open_fraction,
        solar_altitude_rad: sample.solar_altitude_rad,
        solar_azimuth_rad: sample.solar_azimuth_rad,
        shadow_fraction: sample.shadow_fraction,
        interpolated_s: sample.interpolated_s,
    }
}

/// What the model sees of a sample.
pub fn disturbances(row: &SampleRow) -> Disturbances {
    Disturbances {
        ambient_temperature_k: row.ambient_temperature_k,
        dni_w_m2: row.dni_w_m2,
        dhi_w_m2: row.dhi_w_m2,
        solar_altitude_rad: row.solar_altitude_rad,
        shadow_fraction: row.shadow_fraction,
        passengers: row.passengers,
        door_open_fraction: row.door_open_fraction,
    }
}
