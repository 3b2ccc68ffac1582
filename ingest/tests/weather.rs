//! Weather files: formats, gaps, irradiance, weights.

#![expect(clippy::unwrap_used, reason = "a test ends where something is not as expected")]

use chrono::{DateTime, TimeDelta, TimeZone, Utc};
use ingest::irradiance::{BeamAndDiffuse, closure, erbs, extraterrestrial_w_m2};
use ingest::weather::{ColumnMap, IrradianceSplit, TimeLabel, Weather, WeatherFormat, WeatherOptions, discover, read};
use ingest::{ExclusionReason, FileRecord, FindingKind, IngestError};
use proptest::prelude::*;
use shading::Site;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

fn options(format: WeatherFormat) -> WeatherOptions {
    let site = Site::new(47.3779, 8.5657).unwrap();
    let zone = chrono_tz::Europe::Zurich;
    WeatherOptions { format, station: None, max_gap_s: 10_800, split: IrradianceSplit::Erbs, site, zone }
}

fn map(label: TimeLabel) -> ColumnMap {
    ColumnMap::hourly("time", label, "t", "g")
}

fn load(dir: &Path, options: &WeatherOptions) -> Result<(Weather, Vec<FileRecord>), IngestError> {
    read(&discover(dir, "", &options.format)?, options)
}

fn write(files: &[(&str, &str)]) -> tempfile::TempDir {
    let dir = tempfile::tempdir().unwrap();
    for (name, text) in files {
        std::fs::write(dir.path().join(name), text).unwrap();
    }
    dir
}

fn day(hour: u32) -> DateTime<Utc> {
    Utc.with_ymd_and_hms(2021, 6, 21, hour, 0, 0).unwrap()
}

/// 21 June 2021 by the hour: temperature = hour in °C, global irradiance 100 W/m² by day.
fn june(skip: &[u32]) -> String {
    let mut text = "time,t,g\n".to_owned();
    for hour in 0..24 {
        let value = if skip.contains(&hour) { String::new() } else { hour.to_string() };
        let light = if (5..19).contains(&hour) { 100 } else { 0 };
        let _ = writeln!(text, "{},{value},{light}", day(hour).to_rfc3339());
    }
    text
}

fn celsius(weather: &Weather, start: DateTime<Utc>, seconds: i64) -> Result<f64, ExclusionReason> {
    weather.mean(start, start + TimeDelta::seconds(seconds)).map(|m| m.ambient_temperature_k - 273.15)
}

fn data() -> PathBuf {
    let beside = || PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/data"));
    std::env::var_os("BUSCLIMATE_DATA").map_or_else(beside, PathBuf::from)
}

#[test]
fn prop_a_mean_weights_intervals_by_their_overlap() {
    let dir = write(&[("w.csv", &june(&[]))]);
    let (start, _) = load(dir.path(), &options(WeatherFormat::Csv(map(TimeLabel::Start)))).unwrap();
    let from = day(10) + TimeDelta::seconds(900);
    assert!((celsius(&start, from, 3600).unwrap() - (10.0 * 0.75 + 11.0 * 0.25)).abs() < 1e-9);
    let (end, _) = load(dir.path(), &options(WeatherFormat::Csv(map(TimeLabel::End)))).unwrap();
    assert!((celsius(&end, from, 3600).unwrap() - (11.0 * 0.75 + 12.0 * 0.25)).abs() < 1e-9);
    let outside = Err(ExclusionReason::OutsideWeather);
    assert_eq!(celsius(&start, day(23) + TimeDelta::seconds(1), 3600), outside);
    assert_eq!(celsius(&start, day(0) - TimeDelta::seconds(1), 3600), outside);
}

#[test]
fn prop_short_gaps_are_interpolated_and_long_ones_exclude() {
    let dir = write(&[("w.csv", &june(&[5, 6, 7, 12, 13, 14, 15]))]);
    let (weather, records) = load(dir.path(), &options(WeatherFormat::Csv(map(TimeLabel::Start)))).unwrap();
    let mean = weather.mean(day(6), day(7)).unwrap();
    assert!((mean.ambient_temperature_k - 279.15).abs() < 1e-9);
    assert_eq!(mean.interpolated_s, 3600.0);
    assert_eq!(celsius(&weather, day(13), 3600), Err(ExclusionReason::WeatherGap { max_gap_s: 10_800 }));
    assert_eq!(celsius(&weather, day(11) + TimeDelta::seconds(1), 3600).ok(), None);
    assert!(celsius(&weather, day(11), 3600).is_ok());
    let counts: Vec<_> = records[0].findings.iter().map(|f| (f.kind, f.count)).collect();
    assert!(counts.contains(&(FindingKind::Interpolated, 3)), "{counts:?}");
    assert!(counts.contains(&(FindingKind::TimeGap, 4)), "{counts:?}");
}

