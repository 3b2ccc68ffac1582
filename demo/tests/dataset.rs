//! The synthetic data set: the same bytes from the same seed, and the statistics of the real one.

#![expect(clippy::unwrap_used, reason = "a test ends where something is not as expected")]

use chrono::{DateTime, Datelike, TimeZone, Timelike, Utc};
use demo::{MissionPlan, PlanError, SyntheticWeather, default_plan, read_meta_data};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// All files under a folder with their bytes.
fn files(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(files(&path));
        } else {
            found.insert(path.clone(), std::fs::read(&path).unwrap());
        }
    }
    found
}

fn write(folder: &Path, seed: u64, plans: &[MissionPlan], threads: usize) -> demo::Summary {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(|| demo::write(folder, seed, plans, None, &|_, _| ())).unwrap()
}

/// Column of a mission's file as text.
fn column(bytes: &[u8], name: &str) -> Vec<String> {
    let mut reader = csv::Reader::from_reader(bytes);
    let at = reader.headers().unwrap().iter().position(|h| h == name).unwrap();
    reader.records().map(|r| r.unwrap()[at].to_owned()).collect()
}

fn quantile(values: &mut [f64], share: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    values[((values.len() - 1) as f64 * share).round() as usize]
}

fn within(what: &str, value: f64, low: f64, high: f64) {
    assert!((low..=high).contains(&value), "{what} = {value}, not in {low} … {high}");
}

#[test]
fn prop_the_same_seed_gives_the_same_bytes_on_any_number_of_threads() {
    let plans = default_plan(6, 7).unwrap();
    let folders = [tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap()];
    for (folder, (seed, threads)) in folders.iter().zip([(7, 1), (7, 2), (8, 2)]) {
        write(folder.path(), seed, &plans, threads);
    }
    let [one, two, other] = folders.map(|f| {
        let under = |p: PathBuf| p.strip_prefix(f.path()).unwrap().to_owned();
        files(f.path()).into_iter().map(|(path, bytes)| (under(path), bytes)).collect::<BTreeMap<_, _>>()
    });
    assert!(one == two, "the thread count shows");
    assert!(one != other, "the seed does not show");
    assert!(one.keys().all(|p| p.extension().unwrap() == "csv"), "a half-written file is left: {:?}", one.keys());
}

