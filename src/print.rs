//! What came of a command, in words on stdout.

use anyhow::anyhow;
use cabin::{ComfortWindow, OperatingMode, celsius};
use pipeline::{
    Check, Done, Fetched, FetchedFile, Point, ReportCheck, SetpointRow, Shown, Stage, StagePlan, Status, Verification,
    write_whole,
};
use serde::Serialize;
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

/// What a run would do, stage by stage.
pub fn plan(plan: &[StagePlan]) -> Result<(), Failure> {
    for stage in plan {
        if stage.why.is_empty() {
            say(format_args!("{:<9} nothing to do", stage.stage))?;
            continue;
        }
        say(format_args!(
            "{:<9} {} {}, about {:.1} s",
            stage.stage,
            stage.to_compute,
            unit(stage.stage),
            stage.seconds
        ))?;
        for line in &stage.why {
            say(format_args!("          {line}"))?;
        }
    }
    say(format_args!("about {:.1} s in all", plan.iter().map(|stage| stage.seconds).sum::<f64>()))
}

/// What a stage counts.
fn unit(stage: &str) -> &'static str {
    match stage {
        "ingest" => "missions to read",
        "shade" => "segments to join",
        "solve" => "points to compute",
        "simulate" => "missions to simulate",
        "control" => "missions to drive by controllers",
        _ => "files to write",
    }
}

/// Status and plan as one JSON object.
#[derive(Serialize)]
struct StatusAndPlan<'a> {
    #[serde(flatten)]
    status: &'a Status,
    #[serde(skip_serializing_if = "Option::is_none")]
    plan: Option<&'a [StagePlan]>,
}

pub fn status(status: &Status, stages: Option<&[StagePlan]>, json: bool) -> Result<Ending, Failure> {
    let ending = if status.is_settled() { Ending::Done } else { Ending::Pending };
    if json {
        let both = StatusAndPlan { status, plan: stages };
        let text = serde_json::to_string(&both).map_err(|e| Failure::Inputs(e.into()))?;
        say(format_args!("{text}"))?;
        return Ok(ending);
    }
    say(format_args!("{} in {}", status.study, status.database))?;
    say(format_args!("{} samples, {} segments excluded", status.samples, status.excluded_segments))?;
    say(format_args!(
        "{} points: {} solved, {} infeasible, {} not converged, {} pending",
        status.points, status.solved, status.infeasible, status.not_converged, status.pending
    ))?;
    say(format_args!("{} missions simulated (mission × design × window)", status.simulated_missions))?;
    if status.unsimulated_missions > 0 {
        let count = status.unsimulated_missions;
        say(format_args!("{count} missions cannot be simulated; the view simulation_failure says why"))?;
    }
    say(format_args!("{} missions driven by causal controllers (mission × design)", status.controlled_missions))?;
    if status.uncontrolled_missions > 0 {
        let count = status.uncontrolled_missions;
        say(format_args!("{count} missions cannot be driven by controllers; the view control_failure says why"))?;
    }
    if !status.missing_months.is_empty() {
        say(format_args!("months without samples: {:?}", status.missing_months))?;
    }
    for refused in &status.refused_files {
        say(format_args!("refused: {refused}"))?;
    }
    match &status.last_run {
        Some(run) => {
            let reason = run.reason.as_ref().map(|reason| format!(": {reason}")).unwrap_or_default();
            say(format_args!(
                "last run {}: {}{reason}; started {}, busclimate {}",
                run.run_id, run.status, run.started_utc, run.program_version
            ))?;
        }
        None => say(format_args!("no run yet"))?,
    }
    let or_none = |time: &Option<String>| time.clone().unwrap_or_else(|| "–".to_owned());
    say(format_args!(
        "last success {}; newest mission ends {}, weather {}",
        or_none(&status.last_success_utc),
        or_none(&status.newest_mission_utc),
        or_none(&status.newest_weather_utc)
    ))?;
    if let Some(stages) = stages {
        say(format_args!("\na run would do:"))?;
        plan(stages)?;
    }
    Ok(ending)
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

pub fn shown(point: &Point, shown: &Shown, figure: Option<&Path>, json: bool) -> Result<Ending, Failure> {
    if json {
        draw(point, shown, figure)?;
        say(format_args!("{}", shown.json(&point.design)))?;
        return Ok(Ending::Done);
    }
    let (sample, segment, d) = (&shown.sample, &shown.sample.segment, &shown.sample.disturbances);
    say(format_args!(
        "sample {}  design {}  PMV {} … {}",
        point.sample,
        point.design,
        shown.window.pmv_min(),
        shown.window.pmv_max()
    ))?;
    say(format_args!(
        "from {} lines {}–{}: mission {}, segment {}, {} for {} s",
        segment.source_path,
        segment.first_line,
        segment.last_line,
        segment.mission,
        segment.segment,
        segment.start.format("%Y-%m-%dT%H:%M:%SZ"),
        segment.duration_s
    ))?;
    say(format_args!("weight in the year {:.4e}, month {}", shown.weight, sample.month))?;
    say(format_args!(
        "ambient {:.2} °C, DNI {:.1} W/m², DHI {:.1} W/m², solar altitude {:.2}°, shade {:.3}, passengers {:.2}, doors {:.4}",
        celsius(d.ambient_temperature_k),
        d.dni_w_m2,
        d.dhi_w_m2,
        d.solar_altitude_rad.to_degrees(),
        d.shadow_fraction,
        d.passengers,
        d.door_open_fraction
    ))?;
    let watts = |p: Option<f64>| p.map_or_else(|| "–".to_owned(), |p| format!("{p:.3}"));
    match &shown.stored {
        Some(row) => say(format_args!(
            "stored: {}, {} W, next choice {} W more",
            row.status,
            watts(row.hvac_power_w),
            watts(row.runner_up_excess_w)
        ))?,
        None => say(format_args!("stored: nothing yet; `busclimate run` computes it"))?,
    }
    candidates(shown)?;
    if shown.best.is_none() {
        say(format_args!("\nno operation of this design meets the window"))?;
        return Ok(Ending::Done);
    }
    flows(shown)?;
    if let Some(path) = draw(point, shown, figure)? {
        say(format_args!("\nfigure: {}", path.display()))?;
    }
    Ok(Ending::Done)
}

/// Writes the figure that is asked for.
fn draw<'p>(point: &Point, shown: &Shown, figure: Option<&'p Path>) -> Result<Option<&'p Path>, Failure> {
    let Some(path) = figure else { return Ok(None) };
    let svg = shown.figure(&point.design)?.ok_or_else(|| Failure::Inputs(anyhow!("there is nothing to draw")))?;
    write_whole(path, svg.as_bytes())?;
    Ok(Some(path))
}