#[test]
fn prop_measured_components_stay_as_they_are() {
    let text = "time,t,dh,dn\n2021-06-21T10:00:00Z,20,120,700\n";
    let dir = write(&[("w.csv", text)]);
    let map = ColumnMap {
        ghi_column: None,
        dhi_column: Some("dh".to_owned()),
        dni_column: Some("dn".to_owned()),
        ..map(TimeLabel::Start)
    };
    let (weather, _) = load(dir.path(), &options(WeatherFormat::Csv(map))).unwrap();
    let mean = weather.mean(day(10), day(11)).unwrap();
    assert_eq!((mean.dni_w_m2, mean.dhi_w_m2), (700.0, 120.0));
}

fn ogd(station: &str, columns: &str, rows: &[&str]) -> String {
    let mut text = format!("station_abbr;reference_timestamp;{columns}\n");
    for row in rows {
        let _ = writeln!(text, "{station};{row}");
    }
    text
}

#[test]
fn prop_files_of_a_station_are_joined_in_any_order() {
    let columns = "tre200h0;gre000h0;ods000h0";
    let a = ogd("SMA", columns, &["01.01.2021 01:00;1;0;", "01.01.2021 02:00;2;0;"]);
    let b = ogd("SMA", columns, &["01.01.2021 02:00;2;0;", "01.01.2021 03:00;3;0;"]);
    let start = Utc.with_ymd_and_hms(2021, 1, 1, 0, 0, 0).unwrap();
    let mut means = Vec::new();
    for names in [["ogd-smn_sma_h_a.csv", "ogd-smn_sma_h_b.csv"], ["ogd-smn_sma_h_b.csv", "ogd-smn_sma_h_a.csv"]] {
        let dir = write(&[(names[0], &a), (names[1], &b), ("ogd-smn_meta_stations.csv", "x")]);
        let (weather, records) = load(dir.path(), &options(WeatherFormat::MeteoSwissOgd)).unwrap();
        assert_eq!(records.len(), 2);
        assert_eq!(records.iter().flat_map(|r| &r.findings).filter(|f| f.kind == FindingKind::DuplicateRow).count(), 1);
        means.push(weather.mean(start, start + TimeDelta::hours(3)).unwrap());
    }
    // The stamp is the end of the hour.
    assert!((means[0].ambient_temperature_k - 275.15).abs() < 1e-9);
    assert_eq!(means[0], means[1]);
}

#[test]
fn prop_stations_and_intervals_must_not_be_mixed() {
    let hourly = |s: &str| ogd(s, "tre200h0;gre000h0;ods000h0", &["01.01.2021 01:00;1;0;"]);
    let minutes = ogd("SMA", "tre200s0;gre000z0;ods000z0", &["01.01.2021 01:00;1;0;"]);
    let dir = write(&[("ogd-smn_sma_h_1.csv", &hourly("SMA")), ("ogd-smn_ber_h_1.csv", &hourly("BER"))]);
    let mut options = options(WeatherFormat::MeteoSwissOgd);
    let message = load(dir.path(), &options).unwrap_err().to_string();
    assert!(message.contains("\"ber\", \"sma\""), "{message}");
    options.station = Some("KLO".to_owned());
    let message = load(dir.path(), &options).unwrap_err().to_string();
    assert!(message.contains("\"klo\"") && message.contains("\"sma\""), "{message}");
    options.station = Some("SMA".to_owned());
    assert_eq!(load(dir.path(), &options).unwrap().1.len(), 1);
    std::fs::write(dir.path().join("ogd-smn_sma_t_1.csv"), minutes).unwrap();
    let message = load(dir.path(), &options).unwrap_err().to_string();
    assert!(message.contains("3600 s") && message.contains("600 s"), "{message}");
}