#[test]
fn prop_missions_have_the_statistics_of_the_real_ones() {
    let plans = default_plan(24, 1).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let summary = write(folder.path(), 1, &plans, 2);
    assert_eq!(summary.missions, 24);

    let (mut dwells, mut intervals, mut hours_in_service, mut open_in_service) = (Vec::new(), Vec::new(), 0.0, 0.0);
    let (mut distance_m, mut seconds, mut standing) = (0.0, 0.0, 0.0);
    for plan in &plans {
        let bytes = std::fs::read(folder.path().join("ztbus").join(format!("{}.csv", plan.name()))).unwrap();
        let times = column(&bytes, "time_unix");
        let first: i64 = times[0].parse().unwrap();
        assert_eq!(first, plan.start.timestamp());
        assert_eq!(times.len() as i64, (plan.end - plan.start).num_seconds() + 1);
        assert!(times.iter().zip(first..).all(|(text, t)| *text == t.to_string()), "steps of one second");
        let iso = column(&bytes, "time_iso");
        let last: DateTime<Utc> = iso.last().unwrap().parse().unwrap();
        assert_eq!(last, plan.end);

        let doors = column(&bytes, "status_doorIsOpen");
        let counts: Vec<(usize, f64)> = column(&bytes, "itcs_numberOfPassengers")
            .iter()
            .enumerate()
            .filter(|(_, v)| *v != "NaN")
            .map(|(i, v)| (i, v.parse().unwrap()))
            .collect();
        let (first_count, last_count) = (counts[0].0, counts.last().unwrap().0);
        within("first count in min", first_count as f64 / 60.0, 10.0, 13.0);
        within("last count in min before the end", (times.len() - last_count) as f64 / 60.0, 12.0, 15.0);
        let mean = counts.iter().map(|c| c.1).sum::<f64>() / counts.len() as f64;
        within("distance of the mean load", mean - plan.passengers_mean, -0.5, 0.5);
        assert!(counts.iter().all(|c| c.1 <= plan.passengers_max && c.1.fract() == 0.0));
        for &(row, _) in &counts {
            let closed = doors[..row].iter().rev().take_while(|d| *d == "0").count();
            assert!(closed <= 1 && doors[row] == "0", "the count follows the closing within 2 s");
        }
        intervals.extend(counts.windows(2).map(|w| (w[1].0 - w[0].0) as f64));
        let mut open = 0;
        for door in &doors[first_count..last_count] {
            if door == "1" {
                open += 1;
            } else if open > 0 {
                dwells.push(f64::from(open));
                open = 0;
            }
        }
        open_in_service += doors[first_count..last_count].iter().filter(|d| *d == "1").count() as f64;
        hours_in_service += (last_count - first_count) as f64 / 3600.0;
        let speeds: Vec<f64> = column(&bytes, "odometry_vehicleSpeed").iter().map(|v| v.parse().unwrap()).collect();
        distance_m += speeds.iter().sum::<f64>();
        standing += speeds.iter().filter(|v| **v == 0.0).count() as f64;
        seconds += speeds.len() as f64;
        let latitude = column(&bytes, "gnss_latitude");
        within("minutes without GNSS", latitude.iter().filter(|v| *v == "NaN").count() as f64 / 60.0, 8.0, 12.0);
        let ambient = column(&bytes, "temperature_ambient");
        assert_eq!((ambient[0].as_str(), ambient.last().unwrap().as_str()), ("295.15", "NaN"));
    }
    within("share of open doors", open_in_service / hours_in_service / 3600.0, 0.21, 0.28);
    within("stops an hour", dwells.len() as f64 / hours_in_service, 29.0, 35.0);
    within("mean dwell", dwells.iter().sum::<f64>() / dwells.len() as f64, 24.0, 32.0);
    within("median dwell", quantile(&mut dwells, 0.5), 13.5, 16.0);
    within("dwell exceeded by a tenth", quantile(&mut dwells, 0.9), 33.0, 69.0);
    within("median time between counts", quantile(&mut intervals, 0.5), 78.0, 84.0);
    within("mean speed in km/h", distance_m / seconds * 3.6, 13.0, 18.0);
    within("share of standing", standing / seconds, 0.32, 0.37);
}

#[test]
fn prop_the_default_plan_covers_every_month_and_stays_small() {
    let plans = default_plan(48, 1).unwrap();
    for month in 1..=12 {
        assert!(plans.iter().filter(|p| p.start.month() == month).count() >= 3, "month {month}");
    }
    let hours: f64 = plans.iter().map(|p| (p.end - p.start).as_seconds_f64() / 3600.0).sum();
    assert!(hours * 3600.0 * 190.0 < 150e6 * 1.1, "{hours} h");
    assert!(plans.iter().all(|p| (2..15).contains(&p.start.hour())));
    // Two years of missions: no bus is at two places at once.
    let mut many = default_plan(600, 1).unwrap();
    many.sort_by_key(|p| p.start);
    assert!(many.windows(2).all(|w| w[0].end < w[1].start));
    assert!(matches!(default_plan(1_000_000, 1), Err(PlanError::TooMany(_))));
}

