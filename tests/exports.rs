//! Files for other tools: the same values, one schema, whole or not at all.

#![expect(clippy::unwrap_used, reason = "a test ends where something is not as expected")]

use crate::common::Scratch;
use std::collections::BTreeMap;
use std::path::Path;
use testing::peer;

/// Every file below a folder with its content.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut open = vec![folder.to_owned()];
    while let Some(next) = open.pop() {
        for entry in std::fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                open.push(path);
            } else {
                let name = path.strip_prefix(folder).unwrap().to_string_lossy().into_owned();
                found.insert(name, std::fs::read(path).unwrap());
            }
        }
    }
    found
}

#[test]
fn xval_tools_read_from_exports_what_sqlite_reads() {
    let scratch = Scratch::small(24, "[0.0, 0.3, 1.0]", "[1.0]");
    scratch.edit("study.toml", "[0.25, 0.5, 0.625, 0.75, 1.0, 1.25, 1.5, 2.0]", "[0.3, 1.0]");
    scratch.expect(0, &["run"]);
    scratch.expect(0, &["export", "--format", "parquet", "--to", "parquet"]);
    scratch.expect(0, &["export", "--format", "csv", "--to", "csv"]);
    let [database, parquet, csv] =
        ["study.db", "parquet", "csv"].map(|name| scratch.path(name).to_string_lossy().into_owned());
    let Some(lines) = peer("exports.py", "duckdb, pandas, polars, pyarrow", &[database, parquet, csv]) else { return };
    assert!(lines.len() > 200, "{}", lines.len());
    let wrong: Vec<&Vec<String>> = lines.iter().filter(|line| !line[3].is_empty()).collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
    // Tables without rows have their schema too.
    assert!(lines.iter().any(|line| line[2] == "0"), "{lines:#?}");
}

#[test]
fn cli_an_export_is_whole_and_the_same_bytes_again() {
    let scratch = Scratch::small(6, "[1.0]", "[]");
    scratch.expect(0, &["run"]);
    scratch.expect(0, &["export", "--format", "parquet", "--to", "out"]);
    let first = files(&scratch.path("out"));
    assert!(first.contains_key("optimum/design=hp+curtain/part-0.parquet"), "{:?}", first.keys());
    scratch.write("out/notes.txt", "mine");
    scratch.expect(0, &["export", "--format", "parquet", "--to", "out", "--threads", "1"]);
    let mut second = files(&scratch.path("out"));
    assert_eq!(second.remove("notes.txt").unwrap(), b"mine");
    assert!(first == second, "other bytes");
    // Another format takes the place of the first.
    scratch.expect(0, &["export", "--format", "csv", "--to", "out"]);
    let third = files(&scratch.path("out"));
    assert!(third.keys().all(|name| !name.ends_with(".parquet")), "{:?}", third.keys());
    // What is no export stays.
    std::fs::create_dir(scratch.path("mine")).unwrap();
    scratch.write("mine/sample", "mine");
    let refused = scratch.expect(2, &["export", "--format", "csv", "--to", "mine"]);
    assert!(refused.stderr.contains("mine holds files that are no export"), "{}", refused.stderr);
    assert_eq!(files(&scratch.path("mine")).len(), 1);
}

#[test]
fn prop_look_up_tables_are_optima_on_a_full_grid() {
    let scratch = Scratch::small(24, "[0.5, 1.0]", "[]");
    scratch.expect(0, &["run"]);
    scratch.expect(0, &["export", "--format", "lut", "--to", "lut", "--capacity", "100"]);
    let all = files(&scratch.path("lut"));
    assert_eq!(all.len(), 5 * 2 + 2, "{:?}", all.keys());
    let text = String::from_utf8(all["consumption/hp_pmv_-1_1.csv"].clone()).unwrap();
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("t_amb,level_of_loading,incline,mean_speed_kmh,consumption_kwh_per_km"));
    let rows: Vec<Vec<f64>> = lines.map(|line| line.split(',').map(|v| v.parse().unwrap()).collect()).collect();
    assert_eq!(rows.len(), 13 * 5 * 3 * 7);
    let at = |t: f64, level: f64, speed: f64| {
        rows.iter().find(|r| r[0] == t && r[1] == level && r[2] == 0.0 && r[3] == speed).unwrap()[4]
    };
    // Twice as fast is half as much for a kilometre; people warm; cold costs.
    assert!((at(-10.0, 0.5, 10.0) - 2.0 * at(-10.0, 0.5, 20.0)).abs() < 1e-12);
    assert!(at(-10.0, 1.0, 20.0) < at(-10.0, 0.0, 20.0) && at(-10.0, 0.5, 20.0) > at(5.0, 0.5, 20.0));
    let rich = String::from_utf8(all["hvac_power.csv"].clone()).unwrap();
    assert_eq!(rich.lines().count(), 1 + 5 * 2 * 13 * 5 * 3 * 4);
    let package = String::from_utf8(all["datapackage.json"].clone()).unwrap();
    assert!(package.contains("HVAC share") && package.contains("\"level_of_loading_1_is_passengers\": 100.0"));
    for capacity in ["-1", "NaN", "1e9"] {
        let refused =
            scratch.expect(2, &["export", "--format", "lut", "--to", "none", &format!("--capacity={capacity}")]);
        assert!(refused.stderr.contains("give 1 to 500 people"), "{}", refused.stderr);
    }
    let arguments = [scratch.path("lut").to_string_lossy().into_owned()];
    if let Some(lines) = peer("lut.py", "eflips.model", &arguments) {
        assert!(lines.iter().all(|line| line[1] == "1365"), "{lines:?}");
    }
}
