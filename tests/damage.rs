//! Storage that changes a bit without saying so: nothing is built on it in silence.
//!
//! `BUSCLIMATE_FLIPS` says how many bits are changed, one at a time.

use crate::common::{CONTENT, Scratch};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

fn small() -> Scratch {
    let scratch = Scratch::small(3, "[0.5, 1.0]", "[1.0]");
    scratch.expect(0, &["run"]);
    scratch
}

/// What readers see; `None` where the database cannot even be read.
fn seen(scratch: &Scratch) -> Option<Vec<Vec<String>>> {
    CONTENT.iter().map(|sql| scratch.exact(sql).ok()).collect()
}

#[test]
fn prop_a_changed_bit_is_found_or_changes_nothing() {
    let scratch = small();
    // Without free pages, in which a bit says nothing.
    scratch.expect(0, &["backup", "study.toml", "compact.db"]);
    let good = std::fs::read(scratch.path("compact.db")).unwrap();
    scratch.write("study.db", &good);
    let before = seen(&scratch);
    // What is only looked up: names of files and what was noticed in them is read again from the files.
    let averages: Vec<&str> =
        CONTENT.into_iter().filter(|sql| sql.contains("_average") || sql.contains("_annual")).collect();
    let of = |scratch: &Scratch| averages.iter().map(|sql| scratch.exact(sql).ok()).collect::<Vec<_>>();
    let (averages_before, report) = (of(&scratch), scratch.report());
    let flips: u64 = std::env::var("BUSCLIMATE_FLIPS").ok().and_then(|n| n.parse().ok()).unwrap_or(100);
    let (mut damaged, mut found) = (0, 0);
    for seed in 0..flips {
        let mut dice = ChaCha8Rng::seed_from_u64(seed);
        let mut bytes = good.clone();
        let bit = (dice.next_u64() % (8 * bytes.len() as u64)) as usize;
        bytes[bit / 8] ^= 1 << (bit % 8);
        scratch.write("study.db", &bytes);
        let at = format!("seed {seed}, byte {}, bit {}", bit / 8, bit % 8);
        let data = |content: &Option<Vec<Vec<String>>>| content.as_ref().map(|c| c[..35].to_vec());
        if data(&seen(&scratch)) != data(&before) {
            damaged += 1;
            let verify = scratch.run(&["verify", "--fraction", "0"]);
            assert!(verify.status != 0, "{at}: verify finds nothing\n{}", verify.stdout);
            found += 1;
        }
        scratch.write("study.db", &bytes);
        let run = scratch.run(&["run"]);
        if run.status == 0 {
            assert!(of(&scratch) == averages_before, "{at}: wrong averages with exit status 0");
            assert!(scratch.report() == report, "{at}: a wrong report with exit status 0");
        } else {
            assert!(run.stderr.contains("study.db"), "{at}: {}", run.stderr);
        }
    }
    assert!(damaged > flips / 5 && found == damaged, "{damaged} of {flips} bits damaged data, {found} were found");
}

#[test]
fn cli_what_is_damaged_is_named_with_a_remedy() {
    let scratch = small();
    let good = std::fs::read(scratch.path("study.db")).unwrap();
    let says = |damage: &'static str, what: &str, commands: &[&[&str]]| {
        scratch.write("study.db", &good);
        scratch.tamper(damage);
        for command in commands {
            let run = scratch.expect(3, command);
            let line = format!("study.db is damaged: {what}");
            assert!(run.stderr.contains(&line) && run.stderr.contains("restore the last backup"), "{}", run.stderr);
            assert!(!scratch.path("study.db-wal").exists(), "a log is left");
        }
        let verify = scratch.expect(1, &["verify", "--fraction", "0"]);
        assert!(verify.stdout.contains("violated: rows and tables as they were written"), "{}", verify.stdout);
    };
    says(
        "UPDATE annual_average SET hvac_power_w = hvac_power_w + 1.0 WHERE design = 'ptc' AND pmv_limit = 1.0",
        "annual_average",
        &[&["run"], &["report"], &["run", "--rehash"]],
    );
    says(
        "UPDATE optimum_point SET air_unit_power_w = 0.0 WHERE sample_id = (SELECT min(sample_id) FROM optimum_point)",
        "optimum_point",
        &[&["run", "--rehash"]],
    );
    says(
        "UPDATE simulated_mission SET seconds = seconds + 1 WHERE controller = 'paper'",
        "simulated_mission",
        &[&["run", "--rehash"]],
    );
    // A month is averaged anew: it is not built on its damaged rows.
    says(
        "UPDATE optimum_point SET air_unit_power_w = 0.0 WHERE sample_id = (SELECT min(sample_id) FROM optimum_point)",
        "optimum_point",
        &[],
    );
    scratch.tamper(
        "INSERT OR IGNORE INTO stale_month VALUES (1), (2), (3), (4), (5), (6), (7), (8), (9), (10), (11), (12)",
    );
    scratch.tamper("DELETE FROM stage_record WHERE stage = 'solve'");
    let run = scratch.expect(3, &["run"]);
    assert!(run.stderr.contains("study.db is damaged: optimum_point, sample_id "), "{}", run.stderr);
}
