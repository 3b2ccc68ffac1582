//! What the paper finds, beside what this study finds.

use super::{value, weights_note};
use crate::StudyReport;
use crate::document::{Block, DataTable, Section, Span, Table};
use crate::numbers::signed;

/// Whether a study agrees with the paper.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// Within the paper's range, in the paper's rounding.
    Within,
    /// Outside of it.
    Outside,
    /// The study lacks the designs, windows or months for it.
    NotCovered,
}

impl Verdict {
    /// The word in tables.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Within => "within",
            Self::Outside => "outside",
            Self::NotCovered => "not covered",
        }
    }
}

/// One finding, side by side.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PaperFinding {
    /// What is compared.
    pub claim: &'static str,
    /// What the paper says.
    pub paper: &'static str,
    /// What this study says.
    pub ours: String,
    /// Whether they agree.
    pub verdict: Verdict,
}

pub(super) fn section(study: &StudyReport) -> Section {
    let findings = paper_findings(study);
    let row =
        |f: &PaperFinding| vec![f.claim.to_owned(), f.paper.to_owned(), f.ours.clone(), f.verdict.word().to_owned()];
    let count = |verdict| findings.iter().filter(|f| f.verdict == verdict).count();
    let rows = findings.iter().map(row).collect();
    let data = DataTable::of(
        "paper_comparison.csv",
        &findings,
        &[
            ("finding", &|f| f.claim.to_owned()),
            ("paper", &|f| f.paper.to_owned()),
            ("this_study", &|f| f.ours.clone()),
            ("verdict", &|f| f.verdict.word().to_owned()),
        ],
    );
    Section { tables: vec![data], ..Section::new("The paper's findings beside this study") }
        .asking("Does this study find what the paper found whose method it follows?")
        .with(Block::Paragraph(vec![Span::Text(
            "Widmer, van Dooren, Onder, Control Engineering Practice 2025, 106158; 7399 hourly samples of one bus in Zürich, 2019–2022.\n\
             A range is within where both its ends are, as whole percents like those that the paper prints; \"almost 50 %\" is taken as 45 … 50 %.\n\
             A study without every month of the year covers none of them.",
        )]))
        .with(Block::Table(Table::new("paper_comparison.csv", &["finding", "paper", "this study", "verdict"], &[], rows)))
        .with(weights_note(study))
        .with(Block::Means(value(format!(
            "{} of {} findings hold here, {} lie outside their range, {} are not covered by this study.",
            count(Verdict::Within),
            findings.len(),
            count(Verdict::Outside),
            count(Verdict::NotCovered)
        ))))
        .with(Block::limits(
            "The paper's telemetry, coefficients of performance and shade are not public: what lies outside is not by itself an error of\n\
             either.",
        ))
}

/// The findings of the paper's section "Case Study 1". Percentages are compared as whole ones, as the paper prints them; "almost
/// 50 %" is taken as 45 … 50. A study that lacks a month of the year covers none of them.
#[must_use]
pub fn paper_findings(study: &StudyReport) -> Vec<PaperFinding> {
    vec![
        change(study, "radiant heaters with PTC heating", "−5 … −7 %", ("ptc", "ptc+rh"), -7.0..=-5.0),
        change(study, "heat pump instead of PTC", "−50 … −60 %", ("ptc", "hp"), -60.0..=-50.0),
        change(study, "air curtain with heat pump, further", "−10 … −20 %", ("hp", "hp+curtain"), -20.0..=-10.0),
        change(study, "radiant heaters with heat pump", "nothing", ("hp", "hp+rh"), -0.5..=0.5),
        share(study, "lower limit active at PMV ±1", "almost 50 %", |s| s.lower_count, 45.0..=50.0),
        share(study, "cooling at PMV ±1", "less than 20 %", |s| s.cooling_count, 0.0..=20.0),
    ]
}

/// Relative change of the annual power from one design to another, over all windows.
fn change(
    study: &StudyReport,
    claim: &'static str,
    paper: &'static str,
    (from, to): (&str, &str),
    range_percent: std::ops::RangeInclusive<f64>,
) -> PaperFinding {
    let changes: Vec<f64> = study
        .windows()
        .into_iter()
        .filter_map(|w| Some((study.annual_power_w(from, w)?, study.annual_power_w(to, w)?)))
        .filter(|(from_w, _)| *from_w > 0.0)
        .map(|(from_w, to_w)| 100.0 * (to_w / from_w - 1.0))
        .collect();
    if changes.is_empty() {
        return not_covered(claim, paper);
    }
    let least = changes.iter().copied().fold(f64::INFINITY, f64::min);
    let most = changes.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let agrees = [least, most].iter().all(|c| range_percent.contains(&c.round()));
    PaperFinding {
        claim,
        paper,
        ours: format!("{} … {} % over all windows", signed(most, 1), signed(least, 1)),
        verdict: verdict(study, agrees),
    }
}

/// The paper speaks of whole years.
fn verdict(study: &StudyReport, agrees: bool) -> Verdict {
    match (study.missing_months().is_empty(), agrees) {
        (false, _) => Verdict::NotCovered,
        (true, true) => Verdict::Within,
        (true, false) => Verdict::Outside,
    }
}

/// Share of the samples of the best equipped heat pump bus at PMV ±1.
fn share(
    study: &StudyReport,
    claim: &'static str,
    paper: &'static str,
    count: impl Fn(&store::LimitShare) -> u64,
    range_percent: std::ops::RangeInclusive<f64>,
) -> PaperFinding {
    let at_one = || study.limit_shares.iter().filter(|s| s.window.is_plus_minus(1.0));
    let found = at_one().find(|s| s.design == "hp+curtain").or_else(|| at_one().next());
    let Some(row) = found.filter(|s| s.solved_count > 0) else { return not_covered(claim, paper) };
    let percent = 100.0 * count(row) as f64 / row.solved_count as f64;
    PaperFinding {
        claim,
        paper,
        ours: format!("{percent:.1} % of the samples of {}", row.design),
        verdict: verdict(study, range_percent.contains(&percent.round())),
    }
}

fn not_covered(claim: &'static str, paper: &'static str) -> PaperFinding {
    PaperFinding { claim, paper, ours: "–".to_owned(), verdict: Verdict::NotCovered }
}
