//! Tables of telemetry with columns of other names.
#![no_main]

use ingest::mission::{Door, MissionFormat, MissionOptions, RouteChoice, TelemetryMap, Vehicle, discover, read};
use ingest::{Clock, FileReader};
use libfuzzer_sys::fuzz_target;
use std::path::PathBuf;
use std::sync::{Arc, LazyLock};

static FOLDER: LazyLock<PathBuf> = LazyLock::new(|| {
    let folder = std::env::temp_dir().join(format!("busclimate-fuzz-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder for one table");
    folder
});

fuzz_target!(|bytes: &[u8]| {
    let Some((&choice, table)) = bytes.split_first() else { return };
    std::fs::write(FOLDER.join("a.csv"), table).expect("room for one table");
    let column = |name: &str| Some(name.to_owned());
    let door = if choice & 1 == 0 { Door::Flag } else { Door::Share };
    let map = TelemetryMap {
        time_column: "when".to_owned(),
        clock: if choice & 2 == 0 { Clock::Utc } else { Clock::Zone(chrono_tz::Europe::Zurich) },
        vehicle: if choice & 4 == 0 { Vehicle::Column("bus".to_owned()) } else { Vehicle::Number(183) },
        passengers_column: "load".to_owned(),
        door: door("doors".to_owned()),
        speed_column: column("speed"),
        speed_unit_m_s: 1.0 / 3.6,
        power_column: column("power"),
        power_unit_w: 1000.0,
        route_column: column("line"),
        hold_s: 60,
        cut_gap_s: 900,
    };
    let Ok(found) = discover(&FOLDER, "a.csv", &MissionFormat::Csv(Arc::new(map)), &[]) else { return };
    let options = MissionOptions { segment_s: 3600, door_open_share: 0.6, keep_partial: true, routes: RouteChoice::All };
    let mut reader = FileReader::default();
    for mission in &found.missions {
        let content = mission.load(&mut reader).expect("the table is still there");
        let reading = read(mission, &content, &options);
        assert!(reading.file.accepted || !reading.file.findings.is_empty());
        for segment in &reading.segments {
            assert!(segment.passengers >= 0.0 && (0.0..=1.0).contains(&segment.door_open_fraction));
            assert!(segment.first_line <= segment.last_line && segment.duration_s <= 3600);
        }
    }
});
