//! What came of a command, in words on stdout.

mod climates;
mod sensitivity;
mod shown;
mod status;

pub use climates::climates;
pub use sensitivity::sensitivities;
pub use shown::shown;
pub use status::{plan, status};

use anyhow::anyhow;
use cabin::{ComfortWindow, OperatingMode};
use pipeline::{Check, Done, Fetched, FetchedFile, ReportCheck, SetpointRow, Stage, Verification};
use solve::Method;
use std::path::Path;
use std::time::Duration;
use study::Study;

use crate::console::say;
use crate::failure::{Ending, Failure};

pub fn run(study: &Study, stages: &[Stage], done: &Done, elapsed: Duration) -> Result<Ending, Failure> {
    let summary = &done.summary;
    let pending = match summary.pending() {
        0 => String::new(),
        points => format!(", {points} pending: the averages are those of the last time that none was"),
    };
    say(format_args!(
        "{}: {} points, {} solved, {} without an optimum{pending}; {} files refused; {:.1} s",
        study.name,
        summary.counts.points,
        summary.counts.solved,
        summary.counts.failed,
        summary.refused.len(),
        elapsed.as_secs_f64()
    ))?;
    for line in &done.headline {
        say(format_args!("{line}"))?;
    }
    if stages.contains(&Stage::Report) {
        say(format_args!("report: {}", study.report_dir.join("report.html").display()))?;
    }
    match (stages, summary.pending()) {
        ([Stage::Report], 1..) => Ok(Ending::Pending),
        _ => Ok(Ending::of(summary.is_complete() && done.news.is_empty())),
    }
}

pub fn report_check(folder: &Path, check: &ReportCheck) -> Result<Ending, Failure> {
    for (name, difference) in &check.different {
        say(format_args!("{}: {}", folder.join(name).display(), difference.words()))?;
    }
    if let Some([then, now]) = &check.of_another {
        say(format_args!("the report is of: {then}"))?;
        say(format_args!("the database is: {now}"))?;
    }
    let (files, other) = (check.files, check.different.len());
    if other == 0 {
        say(format_args!("all {files} files of the report follow from the database"))?;
    } else {
        say(format_args!(
            "{other} files differ from the {files} that follow from the database; `busclimate report` writes them"
        ))?;
    }
    Ok(Ending::of(other == 0))
}

pub fn setpoints(folder: &Path, found: &[SetpointRow]) -> Result<(), Failure> {
    for SetpointRow { design, window, setpoints: of } in found {
        let range = format!("{design} within PMV {}", window_text(*window));
        for (mode, profile) in [("heating", &of.heating), ("cooling", &of.cooling)] {
            match profile {
                Ok(p) => say(format_args!(
                    "{range}, {mode}: {:.1} °C at {:.0} °C outside … {:.1} °C at {:.0} °C; covers {:.1} % of {} hours",
                    p.curve.at(p.curve.valid_c[0]),
                    p.curve.valid_c[0],
                    p.curve.at(p.curve.valid_c[1]),
                    p.curve.valid_c[1],
                    100.0 * p.coverage,
                    p.points
                ))?,
                Err(reason) => say(format_args!("{range}, {mode}: no profile; {reason}"))?,
            }
        }
        for curtain in &of.curtains {
            let mode = if curtain.mode == OperatingMode::Cooling { "cooling" } else { "heating" };
            let analytic = curtain.analytic_k.map_or_else(|| "never".to_owned(), |k| format!("{k:.1} K"));
            match &curtain.of_optima {
                Some(t) => say(format_args!(
                    "{range}, {mode}: air curtains above {:.1} K, wrong in {:.1} % of the hours; by the model {analytic}",
                    t.value,
                    100.0 * t.misclassified
                ))?,
                None => say(format_args!("{range}, {mode}: air curtains always or never; by the model {analytic}"))?,
            }
        }
        if let Some(t) = &of.heaters {
            let wrong = 100.0 * t.misclassified;
            say(format_args!(
                "{range}: radiant heaters below {:.1} °C, wrong in {wrong:.1} % of the hours",
                t.below_c
            ))?;
        }
    }
    say(format_args!("{} files in {}, and published.csv", 2 * found.len(), folder.display()))
}

/// `±1` for a symmetric window, `-0.5 … 0.7` for another.
fn window_text(window: ComfortWindow) -> String {
    let (low, high) = (window.pmv_min(), window.pmv_max());
    if window.is_symmetric() { format!("±{high}") } else { format!("{low} … {high}") }
}

