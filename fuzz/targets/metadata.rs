//! The list of missions that a demo follows.
#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let _ = demo::read_meta_data(bytes);
});
