//! Other people's programs, run beside ours.

#![expect(clippy::print_stdout, reason = "a test says why it is skipped")]

use std::path::PathBuf;
use std::process::Command;

/// The lines that a script of `tests/peers/` prints, in fields; `None` where Python has not the package that it needs, which is
/// said.
///
/// # Panics
/// Where the script fails.
#[must_use]
pub fn peer(script: &str, package: &str, arguments: &[String]) -> Option<Vec<Vec<String>>> {
    let python = std::env::var("BUSCLIMATE_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let there = Command::new(&python).args(["-c", &format!("import {package}")]).output();
    if !there.is_ok_and(|o| o.status.success()) {
        println!(
            "skipped: {python} has no {package}; pip install -r tests/peers/requirements.txt, or set BUSCLIMATE_PYTHON"
        );
        return None;
    }
    // Of the package that is tested, not of the place where this was compiled: checkouts may share what they build.
    let package = std::env::var_os("CARGO_MANIFEST_DIR").map(PathBuf::from).expect("cargo runs the tests");
    let mut above = package.ancestors().map(|folder| folder.join("tests/peers").join(script));
    let path = above.find(|path| path.exists()).expect("scripts lie in tests/peers");
    let output = Command::new(&python).arg(path).args(arguments).output().expect("python has just run");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).expect("the scripts print ASCII");
    Some(text.lines().map(|l| l.split(',').map(str::to_owned).collect()).collect())
}
