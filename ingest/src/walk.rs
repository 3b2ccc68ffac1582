//! What lies where a study says that inputs are: files, compressed ones, and entries of archives, in folders with all below.

use std::collections::BTreeSet;
use std::ffi::OsStr;
use std::ops::Range;
use std::path::{Component, Path, PathBuf};

use crate::files::{extension, gzip_size, head_of, label, list, open_archive, open_regular, unpacked, unreadable};
use crate::{Content, FileReader, FileStamp, Finding, FindingKind, IngestError};

/// Folders in folders that are looked into at most.
const DEEPEST: usize = 8;
/// Archives that are not read.
const PACKED: [&str; 8] = ["gz", "7z", "tar", "tgz", "bz2", "xz", "zst", "rar"];

/// A file that was found.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Found {
    /// Path as the study names it; the entry of an archive follows a `!`.
    pub label: String,
    /// Its name, without the extension of a compressed file.
    pub name: String,
    pub place: Place,
}

/// Where the bytes of a file are.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Place {
    File(PathBuf),
    Gzip(PathBuf),
    Entry { archive: PathBuf, index: usize, bytes: u64 },
}

/// What was found.
#[derive(Debug, Default)]
pub(crate) struct Walk {
    pub found: Vec<Found>,
    /// Label and finding of what cannot be used.
    pub refused: Vec<(String, Finding)>,
}

/// Finds the files with one of some extensions in a folder with all below it, and in archives (`.zip`); all files that a glob
/// or a name says. Each may be compressed (`.gz`). What operating systems leave beside files is not looked at; archives that
/// are not read, links that lead nowhere and folders that cannot be read are refused with a finding.
///
/// # Errors
/// [`IngestError`] where the path does not exist.
pub(crate) fn walk(base: &Path, pattern: &str, extensions: &[&str]) -> Result<Walk, IngestError> {
    let mut walk = Walk::default();
    let in_folder = base.join(pattern).is_dir();
    let search = Search { base, extensions };
    let mut above: Vec<PathBuf> = base.join(pattern).canonicalize().into_iter().filter(|_| in_folder).collect();
    for path in list(base, pattern)? {
        search.take(&path, &mut above, !in_folder, &mut walk);
    }
    Ok(walk)
}

/// Whether an operating system has left a file beside those of people.
fn is_left_over(path: &Path) -> bool {
    let starts = |name: &OsStr| {
        let name = name.to_string_lossy();
        name.starts_with("._") || name == ".DS_Store" || name == "__MACOSX"
    };
    path.components().any(|part| matches!(part, Component::Normal(name) if starts(name)))
}

struct Search<'a> {
    base: &'a Path,
    extensions: &'a [&'a str],
}

impl Search<'_> {
    /// A file, or a folder with all in it. A file that is `named` counts whatever its extension.
    /// `above` are the folders that it lies in.
    fn take(&self, path: &Path, above: &mut Vec<PathBuf>, named: bool, walk: &mut Walk) {
        let label = label(self.base, path);
        if is_left_over(Path::new(&label)) {
            return;
        }
        if path.is_dir() {
            return self.take_folder(path, above, walk);
        }
        if path.is_symlink() && !path.exists() {
            let message = "the link leads nowhere; its target is gone: bring it back, or remove the link";
            return walk.refuse(label, FindingKind::Unreadable, message);
        }
        let inner = path.with_extension("");
        match extension(path).as_str() {
            "zip" => self.take_archive(path, walk),
            "gz" if self.is_wanted(&inner) || (named && extension(&inner) != "tar") => {
                walk.take(label, &inner, Place::Gzip(path.to_owned()));
            }
            other if PACKED.contains(&other) => walk.refuse_packed(label),
            _ if named || self.is_wanted(path) => walk.take(label, path, Place::File(path.to_owned())),
            _ => {}
        }
    }

    fn is_wanted(&self, path: &Path) -> bool {
        self.extensions.contains(&extension(path).as_str())
    }

    fn take_folder(&self, path: &Path, above: &mut Vec<PathBuf>, walk: &mut Walk) {
        let real = path.canonicalize().unwrap_or_else(|_| path.to_owned());
        if above.contains(&real) {
            let message = "a link to a folder above it; nothing in it is read: remove it";
            return walk.refuse(label(self.base, path), FindingKind::Unreadable, message);
        }
        if above.len() > DEEPEST {
            let message = format!("more than {DEEPEST} folders in each other; nothing in it is read");
            return walk.refuse(label(self.base, path), FindingKind::Unreadable, &message);
        }
        let listed = std::fs::read_dir(path)
            .and_then(|entries| entries.map(|entry| Ok(entry?.path())).collect::<std::io::Result<BTreeSet<PathBuf>>>());
        match listed {
            Ok(inside) => {
                above.push(real);
                inside.iter().for_each(|path| self.take(path, above, false, walk));
                above.pop();
            }
            Err(error) => {
                let message = format!("the folder cannot be read: {error}; check its permissions");
                walk.refuse(label(self.base, path), FindingKind::Unreadable, &message);
            }
        }
    }

    fn take_archive(&self, path: &Path, walk: &mut Walk) {
        let label = label(self.base, path);
        let mut archive = match open_archive(path) {
            Ok(archive) => archive,
            Err(error) => {
                let message = format!("not a readable zip archive: {error}; fetch it again");
                return walk.refuse(label, FindingKind::Unreadable, &message);
            }
        };
        for index in 0..archive.len() {
            let (entry_label, inside, bytes) = match archive.by_index_raw(index) {
                Ok(entry) if entry.is_dir() => continue,
                Ok(entry) => {
                    let name = String::from_utf8_lossy(entry.name_raw()).into_owned();
                    (format!("{label}!{name}"), entry.enclosed_name(), entry.size())
                }
                Err(error) => {
                    let message = format!("the entry cannot be read: {error}; fetch the archive again");
                    walk.refuse(format!("{label}!{index}"), FindingKind::Unreadable, &message);
                    continue;
                }
            };
            match inside {
                Some(file) if is_left_over(&file) => {}
                Some(file) if self.is_wanted(&file) => {
                    walk.take(entry_label, &file, Place::Entry { archive: path.to_owned(), index, bytes });
                }
                Some(file) if extension(&file) == "zip" || PACKED.contains(&extension(&file).as_str()) => {
                    walk.refuse_packed(entry_label);
                }
                Some(_) => {}
                None => {
                    let message =
                        "its path leads out of the archive; such an archive is broken or hostile: fetch it again";
                    walk.refuse(entry_label, FindingKind::UnsafePath, message);
                }
            }
        }
    }
}

