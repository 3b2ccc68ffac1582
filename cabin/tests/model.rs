//! Properties of the balances, the door law and the COP curves.

use cabin::{
    Cabin, Cop, CopError, Disturbances, Heaters, PassengerViews, State, Target, Temperatures, Vehicle, kelvin,
    named_cooling_cops, named_heating_cops, place_passengers,
};
use proptest::prelude::*;

fn night(ambient_c: f64, door_open_fraction: f64) -> Disturbances {
    Disturbances {
        ambient_temperature_k: kelvin(ambient_c),
        dni_w_m2: 0.0,
        dhi_w_m2: 0.0,
        solar_altitude_rad: -0.5,
        shadow_fraction: 1.0,
        passengers: 0.0,
        door_open_fraction,
    }
}

#[test]
fn xval_python_door_loss() {
    // Ambient °C, cabin °C, door loss in kW with all doors open and no curtain, as computed from eq. qdoor elsewhere.
    let cases: [(f64, f64, f64); 5] =
        [(-10.0, 18.0, 86.5), (-0.7, 16.1, 39.5), (5.0, 18.0, 26.6), (30.0, 25.0, -6.08), (34.7, 24.9, -16.56)];
    let vehicle = Vehicle::default();
    let views = PassengerViews::new(&vehicle);
    for (ambient_c, cabin_c, printed_kw) in cases {
        let cabin = Cabin::new(&vehicle, &views, &night(ambient_c, 1.0));
        let t = Temperatures { cabin_k: kelvin(cabin_c), ..cabin.rough_state(kelvin(cabin_c)).temperatures };
        let [open, curtain] = [false, true].map(|curtain| cabin.flows(&t, curtain, 0.0, 0.0).door_w / 1000.0);
        let half_unit = if printed_kw.abs() < 20.0 { 0.005 } else { 0.05 };
        assert!((open - printed_kw).abs() <= half_unit, "{ambient_c} -> {cabin_c}: {open} instead of {printed_kw}");
        assert!((curtain - 0.4 * open).abs() < 1e-12);
    }
}

#[test]
fn prop_a_dark_empty_closed_bus_is_as_cold_as_the_night() {
    let vehicle = Vehicle { other_heat_w: 0.0, ..Vehicle::default() };
    let views = PassengerViews::new(&vehicle);
    let cabin = Cabin::new(&vehicle, &views, &night(-5.0, 0.2));
    let ambient = kelvin(-5.0);
    let State { temperatures: t, slopes, .. } =
        cabin.state(Target::CabinTemperature(ambient), Heaters::Off, &cabin.rough_state(300.0)).expect("settles");
    for k in [t.interior_k, t.shell_inside_k, t.shell_outside_k, t.radiant_heater_k] {
        assert!((k - ambient).abs() < 1e-9, "{t:?}");
    }
    assert!(cabin.air_unit_heat_w(&t, &slopes, false).0.abs() < 1e-6);
}

#[test]
fn prop_named_curves_fall_with_the_lift() {
    for (name, cop, source) in named_heating_cops().into_iter().chain(named_cooling_cops()) {
        let rows = (-60..=80).map(|k| (f64::from(k), cop.at(f64::from(k)))).collect();
        assert!(Cop::table(rows).is_ok(), "{name}");
        assert!(cop.largest() >= cop.at(-60.0) && !source.is_empty());
    }
}

#[test]
fn xval_vecto_rows_and_fit() {
    let curves = named_heating_cops();
    let curve = |name| &curves.iter().find(|(n, ..)| *n == name).expect("named").1;
    // DefaultClimatic.aenv, continuous, at ambient 8 °C and cabin 18 °C; the fit reproduces it with R² = 0.975.
    assert_eq!(curve("vecto-continuous-rows").at(10.0), 2.94);
    assert!((curve("vecto-continuous").at(10.0) - 2.94).abs() < 0.2);
    assert!((curve("vecto-continuous").at(10.0) - 74.13 / 26.79).abs() < 1e-12);
}

#[test]
fn prop_tables_are_checked() {
    assert_eq!(Cop::table(vec![]), Err(CopError::Empty));
    assert!(matches!(Cop::table(vec![(0.0, 3.0), (0.0, 2.0)]), Err(CopError::Order { row: 2, .. })));
    assert!(matches!(Cop::table(vec![(0.0, 2.0), (5.0, 2.1)]), Err(CopError::Rising { row: 2, .. })));
    assert!(matches!(Cop::table(vec![(0.0, -2.0)]), Err(CopError::Value { row: 1, .. })));
    let table = Cop::table(vec![(0.0, 4.0), (10.0, 3.0), (20.0, 2.0)]).expect("falls");
    for (lift_k, cop) in [(-5.0, 4.0), (0.0, 4.0), (5.0, 3.5), (10.0, 3.0), (19.0, 2.1), (20.0, 2.0), (50.0, 2.0)] {
        assert!((table.at(lift_k) - cop).abs() < 1e-12, "{lift_k}");
    }
}

