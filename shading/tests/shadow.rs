//! Shadow fractions by calendar date, and of a street canyon.

use chrono::{DateTime, TimeDelta, TimeZone, Utc};
use proptest::prelude::*;
use shading::{ShadowError, ShadowYear, Site, Streets, SunPosition, canyon_shadow_fraction, canyon_year};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI, TAU};
use std::fmt::Write as _;

fn at(year: i32, month: u32, day: u32, hour: u32) -> DateTime<Utc> {
    Utc.with_ymd_and_hms(year, month, day, hour, 0, 0).unwrap()
}

/// The hour of the year, over 8760.
fn ramp() -> ShadowYear {
    ShadowYear::from_fn(|hour| hour as f64 / 8760.0)
}

fn file() -> String {
    let mut text = "time_utc,shadow_fraction\n".to_owned();
    for hour in 0..8760 {
        let _ = writeln!(text, "{},{}", (at(2023, 1, 1, 0) + TimeDelta::hours(hour)).to_rfc3339(), hour % 2);
    }
    text
}

#[test]
fn prop_the_reference_year_repeats_by_date_and_leap_days_take_the_28th() {
    let year = ramp();
    assert_eq!(year.at(at(2019, 7, 1, 5)), year.at(at(2024, 7, 1, 5)));
    assert_eq!(year.at(at(2024, 2, 29, 5)), year.at(at(2024, 2, 28, 5)));
    assert_eq!(year.at(at(2023, 3, 1, 0)), (59.0 * 24.0) / 8760.0);
    assert_eq!(year.at(at(2024, 3, 1, 0)), (59.0 * 24.0) / 8760.0);
}

#[test]
fn prop_stamps_are_read_as_common_tools_write_them() {
    let year = ShadowYear::read(file().as_bytes()).unwrap();
    for (from, to) in
        [("T", " "), ("+00:00", "Z"), ("+00:00", ""), (":00+00:00", "Z"), ("T00:00:00+00:00", ""), (":00+00:00", "")]
    {
        let other = file().replace(from, to);
        assert_eq!(ShadowYear::read(other.as_bytes()).unwrap(), year, "{to:?} for {from:?}");
    }
    let pandas = file().replace('T', " ").replace("+00:00", "");
    assert_eq!(ShadowYear::read(pandas.as_bytes()).unwrap(), year);
}

#[test]
fn prop_between_full_hours_it_is_linear() {
    let year = ShadowYear::read(file().as_bytes()).unwrap();
    assert_eq!(year.at(at(2022, 5, 5, 0)), 0.0);
    assert_eq!(year.at(at(2022, 5, 5, 0) + TimeDelta::minutes(15)), 0.25);
    assert_eq!(year.at(at(2022, 5, 5, 1) + TimeDelta::minutes(15)), 0.75);
    // The last hour of the year goes over into the first.
    assert_eq!(year.at(at(2022, 12, 31, 23) + TimeDelta::minutes(30)), 0.5);
}

proptest! {
    #[test]
    fn prop_a_mean_is_the_mean_of_many_instants(start in 0_i64..31_536_000, length in 60_i64..20_000) {
        let year = ShadowYear::from_fn(|hour| (hour as f64 * 0.7).sin().abs());
        let from = at(2022, 1, 1, 0) + TimeDelta::seconds(start);
        let mean = year.mean(from, from + TimeDelta::seconds(length));
        let sum: f64 = (0..length).map(|s| year.at(from + TimeDelta::milliseconds(1000 * s + 500))).sum();
        prop_assert!((mean - sum / length as f64).abs() < 1e-9);
    }

    #[test]
    fn prop_a_canyon_shadow_is_a_fraction_and_grows_with_the_walls(
        altitude in -1.5..1.5_f64, azimuth in 0.0..TAU, street in 0.0..PI, ratio in 0.0..4.0_f64,
    ) {
        let sun = SunPosition { altitude_rad: altitude, azimuth_rad: azimuth };
        let fraction = canyon_shadow_fraction(sun, street, ratio);
        prop_assert!((0.0..=1.0).contains(&fraction));
        prop_assert!(canyon_shadow_fraction(sun, street, ratio * 1.5) >= fraction);
    }
}

#[test]
fn prop_a_canyon_has_its_textbook_shadows() {
    let sun = SunPosition { altitude_rad: FRAC_PI_4, azimuth_rad: 0.3 };
    // Along the street there is no shade; across it a wall as high as half the width shades half at 45°.
    assert!(canyon_shadow_fraction(sun, 0.3, 2.0).abs() < 1e-12);
    assert!((canyon_shadow_fraction(sun, 0.3 + FRAC_PI_2, 0.5) - 0.5).abs() < 1e-12);
    let night = SunPosition { altitude_rad: -0.1, azimuth_rad: 0.3 };
    assert_eq!(canyon_shadow_fraction(night, 0.3, 0.0), 1.0);
}

#[test]
fn prop_bad_shadow_files_name_line_and_remedy() {
    let good = file();
    let bad = |from: &str, to: &str| ShadowYear::read(good.replacen(from, to, 1).as_bytes()).unwrap_err();
    assert!(matches!(bad("shadow_fraction", "shade"), ShadowError::Column("shadow_fraction")));
    assert!(matches!(bad("00:00+00:00,1\n", "00:30+00:00,1\n"), ShadowError::Time { line: 3, .. }));
    assert!(matches!(bad(",1\n", ",1.5\n"), ShadowError::Fraction { line: 3, .. }));
    let windows = good.replace(",1\n", ",1.5\n").replace('\n', "\r\n");
    assert!(matches!(ShadowYear::read(windows.as_bytes()), Err(ShadowError::Fraction { line: 3, .. })));
    assert!(matches!(bad("2023-01-01T02", "2023-01-01T01"), ShadowError::Twice { line: 4, .. }));
    let missing = bad("2023-01-01T02:00:00+00:00,0\n", "").to_string();
    assert!(missing.starts_with("1 of 8760 hours are missing, the first is 01-01 02:00"), "{missing}");
    assert!(ShadowYear::read("time_utc;shadow_fraction\n".as_bytes()).unwrap_err().to_string().contains("commas"));
}

/// The solar flows that the paper prints for this hour (figure `single-scenario-hot`: 1.0, 2.4 and 7.1 kW) mean a shadow fraction
/// of 0.12 to 0.16 with the weather of that hour.
#[test]
fn paper_the_default_streets_have_the_shade_of_the_printed_hour() {
    let site = Site::new(47.3779, 8.5657).unwrap();
    let start = Utc.with_ymd_and_hms(2019, 7, 24, 13, 50, 0).unwrap();
    let of = |streets: Streets| canyon_year(&site, &streets.evenly_spread()).mean(start, start + TimeDelta::hours(1));
    let (calibrated, town) = (of(Streets::default()), of(Streets::Town));
    assert!((0.12..=0.16).contains(&calibrated), "{calibrated}");
    assert!((0.45..=0.49).contains(&town), "{town}");
}
