//! A folder of results that appears whole or not at all.
//!
//! The new folder is written and synced beside the old one and takes its name; files in it that are not ours come along. A
//! kill leaves the old folder, the new one, or for the blink between two renames none: the next writer puts it right.

use std::fs::{self, File};
use std::io::{Error, ErrorKind, Result, Write};
use std::path::{Path, PathBuf};

/// The files of a new folder, by name.
pub(crate) type Files<'f> = [(&'f str, &'f [u8])];

/// Makes `folder` hold `files`, and of other files those whose name is not among `ours`. What is in `keep` must stay where it
/// is.
pub(crate) fn replace(folder: &Path, files: &Files<'_>, ours: &[&str], keep: &[&Path]) -> Result<()> {
    // What a link leads to is replaced, not the link.
    let folder = &fs::canonicalize(folder).or_else(|_| std::path::absolute(folder))?;
    let is_inside = |path: &&Path| fs::canonicalize(Path::new(".").join(path)).is_ok_and(|p| p.starts_with(folder));
    if keep.iter().any(is_inside) {
        return one_by_one(folder, files, ours);
    }
    let places = Places::of(folder)?;
    places.recover(ours)?;
    let write = |new: &Path| files.iter().try_for_each(|(name, bytes)| write_synced(&new.join(name), bytes));
    match places.renew(&write, ours) {
        Err(Renew::NotHere) => one_by_one(folder, files, ours),
        Err(Renew::Failed(error)) => Err(error),
        Ok(()) => Ok(()),
    }
}

/// Makes `folder` hold what `write` puts into a new one, and what is there under other names than `ours`.
pub(crate) fn fill(folder: &Path, ours: &[&str], write: &dyn Fn(&Path) -> Result<()>) -> Result<()> {
    let folder = &fs::canonicalize(folder).or_else(|_| std::path::absolute(folder))?;
    let places = Places::of(folder)?;
    places.recover(ours)?;
    places.renew(write, ours).map_err(|cause| match cause {
        Renew::NotHere => Error::new(ErrorKind::PermissionDenied, "no folder can be written and renamed beside it"),
        Renew::Failed(error) => error,
    })
}

struct Places {
    folder: PathBuf,
    new: PathBuf,
    old: PathBuf,
}

/// Why a folder was not renewed.
enum Renew {
    /// It cannot be renamed: a mount, or in a folder that may not be written.
    NotHere,
    Failed(Error),
}

impl From<Error> for Renew {
    fn from(error: Error) -> Self {
        Self::Failed(error)
    }
}

impl Places {
    fn of(folder: &Path) -> Result<Self> {
        let name = folder.file_name().ok_or_else(|| Error::new(ErrorKind::InvalidInput, "not the name of a folder"))?;
        let beside = |suffix: &str| {
            let mut name = name.to_owned();
            name.push(suffix);
            folder.with_file_name(name)
        };
        Ok(Self { folder: folder.to_owned(), new: beside(".new"), old: beside(".old") })
    }

    /// Finishes what a killed writer has left.
    fn recover(&self, ours: &[&str]) -> Result<()> {
        if self.old.exists() && !self.folder.exists() {
            if self.new.exists() {
                move_others(&self.new, &self.old, ours)?;
            }
            fs::rename(&self.old, &self.folder)?;
        }
        for left in [&self.old, &self.new] {
            if left.exists() {
                fs::remove_dir_all(left)?;
            }
        }
        Ok(())
    }

    fn renew(&self, write: &dyn Fn(&Path) -> Result<()>, ours: &[&str]) -> std::result::Result<(), Renew> {
        if let Some(above) = self.folder.parent() {
            fs::create_dir_all(above)?;
        }
        fs::create_dir(&self.new).map_err(|_| Renew::NotHere)?;
        if let Err(error) = write(&self.new).and_then(|()| sync(&self.new)) {
            // The old folder is as it was; what is half written goes.
            let _ = fs::remove_dir_all(&self.new);
            return Err(error.into());
        }
        if self.folder.exists() {
            if fs::rename(&self.folder, &self.old).is_err() {
                fs::remove_dir_all(&self.new)?;
                return Err(Renew::NotHere);
            }
            move_others(&self.old, &self.new, ours)?;
        }
        fs::rename(&self.new, &self.folder)?;
        if let Some(above) = self.folder.parent() {
            sync(above)?;
        }
        if self.old.exists() {
            fs::remove_dir_all(&self.old)?;
        }
        Ok(())
    }
}

