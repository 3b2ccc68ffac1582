//! Profiles cover what they claim, and thresholds err as little as any.

use cabin::{Cop, Vehicle, kelvin, named_heating_cops};
use proptest::prelude::*;
use setpoints::{Edge, FitError, Point, Shape, Switch, curtain_threshold_k, fit, threshold};

fn points() -> impl Strategy<Value = Vec<Point>> {
    let point = (-15.0..38.0_f64, 10.0..30.0_f64, 0.1..2.0_f64);
    prop::collection::vec(point.prop_map(|(ambient_c, cabin_c, weight)| Point { ambient_c, cabin_c, weight }), 10..200)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn prop_a_profile_covers_what_it_claims(points in points(), coverage in 0.5..1.0_f64) {
        let total: f64 = points.iter().map(|p| p.weight).sum();
        for edge in [Edge::Upper, Edge::Lower] {
            let profile = fit(&points, edge, coverage).unwrap();
            let covers = |p: &&Point| match edge {
                Edge::Upper => profile.curve.at(p.ambient_c) >= p.cabin_c - 2e-6,
                Edge::Lower => profile.curve.at(p.ambient_c) <= p.cabin_c + 2e-6,
            };
            let share = points.iter().filter(covers).map(|p| p.weight).sum::<f64>() / total;
            prop_assert!(profile.coverage >= coverage - 1e-9, "{} of {coverage}", profile.coverage);
            prop_assert!((share - profile.coverage).abs() < 1e-6, "{share} {}", profile.coverage);
        }
    }

    #[test]
    fn prop_a_heating_profile_does_not_fall(points in points(), coverage in 0.5..1.0_f64) {
        let profile = fit(&points, Edge::Upper, coverage).unwrap();
        let at = |n: i32| profile.curve.at(-20.0 + f64::from(n) * 0.5);
        prop_assert!((0..120).all(|n| at(n + 1) >= at(n) - 1e-6));
        // Beyond the points it stays.
        prop_assert_eq!(profile.curve.at(-90.0), profile.curve.at(profile.curve.valid_c[0]));
    }

    #[test]
    fn prop_no_other_threshold_errs_less(
        hours in prop::collection::vec((0.0..20.0_f64, any::<bool>(), 0.1..2.0_f64), 2..60),
    ) {
        let hours: Vec<Switch> =
            hours.into_iter().map(|(value, is_on, weight)| Switch { value, is_on, weight }).collect();
        let total: f64 = hours.iter().map(|h| h.weight).sum();
        let wrong = |limit: f64| {
            hours.iter().filter(|h| (h.value > limit) != h.is_on).map(|h| h.weight).sum::<f64>() / total
        };
        if let Some(found) = threshold(&hours) {
            for n in 0..400 {
                prop_assert!(found.misclassified <= wrong(f64::from(n) * 0.05) + 1e-12);
            }
        }
    }
}

#[test]
fn prop_a_curve_that_is_there_is_found() {
    let curve = |t: f64| 15.0 + 0.2 * t + 0.004 * t * t;
    let point = |n: i32| {
        let ambient_c = f64::from(n) * 0.1 - 10.0;
        // Every third point is on the curve, the others are colder.
        Point { ambient_c, cabin_c: curve(ambient_c) - f64::from(n % 3), weight: 1.0 }
    };
    let points: Vec<Point> = (0..300).map(point).collect();
    let heating = fit(&points, Edge::Upper, 1.0).unwrap();
    assert_eq!((heating.coverage, heating.points), (1.0, 300));
    let Shape::Quadratic(found) = heating.curve.shape else { panic!("{heating:?}") };
    for (found, meant) in found.iter().zip([15.0, 0.2, 0.004]) {
        assert!((found - meant).abs() < 1e-6, "{found} {meant}");
    }
    // A tenth of the weight that lies far beyond is left out.
    let mut with_outliers = points.clone();
    with_outliers.extend((0..20).map(|n| Point { ambient_c: f64::from(n), cabin_c: 40.0, weight: 1.6 }));
    let heating = fit(&with_outliers, Edge::Upper, 0.9).unwrap();
    assert!((heating.curve.at(5.0) - curve(5.0)).abs() < 0.01, "{heating:?}");
    let straight: Vec<Point> = (0..100)
        .map(|n| Point { ambient_c: f64::from(n) * 0.2 + 18.0, cabin_c: 24.0 + f64::from(n % 2), weight: 1.0 })
        .collect();
    let cooling = fit(&straight, Edge::Lower, 1.0).unwrap();
    assert!((18..38).all(|t| (cooling.curve.at(f64::from(t)) - 24.0).abs() < 1e-6), "{cooling:?}");
    assert_eq!(fit(&points[..3], Edge::Upper, 1.0), Err(FitError::TooFew(3)));
    assert_eq!(fit(&points, Edge::Upper, 0.2), Err(FitError::Coverage(0.2)));
}

#[test]
fn prop_a_clear_threshold_lies_in_the_middle_of_its_gap() {
    let hour = |value: f64, is_on| Switch { value, is_on, weight: 1.0 };
    let hours = [hour(1.0, false), hour(2.0, false), hour(4.0, true), hour(5.0, true)];
    let found = threshold(&hours).unwrap();
    assert_eq!((found.value, found.misclassified), (3.0, 0.0));
    assert_eq!(threshold(&hours[..2]), None);
    assert_eq!(threshold(&hours[2..]), None);
}

#[test]
fn xval_derivation_thresholds_of_the_model() {
    // Derived by hand from the paper's door law: some 2.05 K with resistive heating, 4.4 to 4.8 K with a heat pump.
    let vehicle = Vehicle::default();
    let ptc = curtain_threshold_k(&vehicle, &Cop::Constant(1.0), kelvin(5.0)).unwrap();
    assert!((ptc - 2.05).abs() < 0.05, "{ptc}");
    let pump = curtain_threshold_k(&vehicle, &named_heating_cops()[0].1, kelvin(5.0)).unwrap();
    assert!((4.4..4.8).contains(&pump), "{pump}");
    assert_eq!(curtain_threshold_k(&vehicle, &Cop::Constant(1e9), kelvin(5.0)), None);
}
