//! The two steady states that the paper prints, figures single-scenario-cold and single-scenario-hot.
//!
//! A label is rounded, and so are the labels that serve as inputs. The tolerance of each value is half a unit of its own
//! label's last place plus what half a unit of every input label makes of it.

use cabin::{
    Cabin, Disturbances, Heaters, PassengerViews, SolarGains, Target, Vehicle, celsius, clothing_insulation_clo, kelvin,
};

/// Ambient and cabin temperature in °C, passengers, door flow in kW, solar gains of interior, inside and outside in kW.
type Inputs = [f64; 7];
/// Half a unit of the last place of each input.
const ROUNDING: Inputs = [0.05, 0.05, 0.05, 0.05, 0.05, 0.05, 0.05];

/// Everything that the figures label, in °C and kW (flows as absolute values), and the mean vote.
fn labels(inputs: Inputs) -> Vec<(&'static str, f64)> {
    let [ambient_c, cabin_c, passengers, door_kw, solar_interior, solar_inside, solar_outside] = inputs;
    let vehicle = Vehicle::default();
    let views = PassengerViews::new(&vehicle);
    let gains = SolarGains {
        interior_w: 1000.0 * solar_interior,
        shell_inside_w: 1000.0 * solar_inside,
        shell_outside_w: 1000.0 * solar_outside,
    };
    let disturbances = |door_open_fraction| Disturbances {
        ambient_temperature_k: kelvin(ambient_c),
        dni_w_m2: 0.0,
        dhi_w_m2: 0.0,
        solar_altitude_rad: 0.0,
        shadow_fraction: 0.0,
        passengers,
        door_open_fraction,
    };
    let settle = |cabin: &Cabin| {
        let cabin_k = kelvin(cabin_c);
        cabin.state(Target::CabinTemperature(cabin_k), Heaters::Off, &cabin.rough_state(cabin_k)).expect("settles")
    };
    // The figures give the door flow; the open fraction follows, since the flow is proportional to it.
    let cabin = Cabin::with_solar_gains(&vehicle, &views, &disturbances(1.0), gains);
    let full_w = cabin.flows(&settle(&cabin).temperatures, true, 0.0, 0.0).door_w.abs();
    let cabin = Cabin::with_solar_gains(&vehicle, &views, &disturbances(1000.0 * door_kw / full_w), gains);
    let state = settle(&cabin);
    let t = state.temperatures;
    let (air_unit_w, _) = cabin.air_unit_heat_w(&t, &state.slopes, true);
    let f = cabin.flows(&t, true, air_unit_w, 0.0);
    assert!(f.net_w().iter().all(|w| w.abs() < 1e-6), "{:?}", f.net_w());
    let kw = |watt: f64| watt.abs() / 1000.0;
    vec![
        ("interior", celsius(t.interior_k)),
        ("shell inside", celsius(t.shell_inside_k)),
        ("shell outside", celsius(t.shell_outside_k)),
        ("radiant heaters", celsius(t.radiant_heater_k)),
        ("air unit", air_unit_w / 1000.0),
        ("passengers", kw(f.passengers_w)),
        ("other", kw(f.other_w)),
        ("convection interior", kw(f.convection_interior_w)),
        ("convection heaters", kw(f.convection_radiant_heater_w)),
        ("radiation heaters to interior", kw(f.radiation_heater_interior_w)),
        ("radiation heaters to shell", kw(f.radiation_heater_shell_w)),
        ("radiation interior to shell", kw(f.radiation_interior_shell_w)),
        ("convection shell inside", kw(f.convection_shell_inside_w)),
        ("conduction", kw(f.conduction_shell_w)),
        ("convection shell outside", kw(f.convection_shell_outside_w)),
        ("radiation shell outside", kw(f.radiation_shell_outside_w)),
        ("PMV", state.pmv),
    ]
}

