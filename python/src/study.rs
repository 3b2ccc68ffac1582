//! A whole study: run, and its tables.

use ::study::keys;
use arrow_array::{ArrayRef, Float64Array, Int32Array, Int64Array, StringArray};
use cabin::Disturbances;
use ingest::ExcludedSegment;
use ingest::sample::{Sample, sample_id};
use pipeline::{Inputs, MissionReader, MissionSamples, Options, PipelineError, Progress, Stage};
use pyo3::exceptions::PyUserWarning;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use pyo3_arrow::PyTable;
use rayon::prelude::*;
use std::ffi::CString;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;
use store::{Relation, Store, Values, dictionary};

use crate::arrow::{batch, table};
use crate::errors::{InputError, StudyError, argument, data};
use crate::missions::time;

/// Rows that are read from the database at a time.
const PORTION: usize = 65_536;

/// A study file, ready to run.
#[pyclass(frozen, module = "busclimate")]
pub struct Study(::study::Study);

/// Lets Ctrl-C end a run at its next safe place, and keeps what a user should look at.
#[derive(Default)]
struct Listening {
    interrupted: AtomicBool,
    warnings: Mutex<Vec<String>>,
}

impl Progress for Listening {
    fn begin(&self, _: &'static str, _: u64) {}
    fn advance(&self, _: u64) {}
    fn end(&self) {}
    fn info(&self, _: &str) {}
    fn warn(&self, message: &str) {
        // A thread that panicked while it added one leaves those before.
        self.warnings.lock().unwrap_or_else(PoisonError::into_inner).push(message.to_owned());
    }
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
        let study = ::study::Study::open(&path, database.as_deref()).map_err(|e| StudyError::new_err(e.to_string()))?;
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
    /// Refused files and the like are UserWarnings. Raises InputError where inputs or database cannot be used, KeyboardInterrupt
    /// after Ctrl-C; a further run resumes.
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
        let listening = Listening::default();
        let done = py.detach(|| pipeline::run(&self.0, &stages, &options, &listening));
        for message in listening.warnings.into_inner().unwrap_or_else(PoisonError::into_inner) {
            let message = CString::new(message.replace('\0', " ")).unwrap_or_default();
            PyErr::warn(py, &py.get_type::<PyUserWarning>(), &message, 1)?;
        }
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
        let rows: Vec<Row<'_>> = samples.iter().map(Row::Sample).collect();
        table(sample_columns(&rows, false))
    }

    /// A mission of the study by its name, as what `busclimate.simulate` takes: `simulate(**study.mission(name))` gives the rows of
    /// the view `simulation`, bit for bit, with the designs, windows and constants that it is given.
    ///
    /// Raises InputError where there is no such mission, or weather or shade cannot be used.
    fn mission<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyDict>> {
        let found =
            py.detach(|| pipeline::mission_inputs(&self.0, name)).map_err(|e| InputError::new_err(e.to_string()))?;
        let found = found.ok_or_else(|| {
            data("name", format!("there is no mission {name:?} with samples; the view sample has the names"))
        })?;
        let ids = |ids: &[i64]| -> ArrayRef { Arc::new(Int64Array::from(ids.to_vec())) };
        let mut samples = vec![("sample_id".to_owned(), ids(&found.samples))];
        samples.extend(disturbance_columns(found.segments.iter().map(Some)));
        let loads: Vec<(String, ArrayRef)> = [
            ("second", ids(&found.loads.iter().map(|l| i64::from(l.second)).collect::<Vec<_>>())),
            ("passengers", Arc::new(Float64Array::from_iter_values(found.loads.iter().map(|l| l.passengers)))),
            ("door_open", Arc::new(Float64Array::from_iter_values(found.loads.iter().map(|l| l.door_open)))),
        ]
        .map(|(name, values)| (name.to_owned(), values))
        .into();
        let arguments = PyDict::new(py);
        arguments.set_item("samples", table(samples)?)?;
        arguments.set_item("minutes", table(disturbance_columns(found.minutes.iter().map(Some)))?)?;
        arguments.set_item("loads", table(loads)?)?;
        arguments.set_item("segment_s", found.segment_s)?;
        arguments.set_item("door_open_share", self.0.missions.door_open_share)?;
        Ok(arguments)
    }

