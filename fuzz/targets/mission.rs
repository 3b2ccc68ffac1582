//! Telemetry of a mission.
#![no_main]

use ingest::Content;
use ingest::mission::{MissionOptions, RouteChoice, MissionSource, read};
use libfuzzer_sys::fuzz_target;
use std::path::Path;

fuzz_target!(|bytes: &[u8]| {
    let Some(source) = MissionSource::at(Path::new("B183_2021-07-26_03-53-27_2021-07-26_07-18-47.csv")) else { return };
    let options = MissionOptions { segment_s: 3600, door_open_share: 0.6, keep_partial: true, routes: RouteChoice::All };
    let reading = read(&source, &Content::new(bytes.to_vec()), &options);
    // Whatever came in: a refusal has a reason, and what is accepted can be.
    assert!(reading.file.accepted || !reading.file.findings.is_empty());
    for segment in &reading.segments {
        assert!(segment.passengers >= 0.0 && (0.0..=0.6).contains(&segment.door_open_fraction));
        assert!(segment.first_line <= segment.last_line && segment.duration_s <= 3600);
    }
});