/// Each file whole, the folder not.
fn one_by_one(folder: &Path, files: &Files<'_>, ours: &[&str]) -> Result<()> {
    fs::create_dir_all(folder)?;
    for (name, bytes) in files {
        ingest::write_whole(&folder.join(name), bytes)?;
    }
    for name in ours.iter().filter(|name| files.iter().all(|(new, _)| new != *name)) {
        match fs::remove_file(folder.join(name)) {
            Err(error) if error.kind() != ErrorKind::NotFound => return Err(error),
            _ => {}
        }
    }
    Ok(())
}

fn move_others(from: &Path, to: &Path, ours: &[&str]) -> Result<()> {
    for entry in fs::read_dir(from)? {
        let entry = entry?;
        if !ours.iter().any(|name| entry.file_name() == *name) {
            fs::rename(entry.path(), to.join(entry.file_name()))?;
        }
    }
    Ok(())
}

fn write_synced(path: &Path, bytes: &[u8]) -> Result<()> {
    let mut file = File::create(path)?;
    file.write_all(bytes)?;
    file.sync_all()
}

/// Makes the names in a folder last, where the system can.
fn sync(folder: &Path) -> Result<()> {
    if cfg!(unix) { File::open(folder)?.sync_all() } else { Ok(()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    const OURS: [&str; 3] = ["a", "b", "c"];

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<String> =
            fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    #[test]
    fn prop_a_folder_is_replaced_and_strangers_stay() {
        let scratch = tempfile::tempdir().unwrap();
        let (folder, keep) = (scratch.path().join("x/report"), scratch.path().join("db"));
        replace(&folder, &[("a", b"1"), ("b", b"1")], &OURS, &[&keep]).unwrap();
        fs::write(folder.join("notes"), "mine").unwrap();
        replace(&folder, &[("a", b"2"), ("c", b"2")], &OURS, &[&keep]).unwrap();
        assert_eq!(names(&folder), ["a", "c", "notes"]);
        assert_eq!(names(&scratch.path().join("x")), ["report"]);
        // Where the database lies inside, the folder stays.
        fs::write(folder.join("db"), "").unwrap();
        replace(&folder, &[("b", b"3")], &OURS, &[&keep, &folder.join("db")]).unwrap();
        assert_eq!(names(&folder), ["b", "db", "notes"]);
    }

    #[test]
    fn prop_what_a_killed_writer_left_is_put_right() {
        let scratch = tempfile::tempdir().unwrap();
        let [folder, new, old] = ["report", "report.new", "report.old"].map(|name| scratch.path().join(name));
        // Killed between the two renames, when half of the strangers had come along.
        for path in [&new, &old] {
            fs::create_dir(path).unwrap();
            fs::write(path.join("a"), "").unwrap();
        }
        fs::write(new.join("notes"), "mine").unwrap();
        fs::write(old.join("more"), "mine").unwrap();
        replace(&folder, &[("b", b"1")], &OURS, &[&scratch.path().join("db")]).unwrap();
        assert_eq!(names(&folder), ["b", "more", "notes"]);
        assert_eq!(names(scratch.path()), ["report"]);
    }

    #[cfg(unix)]
    #[test]
    fn prop_a_link_stays_a_link() {
        let scratch = tempfile::tempdir().unwrap();
        let [real, link] = ["real", "report"].map(|name| scratch.path().join(name));
        fs::create_dir(&real).unwrap();
        std::os::unix::fs::symlink(&real, &link).unwrap();
        replace(&link, &[("a", b"1")], &OURS, &[&scratch.path().join("db")]).unwrap();
        assert!(link.is_symlink());
        assert_eq!(names(&real), ["a"]);
    }
}
