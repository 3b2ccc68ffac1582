//! busclimate in Python: the kernels on Arrow data, and whole studies.
//!
//! `arrow` takes columns in and gives tables out, `settings` turns designs and comfort windows as Python says them into those of a
//! study file, and each of the other files is one thing that Python calls. Numbers are those of the program, bit for bit: the
//! same functions compute them. While they do, Python's lock is free.

mod arrow;
mod comfort;
mod errors;
mod missions;
mod optimize;
mod parameters;
mod samples;
mod sensitivity;
mod settings;
mod simulate;
mod study;

use pyo3::prelude::*;

/// What the package `busclimate` is made of.
#[pymodule]
fn _busclimate(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", pipeline::PROGRAM_VERSION)?;
    module.add("BusclimateError", module.py().get_type::<errors::BusclimateError>())?;
    module.add("StudyError", module.py().get_type::<errors::StudyError>())?;
    module.add("InputError", module.py().get_type::<errors::InputError>())?;
    module.add_class::<pyo3_arrow::PyTable>()?;
    module.add_class::<study::Study>()?;
    module.add_function(wrap_pyfunction!(comfort::pmv, module)?)?;
    module.add_function(wrap_pyfunction!(missions::read_mission, module)?)?;
    module.add_function(wrap_pyfunction!(optimize::model_key, module)?)?;
    module.add_function(wrap_pyfunction!(optimize::optimize, module)?)?;
    module.add_function(wrap_pyfunction!(parameters::parameter_study, module)?)?;
    module.add_function(wrap_pyfunction!(sensitivity::sensitivity, module)?)?;
    module.add_function(wrap_pyfunction!(simulate::simulate, module)?)?;
    Ok(())
}
