//! What the simulations of a study run on, and the key of each.

use cabin::{Operation, Outcome, PassengerViews};
use ingest::sample::Sample;
use simulate::SIMULATION_VERSION;
use std::collections::BTreeMap;
use store::{SimulationId, Store, StoredGrid};
use study::{Study, keys};

use crate::PipelineError;
use crate::missions::{WeatherAndShade, span};

/// What the simulations of a study run on.
pub(crate) struct SimulationBasis<'a> {
    pub study: &'a Study,
    pub grid: StoredGrid,
    pub views: PassengerViews,
    pub surroundings: WeatherAndShade<'a>,
    pub missions: Vec<Vec<Sample>>,
}

impl SimulationBasis<'_> {
    /// The key of every simulation that the study asks for: samples and optima of the mission, weather and shade in time,
    /// design, window, and how the bus behaves.
    pub fn keys(&self) -> BTreeMap<SimulationId, String> {
        let mut keys = BTreeMap::new();
        for samples in &self.missions {
            let mission = self.mission_key(samples);
            for id in self.ids(samples) {
                let key = self.key(&mission, &id);
                keys.insert(id, key);
            }
        }
        keys
    }

    /// The key of a mission with all that its simulations share.
    pub fn mission_key(&self, samples: &[Sample]) -> String {
        let dynamics = format!("{:?} {SIMULATION_VERSION}", self.study.dynamics);
        let sample_keys: Vec<&str> = samples.iter().map(|s| s.key.as_str()).collect();
        keys::hash(&[&sample_keys.join(" "), &self.surroundings.key(span(samples)), &dynamics])
    }

    /// The key of a simulation of a mission whose own key is given.
    fn key(&self, mission: &str, id: &SimulationId) -> String {
        let w = self.study.grid.windows()[id.window];
        let window = format!("{} {}", w.pmv_min(), w.pmv_max());
        keys::hash(&[mission, &self.study.design_rows[id.design].design_key, &window])
    }

    /// What is simulated of a mission, in the order of the study.
    pub fn ids(&self, samples: &[Sample]) -> Vec<SimulationId> {
        let source_path = &samples[0].segment.source_path;
        let designs = 0..self.study.grid.designs().len();
        let of_design = |design| {
            let id = move |&window: &usize| SimulationId { source_path: source_path.clone(), design, window };
            self.study.simulated_windows.iter().map(id)
        };
        designs.flat_map(of_design).collect()
    }
}

/// The optima of a mission's segments by design and window, or which segment has none.
type MissionOptima = BTreeMap<(usize, usize), Result<Vec<Operation>, String>>;

/// The optima of a mission in some designs and windows, by their places.
pub(crate) fn optima(
    store: &mut Store,
    grid: &StoredGrid,
    samples: &[Sample],
    designs: &[usize],
    windows: &[usize],
) -> Result<MissionOptima, PipelineError> {
    // Ids of a mission's samples rise with time; those of other buses lie elsewhere.
    let rows = store.optima_of(grid, [samples[0].id, samples[samples.len() - 1].id], designs, windows)?;
    let mut found: BTreeMap<(usize, usize), BTreeMap<i64, Outcome>> = BTreeMap::new();
    for row in &rows {
        if let Some(outcome) = row.outcome {
            found.entry((row.design, row.window)).or_default().insert(row.sample_id, outcome);
        }
    }
    let mut optima = BTreeMap::new();
    for &design in designs {
        for &window in windows {
            let outcomes = found.remove(&(design, window)).unwrap_or_default();
            let operation = |s: &Sample| match outcomes.get(&s.id) {
                Some(Outcome::Solved(operation, _)) => Ok(*operation),
                Some(other) => Err(format!("segment {} has no optimum: {}", s.segment.segment, other.words())),
                None => Err(format!("segment {} has no optimum", s.segment.segment)),
            };
            optima.insert((design, window), samples.iter().map(operation).collect());
        }
    }
    Ok(optima)
}
