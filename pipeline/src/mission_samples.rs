//! The samples of single mission files, without a database: what a cluster maps over.

use ingest::mission::{MissionReading, MissionSource, read};
use ingest::sample::{Sample, Surroundings};
use ingest::{ExcludedSegment, FileReader};
use std::path::Path;
use study::{Study, keys};

use crate::{Inputs, PipelineError};

/// What a mission file gives.
#[derive(Debug, Clone, PartialEq)]
pub enum MissionSamples {
    /// Its samples, and the segments that give none.
    Read(Vec<Sample>, Vec<ExcludedSegment>),
    /// Nothing: why it is refused.
    Refused(String),
}

/// Reads mission files as `ingest` does and joins them with the study's weather and shade as `shade` does. Missions that overlap
/// or are there twice are not looked for: each file stands for itself.
#[derive(Debug, Clone, Copy)]
pub struct MissionReader<'i> {
    study: &'i Study,
    surroundings: Surroundings<'i>,
}

impl<'i> MissionReader<'i> {
    /// A reader that has read weather and shade.
    ///
    /// # Errors
    /// [`PipelineError`] where they cannot be used.
    pub fn new(study: &'i Study, inputs: &'i Inputs<'_>) -> Result<Self, PipelineError> {
        let (weather, _) = inputs.weather()?;
        let (shadow, _) = inputs.shadow()?;
        Ok(Self { study, surroundings: Surroundings { weather, shadow, site: &study.site, zone: study.zone } })
    }

    /// What a file gives; a mission that cannot be used is no error.
    #[must_use]
    pub fn read(&self, path: &Path) -> MissionSamples {
        let Some(source) = MissionSource::at(path) else {
            return MissionSamples::Refused("its name is not that of a mission".to_owned());
        };
        let reading = match source.load(&mut FileReader::default()) {
            Ok(content) => read(&source, &content, &self.study.missions),
            Err(record) => MissionReading::refused(*record),
        };
        if !reading.file.accepted {
            let why: Vec<String> = reading.file.findings.iter().map(ToString::to_string).collect();
            return MissionSamples::Refused(why.join("; "));
        }
        let key = keys::mission_key(self.study, &reading.file.blake3);
        let (mut samples, mut excluded) = (Vec::new(), reading.excluded);
        for segment in reading.segments {
            match self.surroundings.sample(segment, &key) {
                Ok(sample) => samples.push(sample),
                Err(segment) => excluded.push(segment),
            }
        }
        MissionSamples::Read(samples, excluded)
    }
}
