//! What differs between two databases or runs, in words or as CSV on stdout.

use anyhow::{Context, anyhow};
use pipeline::{AverageChange, Comparison};
use std::path::{Path, PathBuf};

use crate::args::{CompareArgs, CompareFormat, StudyArgs};
use crate::console::say;
use crate::failure::{Ending, Failure};
use crate::open;

/// How every SQLite database begins.
const SQLITE: &[u8] = b"SQLite format 3\0";

pub fn compare(typed: &CompareArgs) -> Result<Ending, Failure> {
    let one = database(&typed.one)?;
    let comparison = match (&typed.other, typed.runs.as_slice()) {
        (Some(other), _) => pipeline::compare(&one, &database(other)?)?,
        (None, [first, second]) => pipeline::compare_runs(&one, [*first, *second])?,
        (None, _) => return Err(Failure::Usage(anyhow!("name two databases, or one and --runs FIRST SECOND"))),
    };
    match typed.format {
        CompareFormat::Text => text(&comparison)?,
        CompareFormat::Csv => csv(&comparison)?,
    }
    Ok(Ending::of(comparison.is_same()))
}

/// The database that a path stands for: itself, or that of a study.
fn database(path: &Path) -> Result<PathBuf, Failure> {
    let begins = |file: &mut std::fs::File| {
        let mut first = [0; SQLITE.len()];
        std::io::Read::read_exact(file, &mut first).is_ok_and(|()| first == SQLITE)
    };
    if path.is_file() && std::fs::File::open(path).is_ok_and(|mut file| begins(&mut file)) {
        return Ok(path.to_owned());
    }
    if !path.exists() {
        let path = path.display();
        return Err(Failure::Usage(anyhow!("there is no {path}; name a database, a study file or the folder of one")));
    }
    Ok(open(&StudyArgs { study: Some(path.to_owned()), db: None })?.database)
}

fn or_none(value: Option<&str>) -> &str {
    value.unwrap_or("–")
}

fn text(c: &Comparison) -> Result<(), Failure> {
    say(format_args!("A: {}\nB: {}", c.sides[0], c.sides[1]))?;
    if c.changes.is_empty() {
        say(format_args!("settings and inputs are the same"))?;
    }
    for (run, change) in &c.changes {
        let run = run.map_or_else(String::new, |run| format!("run {run}, "));
        let (before, after) = (short(change.before.as_deref()), short(change.after.as_deref()));
        say(format_args!("{run}{} {}: {before} → {after}", change.kind.name(), change.name))?;
    }
    if let Some(s) = &c.samples {
        say(format_args!(
            "samples: {} the same, {} with other disturbances, {} only in A, {} only in B",
            s.same, s.other, s.alone[0], s.alone[1]
        ))?;
        for line in &s.first {
            say(format_args!("  {line}"))?;
        }
    }
    if c.averages.is_empty() {
        return say(format_args!("there are no annual averages"));
    }
    say(format_args!("{:<14} {:>14} {:>12} {:>12} {:>11} {:>8}", "design", "PMV", "A W", "B W", "change W", "%"))?;
    for a in &c.averages {
        let range = format!("{} … {}", a.window.pmv_min(), a.window.pmv_max());
        let watts = |value: Option<f64>| value.map_or_else(|| "–".to_owned(), |w| format!("{w:.2}"));
        say(format_args!(
            "{:<14} {range:>14} {:>12} {:>12} {:>11} {:>8}",
            a.design,
            watts(a.hvac_power_w[0]),
            watts(a.hvac_power_w[1]),
            a.change_w().map_or_else(|| "–".to_owned(), |w| format!("{w:+.2}")),
            percent(a)
        ))?;
    }
    Ok(())
}

fn percent(a: &AverageChange) -> String {
    match (a.change_w(), a.hvac_power_w[0]) {
        (Some(change_w), Some(before_w)) if before_w > 0.0 => format!("{:+.2}", 100.0 * change_w / before_w),
        _ => "–".to_owned(),
    }
}

/// A hash by its beginning.
fn short(value: Option<&str>) -> String {
    match value {
        Some(hash) if hash.len() >= 64 && hash[..64].bytes().all(|b| b.is_ascii_hexdigit()) => {
            format!("{}…{}", &hash[..12], &hash[64..])
        }
        other => or_none(other).to_owned(),
    }
}

/// A row for each difference, and for each average.
fn csv(c: &Comparison) -> Result<(), Failure> {
    let text = rows(c).context("cannot write CSV").map_err(Failure::Inputs)?;
    say(format_args!("{}", String::from_utf8_lossy(&text).trim_end()))
}

fn rows(c: &Comparison) -> anyhow::Result<Vec<u8>> {
    let mut csv = csv::Writer::from_writer(Vec::new());
    csv.write_record(["kind", "run_id", "name", "pmv_min", "pmv_max", "a", "b", "change"])?;
    for (run, change) in &c.changes {
        let run = run.map_or_else(String::new, |run| run.to_string());
        let value = |value: &Option<String>| value.clone().unwrap_or_default();
        let (before, after) = (value(&change.before), value(&change.after));
        csv.write_record([change.kind.name(), &run, &change.name, "", "", &before, &after, ""])?;
    }
    if let Some(s) = &c.samples {
        let [a, b] = s.alone.map(|alone| (s.same + s.other + alone).to_string());
        let change = (s.other + s.alone[0] + s.alone[1]).to_string();
        csv.write_record(["samples", "", "samples", "", "", &a, &b, &change])?;
    }
    for a in &c.averages {
        let watts = |value: Option<f64>| value.map_or_else(String::new, |w| w.to_string());
        let [low, high] = [a.window.pmv_min(), a.window.pmv_max()].map(|limit| limit.to_string());
        let [one, other] = a.hvac_power_w.map(watts);
        csv.write_record(["hvac_power_w", "", &a.design, &low, &high, &one, &other, &watts(a.change_w())])?;
    }
    Ok(csv.into_inner()?)
}