#[test]
fn prop_bad_weather_values_are_recorded_with_line_and_remedy() {
    let text = "time,t,g\n2021-06-21T00:00:00Z,10,-3\n2021-06-21T01:00:00Z,10,-50\n2021-06-21T02:00:00Z,75,0\n\
                2021-06-21T01:00:00Z,10,0\nnoon,10,0\n2021-06-21T03:00:00Z,x,0\n";
    let dir = write(&[("w.csv", text)]);
    let (_, records) = load(dir.path(), &options(WeatherFormat::Csv(map(TimeLabel::Start)))).unwrap();
    let said: Vec<String> = records[0].findings.iter().map(|f| format!("{} {f}", f.kind.name())).collect();
    for (kind, place) in [
        ("negative_offset", "line 2, column g"),
        ("out_of_range", "line 3, column g: -50"),
        ("out_of_range", "line 4, column t: 75"),
        ("refused_row", "line 5, column time: time runs backwards"),
        ("refused_value", "line 7, column t: \"x\""),
    ] {
        assert!(said.iter().any(|s| s.starts_with(&format!("{kind} {place}"))), "{kind} {place}: {said:#?}");
    }
    let refused = records[0].findings.iter().find(|f| f.kind == FindingKind::RefusedRow).unwrap();
    assert_eq!(refused.count, 2);
}

#[test]
fn prop_unusable_weather_files_say_why() {
    let csv = || WeatherFormat::Csv(map(TimeLabel::Start));
    let mut kelvin = "time,t,g\n".to_owned();
    for hour in 0..24 {
        let _ = writeln!(kelvin, "{},{},0", day(hour).to_rfc3339(), 280 + hour);
    }
    for (text, part) in [
        ("", "line 1: the file is empty"),
        ("time,t,g\n", "line 2: there are no usable rows"),
        (
            "time,temp,g\n2021-06-21T00:00:00Z,1,1\n",
            "line 1, column t: the column is missing; the file has: time, temp, g",
        ),
        ("time;t;g\n2021-06-21T00:00:00Z;1;1\n", "line 1: columns are separated by ';'"),
        ("time,t,g\n2021-06-21T00:00:00Z,283,1\n", "line 2, column t: 1 of 1 temperatures are outside -60 … 60 °C"),
    ] {
        let dir = write(&[("w.csv", text)]);
        let message = load(dir.path(), &options(csv())).unwrap_err().to_string();
        assert!(message.starts_with("w.csv: ") && message.contains(part), "{message}");
    }
    let dir = write(&[("w.csv", &kelvin)]);
    assert!(load(dir.path(), &options(csv())).unwrap_err().to_string().contains("`temperature_unit = \"K\"`"));
    let utf16: Vec<u8> = "time,t,g\n".encode_utf16().flat_map(u16::to_be_bytes).collect();
    std::fs::write(dir.path().join("w.csv"), utf16).unwrap();
    assert!(load(dir.path(), &options(csv())).unwrap_err().to_string().contains("UTF-8"));
}

#[test]
fn prop_a_reference_year_repeats_by_date_and_shifts_end_stamps() {
    let mut text = "station,time.yy,time.mm,time.dd,time.hh,temp,rad.global,rad.direct,rad.diffus\n".to_owned();
    let first = Utc.with_ymd_and_hms(2021, 1, 1, 0, 0, 0).unwrap();
    for hour in 0..8760 {
        let t = first + TimeDelta::hours(hour);
        // January is stamped at the end of the hour, February at its start.
        let year = if t.format("%m").to_string() == "01" { 2019 } else { 2011 };
        let light = if t.format("%H").to_string() == "11" { 200 } else { 0 };
        let _ = writeln!(text, "X,{year},{},{},0,0,{light}", t.format("%m,%d,%H"), hour as f64 / 1000.0);
    }
    let dir = write(&[("sia4028_x.csv", &text)]);
    let (weather, records) = load(dir.path(), &options(WeatherFormat::Sia4028)).unwrap();
    let at = |year, month, day, hour| {
        let start = Utc.with_ymd_and_hms(year, month, day, hour, 0, 0).unwrap();
        celsius(&weather, start, 3600).unwrap()
    };
    assert!((at(2022, 1, 10, 5) - (9.0 * 24.0 + 6.0) / 1000.0).abs() < 1e-9);
    assert!((at(1999, 3, 10, 5) - ((31.0 + 28.0 + 9.0) * 24.0 + 5.0) / 1000.0).abs() < 1e-9);
    assert_eq!(at(2020, 2, 29, 5), at(2020, 2, 28, 5));
    // Between the two stampings one hour is missing: 31 January 23:00, filled from its neighbours.
    assert!((at(2022, 1, 31, 23) - 0.5 * (at(2022, 1, 31, 22) + at(2022, 2, 1, 0))).abs() < 1e-9);
    assert!(records[0].findings.iter().any(|f| f.kind == FindingKind::Interpolated && f.count == 1));
}

