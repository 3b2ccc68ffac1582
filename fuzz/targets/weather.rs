//! Weather of all formats; the first byte chooses.
#![no_main]

use ingest::Content;
use ingest::weather::{Clock, ColumnMap, IrradianceSplit, TimeLabel, WeatherFormat, WeatherOptions, read_one};
use libfuzzer_sys::fuzz_target;
use shading::Site;

fuzz_target!(|bytes: &[u8]| {
    let [choice, bytes @ ..] = bytes else { return };
    let choice = usize::from(*choice);
    let fixed =
        WeatherFormat::NAMES.get(choice % WeatherFormat::NAMES.len()).and_then(|name| WeatherFormat::fixed(name));
    let zurich = chrono_tz::Europe::Zurich;
    let map = ColumnMap {
        clock: if choice % 2 == 0 { Clock::Zone(zurich) } else { Clock::Utc },
        ..ColumnMap::hourly("time", [TimeLabel::Start, TimeLabel::Middle, TimeLabel::End][choice % 3], "t", "g")
    };
    let options = WeatherOptions {
        format: fixed.unwrap_or(WeatherFormat::Csv(map)),
        station: None,
        max_gap_s: 10_800,
        split: IrradianceSplit::Erbs,
        site: Site::new(47.4, 8.6).expect("the place lies on Earth"),
        zone: zurich,
    };
    if let Ok((_, records)) = read_one("weather", &Content::new(bytes.to_vec()), &options) {
        assert!(records.iter().any(|record| record.accepted));
    }
});
