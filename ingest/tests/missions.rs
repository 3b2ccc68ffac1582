//! Mission files: what is read from good ones, and what is said of bad ones.

#![expect(clippy::unwrap_used, reason = "a test ends where something is not as expected")]

use chrono::{DateTime, Utc};
use ingest::mission::{MissionFormat, MissionOptions, MissionReading, RouteChoice, discover, overlaps, read};
use ingest::{ExclusionReason, FileReader, FindingKind, IngestError};
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};

const OPTIONS: MissionOptions =
    MissionOptions { segment_s: 3600, door_open_share: 0.6, keep_partial: false, routes: RouteChoice::All };
const NAME: &str = "B183_2022-01-10_06-00-00_2022-01-10_08-29-59.csv";
const START_S: i64 = 1_641_794_400;
const HEADER: &str = "time_iso,time_unix,itcs_numberOfPassengers,itcs_stopName,status_doorIsOpen,temperature_ambient";

/// A mission of 2.5 hours: 10 passengers from second 600 on, 30 from second 3600 on, doors open in the first quarter of
/// every minute.
fn rows() -> Vec<String> {
    (0..9000)
        .map(|i| {
            let passengers = match i {
                600 => "10",
                3600 => "30",
                _ => "NaN",
            };
            let stop = if i == 600 { "\"Zürich, Letzipark\"" } else { "\"-\"" };
            let door = if i == 8999 { "NaN" } else { ["0", "1"][usize::from(i % 60 < 15)] };
            format!("\"x\",{},{passengers},{stop},{door},281.15", START_S + i)
        })
        .collect()
}

fn file(rows: &[String], newline: &str) -> Vec<u8> {
    let mut text = HEADER.to_owned();
    for row in rows {
        let _ = write!(text, "{newline}{row}");
    }
    text.push_str(newline);
    text.into_bytes()
}

fn read_bytes(bytes: &[u8], options: &MissionOptions) -> MissionReading {
    let dir = tempfile::tempdir().unwrap();
    std::fs::write(dir.path().join(NAME), bytes).unwrap();
    read_folder(dir.path(), options).remove(0)
}

fn read_folder(dir: &Path, options: &MissionOptions) -> Vec<MissionReading> {
    let found = discover(dir, "", &MissionFormat::ZtBus, &[]).unwrap();
    found.missions.iter().map(|m| read(m, &m.load(&mut FileReader::default()).unwrap(), options)).collect()
}

/// The only finding of a kind.
fn finding(reading: &MissionReading, kind: FindingKind) -> &ingest::Finding {
    let found: Vec<_> = reading.file.findings.iter().filter(|f| f.kind == kind).collect();
    assert_eq!(found.len(), 1, "{:?}", reading.file.findings);
    found[0]
}

fn data() -> PathBuf {
    let beside = || PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/data"));
    std::env::var_os("BUSCLIMATE_DATA").map_or_else(beside, PathBuf::from)
}

#[test]
fn prop_counts_hold_and_doors_are_shared() {
    let reading = read_bytes(&file(&rows(), "\r\n"), &OPTIONS);
    assert_eq!(reading.file.findings, []);
    assert_eq!(reading.file.rows, 9000);
    assert_eq!(reading.segments.len(), 2);
    let first = &reading.segments[0];
    assert!((first.passengers - 10.0 * 3000.0 / 3600.0).abs() < 1e-12);
    assert!((first.door_open_fraction - 0.25 * 0.6).abs() < 1e-12);
    assert_eq!((first.first_line, first.last_line), (2, 3601));
    assert_eq!(first.start, DateTime::<Utc>::from_timestamp(START_S, 0).unwrap());
    assert!((reading.segments[1].passengers - 30.0).abs() < 1e-12);
    assert_eq!((reading.segments[1].first_line, reading.segments[1].last_line), (3602, 7201));
    assert_eq!(reading.excluded.len(), 1);
    assert_eq!(reading.excluded[0].reason, ExclusionReason::Partial { segment_s: 3600 }.to_string());
}

#[test]
fn prop_the_last_part_is_kept_on_demand() {
    let reading = read_bytes(&file(&rows(), "\n"), &MissionOptions { keep_partial: true, ..OPTIONS });
    assert_eq!(reading.segments.len(), 3);
    assert_eq!(reading.segments[2].duration_s, 1800);
    assert!((reading.segments[2].passengers - 30.0).abs() < 1e-12);
}

