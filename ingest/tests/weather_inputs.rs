//! Weather as people have it: what common tools write is read as it was meant, what contradicts the layout or the sun is
//! refused with the likely cause.

#![expect(clippy::unwrap_used, reason = "a test ends where something is not as expected")]

use chrono::{DateTime, TimeDelta, TimeZone, Utc};
use ingest::weather::{
    Clock, ColumnMap, IrradianceSplit, IrradianceUnit, TemperatureUnit, TimeLabel, Weather, WeatherFormat,
    WeatherOptions, discover, read,
};
use ingest::{FileRecord, FindingKind, IngestError};
use shading::Site;
use std::fmt::Write as _;

fn options(format: WeatherFormat) -> WeatherOptions {
    let site = Site::new(47.3779, 8.5657).unwrap();
    let zone = chrono_tz::Europe::Zurich;
    WeatherOptions { format, station: None, max_gap_s: 10_800, split: IrradianceSplit::Erbs, site, zone }
}

fn load(files: &[(&str, &str)], options: &WeatherOptions) -> Result<(Weather, Vec<FileRecord>), IngestError> {
    let dir = tempfile::tempdir().unwrap();
    for (name, text) in files {
        std::fs::write(dir.path().join(name), text).unwrap();
    }
    read(&discover(dir.path(), "", &options.format)?, options)
}

fn map() -> ColumnMap {
    ColumnMap::hourly("time", TimeLabel::Start, "t", "g")
}

fn csv(text: &str, map: ColumnMap) -> Result<(Weather, Vec<FileRecord>), IngestError> {
    load(&[("w.csv", text)], &options(WeatherFormat::Csv(map)))
}

fn utc(text: &str) -> DateTime<Utc> {
    text.parse().unwrap()
}

/// Temperature in °C and irradiances of the hour that begins at an instant.
fn hour(weather: &Weather, start: &str) -> (f64, f64, f64) {
    let mean = weather.mean(utc(start), utc(start) + TimeDelta::hours(1)).unwrap();
    let round = |x: f64| (x * 1e9).round() / 1e9;
    (round(mean.ambient_temperature_k - 273.15), round(mean.dni_w_m2), round(mean.dhi_w_m2))
}

/// Clear days from a start on, by the hour: the temperature is 10 °C and half a degree more each hour of the day, the global
/// irradiance 70 % of what arrives above. `stamp` says the time, `value` a temperature and an irradiance.
fn clear(
    start: DateTime<Utc>,
    hours: i64,
    stamp: impl Fn(DateTime<Utc>) -> String,
    value: impl Fn(f64, f64) -> String,
) -> String {
    let site = Site::new(47.3779, 8.5657).unwrap();
    let mut text = "time,t,g\n".to_owned();
    for n in 0..hours {
        let at = start + TimeDelta::hours(n);
        let sun = |minute| site.sun(at + TimeDelta::minutes(minute)).altitude_rad.sin().max(0.0);
        let light = 0.7 * 1367.0 * (sun(10) + sun(30) + sun(50)) / 3.0;
        let _ = writeln!(text, "{},{}", stamp(at), value(10.0 + 0.5 * (n % 24) as f64, light));
    }
    text
}

type Stamp<'a> = &'a dyn Fn(DateTime<Utc>) -> String;

fn june() -> DateTime<Utc> {
    Utc.with_ymd_and_hms(2021, 6, 1, 0, 0, 0).unwrap()
}

fn plain(t: f64, g: f64) -> String {
    format!("{t:.2},{g:.1}")
}

fn rfc(at: DateTime<Utc>) -> String {
    at.format("%Y-%m-%dT%H:%M:%SZ").to_string()
}

fn refusal(text: &str, map: ColumnMap) -> String {
    csv(text, map).unwrap_err().to_string()
}

