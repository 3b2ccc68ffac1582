//! What is known of a mission before it is read, and whether it has to be.

use ingest::mission::{MissionSource, mission_name};
use std::collections::BTreeMap;
use store::KnownFile;
use study::{Study, keys};

use crate::Inputs;

/// The missions that the database holds. A mission is known by its name and content: it may lie in another folder now, or in
/// an archive.
pub(crate) struct Before<'k> {
    study: &'k Study,
    rehash: bool,
    known: &'k BTreeMap<String, KnownFile>,
    path_of_name: BTreeMap<&'k str, &'k String>,
}

/// How a mission stands against what was read before.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Standing {
    /// It was never read.
    New,
    /// It was read with other settings.
    OtherSettings,
    /// It does not look as it did, or its look says nothing: its content tells.
    Unsure,
    /// It looks as it did, in another place.
    Moved,
    /// It looks as it did.
    Same,
}

impl<'k> Before<'k> {
    pub fn of(study: &'k Study, inputs: &Inputs<'_>, known: &'k BTreeMap<String, KnownFile>) -> Self {
        let read = known.iter().filter(|(_, file)| !file.blake3.is_empty());
        let path_of_name = read.map(|(path, _)| (mission_name(path), path)).collect();
        Self { study, rehash: inputs.rehash(), known, path_of_name }
    }

    /// Where a mission was found before, and what is known of it.
    pub fn find(&self, source: &MissionSource) -> Option<(&'k String, &'k KnownFile)> {
        let elsewhere = || self.path_of_name.get(source.name.as_str()).and_then(|path| self.known.get_key_value(*path));
        self.known.get_key_value(&source.path).filter(|(_, file)| !file.blake3.is_empty()).or_else(elsewhere)
    }

    /// How a mission stands, from its look alone.
    pub fn standing(&self, source: &MissionSource) -> Standing {
        let Some((path, file)) = self.find(source) else { return Standing::New };
        if file.reading_key != keys::mission_key(self.study, &file.blake3) {
            Standing::OtherSettings
        } else if self.rehash || file.stamp.is_none() || file.stamp != source.stamp() {
            Standing::Unsure
        } else if *path != source.path {
            Standing::Moved
        } else {
            Standing::Same
        }
    }
}
