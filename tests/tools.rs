//! The same numbers in every tool: DuckDB, pandas, polars and Datasette beside SQLite.

use crate::common::Scratch;
use testing::peer;

#[test]
fn prop_every_column_of_every_view_has_a_type() {
    let scratch = Scratch::small(3, "[1.0]", "[1.0]");
    scratch.expect(0, &["run"]);
    let untyped = scratch.query(
        "SELECT s.name, c.name, c.type FROM sqlite_schema AS s, pragma_table_info(s.name) AS c
         WHERE s.type = 'view' AND c.type NOT IN ('INTEGER', 'INT', 'REAL', 'TEXT', 'NUM')",
    );
    assert!(untyped.is_empty(), "{untyped:?}");
    // What a view computes is a number or a text, never what its values happen to be.
    let bare = scratch.query(
        "SELECT s.name, c.name, c.type FROM sqlite_schema AS s, pragma_table_info(s.name) AS c
         WHERE s.type = 'view' AND c.type = 'NUM'",
    );
    assert!(bare.is_empty(), "{bare:?}");
}

#[test]
fn xval_tools_read_what_sqlite_reads() {
    let scratch = Scratch::small(24, "{ from = 0.0, to = 1.0, step = 0.1 }", "[0.5]");
    scratch.edit("study.toml", "[0.25, 0.5, 0.625, 0.75, 1.0, 1.25, 1.5, 2.0]", "[0.3, 1.0]");
    scratch.expect(0, &["run"]);
    scratch.write("words.json", scratch.expect(0, &["dictionary", "--format", "json"]).stdout);
    let [database, words] = ["study.db", "words.json"].map(|name| scratch.path(name).to_string_lossy().into_owned());
    let needs = "duckdb, duckdb_extension_sqlite_scanner, datasette, pandas, polars";
    let Some(lines) = peer("tools.py", needs, &[database, words]) else { return };
    let differences: Vec<&Vec<String>> = lines.iter().filter(|line| !line[4].is_empty()).collect();
    assert!(differences.is_empty(), "{differences:#?}");
    for tool in ["duckdb", "pandas", "polars"] {
        let rows: u64 = lines.iter().filter(|l| l[1] == tool).map(|l| l[2].parse::<u64>().unwrap()).sum();
        assert!(rows > 5_000, "{tool} has read {rows} rows");
    }
    // Filters that find nothing, or everything, would show nothing.
    let found = lines.iter().filter(|l| l[1] == "datasette" && l[2] != "0").count();
    assert!(found >= 10, "{lines:#?}");
}

#[test]
fn cli_limits_are_what_was_typed() {
    let scratch = Scratch::small(3, "{ from = 0.0, to = 1.0, step = 0.1 }", "[]");
    let run = scratch.expect(0, &["run"]);
    let limits = scratch.query("SELECT DISTINCT pmv_limit FROM annual_average ORDER BY 1");
    let typed: Vec<String> = (0..=10).map(|i| format!("{:.1}", f64::from(i) / 10.0)).collect();
    assert_eq!(limits.concat(), typed, "{}", run.stdout);
    assert_eq!(scratch.query("SELECT count(*) FROM annual_average WHERE pmv_limit = 0.3"), [["5"]]);
    assert!(scratch.read("report/report.md").contains("±0.3 |"));
    let id = scratch.query("SELECT min(sample_id) FROM sample")[0][0].clone();
    scratch.expect(0, &["show", "--sample", &id, "--design", "hp", "--pmv-limit", "0.3"]);
}

#[test]
fn cli_settings_say_what_differs_from_the_paper_first() {
    let scratch = Scratch::small(3, "[0.5, 1.0]", "[]");
    scratch.edit("study.toml", "[simulation]", "metabolic_rate_met = 1.4\n\n[simulation]");
    scratch.expect(0, &["run"]);
    let rows = scratch.query("SELECT name, value, unit, default_value, source, differs_from_default FROM setting");
    let row = |name: &str| rows.iter().position(|row| row[0] == name).unwrap();
    let rate = row("vehicle.metabolic_rate_met");
    assert_eq!(rows[rate][1..], ["1.4", "met", "1.2", "the study file", "1"]);
    assert_eq!(rows[row("dynamics.heat_pump_limit_w")][1..3], ["12000.0", "W"]);
    assert!(rows[row("dynamics.ptc_limit_w")][4].contains("the paper does not print it"));
    assert_eq!(rows[row("program_version")][1], env!("CARGO_PKG_VERSION"));
    let first_same = rows.iter().position(|row| row[5] == "0").unwrap();
    assert!(rate < first_same && rows[first_same..].iter().all(|row| row[5] == "0"), "{rows:?}");
    // The text as it was run.
    let text = scratch.query("SELECT text FROM study_text JOIN run USING (study_hash)");
    assert!(text[0][0].contains("metabolic_rate_met = 1.4"), "{text:?}");
    let report = scratch.read("report/report.md");
    let first = report.split_once("## Assumptions").unwrap().1.lines().find(|line| line.starts_with("| cons"));
    assert!(first.unwrap().contains("metabolic_rate_met = 1.4"), "{first:?}");

    // What a stage has not used yet is not what its results rest on.
    scratch.edit("study.toml", "metabolic_rate_met = 1.4", "metabolic_rate_met = 1.3");
    scratch.expect(0, &["ingest"]);
    let value = "SELECT value FROM setting WHERE name = 'vehicle.metabolic_rate_met'";
    assert_eq!(scratch.query(value), [["1.4"]]);
    scratch.expect(0, &["solve"]);
    assert_eq!(scratch.query(value), [["1.3"]]);
}