    /// The samples of mission files, read and joined with the study's weather and shade by the code of `ingest` and `shade`,
    /// without a database: what a cluster maps over. Each file stands for itself: those that overlap are not looked for.
    ///
    /// Besides the columns of `samples` there are `path`, `outcome` and `reason`: a segment that gives no sample is a row
    /// "excluded", a file that cannot be used a row "refused", both with the reason and without numbers.
    ///
    /// Raises InputError where weather or shade cannot be used.
    fn read_missions(&self, py: Python<'_>, paths: Vec<PathBuf>) -> PyResult<PyTable> {
        py.detach(|| {
            let wrong = |e: PipelineError| InputError::new_err(e.to_string());
            let inputs = Inputs::new(&self.0, false);
            let reader = MissionReader::new(&self.0, &inputs).map_err(wrong)?;
            let read: Vec<MissionSamples> = paths.par_iter().map(|path| reader.read(path)).collect();
            let mut rows = Vec::new();
            let mut names = Vec::new();
            for (path, of) in paths.iter().zip(&read) {
                match of {
                    MissionSamples::Read(samples, excluded) => {
                        rows.extend(samples.iter().map(Row::Sample));
                        rows.extend(excluded.iter().map(Row::Excluded));
                    }
                    MissionSamples::Refused(reason) => rows.push(Row::Refused(reason)),
                }
                names.resize(rows.len(), path.to_string_lossy().into_owned());
            }
            let mut columns = sample_columns(&rows, true);
            columns.push(("path".to_owned(), Arc::new(StringArray::from(names))));
            table(columns)
        })
    }

    /// What the samples of a mission are made with: readers, settings of the study and the version of both. Workers whose key is
    /// another one give other samples.
    fn reading_key(&self) -> String {
        keys::mission_key(&self.0, "")
    }
}

/// A row of samples.
#[derive(Clone, Copy)]
enum Row<'s> {
    Sample(&'s Sample),
    Excluded(&'s ExcludedSegment),
    Refused(&'s str),
}

impl Row<'_> {
    fn sample(&self) -> Option<&Sample> {
        match self {
            Self::Sample(sample) => Some(sample),
            Self::Excluded(_) | Self::Refused(_) => None,
        }
    }
}

/// The columns of samples, with what became of each row where that is wanted.
fn sample_columns(rows: &[Row<'_>], outcomes: bool) -> Vec<(String, ArrayRef)> {
    let of_segment = |r: &Row<'_>| match r {
        Row::Sample(s) => Some((s.segment.mission.clone(), s.segment.bus, s.segment.segment, s.segment.start)),
        Row::Excluded(e) => Some((e.mission.clone(), e.bus, e.segment, e.start)),
        Row::Refused(_) => None,
    };
    let segments: Vec<_> = rows.iter().map(of_segment).collect();
    let segment = || segments.iter().map(Option::as_ref);
    let columns: Vec<(&str, ArrayRef)> = vec![
        ("sample_id", Arc::new(segment().map(|s| s.map(|s| sample_id(s.1, s.3))).collect::<Int64Array>())),
        ("mission", Arc::new(segment().map(|s| s.map(|s| s.0.as_str())).collect::<StringArray>())),
        ("segment", Arc::new(segment().map(|s| s.map(|s| s.2 as i32)).collect::<Int32Array>())),
        ("start_utc", Arc::new(segment().map(|s| s.map(|s| time(s.3))).collect::<StringArray>())),
        ("month", Arc::new(rows.iter().map(|r| r.sample().map(|s| i32::from(s.month))).collect::<Int32Array>())),
    ];
    let mut columns: Vec<(String, ArrayRef)> =
        columns.into_iter().map(|(name, values)| (name.to_owned(), values)).collect();
    columns.extend(disturbance_columns(rows.iter().map(|r| r.sample().map(|s| &s.disturbances))));
    if outcomes {
        let told = |r: &Row<'_>| match r {
            Row::Sample(_) => ("sample", None),
            Row::Excluded(e) => ("excluded", Some(e.reason.clone())),
            Row::Refused(reason) => ("refused", Some((*reason).to_owned())),
        };
        let told: Vec<(&str, Option<String>)> = rows.iter().map(told).collect();
        columns.push(("outcome".to_owned(), Arc::new(StringArray::from_iter_values(told.iter().map(|t| t.0)))));
        columns.push(("reason".to_owned(), Arc::new(told.iter().map(|t| t.1.as_deref()).collect::<StringArray>())));
    }
    columns
}

/// Disturbances in the units of the model.
fn disturbance_columns<'d>(rows: impl Iterator<Item = Option<&'d Disturbances>> + Clone) -> Vec<(String, ArrayRef)> {
    let real = |of: fn(&Disturbances) -> f64| -> ArrayRef {
        Arc::new(rows.clone().map(|d| d.map(of)).collect::<Float64Array>())
    };
    [
        ("ambient_temperature_k", real(|d| d.ambient_temperature_k)),
        ("dni_w_m2", real(|d| d.dni_w_m2)),
        ("dhi_w_m2", real(|d| d.dhi_w_m2)),
        ("solar_altitude_rad", real(|d| d.solar_altitude_rad)),
        ("shadow_fraction", real(|d| d.shadow_fraction)),
        ("passengers", real(|d| d.passengers)),
        ("door_open_fraction", real(|d| d.door_open_fraction)),
    ]
    .map(|(name, values)| (name.to_owned(), values))
    .into()
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
