//! What the documents say of the repository, held against it.

#![expect(clippy::unwrap_used, reason = "a test ends where something is not as expected")]

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

const WIDEST: usize = 120;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn files(folder: &Path, extension: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if path.is_dir()
            && !name.starts_with('.')
            && !["target", "busclimate-demo", "node_modules"].contains(&name.as_str())
        {
            found.extend(files(&path, extension));
        } else if path.extension().is_some_and(|e| e == extension) {
            found.push(path);
        }
    }
    found.sort();
    found
}

#[test]
fn cli_the_units_for_systemd_are_valid() {
    let text = std::fs::read_to_string(root().join("docs/nightly.md")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let mut units = Vec::new();
    for block in text.split("```ini\n# /etc/systemd/system/").skip(1) {
        let (name, unit) = block.split_once('\n').unwrap();
        let unit = unit.split("```").next().unwrap();
        let unit = unit.replace("/usr/local/bin/busclimate", env!("CARGO_BIN_EXE_busclimate"));
        units.push(folder.path().join(name));
        std::fs::write(folder.path().join(name), unit).unwrap();
    }
    assert_eq!(units.len(), 4, "the document has other units");
    let Ok(output) = std::process::Command::new("systemd-analyze").arg("verify").args(&units).output() else {
        eprintln!("systemd-analyze is not there: the units are not verified");
        return;
    };
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn prop_prose_is_at_most_120_columns_wide() {
    let mut wide = Vec::new();
    for path in files(root(), "md") {
        let mut code = false;
        for (i, line) in std::fs::read_to_string(&path).unwrap().lines().enumerate() {
            code ^= line.trim_start().starts_with("```");
            if !code && !line.trim_start().starts_with('|') && line.chars().count() > WIDEST {
                wide.push(format!("{}:{}", path.display(), i + 1));
            }
        }
    }
    assert!(wide.is_empty(), "wider than {WIDEST} columns: {wide:#?}");
}

#[test]
fn prop_rooms_import_what_the_architecture_says() {
    let text = std::fs::read_to_string(root().join("docs/architecture.md")).unwrap();
    let picture = text.split("## Imports").nth(1).unwrap().split("```").nth(1).unwrap();
    let mut above: Vec<&str> = Vec::new();
    for line in picture.lines().filter(|l| !l.trim().is_empty()) {
        let room = line.split_whitespace().next().unwrap();
        // The last column begins after two or more blanks.
        let said = line.rsplit("  ").next().unwrap().trim();
        let said: BTreeSet<&str> = match said {
            "knows nobody" => BTreeSet::new(),
            "all above" => above.iter().copied().collect(),
            list => list.split(", ").collect(),
        };
        let rooms: BTreeSet<&str> = above.iter().copied().chain(["demo"]).collect();
        let manifest = if room == "src" { root().join("Cargo.toml") } else { root().join(room).join("Cargo.toml") };
        let manifest = std::fs::read_to_string(manifest).unwrap();
        let dependencies = manifest.split("\n[dependencies]\n").nth(1).unwrap().split("\n[").next().unwrap();
        let found: BTreeSet<&str> = dependencies.lines().filter_map(|l| l.strip_suffix(".workspace = true")).collect();
        let of_house: BTreeSet<&str> = found.intersection(&rooms).copied().collect();
        let unsaid: Vec<_> = of_house.difference(&said).collect();
        // What the binary passes on of the model's words is no import worth a line.
        let passed_on = |name: &&&&str| room != "src" || !["cabin", "solve"].contains(**name);
        let unsaid: Vec<_> = unsaid.iter().filter(|n| passed_on(n)).collect();
        assert!(unsaid.is_empty(), "{room} imports {unsaid:?}, which docs/architecture.md does not say");
        assert!(said.iter().all(|s| rooms.contains(s)), "{room} is said to import {said:?}: not all stand above it");
        above.push(room);
    }
    assert!(above.len() >= 10, "{above:?}");
}

#[test]
fn prop_the_wheel_has_the_dependencies_of_the_program() {
    let versions = |lock: &str| -> BTreeSet<(String, String)> {
        let text = std::fs::read_to_string(root().join(lock)).unwrap();
        let packages = text.split("[[package]]").skip(1).map(|package| {
            let of =
                |key: &str| package.lines().find_map(|l| l.strip_prefix(key)).unwrap().trim_matches('"').to_owned();
            (of("name = "), of("version = "))
        });
        packages.collect()
    };
    let (program, wheel) = (versions("Cargo.lock"), versions("python/Cargo.lock"));
    let of = |all: &BTreeSet<(String, String)>, name: &str| -> BTreeSet<String> {
        all.iter().filter(|(other, _)| other == name).map(|(_, version)| version.clone()).collect()
    };
    let names: BTreeSet<&String> = program.iter().map(|(name, _)| name).collect();
    // Arrow and PyO3 may bring further versions of what the program has.
    let other: Vec<_> = names
        .into_iter()
        .filter(|name| !of(&wheel, name).is_empty() && of(&wheel, name).is_disjoint(&of(&program, name)))
        .collect();
    assert!(other.is_empty(), "python/Cargo.lock has other versions of {other:?}");
}

#[test]
fn prop_every_file_that_the_documents_name_is_there() {
    let mut missing = Vec::new();
    let places =
        ["cabin/", "shading/", "ingest/", "solve/", "simulate/", "store/", "study/", "report/", "export/", "pipeline/"];
    let others = ["sensitivity/", "src/", "tests/", "testing/", "docs/", "migrations/"];
    let places: Vec<&str> = places.into_iter().chain(others).collect();
    for path in files(root(), "md") {
        if path.starts_with(root().join("benches")) {
            continue;
        }
        let text = std::fs::read_to_string(&path).unwrap();
        for name in text.split('`').skip(1).step_by(2) {
            let whole = places.iter().any(|p| name.starts_with(p)) && !name.contains([' ', '*', '…']);
            if whole && !root().join(name).exists() {
                missing.push(format!("{}: {name}", path.display()));
            }
        }
    }
    assert!(missing.is_empty(), "{missing:#?}");
}