pub fn check(study: &Study, check: &Check) -> Result<Ending, Failure> {
    let (designs, windows) = (study.grid.designs().len(), study.grid.windows().len());
    say(format_args!(
        "{}: {designs} designs × {windows} comfort windows = {} points a sample",
        study.name,
        study.grid.points()
    ))?;
    say(format_args!(
        "{} missions, {} rows, {} samples and {} points",
        check.missions, check.rows, check.samples, check.points
    ))?;
    say(format_args!(
        "simulated: {designs} designs × {} windows × {} ways to run the bus, at most {:.0} million seconds",
        study.simulated_windows.len(),
        check.replays,
        check.simulated_s / 1e6
    ))?;
    say(format_args!(
        "driven by causal controllers: {} designs × {} windows and published setpoints, at most {:.0} million seconds",
        study.control.designs.len(),
        study.control.windows.len(),
        check.driven_s / 1e6
    ))?;
    say(format_args!("about {:.0} s on two cores, {:.0} MB of database", check.seconds, check.database_bytes / 1e6))?;
    for (reason, count) in &check.excluded {
        say(format_args!("excluded: {count} segments: {reason}"))?;
    }
    for (what, records) in [("refused", &check.refused), ("note", &check.used)] {
        for record in records {
            for finding in &record.findings {
                let times = if finding.count > 1 { format!(" ({} times)", finding.count) } else { String::new() };
                say(format_args!("{what}: {}: {finding}{times}", record.path))?;
            }
        }
    }
    for error in &check.errors {
        say(format_args!("error: {error}"))?;
    }
    match check.errors.as_slice() {
        [] => Ok(Ending::of(check.refused.is_empty() && check.used.iter().all(|record| record.replaced().is_none()))),
        [_] => Err(Failure::Inputs(anyhow!("a run would end with this error"))),
        all => Err(Failure::Inputs(anyhow!("a run would end with these {} errors", all.len()))),
    }
}

/// What was fetched, or is to be.
pub fn fetched(files: &[FetchedFile]) -> Result<Ending, Failure> {
    let mut failed = Vec::new();
    for FetchedFile { source, outcome } in files {
        let to = source.to.display();
        let there = source.to.metadata().map(|m| m.len());
        match (outcome, there) {
            (Some(Ok(Fetched::New(bytes))), _) => say(format_args!("fetched: {to}, {bytes} bytes"))?,
            (Some(Ok(Fetched::Unchanged)), _) => say(format_args!("unchanged: {to}"))?,
            (None, Ok(bytes)) => say(format_args!("there: {to}, {bytes} bytes"))?,
            (Some(Err(error)), _) => failed.push(error.to_string()),
            (None, Err(_)) => failed.push(format!("{to} is missing; it comes from {}", source.url)),
        }
    }
    if files.is_empty() {
        return Err(Failure::Usage(anyhow!(
            "no addresses for this format of weather; name them as `weather` in [fetch]"
        )));
    }
    failed.iter().for_each(|line| tracing::error!("{line}"));
    match failed.len() {
        0 => Ok(Ending::Done),
        n => Err(Failure::Inputs(anyhow!("{n} of {} files are not there as they should be", files.len()))),
    }
}

pub fn verification(study: &str, verification: &Verification) -> Result<Ending, Failure> {
    let row = &verification.row;
    let violations = verification.violations();
    say(format_args!(
        "{study}: {} points solved again ({} of the points, seed {}), {violations} violations",
        row.points, row.fraction, row.seed
    ))?;
    say(format_args!(
        "{:<44} {:>9} {:>10} {:>12} {:<6} {}",
        "check", "checked", "violations", "largest", "", "tolerance"
    ))?;
    for c in &row.checks {
        say(format_args!(
            "{:<44} {:>9} {:>10} {:>12.2e} {:<6} {}",
            c.name, c.checked, c.violations, c.largest, c.unit, c.tolerance
        ))?;
    }
    if let Some(a) = verification.approximation {
        let what = match verification.method {
            Method::Fast | Method::Nlp => "the smooth door law",
            Method::NlpSurrogate => "the smooth door law and the surrogate of the vote",
        };
        say(format_args!(
            "effect of {what} on {} points: mean {:+.3} W, largest {:.3} W",
            a.points, a.mean_w, a.largest_w
        ))?;
    }
    for c in row.checks.iter().filter(|c| c.violations > 0) {
        say(format_args!("violated: {}: {}", c.name, c.first_violation.as_deref().unwrap_or("–")))?;
    }
    Ok(Ending::of(violations == 0))
}