fn disturbances() -> impl Strategy<Value = Disturbances> {
    (-25.0..42.0_f64, 0.0..950.0_f64, 0.0..450.0_f64, -0.3..1.15_f64, 0.0..=1.0_f64, 0.0..120.0_f64, 0.0..0.6_f64)
        .prop_map(|(ambient_c, dni, dhi, altitude, shadow, passengers, doors)| Disturbances {
            ambient_temperature_k: kelvin(ambient_c),
            dni_w_m2: dni,
            dhi_w_m2: dhi,
            solar_altitude_rad: altitude,
            shadow_fraction: shadow,
            passengers,
            door_open_fraction: doors,
        })
}

proptest! {
    #[test]
    fn prop_balances_close_and_slopes_are_true(d in disturbances(), cabin_c in -20.0..45.0_f64, on: bool, curtain: bool) {
        let vehicle = Vehicle::default();
        let views = PassengerViews::from_view_factors(&[0.01, 0.012, 0.0165, 0.017]);
        let cabin = Cabin::new(&vehicle, &views, &d);
        let heaters = if on { Heaters::On } else { Heaters::Off };
        let settle = |cabin_c: f64| {
            let k = kelvin(cabin_c);
            cabin.state(Target::CabinTemperature(k), heaters, &cabin.rough_state(k)).expect("settles")
        };
        let State { temperatures: t, slopes, pmv, pmv_slope, .. } = settle(cabin_c);
        let (heat_w, heat_slope) = cabin.air_unit_heat_w(&t, &slopes, curtain);
        let power_w = if on { cabin.radiant_heater_power_w(&t) } else { 0.0 };
        for net_w in cabin.flows(&t, curtain, heat_w, power_w).net_w() {
            prop_assert!(net_w.abs() < 1e-6, "{net_w}");
        }
        let all = [slopes.interior, slopes.shell_inside, slopes.shell_outside, slopes.radiant_heater];
        prop_assert!(all.iter().all(|s| (0.0..=1.0).contains(s)), "{slopes:?}");
        prop_assert!(heat_slope > 0.0 && pmv_slope > 0.0 && pmv.is_finite());

        let h = 1e-3;
        let (up, down) = (settle(cabin_c + h), settle(cabin_c - h));
        let difference = |f: &dyn Fn(&Temperatures) -> f64| (f(&up.temperatures) - f(&down.temperatures)) / (2.0 * h);
        prop_assert!((difference(&|t| t.interior_k) - slopes.interior).abs() < 1e-6);
        prop_assert!((difference(&|t| t.shell_inside_k) - slopes.shell_inside).abs() < 1e-6);
        prop_assert!((difference(&|t| t.shell_outside_k) - slopes.shell_outside).abs() < 1e-6);
        prop_assert!((difference(&|t| t.radiant_heater_k) - slopes.radiant_heater).abs() < 1e-6);
        prop_assert!(((up.pmv - down.pmv) / (2.0 * h) - pmv_slope).abs() < 0.3 * pmv_slope);
    }

    #[test]
    fn prop_the_quadrature_gives_the_mean_vote_of_all_passengers(d in disturbances(), cabin_c in 5.0..35.0_f64, on: bool) {
        let vehicle = Vehicle::default();
        let placed = place_passengers(&vehicle);
        let views = PassengerViews::from_view_factors(&placed);
        let cabin = Cabin::new(&vehicle, &views, &d);
        let heaters = if on { Heaters::On } else { Heaters::Off };
        let cabin_k = kelvin(cabin_c);
        let state = cabin.state(Target::CabinTemperature(cabin_k), heaters, &cabin.rough_state(cabin_k)).expect("settles");
        let mean = |t: &Temperatures| placed.iter().map(|&v| cabin.passenger_pmv(t, v)).sum::<f64>() / placed.len() as f64;
        let full = mean(&state.temperatures);
        prop_assert!((full - state.pmv).abs() < 1e-8, "{full} {}", state.pmv);

        // The states of a vote and without heat are the same states, met from the other side.
        let near = cabin.rough_state(cabin_k + 8.0);
        let vote = cabin.state(Target::Vote(full), heaters, &near).expect("settles");
        prop_assert!((vote.temperatures.cabin_k - cabin_k).abs() < 1e-6, "{vote:?} {cabin_k}");
        prop_assert_eq!(vote.pmv, full);
        prop_assert!((mean(&vote.temperatures) - full).abs() < 1e-8);
        let passive = cabin.state(Target::passive(cabin.door_loss_share(on)), heaters, &near).expect("settles");
        let (heat_w, _) = cabin.air_unit_heat_w(&passive.temperatures, &passive.slopes, on);
        prop_assert!(heat_w.abs() < 1e-6, "{heat_w}");
        prop_assert!((mean(&passive.temperatures) - passive.pmv).abs() < 1e-8);
    }
}
