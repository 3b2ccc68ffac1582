//! Weather files as pvlib and pandas read them, hour by hour.

#![expect(clippy::unwrap_used, reason = "a test ends where something is not as expected")]

use chrono::{TimeDelta, TimeZone, Utc};
use ingest::weather::{
    ColumnMap, IrradianceSplit, TimeLabel, Weather, WeatherFormat, WeatherMean, WeatherOptions, discover, read,
};
use shading::Site;
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
    let mut compared = 0;
    for row in &rows {
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
    assert!(compared > 85_000, "{compared} of {} rows", rows.len());
}
