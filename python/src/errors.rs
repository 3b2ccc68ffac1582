//! What goes wrong, as exceptions that say which argument it is and what to do.

use pyo3::exceptions::PyException;
use pyo3::{PyErr, create_exception};

create_exception!(busclimate, BusclimateError, PyException, "What busclimate cannot do.");
create_exception!(busclimate, StudyError, BusclimateError, "A study, a design or a comfort window is wrong.");
create_exception!(busclimate, InputError, BusclimateError, "Data or a database cannot be used.");

/// An argument is wrong.
pub fn argument(name: &str, what: impl std::fmt::Display) -> PyErr {
    StudyError::new_err(format!("{name}: {what}"))
}

/// A column of an argument is wrong.
pub fn data(name: &str, what: impl std::fmt::Display) -> PyErr {
    InputError::new_err(format!("{name}: {what}"))
}
