//! What the record of a run says besides what it did: when, and of which inputs.

use chrono::{DateTime, Utc};
use store::Store;
use study::keys;

use crate::PipelineError;

/// Now, for the record of runs; content knows no clock.
pub(crate) fn now() -> DateTime<Utc> {
    Utc::now()
}

/// BLAKE3 over kind, path, content and use of every input. A file's record is stored together with what was made from it, so
/// the hash vouches for what the database holds, not for what lies on the disk.
pub(crate) fn input_hash(store: &mut Store) -> Result<String, PipelineError> {
    let files = store.files()?;
    let parts: Vec<&str> = files
        .iter()
        .flat_map(|f| [f.kind.name(), &f.path, &f.blake3, if f.accepted { "used" } else { "refused" }])
        .collect();
    Ok(keys::hash(&parts))
}
