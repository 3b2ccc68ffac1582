//! What a database holds and what its last run came to, as metrics in the text format of OpenMetrics 1.0
//! (<https://prometheus.io/docs/specs/om/open_metrics_spec/>), which the node exporter's textfile collector reads too.

use chrono::DateTime;
use std::fmt::Write;
use std::path::Path;
use store::Store;
use study::Study;

use crate::status::{Status, status_of};
use crate::{PipelineError, write_whole};

/// Writes the metrics of a study to a file, whole or not at all.
pub(crate) fn write(file: &Path, study: &Study, store: &mut Store) -> Result<(), PipelineError> {
    write_whole(file, text(&status_of(study, store)?).as_bytes())
}

fn text(status: &Status) -> String {
    let mut families = Families { text: String::new(), study: escaped(&status.study) };
    let seconds = |time: &Option<String>| {
        let time = DateTime::parse_from_rfc3339(time.as_deref()?).ok()?;
        Some(time.timestamp() as f64)
    };
    if let Some(run) = &status.last_run {
        let state = |of: &str| (format!("status=\"{}\"", of.replace(' ', "_")), f64::from(u8::from(run.status == of)));
        let states = ["done", "done with losses", "interrupted", "failed"].map(state);
        families.gauge("last_run_status", "1 at the way in which the last run ended.", states);
        let duration_s = seconds(&run.finished_utc).zip(seconds(&Some(run.started_utc.clone())));
        families.plain("last_run_timestamp_seconds", "End of the last run.", seconds(&run.finished_utc));
        families.plain(
            "last_run_duration_seconds",
            "Length of the last run.",
            duration_s.map(|(end, begin)| end - begin),
        );
    }
    families.plain(
        "last_success_timestamp_seconds",
        "End of the last run that finished its work.",
        seconds(&status.last_success_utc),
    );
    let by_stage = |value: fn(&crate::LastStage) -> f64| {
        status.last_stages.iter().map(move |s| (format!("stage=\"{}\"", s.stage), value(s)))
    };
    families.gauge("stage_duration_seconds", "Length of a stage of the last run.", by_stage(|s| s.duration_s));
    families.gauge(
        "stage_computed",
        "What a stage of the last run did: missions, samples, points, simulations, files.",
        by_stage(|s| s.computed as f64),
    );
    let points = [
        ("solved", status.solved),
        ("infeasible", status.infeasible),
        ("not_converged", status.not_converged),
        ("pending", status.pending),
    ];
    let points = points.map(|(state, count)| (format!("state=\"{state}\""), count as f64));
    families.gauge("points", "Points of the study by state.", points);
    families.plain("samples", "Hourly samples.", Some(status.samples as f64));
    families.plain("excluded_segments", "Segments without a sample.", Some(status.excluded_segments as f64));
    families.plain("refused_files", "Input files that are not used.", Some(status.refused_files.len() as f64));
    families.plain(
        "unsimulated_missions",
        "Missions that cannot be simulated.",
        Some(status.unsimulated_missions as f64),
    );
    families.plain(
        "uncontrolled_missions",
        "Missions that causal controllers cannot drive.",
        Some(status.uncontrolled_missions as f64),
    );
    families.plain(
        "newest_mission_timestamp_seconds",
        "End of the newest mission.",
        seconds(&status.newest_mission_utc),
    );
    families.plain("newest_weather_timestamp_seconds", "End of the weather.", seconds(&status.newest_weather_utc));
    families.plain("database_bytes", "Size of the database.", Some(status.database_bytes as f64));
    families.text + "# EOF\n"
}

/// Metric families of one study.
struct Families {
    text: String,
    study: String,
}

impl Families {
    /// A metric without labels of its own; none where there is no value.
    fn plain(&mut self, name: &str, help: &str, value: Option<f64>) {
        self.gauge(name, help, value.map(|value| (String::new(), value)));
    }

    fn gauge(&mut self, name: &str, help: &str, values: impl IntoIterator<Item = (String, f64)>) {
        let mut values = values.into_iter().peekable();
        if values.peek().is_none() {
            return;
        }
        let study = &self.study;
        let _ = writeln!(self.text, "# TYPE busclimate_{name} gauge\n# HELP busclimate_{name} {help}");
        for (label, value) in values {
            let joint = if label.is_empty() { "" } else { "," };
            let _ = writeln!(self.text, "busclimate_{name}{{study=\"{study}\"{joint}{label}}} {value}");
        }
    }
}

/// A label's value.
fn escaped(text: &str) -> String {
    text.replace('\\', "\\\\").replace('"', "\\\"").replace('\n', "\\n")
}
