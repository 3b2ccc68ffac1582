//! One attempt at a download.

use std::io::{Read, Write};
use std::time::Duration;
use ureq::http::{Response, StatusCode, header};
use ureq::{Agent, Body};

use crate::place::Place;
use crate::{Download, FetchError, Fetched};

/// Bytes that are written at a time.
const CHUNK: usize = 1 << 16;

pub(crate) struct Attempt<'a> {
    pub file: &'a Download<'a>,
    pub place: &'a Place,
    pub agent: &'a Agent,
}

/// How an attempt failed.
pub(crate) enum Failed {
    /// It will not go better another time.
    Final(FetchError),
    /// It may; not before so long, if the server says so.
    Passing { reason: String, wait: Option<Duration> },
}

impl Failed {
    fn passing(reason: impl Into<String>) -> Self {
        Self::Passing { reason: reason.into(), wait: None }
    }
}

impl Attempt<'_> {
    pub fn make(&self, progress: &mut dyn FnMut(u64, Option<u64>) -> bool) -> Result<Fetched, Failed> {
        let begun = self.place.begun();
        let mut request = self.agent.get(self.file.url);
        if let Some((bytes, version)) = &begun {
            request = request.header(header::RANGE, format!("bytes={bytes}-")).header(header::IF_RANGE, version);
        } else if let Some(modified) = self.place.modified() {
            request = request.header(header::IF_MODIFIED_SINCE, modified);
        }
        let response = request.call().map_err(|error| self.failed(&error))?;
        let (bytes, total) = match (response.status(), &begun) {
            (StatusCode::NOT_MODIFIED, None) => return Ok(Fetched::Unchanged),
            (StatusCode::OK, _) => (0, response.body().content_length()),
            (StatusCode::PARTIAL_CONTENT, Some((bytes, _))) => match content_range(&response) {
                Some((Some(start), total)) if start == *bytes => (*bytes, total),
                _ => {
                    self.place.discard();
                    return Err(Failed::passing("the server sent another part than was asked for"));
                }
            },
            (StatusCode::RANGE_NOT_SATISFIABLE, Some((bytes, _))) => {
                if content_range(&response) == Some((None, Some(*bytes))) {
                    return self.complete(None);
                }
                self.place.discard();
                return Err(Failed::passing("the server has another file by now"));
            }
            _ => return Err(self.refused(&response)),
        };
        let is_page = response.body().mime_type().is_some_and(|mime| mime.eq_ignore_ascii_case("text/html"));
        if is_page {
            return Err(self.wrong("the server sent a web page instead of the file; check the address in a browser"));
        }
        if let (Some(said), Some(expected)) = (total, self.file.bytes)
            && said != expected
        {
            return Err(self.wrong(&format!("the server says {said} bytes, but {expected} are published")));
        }
        let text = |name| response.headers().get(name).and_then(|value| value.to_str().ok()).map(str::to_owned);
        let last_modified = text(header::LAST_MODIFIED);
        if bytes == 0 {
            let strong = text(header::ETAG).filter(|tag| !tag.starts_with("W/"));
            let version = strong.or_else(|| last_modified.clone());
            drop(self.place.begin(version.as_deref()).map_err(|e| self.unwritable(e))?);
        }
        self.receive(response, bytes, total, progress)?;
        self.complete(last_modified.as_deref())
    }

    fn receive(
        &self,
        response: Response<Body>,
        mut bytes: u64,
        total: Option<u64>,
        progress: &mut dyn FnMut(u64, Option<u64>) -> bool,
    ) -> Result<(), Failed> {
        let mut part = self.place.go_on().map_err(|e| self.unwritable(e))?;
        let (mut body, mut chunk) = (response.into_body().into_with_config().limit(u64::MAX).reader(), vec![0; CHUNK]);
        loop {
            if !progress(bytes, total) {
                return Err(Failed::Final(FetchError::Interrupted));
            }
            match body.read(&mut chunk) {
                Ok(0) => break,
                Ok(n) => {
                    part.write_all(&chunk[..n]).map_err(|e| self.unwritable(e))?;
                    bytes += n as u64;
                }
                Err(error) => return Err(Failed::passing(format!("the transfer broke after {bytes} bytes: {error}"))),
            }
        }
        match total {
            Some(total) if total != bytes => {
                Err(Failed::passing(format!("the transfer ended after {bytes} of {total} bytes")))
            }
            _ => Ok(()),
        }
    }

    /// Checks what is complete, and puts it into its place.
    fn complete(&self, last_modified: Option<&str>) -> Result<Fetched, Failed> {
        let part = self.place.part();
        let bytes = part.metadata().map_err(|e| self.unwritable(e))?.len();
        if let Some(expected) = self.file.bytes.filter(|expected| *expected != bytes) {
            return Err(self.wrong(&format!("{bytes} bytes came, but {expected} are published")));
        }
        if let Some(checksum) = self.file.checksum
            && let Some(found) = checksum.differs(part).map_err(|e| self.unwritable(e))?
        {
            return Err(self.wrong(&format!("its checksum is {found}, but {} is published", checksum.hex())));
        }
        (self.file.check)(part).map_err(|reason| self.wrong(&reason))?;
        self.place.finish(last_modified).map_err(|e| self.unwritable(e))?;
        Ok(Fetched::New(bytes))
    }

    fn unwritable(&self, source: std::io::Error) -> Failed {
        Failed::Final(self.place.error(source))
    }

    fn wrong(&self, reason: &str) -> Failed {
        self.place.discard();
        Failed::Final(FetchError::Wrong { url: self.file.url.to_owned(), reason: reason.to_owned() })
    }

    /// What a status other than those asked for means.
    fn refused(&self, response: &Response<Body>) -> Failed {
        let status = response.status();
        if status == StatusCode::TOO_MANY_REQUESTS || status == StatusCode::REQUEST_TIMEOUT || status.is_server_error()
        {
            let after = response.headers().get(header::RETRY_AFTER);
            let seconds = after.and_then(|value| value.to_str().ok()?.trim().parse().ok());
            return Failed::Passing {
                reason: format!("the server answers {status}"),
                wait: seconds.map(Duration::from_secs),
            };
        }
        let reason = format!("the server answers {status}; check the address in [fetch] of the study");
        Failed::Final(FetchError::Refused { url: self.file.url.to_owned(), reason })
    }

    fn failed(&self, error: &ureq::Error) -> Failed {
        match error {
            ureq::Error::BadUri(_)
            | ureq::Error::Http(_)
            | ureq::Error::TooManyRedirects
            | ureq::Error::InvalidProxyUrl => {
                let reason = format!("{error}; check the address in [fetch] of the study");
                Failed::Final(FetchError::Refused { url: self.file.url.to_owned(), reason })
            }
            other => Failed::passing(other.to_string()),
        }
    }
}

/// Start and total of a part of a file.
fn content_range(response: &Response<Body>) -> Option<(Option<u64>, Option<u64>)> {
    let text = response.headers().get(header::CONTENT_RANGE)?.to_str().ok()?;
    let (range, total) = text.trim().strip_prefix("bytes ")?.split_once('/')?;
    let start = range.split_once('-').and_then(|(start, _)| start.trim().parse().ok());
    Some((start, total.trim().parse().ok()))
}
