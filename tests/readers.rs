//! Readers while a run is at work: they see what was complete before it or what is complete after it, and nothing between.

#![expect(clippy::unwrap_used, reason = "a test ends where something is not as expected")]

use crate::common::Scratch;
use std::collections::BTreeSet;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

const TABLES: [&str; 4] = [
    "SELECT design, pmv_limit, hvac_power_w, sample_count, unsolved_count FROM annual_average",
    "SELECT design, pmv_limit, month, hvac_power_w, sample_count FROM monthly_average",
    "SELECT design, pmv_limit, controller, mean_hvac_power_w, mission_count FROM simulation_annual",
    "SELECT design, pmv_limit, class_order, mean_hvac_power_w, mission_count FROM simulation_class",
];

fn seen(scratch: &Scratch) -> Vec<Vec<String>> {
    TABLES.iter().map(|sql| scratch.exact(sql).unwrap()).collect()
}

#[test]
fn cli_ten_readers_never_see_half_a_result() {
    let scratch = Scratch::demo(24);
    scratch.edit("study.toml", "pmv_limits = [0.0, 0.5, 1.0, 1.5, 2.0]", "pmv_limits = [1.0]");
    scratch.expect(0, &["run"]);
    let (before, report_before) = (seen(&scratch), scratch.read("report/report.md"));
    // Every sample changes, and with it everything.
    scratch.edit("study.toml", "door_open_share = 0.6", "door_open_share = 0.7");

    let (over, snapshots) = (AtomicBool::new(false), Mutex::new(vec![Vec::new(); TABLES.len()]));
    let reports = Mutex::new(BTreeSet::new());
    std::thread::scope(|scope| {
        for reader in 0..10 {
            let (scratch, over, snapshots, reports) = (&scratch, &over, &snapshots, &reports);
            scope.spawn(move || {
                while !over.load(Ordering::Relaxed) {
                    if reader == 0 {
                        // The folder is gone for the blink between two renames.
                        if let Ok(text) = std::fs::read_to_string(scratch.path("report/report.md")) {
                            reports.lock().unwrap().insert(text);
                        }
                        continue;
                    }
                    // Readers of one process share their lock: without a pause they would keep a writer out for as long as they like.
                    std::thread::sleep(Duration::from_millis(150));
                    for (table, rows) in seen(scratch).into_iter().enumerate() {
                        snapshots.lock().unwrap()[table].push(rows);
                    }
                }
            });
        }
        let status = scratch.spawn(&["run", "--quiet"]).wait();
        over.store(true, Ordering::Relaxed);
        assert!(status.unwrap().success());
    });
    let after = seen(&scratch);
    assert!(before.iter().zip(&after).all(|(b, a)| b != a), "the run changed nothing");
    let snapshots = snapshots.into_inner().unwrap();
    for (table, seen) in snapshots.iter().enumerate() {
        let other = seen.iter().filter(|rows| **rows != before[table] && **rows != after[table]).count();
        assert!(other == 0, "{other} of {} snapshots are of half a result: {}", seen.len(), TABLES[table]);
        assert!(seen.len() >= 20, "only {} snapshots", seen.len());
    }
    let allowed = [report_before, scratch.read("report/report.md")];
    assert!(reports.into_inner().unwrap().iter().all(|text| allowed.contains(text)), "a part of a report was seen");
}
