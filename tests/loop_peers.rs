//! A mission in closed loop beside a program that shares nothing.

#![expect(clippy::unwrap_used, reason = "a test ends where something is not as expected")]

use crate::common::Scratch;
use cabin::{
    Cabin, ComfortWindow, Disturbances, Heating, PassengerViews, Vehicle, kelvin, passenger_positions_m,
    place_passengers,
};
use chrono::{DateTime, TimeDelta, Utc};
use ingest::Content;
use ingest::mission::{MissionOptions, MissionSource, RouteChoice, read, span_of_name};
use serde_json::{Value, json};
use setpoints::Curve;
use shading::{ShadowYear, Site};
use simulate::control::{AirCurtain, CausalController, Law};
use simulate::{Dynamics, Limits, Mission, Scenario, Segment, Start, Variant, simulate};
use std::fmt::Write as _;
use testing::{design, optimum, peer};

const DESIGNS: [&str; 3] = ["hp", "hp+curtain", "ptc+rh"];
/// Kelvin that are taken off the warm day.
const COLDER_K: [f64; 2] = [0.0, 24.0];

/// Hours of three days around a date: a day in July with a haze.
fn weather(date: chrono::NaiveDate, colder_k: f64) -> String {
    let mut text = "interval_start_utc,T_degC,DNI_Wm2,DHI_Wm2\n".to_owned();
    let first = (date - chrono::TimeDelta::days(1)).and_hms_opt(0, 0, 0).unwrap();
    for n in 0..72 {
        let angle = |noon: f64| ((f64::from(n % 24) + 0.5 - noon) / 24.0 * std::f64::consts::TAU).cos();
        let celsius = 29.0 + 7.5 * angle(14.0) - colder_k;
        let light = angle(11.4).max(0.0);
        let (dni, dhi) = (420.0 * light, 150.0 * light);
        let time = (first + chrono::TimeDelta::hours(n.into())).format("%Y-%m-%dT%H:%M:%SZ");
        let _ = writeln!(text, "{time},{celsius:.3},{dni:.2},{dhi:.2}");
    }
    text
}

/// What the optimum prescribes for the hours of a design.
fn hours(scratch: &Scratch, design: &str) -> Vec<Value> {
    let rows = scratch.query(&format!(
        "SELECT o.operating_mode, o.cabin_temperature_c + 273.15, o.radiant_heaters_on, o.air_curtain_on
         FROM optimum AS o JOIN sample AS s USING (sample_id) WHERE o.design = '{design}' ORDER BY s.segment"
    ));
    rows.iter()
        .map(|r| {
            let number = |n: usize| r[n].parse::<f64>().unwrap();
            json!({"mode": number(0), "cabin_k": number(1), "heaters": number(2) == 1.0, "curtain": number(3) == 1.0})
        })
        .collect()
}

fn number(text: &str) -> f64 {
    text.parse().unwrap()
}

/// Mean power to 0.1 %, the 15-minute vote to 0.002, time at a limit and tracking to 0.001.
fn assert_close(label: &str, ours: &[f64], row: &[String]) {
    let theirs: Vec<f64> = row[1..].iter().map(|text| number(text)).collect();
    assert_eq!(label, &row[0]);
    assert!((ours[0] / theirs[0] - 1.0).abs() < 1e-3, "{label}: {ours:?} {theirs:?}");
    for (n, allowed) in [(1, 0.002), (2, 1e-3), (3, 1e-3)] {
        assert!((ours[n] - theirs[n]).abs() < allowed, "{label}: {ours:?} {theirs:?}");
    }
}

/// The mission of the demo that is nearest to midsummer.
fn summer_mission(scratch: &Scratch) -> String {
    let month = |name: &String| name[10..12].parse::<i32>().unwrap();
    scratch.missions().into_iter().min_by_key(|name| (month(name) - 7).abs()).unwrap()
}