#[test]
fn prop_line_ends_and_byte_order_mark_change_nothing() {
    let crlf = read_bytes(&file(&rows(), "\r\n"), &OPTIONS);
    let lf = read_bytes(&file(&rows(), "\n"), &OPTIONS);
    let marked = read_bytes(&[b"\xef\xbb\xbf".as_slice(), &file(&rows(), "\n")].concat(), &OPTIONS);
    assert_eq!(crlf.segments, lf.segments);
    assert_eq!(crlf.segments, marked.segments);
}

#[test]
fn prop_an_archive_gives_what_the_folder_gives() {
    let dir = tempfile::tempdir().unwrap();
    let mut zip = zip::ZipWriter::new(std::fs::File::create(dir.path().join("ZTBus.zip")).unwrap());
    let options = zip::write::SimpleFileOptions::default();
    zip.start_file(format!("ZTBus/{NAME}"), options).unwrap();
    zip.write_all(&file(&rows(), "\r\n")).unwrap();
    zip.start_file("ZTBus/metaData.csv", options).unwrap();
    zip.write_all(b"name,busNumber\r\n").unwrap();
    zip.finish().unwrap();
    let mut archived = read_folder(dir.path(), &OPTIONS).remove(0);
    let path = format!("ZTBus.zip!ZTBus/{NAME}");
    assert_eq!(archived.file.path, path);
    for segment in &mut archived.segments {
        assert_eq!(segment.source_path, path);
        NAME.clone_into(&mut segment.source_path);
    }
    assert_eq!(archived.segments, read_bytes(&file(&rows(), "\r\n"), &OPTIONS).segments);
}

#[test]
fn prop_an_archive_entry_that_climbs_out_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    let mut zip = zip::ZipWriter::new(std::fs::File::create(dir.path().join("ZTBus.zip")).unwrap());
    let options = zip::write::SimpleFileOptions::default();
    zip.start_file(format!("../../{NAME}"), options).unwrap();
    zip.write_all(&file(&rows(), "\n")).unwrap();
    zip.start_file(NAME, options).unwrap();
    zip.write_all(&file(&rows(), "\n")).unwrap();
    zip.finish().unwrap();
    let found = discover(dir.path(), "ZTBus.zip", &MissionFormat::ZtBus, &[]).unwrap();
    assert_eq!(found.missions.len(), 1);
    assert_eq!(found.refused.len(), 1);
    assert_eq!(found.refused[0].path, format!("ZTBus.zip!../../{NAME}"));
    assert_eq!(found.refused[0].findings[0].kind, FindingKind::UnsafePath);
}

#[test]
fn prop_a_missing_column_names_the_columns_found() {
    let bytes = b"time_unix,itcs_numberOfPassengers,temperature_ambient\n1641794400,1,280\n";
    let reading = read_bytes(bytes, &OPTIONS);
    assert!(!reading.file.accepted);
    let message = finding(&reading, FindingKind::MissingColumn).to_string();
    assert!(message.starts_with("line 1, column status_doorIsOpen: "), "{message}");
    assert!(message.ends_with("time_unix, itcs_numberOfPassengers, temperature_ambient"), "{message}");
}

#[test]
fn prop_another_delimiter_is_named() {
    let bytes = String::from_utf8(file(&rows(), "\n")).unwrap().replace(',', ";");
    let reading = read_bytes(bytes.as_bytes(), &OPTIONS);
    assert!(!reading.file.accepted);
    let message = finding(&reading, FindingKind::WrongDelimiter).to_string();
    assert!(message.contains("';'") && message.contains("','"), "{message}");
}

#[test]
fn prop_another_encoding_is_refused_with_its_line() {
    let text = String::from_utf8(file(&rows(), "\n")).unwrap();
    let utf16: Vec<u8> = [0xfeff].into_iter().chain(text.encode_utf16()).flat_map(u16::to_le_bytes).collect();
    assert_eq!(finding(&read_bytes(&utf16, &OPTIONS), FindingKind::WrongEncoding).line, Some(1));
    let latin: Vec<u8> = text.chars().map(|c| u8::try_from(u32::from(c)).unwrap()).collect();
    let reading = read_bytes(&latin, &OPTIONS);
    assert!(!reading.file.accepted);
    assert_eq!(finding(&reading, FindingKind::WrongEncoding).line, Some(602));
}

