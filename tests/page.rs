//! The report's page as a reader meets it: what page one says, whether its tables are those of the database, what a browser and
//! an accessibility checker find. Tests with a browser are skipped, with a line that says so, where Chromium, Node.js or the
//! packages of `tests/browser/` are absent.

#![expect(clippy::unwrap_used, reason = "a test ends where something is not as expected")]
#![expect(clippy::print_stdout, reason = "a test says why it was skipped")]

use crate::common::Scratch;
use roxmltree::{Document, Node, ParsingOptions};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The page as XML, which it is but for its script.
fn parsed(page: &str) -> String {
    let (before, rest) = page.split_once("<script>").unwrap();
    let (_, after) = rest.split_once("</script>").unwrap();
    format!("{before}{after}")
}

fn document(text: &str) -> Document<'_> {
    Document::parse_with_options(text, ParsingOptions { allow_dtd: true, ..ParsingOptions::default() }).unwrap()
}

fn text(node: Node<'_, '_>) -> String {
    let all: String = node.descendants().filter(Node::is_text).filter_map(|n| n.text()).collect();
    all.split_whitespace().collect::<Vec<_>>().join(" ")
}

fn of_class<'a, 'i>(document: &'a Document<'i>, class: &str) -> Node<'a, 'i> {
    document.descendants().find(|n| n.attribute("class") == Some(class)).unwrap()
}

/// The rows of a table, each with its cells.
fn rows(table: Node<'_, '_>) -> Vec<Vec<String>> {
    let rows = table.descendants().filter(|n| n.has_tag_name("tr"));
    rows.map(|row| row.children().filter(Node::is_element).map(text).collect()).collect()
}

/// The tables that show a file, in the order of the page.
fn tables_of<'a, 'i>(document: &'a Document<'i>, file: &str) -> Vec<Node<'a, 'i>> {
    let label = format!("Table: {file}");
    let shown = document.descendants().filter(|n| n.attribute("aria-label") == Some(&label));
    shown.map(|n| n.descendants().find(|t| t.has_tag_name("table")).unwrap()).collect()
}

/// The study that all of these tests look at.
fn studied() -> Scratch {
    let scratch = Scratch::small(48, "[0.5, 1.0, 2.0]", "[0.5, 1.0]");
    let run = scratch.run(&["run", "--quiet"]);
    assert!(run.status <= 1, "{}", run.stderr);
    scratch
}

#[test]
fn prop_the_page_needs_nothing_else() {
    let scratch = studied();
    let page = scratch.read("report/report.html");
    let xml = parsed(&page);
    let document = document(&xml);
    let mut ids: Vec<&str> = document.descendants().filter_map(|n| n.attribute("id")).collect();
    let count = ids.len();
    ids.sort_unstable();
    ids.dedup();
    assert_eq!(ids.len(), count, "every id is there once");
    for node in document.descendants().filter(Node::is_element) {
        for loads in ["src", "srcset", "data", "action", "poster", "background", "style", "onload", "onclick"] {
            assert!(node.attribute(loads).is_none(), "{loads} at {:?}", node.tag_name());
        }
        assert!(
            !["link", "img", "iframe", "object", "base"].contains(&node.tag_name().name()),
            "{:?}",
            node.tag_name()
        );
        if let Some(target) = node.attribute("href") {
            let is_there = match target.strip_prefix('#') {
                Some(id) => ids.contains(&id),
                None => scratch.path("report").join(target).is_file(),
            };
            assert!(is_there, "{target} leads nowhere");
        }
        if let Some(id) = node.attribute("aria-labelledby") {
            assert!(ids.contains(&id), "{id}");
        }
    }
    for loads in ["@import", "url(", "http:", "https:", "fetch(", "XMLHttpRequest", "import("] {
        assert!(!page.contains(loads), "{loads}");
    }
    assert!(page.contains("default-src 'none'; style-src 'sha256-"));
    // Every figure and table of data lies beside it, and is spoken of.
    let twin = scratch.read("report/report.md");
    for (name, _) in scratch.report().iter().filter(|(name, _)| name.ends_with(".svg")) {
        assert!(page.contains(&format!("href=\"{name}\"")) && twin.contains(&format!("({name})")), "{name}");
        let data = name.replace(".svg", "_values.csv");
        assert!(
            page.contains(&format!("href=\"{data}\"")) && scratch.read(&format!("report/{data}")).lines().count() > 1
        );
    }
    assert!(page.len() < 2_000_000, "{} bytes", page.len());
}

