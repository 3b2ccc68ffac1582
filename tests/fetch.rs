//! Downloads from a server that does what servers do: cuts off, stalls, lies, redirects, refuses.

#![expect(clippy::unwrap_used, reason = "a test ends where something is not as expected")]

use crate::common::Scratch;
use std::fmt::Write as _;
use std::io::{BufRead, BufReader, Write};
use std::net::{TcpListener, TcpStream};
use std::sync::{Arc, Mutex};
use std::time::Duration;

const MODIFIED: &str = "Wed, 01 Jan 2025 00:00:00 GMT";
const NAME: &str = "ogd-smn_sma_h_historical_2020-2029.csv";

/// What the server does with a request.
#[derive(Clone, Copy)]
enum Does {
    /// Serves the file, or the part that is asked for.
    Serves,
    /// Serves, but closes the connection after so many bytes of the body.
    CutsOffAfter(usize),
    /// Serves so many bytes and then nothing more.
    StallsAfter(usize),
    /// Says a length that is so much larger than what it sends.
    SaysMore(usize),
    /// Says a length that is so much smaller.
    SaysLess(usize),
    /// Ignores what part is asked for.
    ServesAll,
    /// Says a status without a body.
    Status(&'static str),
    /// Sends a page that says sorry.
    Page,
    /// Sends elsewhere on the same server.
    Redirects,
}

/// A server of one file, on a thread of its own.
struct Server {
    address: String,
    requests: Arc<Mutex<Vec<String>>>,
}

impl Server {
    /// The last deed is that of all further requests.
    fn of(body: &[u8], deeds: &[Does]) -> Self {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let address = format!("http://{}", listener.local_addr().unwrap());
        let requests = Arc::new(Mutex::new(Vec::new()));
        let (body, deeds, seen) = (body.to_vec(), deeds.to_vec(), Arc::clone(&requests));
        std::thread::spawn(move || {
            for (n, stream) in listener.incoming().enumerate() {
                let deed = deeds[n.min(deeds.len() - 1)];
                let (body, seen) = (body.clone(), Arc::clone(&seen));
                std::thread::spawn(move || answer(stream.unwrap(), deed, &body, &seen));
            }
        });
        Self { address, requests }
    }

