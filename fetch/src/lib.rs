//! Downloads a file whole or not at all.
//!
//! What has come so far lies beside the place as `NAME.part`, with what tells the server's version of it in
//! `NAME.part.from`: a download that was cut goes on from there, if the server still has that version. What is complete is
//! checked and then renamed, so that a file in its place is whole. Proxies are those of the usual environment variables.

mod attempt;
mod checksum;
mod error;
mod place;

use std::path::Path;
use std::time::Duration;

pub use checksum::{Checksum, ChecksumError};
pub use error::FetchError;

use attempt::{Attempt, Failed};
use place::Place;

/// A file to be fetched.
pub struct Download<'a> {
    /// Its address, `http` or `https`.
    pub url: &'a str,
    /// Where it belongs.
    pub to: &'a Path,
    /// Its size in bytes, where it is published.
    pub bytes: Option<u64>,
    /// Its checksum, where it is published.
    pub checksum: Option<&'a Checksum>,
    /// Says what is wrong with a complete file, such as one that is no archive.
    pub check: &'a (dyn Fn(&Path) -> Result<(), String> + Sync),
}

/// How patient a download is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Patience {
    /// How long to wait for a connection, an answer, or the next bytes.
    pub timeout: Duration,
    /// How often to try.
    pub attempts: u32,
    /// How long to wait before the second attempt; twice as long before each further one, or as the server asks, at most a
    /// minute.
    pub pause: Duration,
}

impl Default for Patience {
    fn default() -> Self {
        Self { timeout: Duration::from_secs(30), attempts: 5, pause: Duration::from_millis(500) }
    }
}

/// What came of a download.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fetched {
    /// The file is there now, so many bytes.
    New(u64),
    /// The server has none that is newer.
    Unchanged,
}

/// The longest pause between attempts.
const LONGEST_PAUSE: Duration = Duration::from_secs(60);

/// Fetches a file. `progress` is told how many bytes of how many are there, and says whether to go on.
///
/// # Errors
/// [`FetchError`]; what has come so far stays for the next time, unless it is wrong.
pub fn download(
    file: &Download<'_>,
    patience: Patience,
    progress: &mut dyn FnMut(u64, Option<u64>) -> bool,
) -> Result<Fetched, FetchError> {
    let place = Place::of(file.to)?;
    let agent = ureq::Agent::config_builder()
        .timeout_connect(Some(patience.timeout))
        .timeout_recv_response(Some(patience.timeout))
        .timeout_per_read(Some(patience.timeout))
        .http_status_as_error(false)
        .max_redirects(5)
        .accept_encoding("identity")
        .user_agent(concat!("busclimate/", env!("CARGO_PKG_VERSION")))
        .build()
        .new_agent();
    let mut pause = patience.pause;
    for number in 1.. {
        let attempt = Attempt { file, place: &place, agent: &agent };
        match attempt.make(progress) {
            Ok(fetched) => return Ok(fetched),
            Err(Failed::Final(error)) => return Err(error),
            Err(Failed::Passing { reason, wait }) => {
                if number >= patience.attempts {
                    return Err(FetchError::GaveUp { url: file.url.to_owned(), attempts: number, reason });
                }
                std::thread::sleep(wait.unwrap_or(pause).min(LONGEST_PAUSE));
                pause *= 2;
            }
        }
    }
    unreachable!("the attempts end with a result")
}
