//! The report of a small made-up study.

#![expect(clippy::unwrap_used, reason = "a test ends where something is not as expected")]

use cabin::{ComfortWindow, Devices, Heating};
use ingest::{FileKind, FileRecord, Finding, FindingKind};
use report::{StudyReport, Verdict, headline, paper_findings, render};
use solve::Method;
use store::{AnnualRow, DesignRow, ExclusionCount, LimitShare, MonthRow, MonthlyRow, StatusCounts};
use study::assumptions::Assumption;

const LIMITS: [f64; 5] = [0.0, 0.5, 1.0, 1.5, 2.0];

/// Designs with their power at PMV 0, falling by a tenth per half a vote.
fn study(designs: &[(&str, f64)]) -> StudyReport {
    let mut report = StudyReport {
        name: "made up".to_owned(),
        program_version: "0.1.0".to_owned(),
        study_hash: "s".repeat(64),
        input_hash: "i".repeat(64),
        months: (1..=12).map(|month| MonthRow { month, sample_count: 10, sample_weight: 1.0 / 120.0 }).collect(),
        status: StatusCounts { solved: 600, infeasible: 0, not_converged: 0 },
        ..StudyReport::default()
    };
    for &(name, neutral_w) in designs {
        report.designs.push(DesignRow {
            name: name.to_owned(),
            heating: if name.starts_with("ptc") { Heating::Ptc } else { Heating::HeatPump },
            heating_cop: "vecto-continuous".to_owned(),
            cooling_cop: "linear".to_owned(),
            devices: Devices { radiant_heaters: name.ends_with("+rh"), air_curtain: name.ends_with("+curtain") },
            method: Method::Fast,
            design_key: String::new(),
        });
        for limit in LIMITS {
            let window = ComfortWindow::symmetric(limit).unwrap();
            let power = |neutral: f64| neutral * (1.0 - 0.2 * limit);
            let reference = designs.iter().find(|d| d.0 == "ptc").map(|d| power(d.1));
            report.annual.push(AnnualRow {
                design: name.to_owned(),
                window,
                hvac_power_w: Some(power(neutral_w)),
                heating_power_w: Some(0.8 * power(neutral_w)),
                cooling_power_w: Some(0.2 * power(neutral_w)),
                sample_count: 120,
                unsolved_count: 0,
                unsolved_weight: 0.0,
                reduction_vs_ptc: reference.map(|r| 1.0 - power(neutral_w) / r),
            });
            report.limit_shares.push(LimitShare {
                design: name.to_owned(),
                window,
                solved_count: 120,
                lower_count: 56,
                upper_count: 20,
                heating_count: 57,
                cooling_count: 21,
                lower_weight: 0.48,
                cooling_weight: 0.17,
                outside_range_count: 3,
            });
            report.monthly.extend((1..=12).map(|month| MonthlyRow {
                design: name.to_owned(),
                window,
                month,
                hvac_power_w: Some(power(neutral_w) + f64::from(month)),
                sample_count: 10,
            }));
        }
    }
    report
}

fn five() -> StudyReport {
    study(&[("ptc", 7200.0), ("ptc+rh", 6770.0), ("hp", 3200.0), ("hp+rh", 3200.0), ("hp+curtain", 2700.0)])
}

fn file(study: &StudyReport, name: &str) -> String {
    let files = render(study).unwrap();
    assert!(files.iter().all(|file| report::FILES.contains(&file.name.as_str())));
    String::from_utf8(files.into_iter().find(|f| f.name == name).unwrap().bytes).unwrap()
}

#[test]
fn prop_the_same_study_gives_the_same_bytes() {
    for (first, again) in render(&five()).unwrap().iter().zip(&render(&five()).unwrap()) {
        assert!(first == again, "{} differs", first.name);
    }
}

#[test]
fn prop_the_report_answers_the_question_first() {
    let text = file(&five(), "report.md");
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines[0], "# made up");
    let answer = "Within PMV ±1, hp+curtain is the cheapest design: 2160 W in the mean over the hours in service, months \
                  weighted by their days; 62.5 % less than ptc. Comfort within PMV ±0.5 takes 12.5 % more.";
    assert_eq!(headline(&five())[0], answer);
    let page = "**A heat pump with air curtains at the doors needs the least electricity.** To keep the passengers comfortable it \
                draws 2.16 kilowatt-hours (kWh) for every hour in service. That is 62.5 % less than electric resistance heating, \
                which draws 5.76 kWh.";
    assert!(text.contains(page), "{text}");
    assert!(text.contains("| ±0.5 | 6480 | 6093 | 2880 | 2880 | 2430 |"), "{text}");
    assert!(text.contains("| ±1 | 0.0 % | 6.0 % | 55.6 % | 55.6 % | 62.5 % |"), "{text}");
    // No table is torn apart: a line of a table has a neighbour in the table.
    for (i, line) in lines.iter().enumerate().filter(|(_, l)| l.starts_with('|')) {
        assert!(lines[i - 1].starts_with('|') || lines[i + 1].starts_with('|'), "line {}: {line}", i + 1);
        assert_eq!(lines[i + 1].starts_with("|-"), !lines[i - 1].starts_with('|'), "line {}: {line}", i + 1);
    }
    assert!(!text.contains("\n\n\n"), "{text}");
}

#[test]
fn prop_missing_months_are_named_with_every_weighted_table() {
    let mut study = five();
    let whole = file(&study, "report.md");
    assert!(!whole.contains("Months"), "{whole}");
    study.months.retain(|m| m.month != 2 && m.month != 11);
    let text = file(&study, "report.md");
    let weighted = ["## Annual", "## Reduction", "## Limits", "## The paper", "## Monthly"];
    for heading in weighted {
        let section = text[text.find(heading).unwrap()..].split("\n## ").next().unwrap();
        assert!(section.contains("Months without samples: February, November."), "{section}");
    }
    assert!(file(&study, "annual_average.csv").lines().nth(1).unwrap().ends_with(",2 11"));
}

