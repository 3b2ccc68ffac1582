//! Finding files, reading their bytes, and writing them whole.

use flate2::read::MultiGzDecoder;
use std::fs::{File, Metadata};
use std::io::{BufReader, Read, Seek, SeekFrom};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime, UNIX_EPOCH};
use zip::ZipArchive;

use crate::{Finding, FindingKind, IngestError};

/// Largest file or archive entry that is read: five times the longest mission of ZTBus. What claims more, or unpacks
/// to more, is refused before it fills the memory.
pub(crate) const MAX_BYTES: u64 = 128 << 20;

/// Largest buffer that a reader keeps for the next file: four usual missions.
const LARGEST_KEPT: usize = 32 << 20;

/// So many bytes are hashed while the processor still has them at hand.
const HASHED_AT_ONCE: u64 = 256 << 10;

/// What tells an unchanged file from a changed one without reading it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FileStamp {
    /// Size in bytes.
    pub bytes: u64,
    /// Time of the last modification in ns since 1970.
    pub modified_ns: i64,
    /// Number of the file in its file system; 0 where the system has none.
    pub inode: u64,
}

/// A file that was modified less than this long ago can be modified again without a new time.
const SETTLED: Duration = Duration::from_secs(2);

impl FileStamp {
    /// The stamp of a file; `None` where there is no such file or the system does not tell.
    #[must_use]
    pub fn of(path: &Path) -> Option<Self> {
        Self::new(&std::fs::metadata(path).ok()?)
    }

    fn new(metadata: &Metadata) -> Option<Self> {
        let since_1970 = metadata.modified().ok()?.duration_since(UNIX_EPOCH).ok()?;
        let modified_ns = i64::try_from(since_1970.as_nanos()).ok()?;
        Some(Self { bytes: metadata.len(), modified_ns, inode: inode(metadata) })
    }

    /// The stamp of a file that is about to be read, where it will vouch for what is read.
    fn settled(metadata: &Metadata) -> Option<Self> {
        let age = SystemTime::now().duration_since(metadata.modified().ok()?).ok()?;
        if age < SETTLED { None } else { Self::new(metadata) }
    }
}

#[cfg(unix)]
fn inode(metadata: &Metadata) -> u64 {
    std::os::unix::fs::MetadataExt::ino(metadata)
}

#[cfg(not(unix))]
fn inode(_: &Metadata) -> u64 {
    0
}

/// Reads files one after the other; keeps a buffer and an open archive from one to the next.
#[derive(Default)]
pub struct FileReader {
    buffer: Vec<u8>,
    archive: Option<(PathBuf, Archive)>,
}

/// An open archive.
type Archive = ZipArchive<BufReader<File>>;

/// The bytes of a file and their hash.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Content {
    /// The bytes.
    pub bytes: Vec<u8>,
    /// BLAKE3 of the bytes, hexadecimal.
    pub blake3: String,
    /// The file as it was before it was read; `None` where that vouches for nothing.
    pub stamp: Option<FileStamp>,
}

impl Content {
    /// Bytes with their hash.
    #[must_use]
    pub fn new(bytes: Vec<u8>) -> Self {
        let hash = blake3::hash(&bytes);
        Self::hashed(bytes, hash)
    }

    fn hashed(bytes: Vec<u8>, hash: blake3::Hash) -> Self {
        Self { bytes, blake3: hash.to_hex().to_string(), stamp: None }
    }

    /// Reads a file.
    ///
    /// # Errors
    /// A finding that says why it cannot be read.
    pub fn read(path: &Path) -> Result<Self, Finding> {
        FileReader::default().read(path)
    }
}

impl FileReader {
    /// Reads a file.
    ///
    /// # Errors
    /// A finding that says why it cannot be read.
    pub(crate) fn read(&mut self, path: &Path) -> Result<Content, Finding> {
        let (file, metadata) = open_regular(path)?;
        let content = limited(file, metadata.len(), std::mem::take(&mut self.buffer))?;
        Ok(Content { stamp: FileStamp::settled(&metadata), ..content })
    }