fn compare(inputs: Inputs, expected: &[(&str, f64)]) {
    let ours = labels(inputs);
    let mut tolerance = vec![0.05; ours.len()];
    for (i, half_unit) in ROUNDING.into_iter().enumerate() {
        // Inputs that are exactly zero (no sun) are not rounded.
        if inputs[i] == 0.0 {
            continue;
        }
        let [mut up, mut down] = [inputs; 2];
        up[i] += half_unit;
        down[i] -= half_unit;
        let (up, down) = (labels(up), labels(down));
        for (k, tolerance) in tolerance.iter_mut().enumerate() {
            *tolerance += (up[k].1 - ours[k].1).abs().max((down[k].1 - ours[k].1).abs());
        }
    }
    assert_eq!(ours.len(), expected.len());
    for (k, ((name, value), &(label, printed))) in ours.into_iter().zip(expected).enumerate() {
        assert_eq!(name, label);
        let allowed = tolerance[k];
        assert!((value - printed).abs() <= allowed, "{name}: {value:.3} instead of {printed} ± {allowed:.3}");
        assert!(allowed < 0.6, "{name}: ± {allowed} would prove nothing");
    }
}

#[test]
fn paper_winter_sample() {
    compare(
        [-0.7, 16.1, 33.5, 2.3, 0.0, 0.0, 0.0],
        &[
            ("interior", 13.5),
            ("shell inside", 9.5),
            ("shell outside", 1.4),
            ("radiant heaters", 12.3),
            ("air unit", 8.0),
            ("passengers", 4.2),
            ("other", 1.0),
            ("convection interior", 0.4),
            ("convection heaters", 0.0),
            ("radiation heaters to interior", 0.0),
            ("radiation heaters to shell", 0.0),
            ("radiation interior to shell", 0.4),
            ("convection shell inside", 10.6),
            ("conduction", 11.0),
            ("convection shell outside", 9.0),
            ("radiation shell outside", 2.0),
            ("PMV", -1.0),
        ],
    );
}

#[test]
fn paper_summer_sample() {
    compare(
        [34.7, 24.9, 16.0, 0.9, 1.0, 2.4, 7.1],
        &[
            ("interior", 30.8),
            ("shell inside", 30.3),
            ("shell outside", 34.9),
            ("radiant heaters", 29.1),
            ("air unit", -13.5),
            ("passengers", 2.0),
            ("other", 1.0),
            ("convection interior", 0.9),
            ("convection heaters", 0.0),
            ("radiation heaters to interior", 0.0),
            ("radiation heaters to shell", 0.0),
            ("radiation interior to shell", 0.1),
            ("convection shell inside", 8.7),
            ("conduction", 6.2),
            ("convection shell outside", 0.7),
            ("radiation shell outside", 0.2),
            ("PMV", 0.5),
        ],
    );
}

#[test]
fn paper_clothing_figure() {
    let rounded = |ambient_c| (clothing_insulation_clo(kelvin(ambient_c), 0.3) * 100.0).round() / 100.0;
    assert_eq!(rounded(10.0), 1.13);
    assert_eq!(rounded(35.0), 0.30);
}

#[test]
fn paper_constants_follow_from_their_sources() {
    let v = Vehicle::default();
    let near = |a: f64, b: f64, tolerance: f64| assert!((a - b).abs() <= tolerance, "{a} and {b}");
    // ISO 6946: h = 4 + 4 v outside at 15 km/h.
    near(v.convection_outside_w_m2_k, 4.0 + 4.0 * 15.0 / 3.6, 0.005);
    // Reciprocity and summation: F_int,s = 1 − A_rh F_rh,int / A_int.
    let view = 1.0 - v.radiant_heater_area_m2 * v.view_factor_heater_interior / v.interior_area_m2;
    near(v.view_factor_interior_shell, view, 1e-12);
    near(v.view_factor_heater_interior + v.view_factor_heater_shell, 1.0, 1e-12);
    let [l, w, h] = [v.cabin_length_m, v.cabin_width_m, v.cabin_height_m];
    near(v.shell_area_m2, 2.0 * (l * w + l * h + w * h), 0.05);
    near(v.roof_area_m2, l * w, 0.05);
    near(v.wall_area_m2, 2.0 * (l + w) * h, 0.05);
}