#[test]
fn prop_stamps_of_common_tools_give_the_same_hours() {
    let meant = csv(&clear(june(), 72, rfc, plain), map()).unwrap().0;
    let midnight_alone = |at: DateTime<Utc>| {
        if at.format("%H").to_string() == "00" {
            at.format("%Y-%m-%d").to_string()
        } else {
            at.format("%Y-%m-%d %H:%M:%S").to_string()
        }
    };
    let stamps: [(&str, Stamp<'_>); 5] = [
        ("without seconds", &|at| at.format("%Y-%m-%dT%H:%MZ").to_string()),
        ("a date alone", &midnight_alone),
        ("with an offset", &|at| (at + TimeDelta::hours(2)).format("%Y-%m-%dT%H:%M+0200").to_string()),
        ("seconds since 1970", &|at| format!("{}.0", at.timestamp())),
        ("of Europe", &|at| at.format("%d.%m.%Y %H:%M").to_string()),
    ];
    for (what, stamp) in stamps {
        assert_eq!(csv(&clear(june(), 72, stamp, plain), map()).unwrap().0, meant, "{what}");
    }
    // Ends as 24:00, and some a minute early.
    let end = |at: DateTime<Utc>| {
        let text = (at + TimeDelta::hours(1)).format("%Y-%m-%d %H:%M").to_string();
        if text.ends_with("00:00") { at.format("%Y-%m-%d 24:00").to_string() } else { text }
    };
    let map_of_ends = || ColumnMap { time_label: TimeLabel::End, ..map() };
    assert_eq!(csv(&clear(june(), 72, end, plain), map_of_ends()).unwrap().0, meant);
    let early = |at: DateTime<Utc>| {
        if at < june() + TimeDelta::hours(20) { end(at) } else { at.format("%Y-%m-%d %H:59").to_string() }
    };
    let (weather, records) = csv(&clear(june(), 72, early, plain), map_of_ends()).unwrap();
    assert_eq!(weather, meant);
    let moved: Vec<_> = records[0].findings.iter().map(|f| (f.kind, f.count, f.line)).collect();
    assert_eq!(moved, [(FindingKind::MovedStamp, 52, Some(22))]);
    let middle = |at: DateTime<Utc>| at.format("%Y-%m-%dT%H:30:00Z").to_string();
    let map_of_middles = ColumnMap { time_label: TimeLabel::Middle, ..map() };
    assert_eq!(csv(&clear(june(), 72, middle, plain), map_of_middles).unwrap().0, meant);
    let message = refusal(&clear(june(), 72, middle, plain), map());
    assert!(
        message.contains("line 2, column time: 2021-06-01 00:30: ") && message.contains("`time_label = \"middle\"`"),
        "{message}"
    );
}

#[test]
fn prop_bare_stamps_mean_the_clock_that_the_study_names() {
    let start = Utc.with_ymd_and_hms(2021, 3, 27, 0, 0, 0).unwrap();
    let local = |at: DateTime<Utc>| at.with_timezone(&chrono_tz::Europe::Zurich).format("%Y-%m-%dT%H:%M").to_string();
    let text = clear(start, 48, local, plain);
    let meant = csv(&clear(start, 48, rfc, plain), map()).unwrap().0;
    let zurich = Clock::Zone(chrono_tz::Europe::Zurich);
    assert_eq!(csv(&text, ColumnMap { clock: zurich, ..map() }).unwrap().0, meant);
    let message = refusal(&text, map());
    assert!(message.contains("column g: ") && message.contains("intervals have more light than the sun"), "{message}");
    assert!(message.contains("what fits: `time_zone = \"Europe/Zurich\"`"), "{message}");
    // Autumn has an hour twice.
    let start = Utc.with_ymd_and_hms(2021, 10, 30, 0, 0, 0).unwrap();
    let text = clear(start, 48, local, plain);
    let (weather, records) = csv(&text, ColumnMap { clock: zurich, ..map() }).unwrap();
    assert_eq!(weather, csv(&clear(start, 48, rfc, plain), map()).unwrap().0);
    assert_eq!(records[0].findings, []);
    // Half an hour beside full hours of UTC.
    let india = |at: DateTime<Utc>| (at + TimeDelta::minutes(330)).format("%Y-%m-%d %H:%M").to_string();
    let text = clear(start + TimeDelta::minutes(30), 24, india, |t, _| format!("{t},0"));
    let weather = csv(&text, ColumnMap { clock: Clock::Offset(19_800), ..map() }).unwrap().0;
    assert_eq!(hour(&weather, "2021-10-30T01:30:00Z").0, 10.5);
    assert_eq!(hour(&weather, "2021-10-30T02:00:00Z").0, 10.75);
}

#[test]
fn prop_a_layout_that_the_file_contradicts_is_refused_with_what_fits() {
    let text = clear(june(), 240, rfc, plain);
    let half_hourly = |at: DateTime<Utc>| {
        let n = (at - june()).num_hours();
        rfc(june() + TimeDelta::minutes(30 * n))
    };
    let message = refusal(&clear(june(), 72, half_hourly, |t, _| format!("{t},0")), map());
    assert!(
        message.contains("line 3, column time: the stamps are 1800 s apart") && message.contains("`interval_s = 1800`"),
        "{message}"
    );
    let message = refusal(&text, ColumnMap { time_label: TimeLabel::End, ..map() });
    assert!(message.contains("what fits: `time_label = \"start\"`"), "{message}");
    for (factor, unit) in [(3.6, "kJ/m2"), (3600.0, "J/m2"), (0.36, "J/cm2"), (0.0036, "MJ/m2")] {
        // Ten days of J/cm² could be as many of fog: what is too dark takes longer to tell.
        let days = if factor < 1.0 { 60 } else { 10 };
        let message = refusal(&clear(june(), 24 * days, rfc, |t, g| format!("{t},{}", g * factor)), map());
        assert!(message.contains(&format!("`irradiance_unit = {unit:?}`")), "{unit}: {message}");
    }
    let units: [(&str, &dyn Fn(f64) -> f64); 3] =
        [("K", &|t| t + 273.15), ("F", &|t| 1.8 * (t + 20.0) + 32.0), ("0.1C", &|t| 10.0 * t)];
    for (unit, of) in units {
        let message = refusal(&clear(june(), 240, rfc, |t, g| format!("{:.2},{g:.1}", of(t))), map());
        assert!(message.contains(&format!("`temperature_unit = {unit:?}`")), "{unit}: {message}");
    }
    // The keys that the messages name mend it.
    let meant = csv(&text, map()).unwrap().0;
    let era5 = clear(june(), 240, rfc, |t, g| format!("{:.2},{}", t + 273.15, (g * 10.0).round() / 10.0 * 3600.0));
    let units =
        ColumnMap { temperature_unit: TemperatureUnit::Kelvin, irradiance_unit: IrradianceUnit::JoulePerM2, ..map() };
    let read = csv(&era5, units).unwrap().0;
    assert_eq!(hour(&read, "2021-06-02T10:00:00Z"), hour(&meant, "2021-06-02T10:00:00Z"));
}

#[test]
fn prop_a_column_that_is_mostly_unusable_refuses_the_file() {
    let decimal_commas = |t: f64, g: f64| format!("\"{t:.1}\",\"{g:.1}\"").replace('.', ",");
    let message = refusal(&clear(june(), 72, rfc, decimal_commas), map());
    assert!(message.contains("line 2, column t: \"10,0\": 72 of 72 values cannot be used"), "{message}");
    assert!(message.contains("probably decimal commas"), "{message}");
    // Whole numbers among them can be read, and help nobody.
    let whole = |t: f64, g: f64| decimal_commas(t, g).replace(",0\"", "\"");
    let message = refusal(&clear(june(), 72, rfc, whole), map());
    assert!(message.contains("36 of 72 values cannot be used") && message.contains("decimal commas"), "{message}");
    let back = |at: DateTime<Utc>| {
        let n = (at - june()).num_hours();
        rfc(at - TimeDelta::hours(if n % 6 == 5 { 4 } else { 0 }))
    };
    let sorted_wrong = clear(june(), 48, back, |t, _| format!("{t},0"));
    let message = refusal(&sorted_wrong, map());
    assert!(message.contains("rows cannot be used, more than 10 %"), "{message}");
}

#[test]
fn prop_months_of_several_years_are_a_reference_year() {
    let january = Utc.with_ymd_and_hms(2022, 1, 1, 0, 0, 0).unwrap();
    let of_year = |at: DateTime<Utc>| {
        let year = if at.format("%m").to_string() == "01" { 2018 } else { 2007 };
        format!("{year}{}", at.format("-%m-%dT%H:%M:%SZ"))
    };
    let (weather, records) = csv(&clear(january, 59 * 24, of_year, plain), map()).unwrap();
    assert_eq!(hour(&weather, "2021-02-11T05:00:00Z").0, 12.5);
    assert_eq!(hour(&weather, "1999-01-11T23:00:00Z").0, 21.5);
    assert!(records[0].findings.iter().any(|f| f.kind == FindingKind::ReferenceYear));
    // Told by the study, one year of hours is one too.
    let told = ColumnMap { reference_year: Some(true), ..map() };
    let (weather, _) = csv(&clear(january, 59 * 24, rfc, plain), told).unwrap();
    assert_eq!(hour(&weather, "2021-02-11T05:00:00Z").0, 12.5);
    // A series with a gap of a year is none.
    let with_gap = |at: DateTime<Utc>| {
        let later = if at.format("%m").to_string() == "01" { 0 } else { 400 };
        rfc(at + TimeDelta::days(later))
    };
    let (weather, records) = csv(&clear(january, 59 * 24, with_gap, plain), map()).unwrap();
    assert_eq!(hour(&weather, "2023-03-08T05:00:00Z").0, 12.5);
    assert!(records[0].findings.iter().all(|f| f.kind != FindingKind::ReferenceYear));
}

fn ogd(columns: &str, rows: &[&str]) -> String {
    let rows: Vec<String> = rows.iter().map(|row| format!("SMA;10.02.2021 {row}\n")).collect();
    format!("station_abbr;reference_timestamp;{columns}\n{}", rows.concat())
}

#[test]
fn prop_files_join_value_by_value() {
    let columns = "tre200h0;gre000h0;ods000h0";
    let now = ogd(columns, &["10:00;35.0;900;", "11:00;;;", "12:00;2.5;;"]);
    let recent = ogd(columns, &["10:00;1.0;100;", "11:00;1.5;200;", "12:00;;150;"]);
    let historical = ogd(columns, &["09:00;0.5;60;40", "10:00;0.9;110;70"]);
    let files = [
        ("ogd-smn_sma_h_now.csv", &now),
        ("ogd-smn_sma_h_recent.csv", &recent),
        ("ogd-smn_sma_h_historical_x.csv", &historical),
    ];
    let files = files.map(|(name, text)| (name, text.as_str()));
    let (weather, _) = load(&files, &options(WeatherFormat::MeteoSwissOgd)).unwrap();
    // Historical beats recent beats now, and any of them beats nothing.
    let temperatures = ["08", "09", "10", "11"].map(|h| hour(&weather, &format!("2021-02-10T{h}:00:00Z")).0);
    assert_eq!(temperatures, [0.5, 0.9, 1.5, 2.5]);
    // Diffuse irradiance is that of the sensor where one measured, else of the model, interval by interval.
    let site = Site::new(47.3779, 8.5657).unwrap();
    let modelled = |start: &str, global: f64| {
        let sun = site.sun(utc(start) + TimeDelta::minutes(30)).altitude_rad;
        ingest::irradiance::erbs(global, sun, 41).dhi_w_m2
    };
    assert_eq!(hour(&weather, "2021-02-10T08:00:00Z").2, 40.0);
    assert_eq!(hour(&weather, "2021-02-10T09:00:00Z").2, 70.0);
    for (start, global) in [("2021-02-10T10:00:00Z", 200.0), ("2021-02-10T11:00:00Z", 150.0)] {
        assert!((hour(&weather, start).2 - modelled(start, global)).abs() < 1e-6, "{start}");
    }
}

#[test]
fn prop_files_are_known_by_their_header() {
    let sia =
        "station,time.yy,time.mm,time.dd,time.hh,temp,rad.global,rad.direct,rad.diffus\nSMA,2001,2,10,8,3,0,0,5\n";
    let metadata = "Station;Abbr.\nZürich;SMA\n";
    let files = [("SMA_2023_DRY.csv", sia), ("SIA4028_metadata_2023.csv", metadata), ("notes.txt", "to be kept")];
    let (weather, records) = load(&files, &options(WeatherFormat::Sia4028)).unwrap();
    assert_eq!((records.len(), hour(&weather, "2021-02-10T08:00:00Z")), (1, (3.0, 0.0, 5.0)));
    let scenario =
        "time.yy,time.mm,time.dd,time.hh,tre200h0,skycover,gls,str.diffus,str.direkt\n2060,1,15,9,3.1,90,16,16,0\n";
    let (weather, _) = load(&[("SMA_2060_RCP85_DRY.csv", scenario)], &options(WeatherFormat::Sia4028)).unwrap();
    assert_eq!(hour(&weather, "2021-01-15T08:00:00Z"), (3.1, 0.0, 16.0));
    // A file of something else is refused with what it is; one of another format in a folder is another study's.
    let (_, records) = load(&[("a.csv", sia), ("b.csv", "x,y\n1,2\n")], &options(WeatherFormat::Sia4028)).unwrap();
    assert_eq!(
        records.iter().filter(|r| !r.accepted).map(|r| r.findings[0].kind).collect::<Vec<_>>(),
        [FindingKind::OtherFormat]
    );
    let (_, records) =
        load(&[("a.csv", sia), ("b.csv", &ogd("tre200h0;gre000h0", &["10:00;1;0"]))], &options(WeatherFormat::Sia4028))
            .unwrap();
    assert_eq!(records.len(), 1);
    let message = refusal(sia, map());
    assert!(message.contains("of the format csv") && message.ends_with("w.csv is of the format sia4028"), "{message}");
}

#[test]
fn prop_long_files_are_read_as_such_or_refused() {
    let mut text =
        "\u{feff}\"Datum\",\"Standort\",\"Parameter\",\"Intervall\",\"Einheit\",\"Wert\",\"Status\"\n".to_owned();
    for n in 0..24 {
        for (station, parameter, value) in [
            ("Rosen", "RainDur", 7),
            ("Rosen", "T", 20),
            ("Stampf", "RainDur", 9),
            ("Stampf", "T", n),
            ("Stampf", "StrGlo", 0),
        ] {
            let _ = writeln!(
                text,
                "\"2021-01-15T{n:02}:00+0100\",\"{station}\",\"{parameter}\",\"h1\",\"\",{value},\"bereinigt\""
            );
        }
    }
    let (weather, records) = load(&[("ugz_ogd_meteo_h1_2021.csv", &text)], &options(WeatherFormat::Ugz)).unwrap();
    assert_eq!((hour(&weather, "2021-01-15T07:00:00Z").0, records[0].findings.len()), (8.0, 0));
    let one_column = ColumnMap::hourly("Datum", TimeLabel::Start, "Wert", "Wert");
    let message = refusal(&text, one_column);
    assert!(message.contains("96 of 120 rows cannot be used") && message.contains("`format = \"ugz\"`"), "{message}");
    let daily = text.replace("\"h1\"", "\"d1\"");
    let message = load(&[("d.csv", &daily)], &options(WeatherFormat::Ugz)).unwrap_err().to_string();
    assert!(message.contains("no hourly values"), "{message}");
}

#[test]
fn prop_hours_of_true_solar_time_are_spread_over_full_hours() {
    let tu = "STATIONS_ID;MESS_DATUM;QN_9;TT_TU;RF_TU;eor\n        183;2021021010;   3;   1.5;  90;eor\n\
              183;2021021011;   3;   2.5;  90;eor\n183;2021021012;   3;  -999;  90;eor\n";
    let st = "STATIONS_ID;MESS_DATUM;QN_592;ATMO_LBERG;FD_LBERG;FG_LBERG;SD_LBERG;ZENIT;MESS_DATUM_WOZ;eor\n\
              183;2021021009:15;  1;-999;  3.6;  36.0;  0;70;2021021010:00;eor\n\
              183;2021021010:15;  1;-999; 10.8;  72.0;  0;70;2021021011:00;eor\n\
              183;2021021011:15;  1;-999; 18.0; 108.0;  0;70;2021021012:00;eor\n";
    let files = [("produkt_tu_stunde_x_183.txt", tu), ("produkt_st_stunde_x_183.txt", st)];
    let (weather, records) = load(&files, &options(WeatherFormat::Dwd)).unwrap();
    assert!(records.iter().all(|r| r.accepted));
    // 3.6 J/cm² in an hour are 10 W/m²; the hour from 9 has 15 min of the first row and 45 of the second.
    let (temperature, _, diffuse) = hour(&weather, "2021-02-10T09:00:00Z");
    assert_eq!((temperature, diffuse), (1.5, 0.25 * 10.0 + 0.75 * 30.0));
    assert_eq!(hour(&weather, "2021-02-10T10:00:00Z").2, 0.25 * 30.0 + 0.75 * 50.0);
}

#[test]
fn prop_lines_above_the_header_are_passed_over() {
    let above = "latitude,longitude,elevation,utc_offset_seconds,timezone,timezone_abbreviation\n\
                 47.38,8.55,450.0,3600,Europe/Zurich,GMT+1\n\ntime,temperature_2m (°C),shortwave_radiation (W/m²),direct_normal_irradiance (W/m²)\n\
                 2021-02-11T01:00,-5.05,0.0,0.0\n2021-02-11T12:00,-4.0,300.0,100.0\n\ntime,temperature_2m_max (°C)\n2021-02-11,3\n";
    let (weather, records) =
        load(&[("open-meteo-47.38N8.55E450m.csv", above)], &options(WeatherFormat::OpenMeteo)).unwrap();
    assert_eq!(hour(&weather, "2021-02-10T23:00:00Z").0, -5.05);
    let (_, dni, dhi) = hour(&weather, "2021-02-11T10:00:00Z");
    let sun = Site::new(47.3779, 8.5657).unwrap().sun(utc("2021-02-11T10:30:00Z")).altitude_rad.sin();
    assert!((dni - 100.0).abs() < 1e-9 && (dhi - (300.0 - 100.0 * sun)).abs() < 1e-6);
    assert_eq!(records[0].rows, 2);
    let named = ColumnMap {
        time_label: TimeLabel::End,
        clock: Clock::Offset(3600),
        ..ColumnMap::hourly("time", TimeLabel::End, "temperature_2m (°C)", "shortwave_radiation (W/m²)")
    };
    assert_eq!(hour(&csv(above, named).unwrap().0, "2021-02-10T23:00:00Z").0, -5.05);
    let fahrenheit = above.replace("(°C)", "(°F)").replace("-5.05", "23").replace("-4.0", "24.8");
    let (weather, _) = load(&[("w.csv", &fahrenheit)], &options(WeatherFormat::OpenMeteo)).unwrap();
    assert_eq!(hour(&weather, "2021-02-10T23:00:00Z").0, -5.0);
}

#[test]
fn prop_local_hours_of_an_epw_are_those_of_its_place() {
    let mut text = "LOCATION,Tokyo,-,JPN,test,476620,35.70,139.77,9.0,6\n".to_owned();
    text.push_str(&"COMMENTS\n".repeat(6));
    text.push_str("DATA PERIODS,1,1,Data,Sunday,1/1,12/31\n");
    let first = Utc.with_ymd_and_hms(2001, 1, 1, 0, 0, 0).unwrap();
    for n in 0..8760 {
        let at = (first + TimeDelta::hours(n)).format("%Y,%-m,%-d");
        let temperature = if n == 100 { 99.9 } else { n as f64 / 1000.0 };
        let _ = writeln!(text, "{at},{},60,x,{temperature},0,0,0,0,0,0,0,0,0,0,0", n % 24 + 1);
    }
    let site = Site::new(35.7, 139.8).unwrap();
    let of_tokyo = || WeatherOptions { site, ..options(WeatherFormat::Epw) };
    // A year without light is none of a sunny place.
    let message = load(&[("tokyo.epw", &text)], &of_tokyo()).unwrap_err().to_string();
    assert!(message.contains("no hour of") && message.contains("outside the atmosphere"), "{message}");
    let lit = text.replace(",12,60,x,", ",12,60,y,");
    let lit: String = lit
        .lines()
        .map(|line| if line.contains(",y,") { line.replace(",0,0,0,0,0,0,0,0,0,0,0", ",0,0,0,0,0,0,300,400,100,0,0") } else { line.to_owned() } + "\n")
        .collect();
    let (weather, records) = load(&[("tokyo.epw", &lit)], &of_tokyo()).unwrap();
    // The first hour of the year begins at 15:00 of the day before in UTC; the year is repeated by date.
    assert_eq!(hour(&weather, "2020-12-31T15:00:00Z").0, 0.0);
    assert_eq!(hour(&weather, "2021-01-01T02:00:00Z"), (0.011, 400.0, 100.0));
    assert!(
        records[0].findings.iter().any(|f| f.kind == FindingKind::MissingValue && f.count == 1),
        "{:?}",
        records[0]
    );
    let (_, records) = load(&[("tokyo.epw", &lit)], &options(WeatherFormat::Epw)).unwrap();
    assert!(records[0].findings.iter().any(|f| f.kind == FindingKind::OtherPlace));
}