/// The cabin in the middle of every minute, without load.
fn minutes<'v>(scratch: &Scratch, name: &str, text: &str, views: &'v PassengerViews, hours: usize) -> Vec<Cabin<'v>> {
    let rows: Vec<Vec<&str>> = text.lines().skip(1).map(|line| line.split(',').collect()).collect();
    let middle = |row: &[&str]| row[0].parse::<DateTime<Utc>>().unwrap() + TimeDelta::minutes(30);
    let (site, vehicle) = (Site::new(47.3779, 8.5657).unwrap(), Vehicle::default());
    let shadow = ShadowYear::read(scratch.read("shadow.csv").as_bytes()).unwrap();
    let start = span_of_name(name.trim_end_matches(".csv")).unwrap().1;
    let minute = |n: usize| {
        let at = start + TimeDelta::seconds(60 * n as i64 + 30);
        let after = rows.iter().position(|row| middle(row) > at).unwrap();
        let share = (at - middle(&rows[after - 1])).as_seconds_f64() / 3600.0;
        let value = |column: usize| {
            let [a, b] = [after - 1, after].map(|row| rows[row][column].parse::<f64>().unwrap());
            a + share * (b - a)
        };
        let disturbances = Disturbances {
            ambient_temperature_k: kelvin(value(1)),
            dni_w_m2: value(2),
            dhi_w_m2: value(3),
            solar_altitude_rad: site.sun(at).altitude_rad,
            shadow_fraction: shadow.at(at),
            passengers: 0.0,
            door_open_fraction: 0.0,
        };
        Cabin::new(&vehicle, views, &disturbances)
    };
    (0..60 * hours).map(minute).collect()
}

#[test]
fn xval_numpy_a_causal_controller_in_closed_loop_comes_out_the_same() {
    let scratch = Scratch::demo(4);
    let name = summer_mission(&scratch);
    let path = scratch.path(&format!("ztbus/{name}"));
    let options =
        MissionOptions { segment_s: 3600, door_open_share: 0.6, keep_partial: false, routes: RouteChoice::All };
    let reading = read(&MissionSource::at(&path).unwrap(), &Content::read(&path).unwrap(), &options);
    let hours = reading.segments.len();
    let heating = [(-10.0, 17.0), (10.0, 18.5), (25.0, 21.0)];
    let cooling = [(10.0, 23.0), (35.0, 26.0)];
    let controller = CausalController {
        heating: Curve::through(&heating).unwrap(),
        cooling: Curve::through(&cooling).unwrap(),
        dead_band_k: 0.0,
        cools_above_c: f64::NEG_INFINITY,
        hysteresis_k: 1.0,
        air_curtain: AirCurtain::Above { heating_k: 4.8, cooling_k: 4.1 },
        heaters_below_c: Some(8.0),
        radiant_heater_k: 343.15,
    };
    let (vehicle, design) = (Vehicle::default(), design("all", Heating::HeatPump, true, true));
    let views = PassengerViews::new(&vehicle);
    // What optima there are does not matter to it.
    let optimum = optimum(&vehicle, &views, &design, &testing::winter_day(), 1.0);
    let segments = vec![Segment { optimum, band_k: [290.0, 295.0] }; hours];
    let windows = [0.25, 0.5, 0.6, 0.65].map(|limit| ComfortWindow::symmetric(limit).unwrap());
    let scenario = Scenario { start: Start::Depot, limits: Limits::Rated };
    let variant =
        Variant { design: &design, scenario, law: Law::Causal(&controller), segments: &segments, windows: &windows };
    let (mut cases, mut ours) = (Vec::new(), Vec::new());
    for colder_k in COLDER_K {
        let (label, text) = (format!("causal {colder_k} K colder"), weather(name[5..15].parse().unwrap(), colder_k));
        let file = format!("weather-{colder_k}.csv");
        scratch.write(&file, &text);
        let minutes = minutes(&scratch, &name, &text, &views, hours);
        let mission = Mission {
            loads: &reading.loads,
            minutes: &minutes,
            segments: hours,
            segment_s: 3600,
            door_open_share: 0.6,
        };
        let s = simulate(&mission, &Dynamics::default(), &[variant]).unwrap().remove(0);
        let votes = s.max_abs_pmv_15min.unwrap();
        let mut values = vec![s.mean_hvac_power_w, votes, s.saturated_fraction, s.tracking_error_k];
        values.push(s.rides.mean_abs_pmv.unwrap());
        values.extend(&s.rides.hours_outside);
        ours.push((label.clone(), s.rides.passenger_hours, values));
        let causal = json!({
            "heating": heating, "cooling": cooling, "curtain_above_k": [4.8, 4.1], "heaters_below_c": 8.0
        });
        let limits = windows.map(|w| [w.pmv_min(), w.pmv_max()]);
        let weather = scratch.path(&file);
        let case = json!({"name": label, "heat_pump": true, "weather": weather, "causal": causal, "windows": limits});
        cases.push(case);
    }
    let given = json!({
        "mission": path, "shadow": scratch.path("shadow.csv"), "place": [47.3779, 8.5657],
        "positions": passenger_positions_m(&vehicle), "hours": hours, "cases": cases,
    });
    scratch.write("cases.json", given.to_string());
    let Some(rows) = peer("mission.py", "numpy", &[scratch.path("cases.json").to_string_lossy().into_owned()]) else {
        return;
    };
    assert_eq!(rows.len(), 3);
    for ((label, passenger_hours, ours), row) in ours.iter().zip(&rows[1..]) {
        assert_close(label, ours, row);
        let theirs: Vec<f64> = row[5..].iter().map(|text| number(text)).collect();
        assert_eq!(theirs.len(), 1 + windows.len());
        assert!((ours[4] - theirs[0]).abs() < 0.002, "{label}: {ours:?} {theirs:?}");
        // A vote of 0.002 more or less moves when a limit is crossed by seconds.
        for (ours, theirs) in ours[5..].iter().zip(&theirs[1..]) {
            assert!((ours - theirs).abs() < 2e-3 * passenger_hours, "{label}: {ours} {theirs} of {passenger_hours}");
        }
        assert!(theirs[1..].iter().any(|hours| *hours > 0.1 && *hours < 0.9 * passenger_hours), "{label}: {theirs:?}");
    }
}

