//! A whole study: run, and its tables.

use arrow_array::{ArrayRef, Float64Array, Int64Array, StringArray, UInt32Array};
use pipeline::{Options, PipelineError, Progress, Stage};
use pyo3::prelude::*;
use pyo3_arrow::PyTable;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;
use store::{Relation, Store, Values, dictionary};

use crate::arrow::{batch, table};
use crate::errors::{InputError, StudyError, argument};
use crate::missions::time;

/// Rows that are read from the database at a time.
const PORTION: usize = 65_536;

/// A study file, ready to run.
#[pyclass(frozen, module = "busclimate")]
pub struct Study(study::Study);

/// Lets Ctrl-C end a run at its next safe place.
#[derive(Default)]
struct Listening {
    interrupted: AtomicBool,
}

impl Progress for Listening {
    fn begin(&self, _: &'static str, _: u64) {}
    fn advance(&self, _: u64) {}
    fn end(&self) {}
    fn info(&self, _: &str) {}
    fn warn(&self, _: &str) {}
    fn stop(&self) -> bool {
        if Python::attach(|py| py.check_signals()).is_err() {
            self.interrupted.store(true, Ordering::Relaxed);
        }
        self.interrupted.load(Ordering::Relaxed)
    }
}

#[pymethods]
impl Study {
    /// Opens a study file, or the one in a folder; `database` is where the experiment database lies, instead of where the file says.
    ///
    /// Raises StudyError, with line, column and the nearest known key, where the file is wrong.
    #[staticmethod]
    #[pyo3(signature = (path, *, database=None))]
    fn open(path: PathBuf, database: Option<PathBuf>) -> PyResult<Self> {
        let path = if path.is_dir() { path.join("study.toml") } else { path };
        let study = study::Study::open(&path, database.as_deref()).map_err(|e| StudyError::new_err(e.to_string()))?;
        Ok(Self(study))
    }

    /// Name of the study.
    #[getter]
    fn name(&self) -> &str {
        &self.0.name
    }

    /// Where the experiment database lies.
    #[getter]
    fn database(&self) -> &PathBuf {
        &self.0.database
    }

    /// Where the report goes.
    #[getter]
    fn report_dir(&self) -> &PathBuf {
        &self.0.report_dir
    }

    /// Runs stages ("ingest", "shade", "solve", "simulate", "control", "report"), all of them where none is named; only what is
    /// missing is computed. Gives the findings in a few lines where a report was made. `wait_s` is how long to wait for another
    /// run on the same database.
    ///
    /// Raises InputError where inputs or database cannot be used, KeyboardInterrupt after Ctrl-C; a further run resumes.
    #[pyo3(signature = (stages=None, *, wait_s=0.0))]
    fn run(&self, py: Python<'_>, stages: Option<Vec<String>>, wait_s: f64) -> PyResult<Vec<String>> {
        let named = |name: &String| {
            let known = Stage::ALL.into_iter().find(|stage| stage.name() == name);
            let names = Stage::ALL.map(Stage::name).join(", ");
            known.ok_or_else(|| argument("stages", format!("there is no stage {name:?}; there are {names}")))
        };
        let stages = stages.map_or_else(|| Ok(Stage::ALL.to_vec()), |names| names.iter().map(named).collect())?;
        let wait = Duration::try_from_secs_f64(wait_s).map_err(|e| argument("wait_s", e))?;
        let options = Options { wait, ..Options::default() };
        let done = py.detach(|| pipeline::run(&self.0, &stages, &options, &Listening::default()));
        match done {
            Ok(done) => Ok(done.headline),
            Err(PipelineError::Interrupted) => {
                py.check_signals()?;
                Err(pyo3::exceptions::PyKeyboardInterrupt::new_err("interrupted; run again to resume"))
            }
            Err(error) => Err(InputError::new_err(error.to_string())),
        }
    }