#[test]
fn prop_empty_files_are_refused() {
    for bytes in [b"".as_slice(), b"\n\n", HEADER.as_bytes(), format!("{HEADER}\r\n").as_bytes()] {
        let reading = read_bytes(bytes, &OPTIONS);
        assert!(!reading.file.accepted);
        assert!(finding(&reading, FindingKind::Empty).line.is_some());
    }
}

#[test]
fn prop_a_truncated_file_keeps_its_whole_segments() {
    let whole = file(&rows(), "\r\n");
    let at = whole.iter().enumerate().filter(|(_, b)| **b == b'\n').nth(5000).unwrap().0;
    let reading = read_bytes(&whole[..at + 9], &OPTIONS);
    assert!(reading.file.accepted);
    assert_eq!(reading.segments.len(), 1);
    let truncated = finding(&reading, FindingKind::Truncated);
    assert!(truncated.message.contains("4000 s"), "{}", truncated.message);
    assert_eq!(finding(&reading, FindingKind::RefusedRow).line, Some(5002));
    let reasons: Vec<_> = reading.excluded.iter().map(|e| e.reason.as_str()).collect();
    let expected = [ExclusionReason::TelemetryGap, ExclusionReason::Partial { segment_s: 3600 }];
    assert_eq!(reasons, expected.map(|r| r.to_string()));
}

#[test]
fn prop_time_that_runs_backwards_is_refused_with_its_line() {
    let mut rows = rows();
    rows[4000] = rows[3990].clone();
    rows[4010] = rows[4009].clone();
    let reading = read_bytes(&file(&rows, "\n"), &OPTIONS);
    let backwards = finding(&reading, FindingKind::RefusedRow);
    assert_eq!((backwards.line, backwards.count), (Some(4002), 1));
    assert!(backwards.message.contains("backwards"));
    assert_eq!(finding(&reading, FindingKind::DuplicateRow).line, Some(4012));
    // Two seconds without a row: the state before holds, and the segment is kept.
    assert_eq!(finding(&reading, FindingKind::TimeGap).count, 2);
    assert_eq!(reading.segments.len(), 2);
}

#[test]
fn prop_gaps_exclude_a_segment_beyond_one_per_cent() {
    for (gap, kept) in [(36, 2), (37, 1)] {
        let mut rows = rows();
        rows.drain(4000..4000 + gap);
        let reading = read_bytes(&file(&rows, "\n"), &OPTIONS);
        assert_eq!(reading.segments.len(), kept);
    }
}

#[test]
fn prop_values_that_cannot_be_are_named_with_line_and_text() {
    let mut rows = rows();
    rows[600] = rows[600].replace(",10,", ",ten,");
    rows[700] = rows[700].replace(",NaN,", ",900,");
    rows[20] = rows[20].replace("281.15", "8.0");
    rows[30] = rows[30].replace("1641794430", "later");
    let reading = read_bytes(&file(&rows, "\n"), &OPTIONS);
    let refused = finding(&reading, FindingKind::RefusedValue);
    assert_eq!(
        refused.to_string(),
        "line 602, column itcs_numberOfPassengers: \"ten\": not a number; the last count holds"
    );
    let refused = finding(&reading, FindingKind::OutOfRange);
    assert_eq!(refused.line, Some(702));
    assert!(refused.message.starts_with("\"900\""), "{}", refused.message);
    let celsius = finding(&reading, FindingKind::WrongUnit);
    assert_eq!((celsius.line, celsius.column.as_deref()), (Some(22), Some("temperature_ambient")));
    assert_eq!(finding(&reading, FindingKind::RefusedRow).line, Some(32));
    assert_eq!(reading.segments[0].passengers, 0.0);
}

#[test]
fn prop_lines_are_right_behind_blank_lines_and_line_breaks_in_quotes() {
    let mut rows = rows();
    rows[100] = rows[100].replace("\"-\"", "\"a\nb\"");
    rows[200].insert(0, '\n');
    rows[5000] = rows[5000].replace(&format!("{}", START_S + 5000), "never");
    let reading = read_bytes(&file(&rows, "\n"), &OPTIONS);
    // The blank line is a row without values.
    let refused = finding(&reading, FindingKind::RefusedRow);
    assert_eq!((refused.line, refused.count), (Some(203), 2));
    assert_eq!((reading.segments[1].first_line, reading.segments[1].last_line), (3604, 7203));
}