#[test]
fn prop_the_weather_has_the_climate_of_zurich() {
    let year = |y| Utc.with_ymd_and_hms(y, 6, 1, 0, 0, 0).unwrap();
    let weather = SyntheticWeather::new(1, year(2001), year(2020));
    assert_eq!(weather.hours().len(), 20 * 8760 + 5 * 24);
    let annual_kwh_m2 = weather.hours().iter().map(|h| h.1).sum::<f64>() / 1000.0 / 20.0;
    within("annual global irradiance", annual_kwh_m2, 1100.0, 1180.0);
    // Long-term means of Zürich/Fluntern.
    for (month, celsius) in [(1, 0.5), (4, 9.5), (7, 19.5), (10, 10.0)] {
        let start = Utc.with_ymd_and_hms(2001, 1, 1, 0, 0, 0).unwrap();
        let of_month = weather
            .hours()
            .iter()
            .enumerate()
            .filter(|(i, _)| (start + chrono::TimeDelta::hours(*i as i64)).month() == month);
        let (sum, count) = of_month.fold((0.0, 0.0), |(s, n), (_, h)| (s + h.0, n + 1.0));
        within("monthly mean temperature", sum / count, celsius - 1.2, celsius + 1.2);
    }
    assert!(weather.hours().iter().all(|h| (-30.0..42.0).contains(&h.0) && (0.0..1100.0).contains(&h.1)));
}

#[test]
fn prop_streets_are_shadier_in_winter_and_dark_at_night() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), 1, &default_plan(1, 1).unwrap(), 1);
    let shadow = std::fs::read(folder.path().join("shadow.csv")).unwrap();
    let year = shading::ShadowYear::read(shadow.as_slice()).unwrap();
    let at = |month, hour| year.at(Utc.with_ymd_and_hms(2022, month, 21, hour, 0, 0).unwrap());
    within("summer noon", at(6, 11), 0.04, 0.1);
    within("winter noon", at(12, 11), 0.3, 0.5);
    assert_eq!(at(12, 2), 1.0);
}

#[test]
fn prop_bad_meta_data_names_line_and_column() {
    let folder = tempfile::tempdir().unwrap();
    let plans = default_plan(2, 1).unwrap();
    write(folder.path(), 1, &plans, 1);
    let good = std::fs::read_to_string(folder.path().join("ztbus/metaData.csv")).unwrap();
    let read = read_meta_data(good.as_bytes()).unwrap();
    assert_eq!(
        read.iter().map(MissionPlan::name).collect::<Vec<_>>(),
        plans.iter().map(MissionPlan::name).collect::<Vec<_>>()
    );

    let bad = |from: &str, to: &str| read_meta_data(good.replacen(from, to, 1).as_bytes()).unwrap_err().to_string();
    assert!(bad("busNumber", "bus").starts_with("line 1: the column busNumber is missing"));
    assert!(bad(",", ";").contains("separated by commas"));
    let end = plans[1].end.timestamp().to_string();
    assert!(bad(&format!(",{end},"), ",later,").starts_with("line 3, column endTime_unix: \"later\" is not"));
    assert!(read_meta_data(&b"\xff\xfe"[..]).is_err());
}

#[test]
fn xval_ztbus_the_header_is_that_of_the_real_file() {
    let beside = || PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/data"));
    let data = std::env::var_os("BUSCLIMATE_DATA").map_or_else(beside, PathBuf::from);
    let folder = tempfile::tempdir().unwrap();
    let plans = default_plan(1, 1).unwrap();
    write(folder.path(), 1, &plans, 1);
    for (real, made) in [
        ("B183_2021-07-26_03-53-27_2021-07-26_07-18-47.csv".to_owned(), format!("{}.csv", plans[0].name())),
        ("metaData.csv".to_owned(), "metaData.csv".to_owned()),
    ] {
        let Ok(real) = std::fs::read(data.join("ztbus").join(&real)) else {
            eprintln!("skipped: no ztbus/{real} under {}; set BUSCLIMATE_DATA", data.display());
            return;
        };
        let made = std::fs::read(folder.path().join("ztbus").join(made)).unwrap();
        let line = |bytes: &[u8]| bytes.split(|b| *b == b'\n').next().unwrap().to_owned();
        assert_eq!(
            String::from_utf8(line(&real)).unwrap().trim_end(),
            String::from_utf8(line(&made)).unwrap().trim_end()
        );
    }
}
