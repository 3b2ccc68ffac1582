//! Weather files as pvlib and pandas read them, hour by hour.

#![expect(clippy::unwrap_used, reason = "a test ends where something is not as expected")]

use chrono::{NaiveDateTime, TimeDelta, TimeZone, Utc};
use ingest::weather::{
    ColumnMap, IrradianceSplit, TimeLabel, Weather, WeatherFormat, WeatherMean, WeatherOptions, discover, read,
};
use shading::Site;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use testing::peer;

fn data() -> PathBuf {
    let beside = || PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/data"));
    std::env::var_os("BUSCLIMATE_DATA").map_or_else(beside, PathBuf::from).join("weather")
}

fn load(folder: &Path, file: &str, format: WeatherFormat) -> Weather {
    let site = Site::new(45.0, 8.0).unwrap();
    let zone = chrono_tz::Europe::Rome;
    let options = WeatherOptions { format, station: None, max_gap_s: 10_800, split: IrradianceSplit::Erbs, site, zone };
    read(&discover(folder, file, &options.format).unwrap(), &options).unwrap().0
}

fn hour(weather: &Weather, [month, day, hour]: [u32; 3]) -> Option<WeatherMean> {
    let start = Utc.with_ymd_and_hms(2021, month, day, hour, 0, 0).unwrap();
    weather.mean(start, start + TimeDelta::hours(1)).ok()
}

#[test]
fn xval_pvlib_weather_files_give_the_same_hours() {
    let folder = data();
    if !folder.exists() {
        println!("skipped: no real data under {}; set BUSCLIMATE_DATA", folder.display());
        return;
    }
    let epw = load(&folder, "pvgis_tmy_45.000_8.000_2005_2023.epw", WeatherFormat::Epw);
    let pvgis = load(&folder, "pvgis_tmy_45.000_8.000_2005_2023.csv", WeatherFormat::Pvgis);
    let first = Utc.with_ymd_and_hms(2021, 1, 1, 0, 0, 0).unwrap();
    for start in (0..8760).map(|n| first + TimeDelta::hours(n)) {
        let mean = |weather: &Weather| weather.mean(start, start + TimeDelta::hours(1)).unwrap();
        assert_eq!(mean(&epw), mean(&pvgis), "{start}");
    }
    let ugz = ColumnMap::hourly("interval_start_utc", TimeLabel::Start, "T_degC", "StrGlo_Wm2");
    let files = [
        ("pvgis", pvgis),
        ("epw", epw),
        ("sia4028", load(&folder, "sia4028_SMA_2023_DRY.csv", WeatherFormat::Sia4028)),
        ("csv", load(&folder, "ugz_stampfenbachstrasse_h1_2019-2022.csv", WeatherFormat::Csv(ugz))),
    ];
    let Some(rows) = peer("weather.py", "pvlib", &[folder.to_string_lossy().into_owned()]) else { return };
    assert!(compare(&files, &rows) > 85_000, "of {} rows", rows.len());
}

/// Compares what both have, to 1e-6.
fn compare(files: &[(&str, Weather)], rows: &[Vec<String>]) -> u32 {
    let mut compared = 0;
    for row in rows {
        let (_, weather) = files.iter().find(|(kind, _)| kind == &row[0]).unwrap();
        let time = [1, 2, 3].map(|i| row[i].parse::<u32>().unwrap());
        let [temperature, dni, dhi] = [4, 5, 6].map(|i| row[i].parse::<f64>().ok());
        let Some(ours) = hour(weather, time) else {
            assert_eq!(temperature, None, "{row:?}");
            continue;
        };
        let pairs = [(temperature, ours.ambient_temperature_k - 273.15), (dni, ours.dni_w_m2), (dhi, ours.dhi_w_m2)];
        for (theirs, ours) in pairs {
            assert!(theirs.is_none_or(|theirs| (theirs - ours).abs() < 1e-6), "{row:?}: {ours}");
            compared += u32::from(theirs.is_some());
        }
    }
    compared
}

