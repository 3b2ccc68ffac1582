//! What a job's owner wants to hear of the data, though nothing is wrong with the results: missions that are gone, late or
//! half-copied missions, late weather.

use chrono::{DateTime, Utc};
use ingest::{FileKind, FindingKind};
use store::Store;
use study::Study;

use crate::PipelineError;

/// What is not as the study file expects it; nothing where it expects nothing.
pub(crate) fn news(study: &Study, store: &mut Store, now: DateTime<Utc>) -> Result<Vec<String>, PipelineError> {
    let mut news = Vec::new();
    let missing = store.missing_files()?;
    if let Some(first) = missing.first() {
        news.push(format!(
            "{} missions are no longer there, the first: {first}; what came from them is kept until a run with --forget-missing",
            missing.len()
        ));
    }
    for (kind, expected_h) in
        [(FileKind::Mission, study.expect_missions_within_h), (FileKind::Weather, study.expect_weather_within_h)]
    {
        let Some(expected_h) = expected_h else { continue };
        let what = if kind == FileKind::Mission { "mission" } else { "weather" };
        match store.newest_file(kind)? {
            None => news.push(format!("there is no {what}, but one of the last {expected_h} hours is expected")),
            Some((newest, path)) => {
                let age_h = (now - newest).num_seconds() as f64 / 3600.0;
                if age_h > expected_h {
                    news.push(format!(
                        "the newest {what} ends {age_h:.0} hours ago ({path}), but one of the last {expected_h} hours is expected"
                    ));
                }
                if kind == FileKind::Mission {
                    news.extend(half_copied(store, &path)?);
                }
            }
        }
    }
    Ok(news)
}

/// Whether a mission ends before its name says.
fn half_copied(store: &mut Store, path: &str) -> Result<Option<String>, PipelineError> {
    let file = store.files()?.into_iter().find(|file| file.path == path);
    let finding = file.and_then(|file| file.findings.into_iter().find(|f| f.kind == FindingKind::Truncated));
    Ok(finding.map(|finding| format!("the newest mission may be half copied: {path}: {finding}")))
}