#[test]
fn xval_numpy_a_mission_in_closed_loop_comes_out_the_same() {
    let scratch = Scratch::small(4, "[0.5]", "[0.5]");
    let name = summer_mission(&scratch);
    scratch.edit("study.toml", "path = \"ztbus\"", &format!("path = \"ztbus/{name}\""));
    scratch.edit("study.toml", "path = \"weather\"", "path = \"weather.csv\"\ntime_column = \"interval_start_utc\"\n\
        time_label = \"start\"\ninterval_s = 3600\ntemperature_column = \"T_degC\"\ndni_column = \"DNI_Wm2\"\ndhi_column = \"DHI_Wm2\"");
    scratch.edit("study.toml", "format = \"meteoswiss-ogd\"", "format = \"csv\"");
    let (mut cases, mut ours) = (Vec::new(), Vec::new());
    for colder_k in COLDER_K {
        let own = format!("weather-{colder_k}.csv");
        let text = weather(name[5..15].parse().unwrap(), colder_k);
        scratch.write(&own, &text);
        scratch.write("weather.csv", &text);
        scratch.expect(0, &["run"]);
        for design in DESIGNS {
            let label = format!("{design} {colder_k} K colder");
            let summary = scratch.query(&format!(
                "SELECT mean_hvac_power_w, max_abs_pmv_15min, saturated_fraction, tracking_error_k FROM simulation
                 WHERE design = '{design}' AND controller = 'paper'"
            ));
            ours.push((label.clone(), summary[0].iter().map(|v| v.parse::<f64>().unwrap()).collect::<Vec<_>>()));
            let weather = scratch.path(&own);
            let is_pump = design.starts_with("hp");
            cases.push(
                json!({"name": label, "heat_pump": is_pump, "weather": weather, "hours": hours(&scratch, design)}),
            );
        }
    }
    let vehicle = Vehicle::default();
    let given = json!({
        "mission": scratch.path(&format!("ztbus/{name}")),
        "shadow": scratch.path("shadow.csv"),
        "place": [47.3779, 8.5657],
        "positions": passenger_positions_m(&vehicle),
        "hours": cases[0]["hours"].as_array().unwrap().len(),
        "cases": cases,
    });
    scratch.write("cases.json", given.to_string());
    let Some(rows) = peer("mission.py", "numpy", &[scratch.path("cases.json").to_string_lossy().into_owned()]) else {
        return;
    };
    let views = place_passengers(&vehicle);
    let least = views.iter().copied().fold(f64::MAX, f64::min);
    assert!((number(&rows[0][1]) - least).abs() < 1e-6, "{rows:?} {least}");
    assert!((number(&rows[0][2]) - views.iter().sum::<f64>() / views.len() as f64).abs() < 1e-6, "{rows:?}");
    assert_eq!(rows.len(), ours.len() + 1);
    let (mut saturates, mut modes) = (false, std::collections::BTreeSet::new());
    for ((label, ours), row) in ours.iter().zip(&rows[1..]) {
        assert_close(label, ours, row);
        saturates |= ours[2] > 0.0;
    }
    for case in given["cases"].as_array().unwrap() {
        modes.extend(case["hours"].as_array().unwrap().iter().map(|hour| hour["mode"].to_string()));
    }
    assert!(saturates && modes.contains("-1.0") && modes.contains("1.0"), "{modes:?}");
}