/// What a cell says, and half a unit of its last digit.
fn number(cell: &str) -> (f64, f64) {
    let first = cell.split(' ').next().unwrap().replace('−', "-");
    let value: f64 = first.parse().unwrap_or_else(|_| panic!("{cell:?} is no number"));
    let half = match first.split_once('.') {
        Some((_, decimals)) => 0.5 * 10_f64.powi(-(decimals.len() as i32)),
        // Zeros at the end may stand for digits that are left out.
        None => 0.5 * 10_f64.powi(first.chars().rev().take_while(|c| *c == '0').count() as i32),
    };
    (value, half * (1.0 + 1e-9))
}

#[test]
fn prop_tables_of_the_page_are_those_of_the_database() {
    let scratch = studied();
    let page = scratch.read("report/report.html");
    let xml = parsed(&page);
    let document = document(&xml);
    let of = |sql: String| scratch.query(&sql).into_iter().flatten().next().unwrap().parse::<f64>().unwrap();
    let limit = |window: &str| window.trim_start_matches('±').to_owned();

    let annual = tables_of(&document, "annual_average.csv");
    let by_window = annual.iter().map(|t| rows(*t)).find(|rows| rows[0][0] == "PMV").unwrap();
    let mut compared = 0;
    for row in &by_window[1..] {
        for (design, cell) in by_window[0].iter().zip(row).skip(1) {
            let window = limit(&row[0]);
            let sql =
                format!("SELECT hvac_power_w FROM annual_average WHERE design = '{design}' AND pmv_limit = {window}");
            let ((shown, half), stored) = (number(cell), of(sql));
            assert!((shown - stored).abs() <= half, "{design} ±{window}: {cell} for {stored}");
            compared += 1;
        }
    }
    assert_eq!(compared, 15);

    // Every month in every window that can be chosen.
    let names: Vec<String> = scratch.query("SELECT name FROM hvac_design").into_iter().flatten().collect();
    let options = document.descendants().filter(|n| n.attribute("data-option").is_some());
    let mut months = 0;
    for option in options {
        let window = limit(option.attribute("data-option").unwrap());
        let tables = option.descendants().filter(|n| n.has_tag_name("table")).map(rows);
        for table in tables.filter(|t| t[0][0] == "month" && t[0].contains(&"samples".to_owned())) {
            for row in &table[1..] {
                for (design, cell) in table[0].iter().zip(row).filter(|(d, _)| names.contains(d)) {
                    let month = row[0].parse::<chrono::Month>().unwrap().number_from_month();
                    let sql = format!(
                        "SELECT hvac_power_w FROM monthly_average WHERE design = '{design}' AND pmv_limit = {window} AND month = {month}"
                    );
                    assert_eq!(cell.parse::<f64>().unwrap(), of(sql).round(), "{design} ±{window} {month}");
                    months += 1;
                }
            }
        }
    }
    assert_eq!(months, 3 * 5 * 12);

    // The values under the pointer are those of the figure's file, and these those of the database.
    let figure = document.descendants().find(|n| n.attribute("href") == Some("pareto.svg")).unwrap();
    let figure = figure.ancestors().find(|n| n.has_tag_name("figure")).unwrap();
    let values = rows(figure.descendants().find(|n| n.has_tag_name("table")).unwrap());
    for row in &values[1..] {
        for (design, cell) in values[0].iter().zip(row).skip(1) {
            let sql = format!(
                "SELECT hvac_power_w / 1e3 FROM annual_average WHERE design = '{design}' AND pmv_limit = {}",
                row[0]
            );
            let ((shown, half), stored) = (number(cell), of(sql));
            assert!((shown - stored).abs() <= half, "{design} {}: {cell} for {stored}", row[0]);
        }
    }
    assert_eq!((values.len(), values[0].len()), (4, 6));
}

