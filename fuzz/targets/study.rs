//! Study files.
#![no_main]

use libfuzzer_sys::fuzz_target;
use std::path::Path;
use study::Study;

fuzz_target!(|text: &str| {
    if let Err(error) = Study::parse(text, Path::new("study.toml")) {
        assert!(error.to_string().starts_with("study.toml"));
    }
});
