//! The sun's position against NREL's SPA.

#![expect(clippy::unwrap_used, reason = "a test ends where something is not as expected")]

use chrono::{DateTime, TimeDelta, TimeZone, Utc};
use shading::Site;
use solar_positioning::{Location, SolarPositions};
use std::path::PathBuf;

/// Beyond this error another algorithm would have to be taken.
const LIMIT_DEG: f64 = 0.05;

/// Refraction of NREL's SPA in degrees (Reda and Andreas 2004, eq. 42) for a true altitude in degrees.
fn refraction_deg(true_altitude_deg: f64, pressure_hpa: f64, temperature_c: f64) -> f64 {
    let angle_deg: f64 = true_altitude_deg + 10.3 / (true_altitude_deg + 5.11);
    pressure_hpa / 1010.0 * 283.0 / (273.0 + temperature_c) * 1.02 / (60.0 * angle_deg.to_radians().tan())
}

/// Altitude and azimuth in degrees.
fn sun(latitude_deg: f64, longitude_deg: f64, instant: DateTime<Utc>) -> (f64, f64) {
    let position = Site::new(latitude_deg, longitude_deg).unwrap().sun(instant);
    (position.altitude_rad.to_degrees(), position.azimuth_rad.to_degrees())
}

fn turn_deg(a_deg: f64, b_deg: f64) -> f64 {
    (a_deg - b_deg + 180.0).rem_euclid(360.0) - 180.0
}

fn data() -> PathBuf {
    let beside = || PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/data"));
    std::env::var_os("BUSCLIMATE_DATA").map_or_else(beside, PathBuf::from)
}

#[test]
fn xval_nrel_reference_positions_between_1990_and_2050() {
    let file = data().join("validation/spa_reference_testdata.csv");
    let Ok(text) = std::fs::read_to_string(&file) else {
        eprintln!("skipped: there is no {}; set BUSCLIMATE_DATA", file.display());
        return;
    };
    let mut worst = (0.0_f64, 0.0_f64);
    let mut judged = 0;
    // date, latitude, longitude, azimuth, zenith
    let mut reader = csv::ReaderBuilder::new().has_headers(false).comment(Some(b'#')).from_reader(text.as_bytes());
    for record in reader.records() {
        let record = record.unwrap();
        let number = |i: usize| record[i].trim().parse::<f64>().unwrap();
        let instant = DateTime::parse_from_rfc3339(record[0].trim()).unwrap().to_utc();
        let (altitude_deg, azimuth_deg) = sun(number(1), number(2), instant);
        let year: i32 = record[0].trim()[..4].parse().unwrap();
        if !(1990..=2050).contains(&year) || altitude_deg <= 0.0 {
            continue;
        }
        // The reference zenith includes refraction at 1000 hPa and 10 °C.
        let apparent_deg = altitude_deg + refraction_deg(altitude_deg, 1000.0, 10.0);
        let altitude_error = (90.0 - number(4) - apparent_deg).abs();
        // At the zenith the azimuth means nothing: what counts is the angle on the sky.
        let azimuth_error = (turn_deg(azimuth_deg, number(3)) * altitude_deg.to_radians().cos()).abs();
        worst = (worst.0.max(altitude_error), worst.1.max(azimuth_error));
        judged += 1;
    }
    eprintln!("largest error of {judged} positions: altitude {:.4}°, azimuth on the sky {:.4}°", worst.0, worst.1);
    assert!(judged > 50, "{judged}");
    assert!(worst.0 < LIMIT_DEG && worst.1 < LIMIT_DEG, "{worst:?}");
}

/// Reda and Andreas 2004, table A5.1: Denver, 17 October 2003 12:30:30 UTC−7, refraction at 820 hPa and 11 °C.
#[test]
fn xval_nrel_worked_example() {
    let instant = Utc.with_ymd_and_hms(2003, 10, 17, 19, 30, 30).unwrap();
    let (altitude_deg, azimuth_deg) = sun(39.742_476, -105.1786, instant);
    let zenith_deg = 90.0 - altitude_deg - refraction_deg(altitude_deg, 820.0, 11.0);
    assert!((zenith_deg - 50.111_62).abs() < 0.01, "{zenith_deg}");
    assert!((azimuth_deg - 194.340_24).abs() < 0.01, "{azimuth_deg}");
}

/// The crate `solar-positioning` implements NREL's SPA.
#[test]
fn xval_solar_positioning_over_sixty_years_around_the_globe() {
    let start = Utc.with_ymd_and_hms(1990, 1, 1, 0, 0, 0).unwrap();
    let (mut worst, mut where_worst) = (0.0_f64, String::new());
    for step in 0..40_000_i64 {
        let instant = start + TimeDelta::seconds(step * 48_000 + step % 3600);
        let spa = SolarPositions::new().for_time(&instant, 69.0).unwrap();
        for (latitude, longitude) in [(47.3779, 8.5657), (-33.9, 151.2), (1.3, 103.8), (64.1, -21.9)] {
            let reference = spa.at(Location { latitude, longitude }, 0.0, None).unwrap();
            let reference_altitude = 90.0 - reference.zenith_angle();
            if reference_altitude <= 0.0 {
                continue;
            }
            let (altitude, azimuth) = sun(latitude, longitude, instant);
            let on_sky = turn_deg(azimuth, reference.azimuth()) * reference_altitude.to_radians().cos();
            let error = (altitude - reference_altitude).hypot(on_sky);
            if error > worst {
                (worst, where_worst) = (error, format!("{latitude} {longitude} {instant}"));
            }
        }
    }
    eprintln!("largest distance on the sky: {worst:.4}° at {where_worst}");
    assert!(worst < LIMIT_DEG, "{worst} at {where_worst}");
}

#[test]
fn prop_coordinates_off_the_globe_are_refused() {
    assert!(Site::new(91.0, 0.0).is_err() && Site::new(0.0, -181.0).is_err() && Site::new(f64::NAN, 0.0).is_err());
}
