//! Published setpoints, at points that their sources give.

use setpoints::published;

#[test]
fn xval_sources_published_setpoints_are_those_of_their_sources() {
    let all = published();
    let at = |name: &str, ambient_c: f64| {
        let profile = all.iter().find(|p| p.name == name).expect("a published profile");
        [profile.heating.at(ambient_c), profile.cooling.at(ambient_c)]
    };
    // VDV 236 in formulas: 20 + (T + 10)/32 and 16 + 4/3 (T + 13) for comfort, 22 + 10/13 (T − 22) at most.
    for (name, ambient_c, setpoint_c) in [
        ("vdv-comfort", 6.0, 20.5),
        ("vdv-comfort", -11.5, 18.0),
        ("vdv-comfort", 40.0, 30.0),
        ("vdv-economy", 22.0 + 13.0 / 12.0, 20.0),
        ("vdv-max", 28.5, 27.0),
        ("vdv-min", -40.0, 12.0),
    ] {
        let [heating_c, cooling_c] = at(name, ambient_c);
        assert!((heating_c - setpoint_c).abs() < 1e-9 && heating_c == cooling_c, "{name}: {heating_c} {setpoint_c}");
    }
    // Above 30.7 °C the economy curve is the warmer one, as its source has it.
    assert!(at("vdv-economy", 30.6)[0] < at("vdv-comfort", 30.6)[0]);
    assert!(at("vdv-economy", 30.8)[0] > at("vdv-comfort", 30.8)[0]);
    assert_eq!(at("vbz-18", -16.0), [13.5, 23.0]);
    assert_eq!(at("vbz-16", 26.5), [16.0, 26.5]);
    assert_eq!(at("constant-20", -5.0), [20.0, 20.0]);
    let single = ["vdv-comfort", "vdv-economy", "vdv-max", "vdv-min", "constant-20"];
    assert!(all.iter().all(|p| p.is_single() == single.contains(&p.name)));
    // Nobody cools below its heating setpoint.
    for ambient_c in (-25..45).map(f64::from) {
        assert!(all.iter().all(|p| p.cooling.at(ambient_c) >= p.heating.at(ambient_c)), "{ambient_c}");
    }
    assert_eq!(at("vecto", 30.0), [18.0, 27.0]);
    assert_eq!(at("vecto", -5.0), [18.0, 23.0]);
}
