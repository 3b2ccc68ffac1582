//! What the database holds, and what a run would do.

use pipeline::{StagePlan, Status};
use serde::Serialize;

use crate::console::say;
use crate::failure::{Ending, Failure};

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