    /// A table or view of the database, such as "annual_average" or "optimum"; `busclimate dictionary` describes them all.
    ///
    /// Raises StudyError where there is none of that name, with those that there are.
    fn table(&self, py: Python<'_>, name: &str) -> PyResult<PyTable> {
        let wrong = |e: store::StoreError| InputError::new_err(e.to_string());
        let relations = dictionary().map_err(wrong)?;
        let relation = relations.iter().find(|r| r.name == name && !r.internal).ok_or_else(|| {
            let names: Vec<&str> = relations.iter().filter(|r| !r.internal).map(|r| r.name.as_str()).collect();
            argument("name", format!("there is no table {name:?}; there are {}", names.join(", ")))
        })?;
        let portions = py.detach(|| self.read(|store| portions(store, relation)))?;
        let batches = portions.into_iter().map(batch).collect::<PyResult<Vec<_>>>()?;
        let schema =
            batches.first().map(|b| b.schema()).ok_or_else(|| InputError::new_err(format!("{name} is not there")))?;
        PyTable::try_new(batches, schema)
    }

    /// The samples in the units of the model: what `optimize` turns into the optima of the study, bit for bit.
    fn samples(&self, py: Python<'_>) -> PyResult<PyTable> {
        let samples = py.detach(|| self.read(Store::samples))?;
        let real = |of: fn(&cabin::Disturbances) -> f64| -> ArrayRef {
            Arc::new(Float64Array::from_iter_values(samples.iter().map(|s| of(&s.disturbances))))
        };
        let columns: Vec<(&str, ArrayRef)> = vec![
            ("sample_id", Arc::new(Int64Array::from_iter_values(samples.iter().map(|s| s.id)))),
            ("mission", Arc::new(StringArray::from_iter_values(samples.iter().map(|s| s.segment.mission.as_str())))),
            ("segment", Arc::new(UInt32Array::from_iter_values(samples.iter().map(|s| s.segment.segment)))),
            ("start_utc", Arc::new(StringArray::from_iter_values(samples.iter().map(|s| time(s.segment.start))))),
            ("month", Arc::new(UInt32Array::from_iter_values(samples.iter().map(|s| s.month.into())))),
            ("ambient_temperature_k", real(|d| d.ambient_temperature_k)),
            ("dni_w_m2", real(|d| d.dni_w_m2)),
            ("dhi_w_m2", real(|d| d.dhi_w_m2)),
            ("solar_altitude_rad", real(|d| d.solar_altitude_rad)),
            ("shadow_fraction", real(|d| d.shadow_fraction)),
            ("passengers", real(|d| d.passengers)),
            ("door_open_fraction", real(|d| d.door_open_fraction)),
        ];
        table(columns.into_iter().map(|(name, values)| (name.to_owned(), values)).collect())
    }
}

impl Study {
    fn read<T>(&self, of: impl FnOnce(&mut Store) -> Result<T, store::StoreError>) -> PyResult<T> {
        let wrong = |e: store::StoreError| InputError::new_err(e.to_string());
        let mut store = Store::open_read_only(&self.0.database).map_err(wrong)?;
        store.belongs_to(&self.0.name).map_err(wrong)?;
        let found = of(&mut store).map_err(wrong)?;
        store.close().map_err(wrong)?;
        Ok(found)
    }
}

/// All rows of a table, in portions; at least one, which may be empty.
fn portions(store: &mut Store, relation: &Relation) -> Result<Vec<Vec<(String, ArrayRef)>>, store::StoreError> {
    let mut all = Vec::new();
    store.portions(relation, None, PORTION, &mut |portion| {
        let names = relation.columns.iter().map(|c| c.name.clone());
        all.push(names.zip(portion.iter().map(array)).collect());
        ControlFlow::Continue(())
    })?;
    Ok(all)
}

fn array(values: &Values) -> ArrayRef {
    match values {
        Values::Integer(values) => Arc::new(Int64Array::from(values.clone())),
        Values::Real(values) => Arc::new(Float64Array::from(values.clone())),
        Values::Text(values) => Arc::new(StringArray::from(values.clone())),
    }
}
