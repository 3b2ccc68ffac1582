//! PMV and PPD against ISO 7730:2005 Table D.1 and published validation rows.
#![expect(clippy::print_stderr, reason = "a test that cannot run for want of data says so")]

use cabin::{PmvModel, StandardRange, predicted_percentage_dissatisfied};
use proptest::prelude::*;

/// air °C, radiant °C, air speed m/s, humidity %, met, clo; printed PMV and PPD; PMV by a converged reference.
const TABLE_D1: &[([f64; 6], f64, f64, f64)] = &[
    ([22.0, 22.0, 0.1, 60.0, 1.2, 0.5], -0.75, 17.0, -0.753051),
    ([27.0, 27.0, 0.1, 60.0, 1.2, 0.5], 0.77, 17.0, 0.763911),
    ([27.0, 27.0, 0.3, 60.0, 1.2, 0.5], 0.44, 9.0, 0.432762),
    ([23.5, 25.5, 0.1, 60.0, 1.2, 0.5], -0.01, 5.0, -0.014374),
    ([23.5, 25.5, 0.3, 60.0, 1.2, 0.5], -0.55, 11.0, -0.556032),
    ([19.0, 19.0, 0.1, 40.0, 1.2, 1.0], -0.6, 13.0, -0.600626),
    ([23.5, 23.5, 0.1, 40.0, 1.2, 1.0], 0.5, 10.0, 0.36138),
    ([23.5, 23.5, 0.3, 40.0, 1.2, 1.0], 0.12, 5.0, 0.119405),
    ([23.0, 21.0, 0.1, 40.0, 1.2, 1.0], 0.05, 5.0, 0.051976),
    ([23.0, 21.0, 0.3, 40.0, 1.2, 1.0], -0.16, 6.0, -0.168528),
    ([22.0, 22.0, 0.1, 60.0, 1.6, 0.5], 0.05, 5.0, 0.046616),
    ([27.0, 27.0, 0.1, 60.0, 1.6, 0.5], 1.17, 34.0, 1.170269),
    ([27.0, 27.0, 0.3, 60.0, 1.6, 0.5], 0.95, 24.0, 0.950155),
];

/// Row 7 does not follow from the standard's own program; the row is a known misprint (0.50 for 0.36).
const MISPRINT: usize = 6;

fn pmv([air, radiant, speed, humidity, met, clo]: [f64; 6]) -> f64 {
    PmvModel::new(clo, met, humidity / 100.0, speed).at(air, radiant).pmv
}

#[test]
fn xval_iso7730_table_d1() {
    for (i, &(inputs, printed_pmv, printed_ppd, _)) in TABLE_D1.iter().enumerate() {
        let value = pmv(inputs);
        if i == MISPRINT {
            assert!((value - printed_pmv).abs() > 0.1, "the misprint is gone: {value}");
            continue;
        }
        assert!((value - printed_pmv).abs() < 0.01, "row {}: {value} instead of {printed_pmv}", i + 1);
        let ppd = predicted_percentage_dissatisfied(value);
        assert!((ppd - printed_ppd).abs() < 1.0, "row {}: {ppd} % instead of {printed_ppd} %", i + 1);
    }
}

#[test]
fn xval_python_converged_annex_d() {
    for (i, &(inputs, _, _, converged)) in TABLE_D1.iter().enumerate() {
        let value = pmv(inputs);
        assert!((value - converged).abs() < 1e-6, "row {}: {value} instead of {converged}", i + 1);
    }
}

#[test]
fn xval_validation_data_comfort_models() {
    let Some(text) = data("validation/ts_pmv_ppd.json") else { return };
    let file: serde_json::Value = serde_json::from_str(&text).expect("valid JSON");
    let tolerance = |name: &str| file["tolerance"][name].as_f64().expect("a tolerance");
    let mut rows = 0;
    for row in file["data"].as_array().expect("rows") {
        let (inputs, outputs) = (&row["inputs"], &row["outputs"]);
        // A row may hold arrays: then it is as many rows, and its scalars count for each.
        let length = outputs["pmv"].as_array().map_or(1, Vec::len);
        for i in 0..length {
            let number = |value: &serde_json::Value| value.as_array().map_or(value, |a| &a[i]).as_f64();
            let input = |name: &str| number(&inputs[name]).unwrap_or_else(|| panic!("{name} in {row}"));
            let imperial = inputs["units"] == "ip";
            let temperature_c = |name| if imperial { (input(name) - 32.0) / 1.8 } else { input(name) };
            let speed_m_s = if imperial { 0.3048 * input("vr") } else { input("vr") };
            let [air, radiant] = ["tdb", "tr"].map(temperature_c);
            let value = pmv([air, radiant, speed_m_s, input("rh"), input("met"), input("clo")]);
            assert!(value.is_finite(), "{value} in {row}");
            if inputs["standard"] == "ASHRAE" && speed_m_s > 0.105 {
                // Above 0.1 m/s ASHRAE 55 corrects for elevated air speed, which ISO 7730 does not know.
                continue;
            }
            // Without a value the row lies outside the standard's range, where the other programs do not answer.
            let Some(expected) = number(&outputs["pmv"]) else { continue };
            assert!((value - expected).abs() <= tolerance("pmv"), "{value} in {row}");
            if let Some(expected) = number(&outputs["ppd"]) {
                let ppd = predicted_percentage_dissatisfied(value);
                assert!((ppd - expected).abs() <= tolerance("ppd"), "{ppd} % in {row}");
            }
            rows += 1;
        }
    }
    assert!(rows > 12, "only {rows} rows");
}

#[test]
fn prop_the_range_of_use_is_flagged_and_never_clipped() {
    let model = PmvModel::new(1.38, 1.2, 0.4, 0.1);
    let winter = model.at(16.1, 9.9);
    assert_eq!(model.standard_range(16.1, 9.9, winter.pmv), StandardRange::Outside);
    assert_eq!(model.standard_range(20.0, 18.0, -0.5), StandardRange::Inside);
    let frost = model.at(-20.0, -25.0).pmv;
    assert!(frost.is_finite() && frost < -3.0, "{frost}");
}

proptest! {
    #[test]
    fn prop_slopes_are_those_of_the_value(
        air in -30.0..55.0_f64, radiant in -30.0..55.0_f64, clo in 0.3..1.7_f64,
    ) {
        let model = PmvModel::new(clo, 1.2, 0.4, 0.1);
        let at = |air, radiant| model.at(air, radiant).pmv;
        let point = model.at(air, radiant);
        let h = 1e-4;
        let per_air = (at(air + h, radiant) - at(air - h, radiant)) / (2.0 * h);
        let per_radiant = (at(air, radiant + h) - at(air, radiant - h)) / (2.0 * h);
        // Where convection changes from forced to natural the slope jumps; a difference across the jump lies between.
        let near = |exact: f64, difference: f64| (exact - difference).abs() < 1e-6 + 0.3 * exact.abs();
        prop_assert!(near(point.per_air_k, per_air), "{} {per_air}", point.per_air_k);
        prop_assert!(near(point.per_radiant_k, per_radiant), "{} {per_radiant}", point.per_radiant_k);
        prop_assert!(point.per_air_k > 0.0 && point.per_radiant_k > 0.0);
    }
}

fn data(name: &str) -> Option<String> {
    let root = std::env::var_os("BUSCLIMATE_DATA").map_or_else(
        || std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data"),
        std::path::PathBuf::from,
    );
    let text = std::fs::read_to_string(root.join(name)).ok();
    if text.is_none() {
        eprintln!("skipped: {name} is not in {}; set BUSCLIMATE_DATA to the data folder", root.display());
    }
    text
}