#[test]
fn prop_findings_compare_with_the_paper_in_whole_percent() {
    let verdicts = |designs: &[(&str, f64)]| {
        let findings = paper_findings(&study(designs));
        findings.iter().map(|f| f.verdict).collect::<Vec<_>>()
    };
    use Verdict::{NotCovered, Outside, Within};
    let good = [("ptc", 7200.0), ("ptc+rh", 6770.0), ("hp", 3200.0), ("hp+rh", 3200.0), ("hp+curtain", 2700.0)];
    assert_eq!(verdicts(&good), [Within; 6]);
    let mut bad = good;
    bad[1].1 = 6600.0;
    bad[2].1 = 3800.0;
    assert_eq!(verdicts(&bad), [Outside, Outside, Outside, Outside, Within, Within]);
    let few = [("hp", 3200.0)];
    let none = NotCovered;
    assert_eq!(verdicts(&few), [none, none, none, none, Within, Within]);
    // The paper speaks of whole years.
    let mut months = study(&good);
    months.months.pop();
    assert!(paper_findings(&months).iter().all(|f| f.verdict == NotCovered && f.ours != "–"));
}

#[test]
fn prop_text_from_outside_breaks_neither_tables_nor_spreadsheets() {
    let mut study = study(&[("a|b\n<script>", 1000.0), ("=cmd()", 900.0)]);
    study.note = Some("a note with <b>".to_owned());
    let record = |path: &str, accepted, findings| FileRecord {
        path: path.to_owned(),
        kind: FileKind::Mission,
        blake3: "0".repeat(64),
        bytes: 1,
        rows: 1,
        first: None,
        last: None,
        stamp: None,
        accepted,
        findings,
    };
    let finding = Finding {
        kind: FindingKind::Empty,
        count: 1,
        line: Some(1),
        column: Some("-c".to_owned()),
        message: "line\nbreak | *bar*".to_owned(),
    };
    study.files.push(record("=HYPERLINK(\"x\"),|.csv", false, Vec::new()));
    study.files.push(record("@x|y", true, vec![finding]));
    study.exclusions.push(ExclusionCount { reason: "a | b".to_owned(), count: 2 });
    study.assumptions.push(Assumption {
        what: "COP".to_owned(),
        value: "1|2".to_owned(),
        source: "x".to_owned(),
        substitute: true,
    });
    let text = file(&study, "report.md");
    assert!(!text.contains("<script>") && !text.contains("<b>"), "{text}");
    let page = file(&study, "report.html");
    assert_eq!((page.matches("<script").count(), page.matches("</script").count()), (1, 1), "the page's own");
    assert!(!page.contains("<b>") && page.contains("a note with &lt;b&gt;"));
    for line in text.lines().filter(|l| l.starts_with("| @x")) {
        assert_eq!(line, r"| @x\|y, line 1, column -c | empty | 1 | line break \| \*bar\* |");
    }
    let columns = |line: &str| line.replace(r"\|", "").matches('|').count();
    let design_rows: Vec<&str> = text.lines().filter(|l| l.starts_with("| ±") || l.starts_with("| 0 ")).collect();
    assert!(design_rows.len() >= 5 && design_rows.iter().all(|l| columns(l) == 4), "{design_rows:?}");

    for (table, cell) in [("sources.csv", "'=HYPERLINK(\"x\"),|.csv"), ("data_quality.csv", "'@x|y")] {
        let csv = file(&study, table);
        let row = csv::Reader::from_reader(csv.as_bytes()).records().next().unwrap().unwrap();
        assert_eq!(&row[0], cell);
    }
    roxmltree::Document::parse(&file(&study, "pareto.svg")).unwrap();
}

#[test]
fn prop_tables_keep_every_digit() {
    let study = five();
    let csv = file(&study, "annual_average.csv");
    let mut reader = csv::Reader::from_reader(csv.as_bytes());
    for (row, expected) in reader.records().zip(&study.annual) {
        let row = row.unwrap();
        assert_eq!(row[0], expected.design);
        assert_eq!(row[4].parse::<f64>().ok(), expected.hvac_power_w);
        assert_eq!(row[10].parse::<f64>().ok(), expected.reduction_vs_ptc);
    }
    assert_eq!(csv.lines().count(), 1 + 25);
    assert_eq!(file(&study, "monthly_average.csv").lines().count(), 1 + 25 * 12);
}

#[test]
fn prop_the_figure_is_xml_with_a_mark_for_every_point() {
    let text = file(&five(), "pareto.svg");
    let svg = roxmltree::Document::parse(&text).unwrap();
    assert!(svg.descendants().any(|n| n.has_tag_name("title")));
    assert!(!text.contains("<script"));
    for name in ["ptc+rh", "hp+curtain", "limit of |PMV|", "annual mean HVAC power in kW"] {
        assert!(svg.descendants().any(|n| n.text().is_some_and(|t| t.contains(name))), "{name}");
    }
    for colour in ["#d55e00", "#e69f00", "#0072b2", "#56b4e9", "#009e73"] {
        assert!(text.contains(colour), "{colour}");
    }
    // Lines on each other have one place for their names.
    assert!(text.contains(">hp, hp+rh<"), "{text}");
    assert!(render(&study(&[])).unwrap().iter().all(|file| file.name != "pareto.svg"));
}
