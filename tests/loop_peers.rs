//! A mission in closed loop beside a program that shares nothing.

#![expect(clippy::unwrap_used, reason = "a test ends where something is not as expected")]

mod common;

use cabin::{Vehicle, passenger_positions_m, place_passengers};
use common::Scratch;
use serde_json::{Value, json};
use std::fmt::Write as _;
use testing::peer;

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

#[test]
fn xval_numpy_a_mission_in_closed_loop_comes_out_the_same() {
    let scratch = Scratch::small(4, "[0.5]", "[0.5]");
    // The mission nearest to midsummer.
    let name = scratch.missions().into_iter().min_by_key(|name| {
        let month: i32 = name[10..12].parse().unwrap();
        (month - 7).abs()
    });
    let name = name.unwrap();
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
        "cases": cases,
    });
    scratch.write("cases.json", given.to_string());
    let Some(rows) = peer("mission.py", "numpy", &[scratch.path("cases.json").to_string_lossy().into_owned()]) else {
        return;
    };
    let number = |text: &String| text.parse::<f64>().unwrap();
    let views = place_passengers(&vehicle);
    let least = views.iter().copied().fold(f64::MAX, f64::min);
    assert!((number(&rows[0][1]) - least).abs() < 1e-6, "{rows:?} {least}");
    assert!((number(&rows[0][2]) - views.iter().sum::<f64>() / views.len() as f64).abs() < 1e-6, "{rows:?}");
    assert_eq!(rows.len(), ours.len() + 1);
    let (mut saturates, mut modes) = (false, std::collections::BTreeSet::new());
    for ((label, ours), row) in ours.iter().zip(&rows[1..]) {
        let theirs: Vec<f64> = row[1..].iter().map(number).collect();
        println!("{label}: {ours:?} {theirs:?}");
        assert_eq!(label, &row[0]);
        assert!((ours[0] / theirs[0] - 1.0).abs() < 1e-3, "{label}: {ours:?} {theirs:?}");
        assert!((ours[1] - theirs[1]).abs() < 0.002, "{label}: {ours:?} {theirs:?}");
        assert!((ours[2] - theirs[2]).abs() < 1e-3, "{label}: {ours:?} {theirs:?}");
        assert!((ours[3] - theirs[3]).abs() < 1e-3, "{label}: {ours:?} {theirs:?}");
        saturates |= ours[2] > 0.0;
    }
    for case in given["cases"].as_array().unwrap() {
        modes.extend(case["hours"].as_array().unwrap().iter().map(|hour| hour["mode"].to_string()));
    }
    assert!(saturates && modes.contains("-1.0") && modes.contains("1.0"), "{modes:?}");
}
