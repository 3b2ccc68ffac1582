//! Missions that the database knows and that are not where the study says: they stay as they were read, until somebody says
//! that they are to be forgotten.

use ingest::mission::{Discovery, mission_name, span_of_name};
use std::collections::{BTreeMap, BTreeSet};
use store::KnownFile;
use study::{Study, keys};

/// What is not there.
#[derive(Debug, Default)]
pub(crate) struct Gone {
    /// Missions whose results are kept.
    pub missing: BTreeSet<String>,
    /// Files that are forgotten, with what came from them.
    pub forgotten: BTreeSet<String>,
}

impl Gone {
    /// What is known and was not found. Kept is what was read as the study says, by a bus of the study, unless another mission
    /// has taken its time.
    pub fn of(study: &Study, found: &Discovery, known: &BTreeMap<String, KnownFile>) -> Self {
        let there: BTreeSet<&str> = found
            .missions
            .iter()
            .map(|m| m.path.as_str())
            .chain(found.refused.iter().map(|f| f.path.as_str()))
            .collect();
        let names: BTreeSet<&str> = found.missions.iter().map(|m| m.name.as_str()).collect();
        let mut gone = Self::default();
        for (path, file) in known {
            let name = mission_name(path);
            if there.contains(path.as_str()) {
                continue;
            }
            // What lies elsewhere now is neither.
            if names.contains(name) && !file.blake3.is_empty() {
                continue;
            }
            let is_kept = file.accepted
                && !study.forget_missing
                && file.reading_key == keys::mission_key(study, &file.blake3)
                && span_of_name(name).is_some_and(|(bus, start, end)| {
                    let overlaps =
                        |m: &ingest::mission::MissionSource| m.bus == bus && m.start <= end && start <= m.end;
                    (study.buses.is_empty() || study.buses.contains(&bus)) && !found.missions.iter().any(overlaps)
                });
            let list = if is_kept { &mut gone.missing } else { &mut gone.forgotten };
            list.insert(path.clone());
        }
        gone
    }
}
