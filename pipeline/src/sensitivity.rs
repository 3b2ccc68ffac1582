//! What the year of a study depends on: one input at a time, and all of them together.

use ::sensitivity::{
    Analysis, AnalysisError, Quantified, RESAMPLES, Resamples, SENSITIVITY_VERSION, Saltelli, Variation,
};
use ingest::sample::Sample;
use solve::Grid;
use std::collections::BTreeMap;
use store::{
    DesignRow, IndexRow, InputRow, RecordedStage, ResultOf, Sensitivities, SensitivityResult, StageRecord, Store,
    SwingRow,
};
use study::{Study, keys};

use crate::variants::year;
use crate::{PipelineError, Progress, Work, freshness, open};

/// Key of a sensitivity study: samples, designs, the bus and which inputs vary.
pub(crate) fn sensitivity_key(study: &Study, store: &mut Store) -> Result<String, PipelineError> {
    let asked = format!("{:?} {SENSITIVITY_VERSION} {RESAMPLES}", study.sensitivity);
    Ok(keys::hash(&[&freshness::solve_key(study, store)?, &asked]))
}

/// What the last sensitivity study of the study as it is now says; nothing where there was none, or it is of something else.
pub(crate) fn fresh(study: &Study, store: &mut Store) -> Result<Sensitivities, PipelineError> {
    let key = sensitivity_key(study, store)?;
    match store.stage(RecordedStage::Sensitivity)? {
        Some(record) if record.key == key => Ok(store.sensitivities()?),
        _ => Ok(Sensitivities::default()),
    }
}

/// What the last sensitivity study says, for whoever asks; nothing where it is of something else than the study is now.
///
/// # Errors
/// [`PipelineError`] where the database cannot be used.
pub fn sensitivities(study: &Study) -> Result<Sensitivities, PipelineError> {
    let mut store = open::for_reading(study)?;
    let all = fresh(study, &mut store)?;
    store.close()?;
    Ok(all)
}

/// Solves the year in every set of inputs, unless that is done.
pub(crate) fn sensitivity(study: &Study, store: &mut Store, progress: &dyn Progress) -> Result<Work, PipelineError> {
    let asked = &study.sensitivity;
    let design = Saltelli { points: asked.points, inputs: asked.inputs.len(), seed: asked.seed };
    let key = sensitivity_key(study, store)?;
    let message = |computed: usize| {
        let (sets, inputs) = (design.sets(), asked.inputs.len());
        format!("{computed} of {sets} sets of {inputs} inputs solved now")
    };
    let work = |computed: usize| Work {
        computed: computed as u64,
        withdrawn: 0,
        total: design.sets() as u64,
        message: message(computed),
    };
    if store.stage(RecordedStage::Sensitivity)?.is_some_and(|record| record.key == key) {
        return Ok(work(0));
    }
    let samples: BTreeMap<i64, Sample> = store.samples()?.into_iter().map(|s| (s.id, s)).collect();
    if samples.is_empty() {
        return Err(PipelineError::Request("there are no samples yet; run `busclimate run` first".to_owned()));
    }
    let grid = Grid::new(study.grid.designs().to_vec(), vec![asked.window]).expect("the names are those of a grid");
    let reference = study.design_rows.iter().position(DesignRow::is_plain_resistive);
    let year = year(&samples, &Variation::none(&study.vehicle));
    let analysis = Analysis::new(&year, &study.vehicle, &grid, reference);
    let (base, swings) = analysis.one_at_a_time(&asked.inputs).map_err(failure)?;
    progress.begin("sets", design.sets() as u64);
    let mut before = 0;
    let solved = analysis.solve(&asked.inputs, &design, |done| {
        progress.advance((done - before) as u64);
        before = done;
        !progress.stop()
    });
    progress.end();
    let solved = solved.map_err(failure)?;
    let resamples = Resamples::new(asked.points, RESAMPLES, asked.seed.into());
    let spreadings = analysis.spreadings(&design, &solved, &resamples);

    let of = |place: usize| {
        let Quantified { design, quantity, .. } = analysis.results()[place];
        let design = study.design_rows[design].name.clone();
        ResultOf { design, window: asked.window, quantity: quantity.name().to_owned() }
    };
    let input = |place: usize| InputRow { name: asked.inputs[place].name.clone(), order: place as u64 };
    let input_base = |place: usize| analysis.base().get(&asked.inputs[place].name).unwrap_or(f64::NAN);
    let all = Sensitivities {
        results: spreadings
            .iter()
            .map(|s| SensitivityResult {
                of: of(s.result),
                base_value: base[s.result],
                mean_value: s.mean,
                sd_value: s.sd,
                ends: s.ends,
                sets: design.sets() as u64,
                unsolved: solved.unsolved,
                limited: solved.limited[analysis.results()[s.result].design],
                seed: asked.seed.into(),
            })
            .collect(),
        swings: swings
            .iter()
            .map(|s| SwingRow {
                of: of(s.result),
                input: input(s.input),
                inputs: [input_base(s.input), s.values[0], s.values[1]],
                values: [base[s.result], s.results[0], s.results[1]],
            })
            .collect(),
        indices: spreadings
            .iter()
            .flat_map(|s| {
                let indices = s.indices.iter().flatten().enumerate();
                indices.map(|(place, index)| IndexRow {
                    of: of(s.result),
                    input: input(place),
                    first: [index.first, index.first_ends[0], index.first_ends[1]],
                    total: [index.total, index.total_ends[0], index.total_ends[1]],
                })
            })
            .collect(),
    };
    store.complete_sensitivities(&StageRecord { key, result: solved.unsolved.to_string() }, &all)?;
    Ok(work(design.sets()))
}

fn failure(error: AnalysisError) -> PipelineError {
    match error {
        AnalysisError::Stopped => PipelineError::Interrupted,
        error => PipelineError::Request(format!("[sensitivity.inputs] {error}")),
    }
}