#[test]
fn prop_page_one_can_be_read_aloud() {
    let scratch = studied();
    let page = scratch.read("report/report.html");
    let xml = parsed(&page);
    let document = document(&xml);
    let front = of_class(&document, "front");
    let is_word = |n: &Node<'_, '_>| ["p", "li", "td", "th", "text", "figcaption", "h1"].contains(&n.tag_name().name());
    let no_files = |n: &Node<'_, '_>| n.ancestors().all(|a| a.attribute("class") != Some("file"));
    let pieces: Vec<String> = front.descendants().filter(|n| is_word(n) && no_files(n)).map(text).collect();
    let all = pieces.join("\n");
    let words: Vec<&str> =
        all.split(|c: char| c.is_whitespace() || "()“”,;:.".contains(c)).filter(|w| !w.is_empty()).collect();
    assert!(words.len() > 150, "{all}");

    // Names of this study, of units without words and of the trade need a glossary.
    let designs: Vec<String> = scratch.query("SELECT name FROM hvac_design").into_iter().flatten().collect();
    for word in &words {
        assert!(!designs.iter().any(|d| d == word), "{word} in {all}");
        assert!(!["W", "kW", "K", "COP", "HVAC", "PTC", "paper", "8760", "dataset"].contains(word), "{word} in {all}");
    }
    // An abbreviation is explained where it first stands.
    let explained = [
        ("kWh", "kilowatt-hours (kWh)"),
        ("PMV", "predicted mean vote (PMV)"),
        ("ISO", "international standard ISO 7730"),
    ];
    for word in words.iter().filter(|w| w.chars().filter(|c| c.is_uppercase()).count() > 1 || **w == "kWh") {
        let (name, words) =
            explained.iter().find(|(name, _)| name == word).unwrap_or_else(|| panic!("{word} in {all}"));
        let (first, told) = (all.find(name).unwrap(), all.find(words).unwrap_or_else(|| panic!("{words} in {all}")));
        assert!(told + words.find(name).unwrap() <= first, "{name} stands before its explanation: {all}");
    }
    // Nobody holds their breath for longer.
    for sentence in front.descendants().filter(|n| n.has_tag_name("p") && no_files(n)).map(text) {
        for sentence in sentence.split(". ") {
            assert!(sentence.split(' ').count() <= 45, "{sentence}");
        }
    }
    for must in [
        "A heat pump with air curtains at the doors needs the least electricity",
        "for every hour in service",
        "hours in the depot",
        "Comfort costs electricity",
        "% less",
    ] {
        assert!(all.contains(must), "{must} in {all}");
    }
    // Hashes are for the end.
    let hash = scratch.query("SELECT study_hash FROM run").into_iter().flatten().next().unwrap();
    let last = text(document.descendants().rfind(|n| n.has_tag_name("section")).unwrap());
    assert!(last.contains(&hash) && !all.contains(&hash));
}

#[test]
fn cli_a_report_can_be_checked_against_the_database() {
    let scratch = studied();
    let all = scratch.expect(0, &["report", "--check", "report"]);
    let files = scratch.report().len();
    assert_eq!(all.stdout.trim(), format!("all {files} files of the report follow from the database"));

    let copy = |name: &str, bytes: &[u8]| scratch.write(&format!("copy/{name}"), bytes);
    std::fs::create_dir(scratch.path("copy")).unwrap();
    scratch.report().iter().for_each(|(name, bytes)| copy(name, bytes));
    copy("notes.txt", b"mine");
    scratch.expect(0, &["report", "--check", "copy"]);
    copy("pareto.svg", b"<svg/>");
    copy("control_failures.csv", b"mission\n");
    std::fs::remove_file(scratch.path("copy/report.html")).unwrap();
    let run = scratch.expect(1, &["report", "--check", "copy"]);
    for line in [
        "copy/pareto.svg: is another one",
        "copy/report.html: is not there",
        "copy/control_failures.csv: is not part of the report any more",
    ] {
        assert!(run.stdout.contains(line), "{}", run.stdout);
    }
    assert!(
        run.stdout.contains(&format!("3 files differ from the {files} that follow from the database")),
        "{}",
        run.stdout
    );

    // Numbers that changed in the database, and a report that was made before.
    scratch.edit("study.toml", "[0.5, 1.0, 2.0]", "[0.5, 1.0, 1.5]");
    assert!(scratch.run(&["run", "--quiet"]).status <= 1);
    let before = scratch.report();
    std::fs::remove_file(scratch.path("copy/control_failures.csv")).unwrap();
    scratch.report().iter().for_each(|(name, bytes)| copy(name, bytes));
    scratch.expect(0, &["report", "--check", "copy"]);
    scratch.tamper("UPDATE annual_average SET hvac_power_w = hvac_power_w + 40 WHERE design = 'hp' AND pmv_limit = 1");
    let run = scratch.run(&["report", "--check", "copy"]);
    assert!(run.status != 0, "{}", run.stdout);
    assert_eq!(scratch.report(), before, "nothing is written");

    let run = scratch.expect(2, &["report", "--check", "nowhere"]);
    assert!(run.stderr.contains("nowhere is no folder with a report"), "{}", run.stderr);
}

