//! Archives: what is listed, and what of it is read.
#![no_main]

use ingest::FileReader;
use ingest::mission::{MissionFormat, MissionOptions, RouteChoice, discover, read};
use libfuzzer_sys::fuzz_target;
use std::path::PathBuf;
use std::sync::LazyLock;

static FOLDER: LazyLock<PathBuf> = LazyLock::new(|| {
    let folder = std::env::temp_dir().join(format!("busclimate-fuzz-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder for one archive");
    folder
});

fuzz_target!(|bytes: &[u8]| {
    std::fs::write(FOLDER.join("a.zip"), bytes).expect("room for one archive");
    let Ok(found) = discover(&FOLDER, "a.zip", &MissionFormat::ZtBus, &[]) else { return };
    let (mut reader, options) =
        (FileReader::default(), MissionOptions { segment_s: 3600, door_open_share: 0.6, keep_partial: false, routes: RouteChoice::All });
    for mission in &found.missions {
        if let Ok(content) = mission.load(&mut reader) {
            let _ = read(mission, &content, &options);
        }
    }
});