    fn requests(&self) -> Vec<String> {
        self.requests.lock().unwrap().clone()
    }
}

fn answer(mut stream: TcpStream, deed: Does, body: &[u8], seen: &Mutex<Vec<String>>) {
    let mut request = String::new();
    for line in BufReader::new(stream.try_clone().unwrap()).lines() {
        let line = line.unwrap_or_default();
        if line.is_empty() {
            break;
        }
        request += &(line.to_lowercase() + "\n");
    }
    seen.lock().unwrap().push(request.clone());
    let from = request.lines().find_map(|l| l.strip_prefix("range: bytes=")?.trim_end_matches('-').parse().ok());
    let from: usize = from.filter(|_| !matches!(deed, Does::ServesAll)).unwrap_or(0);
    if matches!(deed, Does::Serves) && request.contains("if-modified-since: ") {
        let _ = stream.write_all(b"HTTP/1.1 304 Not Modified\r\nConnection: close\r\n\r\n");
        return;
    }
    if from >= body.len() && from > 0 {
        let head = format!("HTTP/1.1 416 Range Not Satisfiable\r\nContent-Range: bytes */{}\r\n", body.len());
        let _ = stream.write_all(format!("{head}Content-Length: 0\r\nConnection: close\r\n\r\n").as_bytes());
        return;
    }
    let rest = &body[from..];
    let (said, sent) = match deed {
        Does::CutsOffAfter(n) | Does::StallsAfter(n) => (rest.len(), n.min(rest.len())),
        Does::SaysMore(n) => (rest.len() + n, rest.len()),
        Does::SaysLess(n) => (rest.len() - n, rest.len()),
        _ => (rest.len(), rest.len()),
    };
    let mut head = String::new();
    let status = match deed {
        Does::Status(status) => status,
        Does::Redirects => "302 Found",
        _ if from > 0 => "206 Partial Content",
        _ => "200 OK",
    };
    let _ = write!(head, "HTTP/1.1 {status}\r\nConnection: close\r\n");
    match deed {
        Does::Status(_) => head += "Content-Length: 0\r\n\r\n",
        Does::Redirects => head += &format!("Location: /elsewhere/{NAME}\r\nContent-Length: 0\r\n\r\n"),
        Does::Page => head += "Content-Type: text/html; charset=utf-8\r\nContent-Length: 5\r\n\r\nsorry",
        _ => {
            let _ = write!(head, "Content-Length: {said}\r\nLast-Modified: {MODIFIED}\r\nETag: \"1\"\r\n");
            if from > 0 {
                let _ = write!(head, "Content-Range: bytes {from}-{}/{}\r\n", body.len() - 1, body.len());
            }
            head += "\r\n";
        }
    }
    let _ = stream.write_all(head.as_bytes());
    if !matches!(deed, Does::Status(_) | Does::Redirects | Does::Page) {
        let _ = stream.write_all(&rest[..sent]);
        let _ = stream.flush();
        if matches!(deed, Does::StallsAfter(_)) {
            std::thread::sleep(Duration::from_secs(5));
        }
    }
}

/// A file of MeteoSwiss, some 100 kB.
fn weather() -> Vec<u8> {
    let mut text = "station_abbr;reference_timestamp;tre200h0;gre000h0;ods000h0\n".to_owned();
    for n in 0..3000 {
        let _ = writeln!(text, "SMA;{:02}.01.2021 {:02}:00;{}.5;0;", 1 + n / 24 % 28, n % 24, n % 7);
    }
    text.into_bytes()
}

/// A study that takes its weather from a server.
fn study(server: &Server) -> Scratch {
    let scratch = Scratch::empty();
    scratch.expect(0, &["init", "."]);
    let text = scratch.read("study.toml");
    scratch.write("study.toml", format!("{text}\n[fetch]\nweather = [\"{}/{NAME}\"]\n", server.address));
    scratch
}

/// Cases that mostly wait.
fn side_by_side<T: Send, const N: usize>(cases: [T; N], check: impl Fn(T) + Sync) {
    std::thread::scope(|scope| cases.into_iter().for_each(|case| drop(scope.spawn(|| check(case)))));
}

const FETCH: [&str; 5] = ["fetch", "--only", "weather", "--timeout", "1"];

fn names(scratch: &Scratch) -> Vec<String> {
    let Ok(entries) = std::fs::read_dir(scratch.path("weather")) else { return Vec::new() };
    let mut names: Vec<String> = entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn cli_what_is_fetched_is_whole_however_the_server_behaves() {
    let body = weather();
    let cases = [
        ("plain", vec![Does::Serves], 1),
        ("cuts off", vec![Does::CutsOffAfter(40_000), Does::CutsOffAfter(10_000), Does::Serves], 3),
        ("stalls", vec![Does::StallsAfter(30_000), Does::Serves], 2),
        ("ignores the part asked for", vec![Does::CutsOffAfter(40_000), Does::ServesAll], 2),
        (
            "is busy",
            vec![Does::Status("503 Service Unavailable"), Does::Status("429 Too Many Requests"), Does::Serves],
            3,
        ),
        ("redirects", vec![Does::Redirects, Does::Serves], 2),
        ("says too much", vec![Does::SaysMore(100), Does::Serves], 2),
    ];
    side_by_side(cases, |(what, deeds, requests)| {
        let server = Server::of(&body, &deeds);
        let scratch = study(&server);
        let run = scratch.expect(0, &FETCH);
        assert!(run.stdout.contains(&format!("weather/{NAME}, {} bytes", body.len())), "{what}: {}", run.stdout);
        assert_eq!(std::fs::read(scratch.path(&format!("weather/{NAME}"))).unwrap(), body, "{what}");
        assert_eq!(names(&scratch), [NAME], "{what}");
        assert_eq!(server.requests().len(), requests, "{what}: {:?}", server.requests());
        // Once more: nothing is newer.
        let again = Server::of(&body, &[Does::Serves]);
        scratch.edit("study.toml", &server.address, &again.address);
        assert!(scratch.expect(0, &FETCH).stdout.contains("unchanged: "), "{what}");
        assert!(scratch.expect(0, &["fetch", "--only", "weather", "--offline"]).stdout.contains("there: "), "{what}");
    });
}

#[test]
fn cli_a_download_that_failed_goes_on_and_a_wrong_one_leaves_nothing() {
    let body = weather();
    // Every attempt is cut; the next command goes on from where they came to.
    let server = Server::of(&body, &[Does::CutsOffAfter(1000)]);
    let scratch = study(&server);
    let run = scratch.expect(3, &FETCH);
    assert!(run.stderr.contains("after 5 attempts; what has come is kept"), "{}", run.stderr);
    assert_eq!(names(&scratch), [format!("{NAME}.part"), format!("{NAME}.part.from")]);
    let rest = Server::of(&body, &[Does::Serves]);
    scratch.edit("study.toml", &server.address, &rest.address);
    scratch.expect(0, &FETCH);
    assert_eq!(std::fs::read(scratch.path(&format!("weather/{NAME}"))).unwrap(), body);
    assert!(rest.requests()[0].contains("range: bytes=5000-\n") && rest.requests()[0].contains("if-range: \"1\""));

    // All of it had come when the connection broke: the server has no more to send.
    let server = Server::of(&body, &[Does::Serves]);
    let scratch = study(&server);
    std::fs::create_dir(scratch.path("weather")).unwrap();
    scratch.write(&format!("weather/{NAME}.part"), &body);
    scratch.write(&format!("weather/{NAME}.part.from"), "\"1\"");
    scratch.expect(0, &FETCH);
    assert_eq!(std::fs::read(scratch.path(&format!("weather/{NAME}"))).unwrap(), body);
    // What came is longer than what the server has now: from the start.
    let scratch = study(&server);
    std::fs::create_dir(scratch.path("weather")).unwrap();
    scratch.write(&format!("weather/{NAME}.part"), [&body[..], b"more"].concat());
    scratch.write(&format!("weather/{NAME}.part.from"), "\"1\"");
    scratch.expect(0, &FETCH);
    assert_eq!(std::fs::read(scratch.path(&format!("weather/{NAME}"))).unwrap(), body);

    let cases = [
        (Does::Page, "the server sent a web page instead of the file"),
        (Does::Status("404 Not Found"), "the server answers 404 Not Found; check the address in [fetch]"),
        (Does::SaysLess(5), "its last line is not whole"),
        (Does::Status("503 Service Unavailable"), "the server answers 503 Service Unavailable, after 5 attempts"),
        (Does::Redirects, "check the address in [fetch]"),
    ];
    side_by_side(cases, |(deed, said)| {
        let scratch = study(&Server::of(&body, &[deed]));
        let run = scratch.expect(3, &FETCH);
        assert!(run.stderr.contains(said), "{said}: {}", run.stderr);
        assert_eq!(names(&scratch), [""; 0], "{said}");
        let offline = scratch.expect(3, &["fetch", "--only", "weather", "--offline"]);
        assert!(offline.stderr.contains(&format!("{NAME} is missing; it comes from http://")), "{}", offline.stderr);
    });
}

#[test]
fn cli_an_archive_is_checked_before_it_is_put_in_its_place() {
    let mut zip = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
    zip.start_file("a.csv", zip::write::SimpleFileOptions::default()).unwrap();
    zip.write_all(b"a,b\n").unwrap();
    let body = zip.finish().unwrap().into_inner();
    let (server, half) = (Server::of(&body, &[Does::Serves]), Server::of(&body[..60], &[Does::Serves]));
    let of = |address: &str, more: &str| {
        let scratch = Scratch::empty();
        scratch.expect(0, &["init", "."]);
        let text = scratch.read("study.toml");
        scratch.write("study.toml", format!("{text}\n[fetch]\nmissions = \"{address}/Z.zip\"\n{more}\n"));
        scratch
    };
    let fetch = ["fetch", "--only", "missions", "--timeout", "1"];
    let md5 = "missions_checksum = \"md5:00000000000000000000000000000000\"";
    for (address, more, said) in [
        (&half.address, "", "it is no zip archive, or not all of it"),
        (&server.address, "missions_bytes = 7", "bytes, but 7 are published"),
        (&server.address, md5, "but 00000000000000000000000000000000 is published; nothing of it is kept"),
    ] {
        let scratch = of(address, more);
        let run = scratch.expect(3, &fetch);
        assert!(run.stderr.contains(said), "{said}: {}", run.stderr);
        assert_eq!(std::fs::read_dir(scratch.path("ztbus")).unwrap().count(), 0, "{said}");
    }
    let scratch = of(&server.address, &format!("missions_bytes = {}", body.len()));
    scratch.expect(0, &fetch);
    assert_eq!(std::fs::read(scratch.path("ztbus/Z.zip")).unwrap(), body);
    let scratch = of(&server.address, "missions_checksum = \"crc:1\"");
    assert!(scratch.expect(2, &fetch).stderr.contains("[fetch] missions_checksum = \"crc:1\" is no checksum"));
}
