//! Words and questions: the documents are what the program says, and the answers are those of pandas from the raw rows.

#![expect(clippy::unwrap_used, reason = "a test ends where something is not as expected")]

use crate::common::Scratch;
use std::path::Path;
use testing::peer;

/// The part of a document that the program makes; what is written by hand stands before its first `## `.
fn made(document: &str) -> String {
    let text = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(document)).unwrap();
    let begin = text.find("\n## ").unwrap() + 1;
    text[begin..].to_owned()
}

#[test]
fn cli_the_documents_are_what_the_program_says() {
    let scratch = Scratch::empty();
    for (document, format) in [("docs/database.md", "markdown"), ("docs/questions.md", "questions")] {
        let said = scratch.expect(0, &["dictionary", "--format", format]).stdout;
        assert!(made(document) == said, "{document} differs from `busclimate dictionary --format {format}`");
    }
}

#[test]
fn xval_pandas_answers_to_questions_are_those_of_the_raw_rows() {
    let scratch = Scratch::demo(48);
    scratch.expect(0, &["run"]);
    let words = scratch.expect(0, &["dictionary", "--format", "json"]).stdout;
    scratch.write("words.json", words);
    let [database, words] = ["study.db", "words.json"].map(|name| scratch.path(name).to_string_lossy().into_owned());
    let needs = "duckdb, duckdb_extension_sqlite_scanner, pandas";
    let Some(lines) = peer("questions.py", needs, &[database, words]) else { return };
    assert_eq!(lines.len(), 2 * 22, "{lines:#?}");
    let wrong: Vec<&Vec<String>> = lines.iter().filter(|line| !line[3].is_empty() || line[2] == "0").collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn cli_datasette_has_titles_and_queries() {
    let scratch = Scratch::small(12, "[0.5, 1.0]", "[1.0]");
    scratch.expect(0, &["run"]);
    scratch.write("metadata.json", scratch.expect(0, &["dictionary", "--format", "datasette"]).stdout);
    let [database, metadata] =
        ["study.db", "metadata.json"].map(|name| scratch.path(name).to_string_lossy().into_owned());
    let Some(lines) = peer("datasette_pages.py", "datasette", &[database, metadata]) else { return };
    // Every question has an answer within Datasette's own limit of a second.
    assert_eq!(lines.iter().filter(|line| line[0] == "query").count(), 22, "{lines:#?}");
    let wrong: Vec<&Vec<String>> = lines.iter().filter(|line| line[2] != "ok").collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn cli_the_example_of_an_analysis_runs() {
    let scratch = Scratch::small(24, "[0.5, 1.0]", "[]");
    scratch.expect(0, &["run"]);
    let [database, folder] = ["study.db", "figures"].map(|name| scratch.path(name).to_string_lossy().into_owned());
    let script = "../../examples/02-analysis/analysis.py";
    let Some(lines) = peer(script, "matplotlib, pandas", &[database, folder]) else { return };
    assert!(lines.iter().any(|line| line[0].starts_with("Heat balance of the whole bus closes")), "{lines:?}");
    for figure in ["comfort.png", "temperature.png", "heat.png"] {
        assert!(scratch.path("figures").join(figure).metadata().unwrap().len() > 10_000, "{figure}");
    }
}
