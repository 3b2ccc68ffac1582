//! The report as Markdown.

use minijinja::syntax::SyntaxConfig;
use minijinja::value::Value;
use minijinja::{AutoEscape, Environment, Error, Output, State, context};
use std::fmt::Write as _;

use crate::headline::{answer, shown_window};
use crate::numbers::{month, percent, watts, window};
use crate::{PaperFinding, ReportError, StudyReport, simulation};

const TEMPLATE: &str = include_str!("../templates/report.md");
/// Findings that the report lists one by one; all of them are in data_quality.csv.
const LISTED: usize = 40;

pub(crate) fn render(study: &StudyReport, findings: &[PaperFinding]) -> Result<String, ReportError> {
    let mut environment = Environment::new();
    let mut syntax = SyntaxConfig::builder();
    syntax.trim_blocks(true).lstrip_blocks(true).keep_trailing_newline(true);
    environment.set_syntax(syntax.build()?);
    environment.set_auto_escape_callback(|_| AutoEscape::None);
    environment.set_formatter(escape);
    environment.add_template("report.md", TEMPLATE)?;
    Ok(environment.get_template("report.md")?.render(content(study, findings))?)
}

fn content(study: &StudyReport, findings: &[PaperFinding]) -> Value {
    let windows = study.windows();
    let shown = shown_window(study);
    let names: Vec<&str> = study.designs.iter().map(|d| d.name.as_str()).collect();
    let by_design = |cell: &dyn Fn(&str) -> String| names.iter().map(|n| cell(n)).collect::<Vec<_>>();

    let power: Vec<Value> = windows
        .iter()
        .map(|&w| context! { window => window(w), cells => by_design(&|d| watts(study.annual_power_w(d, w))) })
        .collect();
    let has_reference = names.contains(&"ptc");
    let reduction: Vec<Value> = windows
        .iter()
        .map(|&w| {
            let cell = |d: &str| percent(study.annual_row(d, w).and_then(|r| r.reduction_vs_ptc));
            context! { window => window(w), cells => by_design(&cell) }
        })
        .collect();
    let parts: Vec<Value> = shown
        .map(|w| {
            let rows = names.iter().filter_map(|d| study.annual_row(d, w));
            rows.map(|r| {
                context! {
                    design => &r.design, heating => watts(r.heating_power_w), cooling => watts(r.cooling_power_w),
                    total => watts(r.hvac_power_w),
                }
            })
            .collect()
        })
        .unwrap_or_default();
    let monthly: Vec<Value> = study
        .months
        .iter()
        .map(|m| {
            let power = |design: &str| {
                let of = |r: &&store::MonthlyRow| {
                    r.design == design && r.month == m.month && Some((r.pmv_min, r.pmv_max)) == shown
                };
                watts(study.monthly.iter().find(of).and_then(|r| r.hvac_power_w))
            };
            context! {
                month => month(m.month), samples => m.sample_count.to_string(),
                weight => format!("{:.3e}", m.sample_weight), cells => by_design(&power),
            }
        })
        .collect();
    let shares: Vec<Value> = study
        .limit_shares
        .iter()
        .filter(|s| Some((s.pmv_min, s.pmv_max)) == shown && s.solved_count > 0)
        .map(|s| {
            let share = |n: u64| percent(Some(n as f64 / s.solved_count as f64));
            context! {
                design => &s.design, lower => share(s.lower_count), upper => share(s.upper_count),
                heating => share(s.heating_count), cooling => share(s.cooling_count),
                lower_weight => percent(Some(s.lower_weight)), cooling_weight => percent(Some(s.cooling_weight)),
                outside => share(s.outside_range_count),
            }
        })
        .collect();
    let kinds = ["mission", "weather", "shadow"].map(|kind| {
        let of = || study.files.iter().filter(|f| f.kind == kind);
        let used = || of().filter(|f| f.accepted);
        context! {
            kind => kind, used => used().count().to_string(), refused => of().filter(|f| !f.accepted).count().to_string(),
            rows => used().map(|f| f.rows).sum::<u64>().to_string(),
            bytes => used().map(|f| f.bytes).sum::<u64>().to_string(),
            first => used().filter_map(|f| f.first_utc.as_deref()).min().unwrap_or("–"),
            last => used().filter_map(|f| f.last_utc.as_deref()).max().unwrap_or("–"),
        }
    });
    let quality: Vec<Value> = study
        .findings
        .iter()
        .take(LISTED)
        .map(|f| {
            let place = |mut text: String| {
                if let Some(line) = f.finding.line {
                    let _ = write!(text, ", line {line}");
                }
                if let Some(column) = &f.finding.column {
                    let _ = write!(text, ", column {column}");
                }
                text
            };
            context! {
                place => place(f.path.clone()), kind => &f.finding.kind, count => f.finding.count.to_string(),
                message => &f.finding.message,
            }
        })
        .collect();
    let points = study.status.solved + study.status.infeasible + study.status.not_converged;
    let missing = study.missing_months();
    let (simulated_design, classes) = simulation::class_rows(study);
    context! {
        name => &study.name, note => &study.note, version => &study.program_version,
        study_hash => &study.study_hash, input_hash => &study.input_hash,
        answer => answer(study), designs => by_design(&str::to_owned), shown => shown.map(window),
        missing => missing.iter().map(|m| month(*m)).collect::<Vec<_>>().join(", "), missing_count => missing.len(),
        refused => study.files.iter().filter(|f| !f.accepted).count(),
        samples => study.months.iter().map(|m| m.sample_count).sum::<u64>(), points,
        solved => study.status.solved, infeasible => study.status.infeasible, lost => study.status.not_converged,
        unequal => windows.iter().filter(|w| w.0 != -w.1).count(),
        simulated => simulation::annual_rows(study), simulated_design, classes,
        mission_figures => study.mission_figures.len() == 2,
        power, reduction, has_reference, parts, monthly, shares, kinds, quality,
        more_findings => study.findings.len().saturating_sub(LISTED),
        paper => findings.iter().map(|f| context! {
            claim => f.claim, paper => f.paper, ours => &f.ours, verdict => f.verdict.word(),
        }).collect::<Vec<_>>(),
        exclusions => study.exclusions.iter().map(|e| context! {
            reason => &e.reason, count => e.count.to_string(),
        }).collect::<Vec<_>>(),
        equipment => study.designs.iter().map(|d| context! {
            name => &d.name, heating => &d.heating, heating_cop => &d.heating_cop, cooling_cop => &d.cooling_cop,
            heaters => yes(d.radiant_heaters), curtain => yes(d.air_curtain),
        }).collect::<Vec<_>>(),
        assumptions => study.assumptions.iter().map(|a| context! {
            what => &a.what, value => &a.value, source => &a.source, substitute => yes(a.substitute),
        }).collect::<Vec<_>>(),
    }
}

fn yes(is: bool) -> &'static str {
    if is { "yes" } else { "no" }
}

/// Text from outside must not break a table or the page.
fn escape(out: &mut Output, state: &mut State, value: &Value) -> Result<(), Error> {
    let Some(text) = value.as_str().filter(|_| !value.is_safe()) else {
        return minijinja::escape_formatter(out, state, value);
    };
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '|' | '*' | '`' | '[' | ']' | '\\' | '~' => escaped.extend(['\\', c]),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '&' => escaped.push_str("&amp;"),
            c if c.is_control() => escaped.push(' '),
            c => escaped.push(c),
        }
    }
    out.write_str(&escaped).map_err(Error::from)
}