/// Values of pvlib 0.16.1, `irradiance.erbs` and `irradiance.get_extra_radiation`; `tests/peers/erbs.py` prints them.
#[test]
fn xval_pvlib_erbs_and_extraterrestrial_radiation() {
    for (day, value) in PVLIB_EXTRA {
        assert!((extraterrestrial_w_m2(day) - value).abs() < 1e-9 * value, "{day}");
    }
    for (ghi, altitude_deg, day, dni, dhi) in PVLIB_ERBS {
        let split = erbs(ghi, f64::to_radians(altitude_deg), day);
        assert!(
            (split.dni_w_m2 - dni).abs() < 1e-6 && (split.dhi_w_m2 - dhi).abs() < 1e-6,
            "{ghi} {altitude_deg} {split:?}"
        );
    }
}

include!("reference/pvlib_erbs.rs");

proptest! {
    #[test]
    fn prop_splits_close_and_stay_physical(ghi in 0.0..1500.0_f64, diffuse in 0.0..1.2_f64, altitude in -0.5..1.57_f64, day in 1..366_u32) {
        for BeamAndDiffuse { dni_w_m2, dhi_w_m2 } in [erbs(ghi, altitude, day), closure(ghi, diffuse * ghi, altitude, day)] {
            prop_assert!(dni_w_m2 >= 0.0 && dhi_w_m2 >= 0.0 && dni_w_m2 <= extraterrestrial_w_m2(day));
            prop_assert!((dni_w_m2 * altitude.sin().max(0.0) + dhi_w_m2 - ghi).abs() < 1e-9);
        }
    }
}

#[test]
fn xval_meteoswiss_real_files_are_read() {
    let dir = data().join("weather");
    if !dir.exists() {
        eprintln!("skipped: no real data under {}; set BUSCLIMATE_DATA", data().display());
        return;
    }
    let options = |format| WeatherOptions { station: Some("sma".to_owned()), ..options(format) };
    let files = discover(&dir, "ogd-smn_*_t_*.csv", &WeatherFormat::MeteoSwissOgd).unwrap();
    assert_eq!(files.files.len(), 2);
    let (weather, records) = read(&files, &options(WeatherFormat::MeteoSwissOgd)).unwrap();
    assert_eq!(records.len(), 1);
    // 01.01.2025 00:10 in the file: −2.9 °C, the mean from 00:00 to 00:10.
    let start = Utc.with_ymd_and_hms(2025, 1, 1, 0, 0, 0).unwrap();
    assert!((celsius(&weather, start, 600).unwrap() + 2.9).abs() < 1e-9);

    let files = discover(&dir, "sia4028_SMA_2023_DRY.csv", &WeatherFormat::Sia4028).unwrap();
    let (weather, records) = read(&files, &options(WeatherFormat::Sia4028)).unwrap();
    assert_eq!(records[0].rows, 8760);
    let year = Utc.with_ymd_and_hms(2022, 1, 1, 0, 0, 0).unwrap();
    let mean = weather.mean(year, year + TimeDelta::days(365)).unwrap();
    // The means of the columns; two hours at the borders between the stampings are interpolated.
    assert!((mean.ambient_temperature_k - 273.15 - SIA_MEANS[0]).abs() < 1e-2, "{mean:?}");
    assert!((mean.dni_w_m2 - SIA_MEANS[1]).abs() < 0.2 && (mean.dhi_w_m2 - SIA_MEANS[2]).abs() < 0.2, "{mean:?}");

    let map = ColumnMap::hourly("interval_start_utc", TimeLabel::Start, "T_degC", "StrGlo_Wm2");
    let format = WeatherFormat::Csv(map);
    let files = discover(&dir, "ugz_stampfenbachstrasse_h1_2019-2022.csv", &format).unwrap();
    let (_, records) = read(&files, &WeatherOptions { station: None, ..options(format) }).unwrap();
    assert_eq!(records[0].rows, 35_064);
    let missing = |column: &str| {
        let found = records[0].findings.iter();
        found
            .filter(|f| f.kind == FindingKind::MissingValue && f.column.as_deref() == Some(column))
            .map(|f| f.count)
            .sum::<u64>()
    };
    // README of the data: temperature is missing for 314 h, radiation for 48 h.
    assert_eq!((missing("T_degC"), missing("StrGlo_Wm2")), (314, 48));
}

/// Means of `temp`, `rad.direct` and `rad.diffus` over the file, by Python's csv module.
const SIA_MEANS: [f64; 3] = [10.545_582_191_780_795, 154.317_808_219_178, 56.149_771_689_497_72];