fn candidates(shown: &Shown) -> Result<(), Failure> {
    say(format_args!("\nchoices           power W  air unit W  heaters W  curtain W   cabin °C      PMV"))?;
    for candidate in &shown.candidates {
        let name = match (candidate.devices.radiant_heaters, candidate.devices.air_curtain) {
            (false, false) => "neither",
            (false, true) => "curtain",
            (true, false) => "heaters",
            (true, true) => "both",
        };
        let Some(o) = candidate.operation else {
            say(format_args!("{name:<10} no operation meets the window"))?;
            continue;
        };
        let note = if candidate.available { "" } else { "  (not on board)" };
        say(format_args!(
            "{name:<12} {:>12.1} {:>11.1} {:>10.1} {:>10.1} {:>10.3} {:>8.4}{note}",
            o.hvac_power_w(),
            o.air_unit_power_w,
            o.radiant_heater_power_w,
            o.air_curtain_power_w,
            celsius(o.temperatures.cabin_k),
            o.pmv
        ))?;
    }
    Ok(())
}

/// Temperatures and heat flows of the optimum.
fn flows(shown: &Shown) -> Result<(), Failure> {
    let Some((operation, flows)) = &shown.best else { return Ok(()) };
    let t = operation.temperatures;
    say(format_args!(
        "\ntemperatures in °C: cabin {:.2}, interior {:.2}, shell inside {:.2}, shell outside {:.2}, radiant heaters {:.2}, \
         mean radiant {:.2}",
        celsius(t.cabin_k),
        celsius(t.interior_k),
        celsius(t.shell_inside_k),
        celsius(t.shell_outside_k),
        celsius(t.radiant_heater_k),
        celsius(operation.mean_radiant_temperature_k)
    ))?;
    say(format_args!("heat flows in W:"))?;
    for (_, name, watt) in flows.named_w() {
        say(format_args!("  {name:<36} {watt:>10.1}"))?;
    }
    let residual = flows.net_w().into_iter().map(f64::abs).fold(0.0, f64::max);
    say(format_args!("largest residual of the five balances: {residual:.1e} W"))
}
