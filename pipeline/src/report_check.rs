//! Whether a report that lies somewhere still follows from the database.

use std::io::ErrorKind;
use std::path::Path;
use study::Study;

use crate::report::content;
use crate::{PipelineError, open};

/// A report in a folder beside the one of the database.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ReportCheck {
    /// Files that the report of the database has.
    pub files: usize,
    /// Files that are otherwise in the folder, by name.
    pub different: Vec<(String, Difference)>,
    /// The line with which the report in the folder says of what it is, where it says so otherwise than that of the database:
    /// first what it says, then what the database says.
    pub of_another: Option<[String; 2]>,
}

/// How a file of a report differs from that of the database.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Difference {
    /// It is not there.
    Missing,
    /// It has other bytes.
    Other,
    /// It is there, and the report of the database has none of its name.
    Surplus,
}

impl Difference {
    /// In words.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Missing => "is not there",
            Self::Other => "is another one",
            Self::Surplus => "is not part of the report any more",
        }
    }
}

/// Makes the report of the database in memory and looks for it in a folder. Nothing is written, and files that no report has are
/// nobody's business.
///
/// # Errors
/// [`PipelineError::Request`] where there is no such folder, or a file in it cannot be read; [`PipelineError::Store`],
/// [`PipelineError::Report`].
pub fn check_report(study: &Study, folder: &Path) -> Result<ReportCheck, PipelineError> {
    if !folder.is_dir() {
        return Err(PipelineError::Request(format!("{} is no folder with a report", folder.display())));
    }
    let mut store = open::for_reading(study)?;
    let report = store.at_one_moment(|store| content(study, store))?;
    store.close()?;
    let files = report::render(&report)?;
    let mut different = Vec::new();
    for file in &files {
        match read(&folder.join(&file.name))? {
            None => different.push((file.name.clone(), Difference::Missing)),
            Some(bytes) if bytes != file.bytes => different.push((file.name.clone(), Difference::Other)),
            Some(_) => {}
        }
    }
    for name in report::FILES.iter().filter(|name| files.iter().all(|file| file.name != **name)) {
        if folder.join(name).exists() {
            different.push(((*name).to_owned(), Difference::Surplus));
        }
    }
    let line = |bytes: &[u8]| {
        let text = String::from_utf8_lossy(bytes).into_owned();
        text.lines().find(|line| line.starts_with("busclimate ") && line.contains(" · study ")).map(str::to_owned)
    };
    let now = files.iter().find(|file| file.name == "report.md").and_then(|file| line(&file.bytes));
    let then = read(&folder.join("report.md"))?.and_then(|bytes| line(&bytes));
    let of_another = then.zip(now).filter(|(then, now)| then != now).map(|(then, now)| [then, now]);
    Ok(ReportCheck { files: files.len(), different, of_another })
}

fn read(path: &Path) -> Result<Option<Vec<u8>>, PipelineError> {
    match std::fs::read(path) {
        Ok(bytes) => Ok(Some(bytes)),
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(None),
        Err(error) => Err(PipelineError::Request(format!("{} cannot be read: {error}", path.display()))),
    }
}
