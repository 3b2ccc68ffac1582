//! What the program says of itself, to shells, manuals, editors and other programs.

#![expect(clippy::unwrap_used, reason = "a test ends where something is not as expected")]

use crate::common::Scratch;
use serde_json::Value;

#[test]
fn cli_the_schema_knows_every_key_of_a_new_study() {
    let scratch = Scratch::empty();
    scratch.expect(0, &["init", "new"]);
    let schema: Value = serde_json::from_str(&scratch.read("new/study.schema.json")).unwrap();
    assert_eq!(scratch.expect(0, &["schema"]).stdout, scratch.read("new/study.schema.json"));
    let text = scratch.read("new/study.toml");
    assert!(text.starts_with("#:schema study.schema.json\n"), "{text}");
    // Keys as they are, and those that stand there as comments with their defaults.
    let mut section = schema.clone();
    let mut keys = 0;
    for line in text.lines() {
        let line = line.trim_start_matches("# ");
        if let Some(name) = line.strip_prefix('[') {
            let name = name.split(']').next().unwrap();
            section = name.split('.').fold(schema.clone(), |at, part| inner(&schema, &at, part));
        } else if let Some((key, _)) = line.split_once(" = ")
            && key.chars().all(|c| c.is_ascii_lowercase() || c == '_' || c.is_ascii_digit())
        {
            assert!(section["properties"][key].is_object(), "{key} in {section:#}");
            keys += 1;
        }
    }
    assert!(keys > 60, "{keys} keys");
    let vehicle = inner(&schema, &schema, "vehicle");
    assert_eq!(vehicle["properties"]["metabolic_rate_met"]["default"], 1.2);
    assert_eq!(vehicle["additionalProperties"], false);
}

/// The schema of a key, references followed.
fn inner(schema: &Value, at: &Value, key: &str) -> Value {
    let found = at["properties"].get(key.trim_matches('"')).unwrap_or(&at["additionalProperties"]);
    match found["$ref"].as_str() {
        Some(path) => schema.pointer(path.trim_start_matches('#')).unwrap().clone(),
        None => found.clone(),
    }
}

#[test]
fn cli_completions_and_manual_pages_name_every_command() {
    let scratch = Scratch::empty();
    scratch.expect(0, &["man", "man1"]);
    let (help, bash) = (scratch.expect(0, &["help"]).stdout, scratch.expect(0, &["completions", "bash"]).stdout);
    let commands = help.split("Commands:").nth(1).unwrap().split("Options:").next().unwrap();
    let named = commands.lines().filter(|l| l.starts_with("  ") && !l.starts_with("   "));
    let named: Vec<&str> = named.map(|l| l.split_whitespace().next().unwrap()).filter(|c| *c != "help").collect();
    assert!(named.len() > 15 && named.contains(&"export"), "{named:?}");
    for command in named {
        assert!(scratch.path("man1").join(format!("busclimate-{command}.1")).exists(), "{command}");
        assert!(bash.contains(&format!("busclimate,{command})")), "{command}");
    }
}

#[test]
fn cli_an_optimum_is_shown_as_json_too() {
    let scratch = Scratch::small(3, "[1.0]", "[]");
    scratch.expect(0, &["run"]);
    let id = scratch.query("SELECT min(sample_id) FROM sample")[0][0].clone();
    let point = ["show", "--sample", &id, "--design", "hp", "--pmv-limit", "1", "--json"];
    let shown: Value = serde_json::from_str(&scratch.expect(0, &point).stdout).unwrap();
    assert_eq!(shown["sample_id"].to_string(), id);
    let power = format!("SELECT hvac_power_w FROM optimum WHERE sample_id = {id} AND design = 'hp'");
    let stored: f64 = scratch.query(&power)[0][0].parse().unwrap();
    assert!((shown["optimum"]["hvac_power_w"].as_f64().unwrap() - stored).abs() < 1e-6, "{shown:#}");
    assert_eq!(shown["candidates"].as_array().unwrap().len(), 4);
    let flows = shown["heat"]["flows_w"].as_object().unwrap();
    let door = format!("SELECT door_w FROM heat_flow WHERE sample_id = {id} AND design = 'hp'");
    let stored: f64 = scratch.query(&door)[0][0].parse().unwrap();
    assert!(flows.len() == 17 && (flows["door_w"].as_f64().unwrap() - stored).abs() < 1e-6, "{flows:?}");
}

#[test]
fn cli_quiet_and_verbose_exclude_each_other() {
    let scratch = Scratch::small(3, "[1.0]", "[]");
    scratch.expect(2, &["run", "-q", "-v"]);
    assert_eq!(scratch.expect(0, &["run", "-q"]).stderr, "");
    let details = scratch.expect(0, &["run", "-v"]).stderr;
    assert!(details.contains("DEBUG"), "{details}");
}