/// Hours of a real year in the layouts in which others publish theirs: value by value as pvlib and pandas read them.
#[test]
fn xval_pvlib_layouts_of_other_services_give_the_same_hours() {
    let source = data().join("pvgis_tmy_45.000_8.000_2005_2023.csv");
    let Ok(text) = std::fs::read_to_string(&source) else {
        println!("skipped: no real data at {}; set BUSCLIMATE_DATA", source.display());
        return;
    };
    let mut series = "Latitude (decimal degrees):\t45.000\nLongitude (decimal degrees):\t8.000\nElevation (m):\t250\n\
        Radiation database:\tPVGIS-SARAH\n\n\nSlope: 0 deg. \nAzimuth: 0 deg. \n\
        time,Gb(i),Gd(i),Gr(i),H_sun,T2m,WS10m,Int\n"
        .to_owned();
    let mut meteo = "latitude,longitude,elevation,utc_offset_seconds,timezone,timezone_abbreviation\n\
        45.0,8.0,250.0,3600,Europe/Rome,GMT+1\n\n\
        time,temperature_2m (°C),relative_humidity_2m (%),shortwave_radiation (W/m²),diffuse_radiation (W/m²)\n"
        .to_owned();
    let mut air = "STATIONS_ID;MESS_DATUM;QN_9;TT_TU;RF_TU;eor\r\n".to_owned();
    let mut solar =
        "STATIONS_ID;MESS_DATUM;QN_592;ATMO_LBERG;FD_LBERG;FG_LBERG;SD_LBERG;ZENIT;MESS_DATUM_WOZ;eor\r\n".to_owned();
    let mut city = "\"Datum\",\"Standort\",\"Parameter\",\"Intervall\",\"Einheit\",\"Wert\",\"Status\"\r\n".to_owned();
    for row in text.lines().skip_while(|line| !line.starts_with("time(UTC)")).skip(1).take(8760) {
        let field: Vec<&str> = row.split(',').collect();
        let [temperature, global, diffuse] = [1, 3, 5].map(|n| field[n].parse::<f64>().unwrap());
        let start = NaiveDateTime::parse_from_str(&format!("2021{}", &field[0][4..]), "%Y%m%d:%H%M").unwrap();
        let beam = global - diffuse;
        let moment = start.format("%Y%m%d:%H10");
        writeln!(series, "{moment},{beam:.2},{diffuse},0.0,30.0,{temperature},1.5,0.0").unwrap();
        // Stamped at the end, in local time.
        let end = (start + TimeDelta::hours(2)).format("%Y-%m-%dT%H:%M");
        writeln!(meteo, "{end},{temperature},71,{global},{diffuse}").unwrap();
        writeln!(
            air,
            "        183;{};    3;{temperature:6};  71.0;eor\r",
            (start + TimeDelta::hours(1)).format("%Y%m%d%H")
        )
        .unwrap();
        // Sums; the values are those of some minutes after the full hour, the middle of these intervals.
        let end = (start + TimeDelta::minutes(40)).format("%Y%m%d%H:%M");
        let [global, diffuse] = [global, diffuse].map(|w_m2| w_m2 * 0.36);
        writeln!(solar, "        183;{end};    1;   -999;{diffuse:9.1};{global:9.1};   0;   80.00;2021010101:00;eor\r")
            .unwrap();
        let local = (start + TimeDelta::hours(1)).format("%Y-%m-%dT%H:%M+0100");
        for (name, unit, value) in [("T", "°C", temperature), ("StrGlo", "W/m2", global / 0.36)] {
            writeln!(
                city,
                "\"{local}\",\"Zch_Stampfenbachstrasse\",\"{name}\",\"h1\",\"{unit}\",{value},\"bereinigt\"\r"
            )
            .unwrap();
        }
    }
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    write("series.csv", &series);
    write("meteo.csv", &meteo);
    write("produkt_tu_stunde_20210101_20211231_00183.txt", &air);
    write("produkt_st_stunde_20210101_20211231_00183.txt", &solar);
    write("city.csv", &city);
    let files = [
        ("series", load(folder.path(), "series.csv", WeatherFormat::Pvgis)),
        ("meteo", load(folder.path(), "meteo.csv", WeatherFormat::OpenMeteo)),
        ("dwd", load(folder.path(), "produkt_*.txt", WeatherFormat::Dwd)),
        ("ugz", load(folder.path(), "city.csv", WeatherFormat::Ugz)),
    ];
    let Some(rows) = peer("layouts.py", "pvlib", &[folder.path().to_string_lossy().into_owned()]) else { return };
    let compared = compare(&files, &rows);
    assert!(compared > 45_000, "{compared} of {} rows", rows.len());
}
