//! Shadow fractions.
#![no_main]

use libfuzzer_sys::fuzz_target;
use shading::ShadowYear;

fuzz_target!(|bytes: &[u8]| {
    if ingest::check_lines(bytes, b',', 87_840).is_ok()
        && let Ok(year) = ShadowYear::read(bytes)
    {
        assert!(year.hourly().iter().all(|fraction| (0.0..=1.0).contains(fraction)));
    }
});