    /// Reads pieces of a file, one after the other.
    ///
    /// # Errors
    /// A finding that says why they cannot be read.
    pub(crate) fn read_pieces(&mut self, path: &Path, pieces: &[Range<usize>]) -> Result<Content, Finding> {
        let (mut file, metadata) = open_regular(path)?;
        let mut bytes = std::mem::take(&mut self.buffer);
        bytes.clear();
        for piece in pieces {
            let read = file.seek(SeekFrom::Start(piece.start as u64));
            read.and_then(|_| (&file).take(piece.len() as u64).read_to_end(&mut bytes)).map_err(|e| unreadable(&e))?;
        }
        Ok(Content { stamp: FileStamp::settled(&metadata), ..Content::new(bytes) })
    }

    /// Reads a file that is compressed by gzip.
    ///
    /// # Errors
    /// A finding that says why it cannot be read.
    pub(crate) fn read_gzip(&mut self, path: &Path) -> Result<Content, Finding> {
        let (file, metadata) = open_regular(path)?;
        let content = limited(unpacked(file), gzip_size(path), std::mem::take(&mut self.buffer))?;
        Ok(Content { stamp: FileStamp::settled(&metadata), ..content })
    }

    /// Reads an entry of an archive; the archive is opened once for all entries that follow each other.
    ///
    /// # Errors
    /// A finding that says why it cannot be read.
    pub(crate) fn read_entry(&mut self, path: &Path, index: usize) -> Result<Content, Finding> {
        let metadata = std::fs::metadata(path).map_err(|e| unreadable(&e))?;
        let archive = match self.archive.take() {
            Some((open, archive)) if open == path => archive,
            _ => open_archive(path).map_err(|e| unreadable(&e))?,
        };
        let (_, archive) = self.archive.insert((path.to_owned(), archive));
        let entry = archive.by_index(index).map_err(|e| unreadable(&e))?;
        let size = entry.size();
        let content = limited(entry, size, std::mem::take(&mut self.buffer))?;
        Ok(Content { stamp: FileStamp::settled(&metadata), ..content })
    }

    /// Takes back the bytes of a file that is done with, unless they are unusually many.
    pub fn recycle(&mut self, content: Content) {
        if content.bytes.capacity() <= LARGEST_KEPT {
            self.buffer = content.bytes;
        }
    }
}

/// Opens a file; a pipe would be waited for without end.
pub(crate) fn open_regular(path: &Path) -> Result<(File, Metadata), Finding> {
    if std::fs::metadata(path).is_ok_and(|m| !m.is_file()) {
        return Err(Finding::whole(FindingKind::Unreadable, "not a regular file; give a file"));
    }
    let file = File::open(path).map_err(|e| unreadable(&e))?;
    let metadata = file.metadata().map_err(|e| unreadable(&e))?;
    Ok((file, metadata))
}

/// How many bytes a file that is compressed by gzip claims to hold: its last four say it, modulo 4 GiB (RFC 1952, section
/// 2.3.1). Where they say less than the file has, they are those of the last of several parts; telemetry shrinks to a tenth.
pub(crate) fn gzip_size(path: &Path) -> u64 {
    let said = || {
        let mut file = open_regular(path).ok()?.0;
        let length = file.seek(SeekFrom::End(0)).ok()?;
        file.seek(SeekFrom::End(-4)).ok()?;
        let mut last = [0; 4];
        file.read_exact(&mut last).ok()?;
        let size = u64::from(u32::from_le_bytes(last));
        Some(if size < length { 12 * length } else { size })
    };
    // A broken file says anything.
    said().unwrap_or(0).min(MAX_BYTES)
}

/// What a file that is compressed by gzip holds.
pub(crate) fn unpacked(file: File) -> impl Read {
    MultiGzDecoder::new(BufReader::new(file))
}

/// The first bytes of a file.
pub(crate) fn head_of(source: impl Read, most: usize) -> Result<Vec<u8>, Finding> {
    let mut bytes = Vec::new();
    source.take(most as u64).read_to_end(&mut bytes).map_err(|e| unreadable(&e))?;
    Ok(bytes)
}