/// The first of some programs that is on the PATH.
fn program(names: &[&str]) -> Option<PathBuf> {
    let folders: Vec<PathBuf> = std::env::split_paths(&std::env::var_os("PATH")?).collect();
    names.iter().flat_map(|name| folders.iter().map(move |folder| folder.join(name))).find(|path| path.is_file())
}

/// What the browser says of a page; `None`, which is said, where there is none.
fn browsed(page: &Path) -> Option<Value> {
    let here = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/browser");
    let packages = std::env::var_os("BUSCLIMATE_BROWSER").map_or_else(|| here.clone(), PathBuf::from);
    let (chromium, node) = (program(&["chromium", "chromium-browser", "google-chrome"]), program(&["node"]));
    let (Some(chromium), Some(node), true) = (chromium, node, packages.join("node_modules/axe-core").is_dir()) else {
        println!(
            "skipped: Chromium, Node.js or its packages are not here; npm ci in tests/browser, or set BUSCLIMATE_BROWSER"
        );
        return None;
    };
    let output = Command::new(node).arg(here.join("page.mjs")).args([&packages, &chromium]).arg(page).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    Some(serde_json::from_slice(&output.stdout).unwrap())
}

#[test]
fn cli_a_reader_can_choose_and_read_with_every_sense() {
    let scratch = studied();
    let Some(seen) = browsed(&scratch.path("report/report.html")) else { return };
    let none: [Value; 0] = [];
    assert_eq!(seen["errors"].as_array().unwrap()[..], none, "nothing goes wrong");
    assert_eq!(seen["requests"].as_array().unwrap()[..], none, "nothing is asked for");
    for view in seen["views"].as_array().unwrap() {
        assert_eq!(view["violations"].as_array().unwrap()[..], none, "{view}");
        assert_eq!(view["wider"], 0, "{view}");
    }
    assert_eq!(seen["views"].as_array().unwrap().len(), 4);

    // A design that is not chosen leaves figures and tables, and comes back.
    let chosen = &seen["chosen"];
    let count = |of: &Value| of.as_array().unwrap().len();
    assert_eq!(chosen["name"], "ptc");
    assert!(chosen["after"]["groups"].as_u64() < chosen["before"]["groups"].as_u64(), "{chosen}");
    assert_eq!(count(&chosen["after"]["columns"]) + 1, count(&chosen["before"]["columns"]));
    assert_eq!(count(&chosen["after"]["study"]) + 1, count(&chosen["before"]["study"]));
    assert_eq!((&chosen["alike"], &chosen["again"]), (&Value::Bool(true), &chosen["before"]));
    // A window is chosen everywhere at once.
    let window = &seen["window"];
    assert!(window["before"].as_array().unwrap().iter().all(|w| w == "±1"), "{window}");
    assert!(window["after"].as_array().unwrap().iter().all(|w| w == "±0.5") && window["changed"] == true, "{window}");
    // Values by keys and by pointer are those of the row that is marked.
    for by in ["keys", "pointer"] {
        let (said, row) = (seen[by]["readout"].as_str().unwrap(), seen[by]["row"].as_array().unwrap());
        assert_eq!(row.len(), 6, "{said}");
        assert!(row.iter().all(|cell| said.contains(cell.as_str().unwrap())), "{said}");
    }
    assert_eq!(seen["escaped"]["readout"], "");
    // Without script everything is there, and nothing that does not work.
    let figures = scratch.report().iter().filter(|(name, _)| name.ends_with(".svg")).count() as u64;
    assert_eq!(seen["plain"].as_u64(), Some(figures));
    assert!(seen["plain_tables"].as_u64() > Some(figures) && seen["plain_controls"] == 0);
    assert!(seen["bytes_of_script"].as_u64() < Some(8_000) && seen["pdf_pages"].as_u64() > Some(3));
}

/// All that a page says without its numbers, and all that makes it look and act.
fn without_numbers(page: &str) -> String {
    page.chars().filter(|c| !(c.is_ascii_digit() || ".−-+ \n".contains(*c))).collect()
}

#[test]
fn regress_the_page_in_docs_is_what_the_demo_gives() {
    let scratch = Scratch::empty();
    assert!(scratch.run(&["run"]).status <= 1);
    let now = scratch.read("busclimate-demo/report/report.html");
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/demo-report.html");
    let then = std::fs::read_to_string(docs).unwrap();
    // Numbers may differ in their last digits where a machine computes otherwise.
    assert!(
        without_numbers(&now) == without_numbers(&then),
        "docs/demo-report.html is to be busclimate-demo/report/report.html, and docs/demo-report.png a picture of it"
    );
}