#[test]
fn prop_rows_outside_the_named_span_refuse_the_file() {
    let shifted: Vec<String> = rows().iter().map(|r| r.replace(",1641", ",1741")).collect();
    let reading = read_bytes(&file(&shifted, "\n"), &OPTIONS);
    assert!(!reading.file.accepted);
    assert!(finding(&reading, FindingKind::RefusedRow).message.contains("2022-01-10 06:00:00 UTC"));
}

#[test]
fn prop_overlapping_missions_of_a_bus_lose_the_later_one() {
    let dir = tempfile::tempdir().unwrap();
    for name in [
        "B183_2022-01-10_06-00-00_2022-01-10_08-29-59.csv",
        "B183_2022-01-10_08-00-00_2022-01-10_10-00-00.csv",
        "B183_2022-01-10_08-30-00_2022-01-10_11-00-00.csv",
        "B208_2022-01-10_06-00-00_2022-01-10_08-29-59.csv",
    ] {
        std::fs::write(dir.path().join(name), "").unwrap();
    }
    let found = discover(dir.path(), "", &MissionFormat::ZtBus, &[]).unwrap();
    let refused = overlaps(&found.missions);
    assert_eq!(refused.len(), 1);
    assert_eq!(refused[0].1.path, "B183_2022-01-10_08-00-00_2022-01-10_10-00-00.csv");
    assert!(refused[0].1.findings[0].message.contains("B183_2022-01-10_06-00-00"));
}

#[test]
fn prop_what_is_no_mission_is_said() {
    let dir = tempfile::tempdir().unwrap();
    let empty = discover(dir.path(), "", &MissionFormat::ZtBus, &[]).unwrap_err();
    assert!(matches!(empty, IngestError::NoMissions { .. }));
    assert!(matches!(discover(dir.path(), "nowhere", &MissionFormat::ZtBus, &[]), Err(IngestError::Path { .. })));
    std::fs::write(dir.path().join(NAME), "").unwrap();
    std::fs::write(dir.path().join("metaData.csv"), "").unwrap();
    std::fs::write(dir.path().join("notes.csv"), "").unwrap();
    std::fs::write(dir.path().join("B183_2022-01-10_06-00-00_2012-01-10_08-29-59.csv"), "").unwrap();
    let found = discover(dir.path(), "", &MissionFormat::ZtBus, &[183]).unwrap();
    assert_eq!(found.missions.len(), 1);
    assert_eq!(found.refused.len(), 2);
    assert!(found.refused.iter().all(|f| f.findings[0].kind == FindingKind::NotAMission));
    let other = discover(dir.path(), "*.csv", &MissionFormat::ZtBus, &[208]).unwrap_err().to_string();
    assert!(other.contains("[183]"), "{other}");
}

#[test]
fn xval_python_the_real_mission_has_the_rows_and_door_seconds_that_python_counts() {
    let Ok(found) = discover(&data(), "ztbus", &MissionFormat::ZtBus, &[183]) else {
        eprintln!("skipped: no real data under {}; set BUSCLIMATE_DATA", data().display());
        return;
    };
    let mission = &found.missions[0];
    let options = MissionOptions { keep_partial: true, ..OPTIONS };
    let reading = read(mission, &mission.load(&mut FileReader::default()).unwrap(), &options);
    assert_eq!(reading.file.rows, 12_321);
    assert_eq!(reading.file.findings, []);
    assert_eq!(reading.segments.len(), 4);
    assert_eq!(reading.segments.iter().map(|s| s.duration_s).sum::<u32>(), 12_321);
    // Seconds with an open door, counted with Python's csv module.
    for (segment, open_s) in reading.segments.iter().zip([702.0, 1077.0, 1158.0]) {
        assert!((segment.door_open_fraction - 0.6 * open_s / 3600.0).abs() < 1e-12, "{segment:?}");
    }
    // metaData.csv of ZTBus: distance and energy of the mission, by its authors.
    let distance_m: f64 = reading.segments.iter().map(|s| s.distance_m.unwrap()).sum();
    let energy_j: f64 = reading.segments.iter().map(|s| s.vehicle_power_w.unwrap() * f64::from(s.duration_s)).sum();
    assert!((distance_m / 48_274.1 - 1.0).abs() < 0.002, "{distance_m}");
    assert!((energy_j / 2.13587e8 - 1.0).abs() < 0.002, "{energy_j}");
    assert_eq!(reading.segments[1].route.as_deref(), Some("83"));
}