impl Walk {
    fn take(&mut self, label: String, file: &Path, place: Place) {
        let name = file.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        self.found.push(Found { label, name, place });
    }

    fn refuse_packed(&mut self, label: String) {
        self.refuse(label, FindingKind::Unreadable, "such an archive is not read; unpack it");
    }

    fn refuse(&mut self, label: String, kind: FindingKind, message: &str) {
        self.refused.push((label, Finding::whole(kind, message)));
    }
}

impl Place {
    /// Reads the bytes.
    ///
    /// # Errors
    /// A finding that says why they cannot be read.
    pub fn read(&self, reader: &mut FileReader) -> Result<Content, Finding> {
        match self {
            Self::File(path) => reader.read(path),
            Self::Gzip(path) => reader.read_gzip(path),
            Self::Entry { archive, index, .. } => reader.read_entry(archive, *index),
        }
    }

    /// Reads pieces, one after the other.
    ///
    /// # Errors
    /// A finding that says why they cannot be read.
    pub fn read_pieces(&self, pieces: &[Range<usize>], reader: &mut FileReader) -> Result<Content, Finding> {
        if let Self::File(path) = self {
            return reader.read_pieces(path, pieces);
        }
        let whole = self.read(reader)?;
        let piece = |piece: &Range<usize>| whole.bytes.get(piece.clone()).unwrap_or_default();
        let pieces = Content::new(pieces.iter().map(piece).collect::<Vec<_>>().concat());
        let stamp = whole.stamp;
        reader.recycle(whole);
        Ok(Content { stamp, ..pieces })
    }

    /// The first bytes.
    ///
    /// # Errors
    /// A finding that says why they cannot be read.
    pub fn head(&self, bytes: usize) -> Result<Vec<u8>, Finding> {
        match self {
            Self::File(path) => head_of(open_regular(path)?.0, bytes),
            Self::Gzip(path) => head_of(unpacked(open_regular(path)?.0), bytes),
            Self::Entry { archive, index, .. } => {
                let mut archive = open_archive(archive).map_err(|e| unreadable(&e))?;
                let entry = archive.by_index(*index).map_err(|e| unreadable(&e))?;
                head_of(entry, bytes)
            }
        }
    }

    /// Size of the content in bytes, as the system or the archive says; 0 where it does not.
    pub fn bytes(&self) -> u64 {
        match self {
            Self::File(path) => std::fs::metadata(path).map_or(0, |m| m.len()),
            Self::Gzip(path) => gzip_size(path),
            Self::Entry { bytes, .. } => *bytes,
        }
    }

    /// The stamp of the file, or of the archive that it lies in.
    pub fn stamp(&self) -> Option<FileStamp> {
        match self {
            Self::File(path) | Self::Gzip(path) | Self::Entry { archive: path, .. } => FileStamp::of(path),
        }
    }
}
