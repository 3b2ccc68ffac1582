//! Checksums as they are published.

use md5::Md5;
use sha2::{Digest, Sha256};
use std::fs::File;
use std::io::{BufReader, Read};
use std::path::Path;
use std::str::FromStr;

/// A published checksum, written `sha256:…` or `md5:…`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Checksum {
    kind: Kind,
    hex: String,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Sha256,
    Md5,
}

/// Text that is no checksum.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{0:?} is no checksum; write \"sha256:\" and 64, or \"md5:\" and 32 hexadecimal digits")]
pub struct ChecksumError(String);

impl FromStr for Checksum {
    type Err = ChecksumError;

    fn from_str(text: &str) -> Result<Self, ChecksumError> {
        let error = || ChecksumError(text.to_owned());
        let (kind, hex) = text.split_once(':').ok_or_else(error)?;
        let (kind, digits) = match kind {
            "sha256" => (Kind::Sha256, 64),
            "md5" => (Kind::Md5, 32),
            _ => return Err(error()),
        };
        if hex.len() != digits || !hex.bytes().all(|b| b.is_ascii_hexdigit()) {
            return Err(error());
        }
        Ok(Self { kind, hex: hex.to_lowercase() })
    }
}

impl Checksum {
    /// The checksum of a file where it is another one.
    pub(crate) fn differs(&self, path: &Path) -> std::io::Result<Option<String>> {
        let found = match self.kind {
            Kind::Sha256 => hex::<Sha256>(path)?,
            Kind::Md5 => hex::<Md5>(path)?,
        };
        Ok((found != self.hex).then_some(found))
    }

    pub(crate) fn hex(&self) -> &str {
        &self.hex
    }
}

fn hex<D: Digest>(path: &Path) -> std::io::Result<String> {
    let (mut reader, mut digest, mut buffer) = (BufReader::new(File::open(path)?), D::new(), vec![0; 1 << 16]);
    loop {
        match reader.read(&mut buffer)? {
            0 => break,
            n => digest.update(&buffer[..n]),
        }
    }
    Ok(digest.finalize().iter().map(|byte| format!("{byte:02x}")).collect())
}
