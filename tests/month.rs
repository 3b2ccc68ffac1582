//! A month of nights: each brings a day's missions and weather, every third run is killed, and the month ends as one run from
//! scratch does.
//!
//! `BUSCLIMATE_NIGHTS` says how many nights there are.

use crate::common::world::{WEATHER, World};
use crate::common::{CONTENT, Scratch};
use std::collections::BTreeMap;
use std::time::{Duration, Instant};

#[test]
fn prop_a_month_of_nights_with_kills_ends_where_one_run_does() {
    let nights: usize = std::env::var("BUSCLIMATE_NIGHTS").ok().and_then(|n| n.parse().ok()).unwrap_or(6);
    let demo = Scratch::demo(2 * nights + 6);
    let whole = World::of_demo(&demo);
    let scratch = Scratch::empty();
    let names: Vec<String> = whole.missions.keys().cloned().collect();
    let weather: Vec<&str> = whole.weather[WEATHER].lines().collect();
    for night in 0..=nights {
        // Six missions to begin with, then two a night; weather as far as the nights are, and all of it at last.
        let missions = (6 + 2 * night).min(names.len());
        let rows = if night == nights { weather.len() } else { weather.len() * (night + 2) / (nights + 2) };
        let world = World {
            missions: names[..missions].iter().map(|name| (name.clone(), whole.missions[name].clone())).collect(),
            weather: BTreeMap::from([(WEATHER.to_owned(), weather[..rows].join("\n") + "\n")]),
            ..whole.clone()
        };
        world.write(&scratch);
        let begin = Instant::now();
        if night % 3 == 2 {
            scratch.run_and_kill(Duration::from_millis(37 * (night as u64 % 8)));
            eprintln!("night {night}: killed");
            continue;
        }
        let run = scratch.run(&["run"]);
        assert!(run.status <= 1, "night {night}: {}", run.stderr);
        let bytes = std::fs::metadata(scratch.path("study.db")).unwrap().len();
        eprintln!("night {night}: {:.2} s, {:.1} MB", begin.elapsed().as_secs_f64(), bytes as f64 / 1e6);
    }
    scratch.expect(0, &["run"]);
    let fresh = Scratch::empty();
    whole.write(&fresh);
    fresh.expect(0, &["run"]);
    for sql in CONTENT {
        assert!(scratch.exact(sql).unwrap() == fresh.exact(sql).unwrap(), "{sql}");
    }
    assert!(scratch.report() == fresh.report());
    // Freed pages are used again: the month's database is no larger than a new one by more than a tenth.
    let size = |scratch: &Scratch| std::fs::metadata(scratch.path("study.db")).unwrap().len() as f64;
    let (grown, new) = (size(&scratch), size(&fresh));
    assert!(grown < 1.1 * new + 2e5, "{grown} bytes after the month, {new} from scratch");
}