fn limited(source: impl Read, size: u64, mut bytes: Vec<u8>) -> Result<Content, Finding> {
    let too_large = || {
        let message = format!(
            "it holds more than {} MiB, as no mission and no weather file does; split a table of many by vehicle or month",
            MAX_BYTES >> 20
        );
        Finding::whole(FindingKind::Unreadable, message)
    };
    if size > MAX_BYTES {
        return Err(too_large());
    }
    // And room to see that there is no more.
    let room = usize::try_from(size).unwrap_or(0) + 64;
    bytes.clear();
    if bytes.capacity() < room {
        // A larger one in its place, which need not be copied, with room for the next file.
        bytes = Vec::with_capacity(room.next_power_of_two());
    }
    let (mut source, mut hasher, mut hashed) = (source.take(MAX_BYTES + 1), blake3::Hasher::new(), 0);
    while source.by_ref().take(HASHED_AT_ONCE).read_to_end(&mut bytes).map_err(|e| unreadable(&e))? > 0 {
        hasher.update(&bytes[hashed..]);
        hashed = bytes.len();
    }
    if bytes.len() as u64 > MAX_BYTES {
        return Err(too_large());
    }
    Ok(Content::hashed(bytes, hasher.finalize()))
}

pub(crate) fn unreadable(error: &dyn std::error::Error) -> Finding {
    Finding::whole(FindingKind::Unreadable, format!("cannot be read: {error}; check the file and its permissions"))
}

/// Writes beside the place and renames, so that a file that is there is whole.
///
/// # Errors
/// What the system says.
pub fn write_whole(path: &Path, bytes: &[u8]) -> std::io::Result<()> {
    let mut beside = path.as_os_str().to_owned();
    beside.push(".part");
    std::fs::write(&beside, bytes).and_then(|()| std::fs::rename(&beside, path))
}

/// Opens an archive; its entries are read one by one, nothing is unpacked to disk.
pub(crate) fn open_archive(path: &Path) -> Result<Archive, zip::result::ZipError> {
    ZipArchive::new(BufReader::new(File::open(path)?))
}

/// Whether a file is a whole zip archive.
///
/// # Errors
/// What is wrong with it.
pub fn check_archive(path: &Path) -> Result<(), String> {
    open_archive(path).map(drop).map_err(|error| error.to_string())
}

/// What a path of the study names: all that lies in a folder, the matches of a glob, or one file; sorted.
pub(crate) fn list(base: &Path, pattern: &str) -> Result<Vec<PathBuf>, IngestError> {
    let path = base.join(pattern);
    let error = |reason: String| IngestError::Path { path: path.clone(), reason };
    let mut files = Vec::new();
    if path.is_dir() {
        for entry in std::fs::read_dir(&path).map_err(|e| error(e.to_string()))? {
            files.push(entry.map_err(|e| error(e.to_string()))?.path());
        }
    } else if path.exists() {
        files.push(path.clone());
    } else if pattern.contains(['*', '?', '[']) {
        let base = glob::Pattern::escape(&base.to_string_lossy());
        let full = Path::new(&base).join(pattern);
        for entry in glob::glob(&full.to_string_lossy()).map_err(|e| error(format!("not a valid pattern: {e}")))? {
            files.push(entry.map_err(|e| error(e.to_string()))?);
        }
    } else {
        return Err(error("there is no such file or folder".to_owned()));
    }
    files.sort();
    Ok(files)
}

/// A path as the study names it: relative to the study file where it lies below it.
pub(crate) fn label(base: &Path, path: &Path) -> String {
    path.strip_prefix(base).unwrap_or(path).to_string_lossy().replace('\\', "/")
}

/// Columns of a table at most: ten times those of ZTBus. Each one costs a parser memory before anybody looks at it.
const MOST_COLUMNS: usize = 1000;
/// Longest line in bytes: two hundred times those of ZTBus.
pub(crate) const LONGEST_LINE: usize = 64 << 10;

