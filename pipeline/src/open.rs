//! The database of a study, which must be that study's.

use store::Store;
use study::Study;

use crate::PipelineError;
use crate::files::make_folder;

/// For writing; whoever calls holds the lock.
pub(crate) fn for_writing(study: &Study) -> Result<Store, PipelineError> {
    of_study(Store::open(&study.database)?, study)
}

/// For reading.
pub(crate) fn for_reading(study: &Study) -> Result<Store, PipelineError> {
    of_study(Store::open_read_only(&study.database)?, study)
}

fn of_study(mut store: Store, study: &Study) -> Result<Store, PipelineError> {
    match store.belongs_to(&study.name) {
        Ok(()) => Ok(store),
        Err(other) => {
            // Another study's database is left at rest, as it was.
            store.close()?;
            Err(other.into())
        }
    }
}

/// Makes the folder that the database lies in.
pub(crate) fn make_place(study: &Study) -> Result<(), PipelineError> {
    match study.database.parent().filter(|f| !f.as_os_str().is_empty()) {
        Some(folder) => make_folder(folder),
        None => Ok(()),
    }
}