/// Refuses a table whose lines would fill the memory while they are parsed: too long, too many, or too many columns.
///
/// # Errors
/// A finding with the line and the limit.
pub fn check_lines(bytes: &[u8], separator: u8, most_rows: usize) -> Result<(), Finding> {
    check_header(bytes, separator)?;
    let (mut start, mut line) = (0, 0);
    for end in memchr::memchr_iter(b'\n', bytes).chain([bytes.len()]) {
        line += 1;
        check_length(line, end - start)?;
        start = end + 1;
    }
    if line > most_rows + 2 {
        return too_much(most_rows + 2, format!("more than {most_rows} rows; no such file holds as many"));
    }
    Ok(())
}

/// The same of the header alone.
pub(crate) fn check_header(bytes: &[u8], separator: u8) -> Result<(), Finding> {
    let header = bytes.split(|&b| b == b'\n').next().unwrap_or_default();
    check_length(1, header.len())?;
    let columns = memchr::memchr_iter(separator, header).count() + 1;
    if columns > MOST_COLUMNS {
        return too_much(1, format!("{columns} columns; at most {MOST_COLUMNS} are read"));
    }
    Ok(())
}

fn check_length(line: usize, bytes: usize) -> Result<(), Finding> {
    if bytes > LONGEST_LINE {
        return too_much(line, format!("a line of {bytes} bytes; at most {LONGEST_LINE} are read"));
    }
    Ok(())
}

fn too_much(line: usize, message: String) -> Result<(), Finding> {
    Err(Finding::whole(FindingKind::Unreadable, message).at_line(line as u64))
}

/// The lower-case extension of a path.
pub(crate) fn extension(path: &Path) -> String {
    path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default()
}

/// Refuses what is no text in UTF-8 or a superset of ASCII, with the line of the first bad byte.
pub(crate) fn check_text(bytes: &[u8], utf8: bool) -> Result<(), Finding> {
    let finding = |message: String, at: usize| {
        let line = 1 + bytes[..at].iter().filter(|&&b| b == b'\n').count() as u64;
        Err(Finding::whole(FindingKind::WrongEncoding, message).at_line(line))
    };
    if bytes.iter().all(u8::is_ascii_whitespace) {
        let message = "the file is empty; fetch or export it again";
        return Err(Finding::whole(FindingKind::Empty, message).at_line(1));
    }
    if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
        return finding("the file is UTF-16; save it as UTF-8".to_owned(), 0);
    }
    if let Some(at) = memchr::memchr(0, &bytes[..bytes.len().min(1 << 16)]) {
        return finding("the file holds zero bytes; it is not text, or UTF-16: save it as UTF-8".to_owned(), at);
    }
    if utf8
        && simdutf8::basic::from_utf8(bytes).is_err()
        && let Err(error) = std::str::from_utf8(bytes)
    {
        let at = error.valid_up_to();
        let message = format!("byte 0x{:02x} is not UTF-8; convert the file to UTF-8", bytes[at]);
        return finding(message, at);
    }
    Ok(())
}

/// Positions of the wanted columns in a header, or what is wrong with it.
pub(crate) fn find_columns(
    header: &csv::StringRecord,
    wanted: &[&str],
    separator: char,
) -> Result<Vec<usize>, Finding> {
    let mut positions = Vec::with_capacity(wanted.len());
    for name in wanted {
        if let Some(position) = header.iter().position(|h| h.trim() == *name) {
            positions.push(position);
            continue;
        }
        let other = [';', ',', '\t', '|'].into_iter().find(|&s| s != separator && header.iter().any(|h| h.contains(s)));
        if let (Some(other), true) = (other, header.len() <= 2) {
            let message =
                format!("columns are separated by {other:?}, but {separator:?} belongs there; convert the file");
            return Err(Finding::whole(FindingKind::WrongDelimiter, message).at_line(1));
        }
        let found: String = header.iter().map(str::trim).collect::<Vec<_>>().join(", ").chars().take(400).collect();
        let message = format!("the column is missing; the file has: {found}");
        return Err(Finding::whole(FindingKind::MissingColumn, message).at_line(1).in_column(name));
    }
    Ok(positions)
}
