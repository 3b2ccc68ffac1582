//! Whatever happens to inputs and study, and whenever a run is killed: the database ends as one made from scratch does, to
//! the last bit.
//!
//! `BUSCLIMATE_EDIT_SEQUENCES` says how many sequences of edits are tried, `BUSCLIMATE_EDIT_SEED` where they start.

#![expect(clippy::unwrap_used, reason = "a test ends where something is not as expected")]

use crate::common::world::{WEATHER, World};
use crate::common::{CONTENT, Scratch};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use std::time::Duration;

struct Dice(ChaCha8Rng);

impl Dice {
    fn below(&mut self, n: usize) -> usize {
        (self.0.next_u64() % n as u64) as usize
    }

    fn one_of<T: Copy>(&mut self, items: &[T]) -> T {
        items[self.below(items.len())]
    }
}

/// Changes one thing, and says which.
fn edit(world: &mut World, original: &World, dice: &mut Dice) -> &'static str {
    let names: Vec<String> = world.missions.keys().cloned().collect();
    // Two missions stay, so that there is a study.
    let name = names[2 + dice.below(names.len() - 2)].clone();
    let text = original.missions[&name].clone().unwrap();
    match dice.below(22) {
        0 | 1 => {
            world.missions.insert(name, None);
            "a mission away"
        }
        2 => {
            world.missions.insert(name, Some(text));
            "a mission as it was"
        }
        3 => {
            let other = text.replacen(",1,1,1,", ",0,1,1,", 1 + dice.below(400));
            world.missions.insert(name, Some(other));
            "a mission with other doors"
        }
        4 => {
            let lines: Vec<&str> = text.lines().collect();
            let kept = lines.len() / 2 + dice.below(lines.len() / 2);
            world.missions.insert(name, Some(lines[..kept].join("\n") + "\n"));
            "a mission cut short"
        }
        5 => {
            world.missions.insert(name, Some(text.replacen("status_doorIsOpen", "doors", 1)));
            "a mission without a column"
        }
        6 => {
            world.missions_path = dice.one_of(&["ztbus", "buses", "missions.zip", "ZTBus.zip"]);
            "missions elsewhere"
        }
        7 => {
            world.shadow_path = dice.one_of(&["shadow.csv", "streets.csv"]);
            "shade elsewhere"
        }
        8 => {
            world.shadow = original.shadow.replacen("T12:00:00Z,0.", "T12:00:00Z,0.0", 60 * dice.below(3));
            "other shade"
        }
        9 => {
            let text = world.weather.values().next().unwrap().clone();
            world.weather = [(dice.one_of(&[WEATHER, "ogd-smn_sma_h_2022.csv"]).to_owned(), text)].into();
            "weather under another name"
        }
        10 => {
            let text = original.weather[WEATHER].clone();
            let (from, to) = dice.one_of(&[(";4.9;", ";5.1;"), (" 07:00;", " 07:00;x"), ("", "")]);
            world.weather = [(WEATHER.to_owned(), if from.is_empty() { text } else { text.replace(from, to) })].into();
            "other weather"
        }
        11 => {
            let lines: Vec<&str> = original.weather[WEATHER].lines().collect();
            let half = 1 + dice.below(lines.len() - 2);
            let parts = [&lines[1..half], &lines[half..]].map(|part| format!("{}\n{}\n", lines[0], part.join("\n")));
            let [early, late] = parts;
            world.weather =
                [("ogd-smn_sma_h_b.csv".to_owned(), early), ("ogd-smn_sma_h_a.csv".to_owned(), late)].into();
            "weather in two files"
        }
        12 => {
            world.time_zone = dice.one_of(&["Europe/Zurich", "Asia/Tokyo", "America/Los_Angeles"]);
            "another time zone"
        }
        13 => {
            world.max_gap_s = dice.one_of(&[10_800, 3_600, 0]);
            "another longest gap"
        }
        14 => {
            (world.segment_s, world.keep_partial) = (dice.one_of(&[3600, 1800]), dice.one_of(&[true, false]));
            "other segments"
        }
        15 => {
            world.door_open_share = dice.one_of(&[0.6, 0.5]);
            "another share of doors"
        }
        16 => {
            world.air_velocity_m_s = dice.one_of(&[0.1, 0.2]);
            "another constant of the bus"
        }
        17 => {
            world.limits = dice.one_of::<&[f64]>(&[&[0.5, 1.0], &[1.0], &[1.0, 0.0, 0.3], &[0.5, 1.0, 2.0]]).to_vec();
            world.simulated = dice.one_of::<&[f64]>(&[&[1.0], &[]]).to_vec();
            "other windows"
        }
        18 => {
            let kinds = [("ptc", false, false), ("ptc", true, true), ("hp", true, false), ("hp", false, true)];
            let (heating, heaters, curtain) = dice.one_of(&kinds);
            let name = format!("design {}", dice.below(3));
            world.designs.retain(|d| d.0 != name);
            let place = dice.below(world.designs.len() + 1);
            world.designs.insert(place, (name, heating, "vecto-continuous", heaters, curtain));
            "another design"
        }
        19 if world.designs.len() > 1 => {
            let place = dice.below(world.designs.len());
            world.designs.remove(place);
            "a design less"
        }
        20 => {
            let place = dice.below(world.designs.len());
            world.designs[place].2 = dice.one_of(&["vecto-continuous", "vecto-2stage"]);
            "another COP"
        }
        _ => {
            let place = dice.below(world.designs.len());
            let name = format!("renamed {}", dice.below(100));
            if world.designs.iter().all(|d| d.0 != name) {
                world.designs[place].0 = name;
            }
            world.designs.rotate_left(1);
            "designs under other names in another order"
        }
    }
}

fn setting(name: &str, otherwise: u64) -> u64 {
    std::env::var(name).ok().and_then(|text| text.parse().ok()).unwrap_or(otherwise)
}

#[test]
fn prop_any_sequence_of_edits_and_kills_ends_where_a_run_from_scratch_does() {
    let first = setting("BUSCLIMATE_EDIT_SEED", 1);
    let demo = Scratch::demo(6);
    let original = World::of_demo(&demo);
    for seed in first..first + setting("BUSCLIMATE_EDIT_SEQUENCES", 6) {
        let mut dice = Dice(ChaCha8Rng::seed_from_u64(seed));
        let scratch = Scratch::empty();
        let mut history = vec![original.clone()];
        let mut story = vec![format!("seed {seed}")];
        for _ in 0..8 {
            let mut world = history[history.len() - 1].clone();
            if history.len() > 1 && dice.below(4) == 0 {
                story.push("undo".to_owned());
                history.pop();
                world = history[history.len() - 1].clone();
            } else {
                story.push(edit(&mut world, &original, &mut dice).to_owned());
                history.push(world.clone());
            }
            world.write(&scratch);
            match dice.below(4) {
                0 => story.push("—".to_owned()),
                1 | 2 => {
                    let run = scratch.run(&["run", "--quiet"]);
                    story.push(format!("run: {}", run.status));
                }
                _ => {
                    scratch.run_and_kill(Duration::from_millis(dice.below(800) as u64));
                    story.push("killed run".to_owned());
                }
            }
        }
        let run = scratch.run(&["run"]);
        let fresh = Scratch::empty();
        history[history.len() - 1].write(&fresh);
        let from_scratch = fresh.run(&["run"]);
        assert_eq!(run.status, from_scratch.status, "{story:#?}\n{}\n{}", run.stderr, from_scratch.stderr);
        assert!(run.status <= 1, "{story:#?}\n{}", run.stderr);
        for sql in CONTENT {
            let (ours, theirs) = (scratch.exact(sql).unwrap(), fresh.exact(sql).unwrap());
            if ours != theirs {
                let differs = ours.iter().zip(&theirs).find(|(a, b)| a != b);
                panic!("{story:#?}\n{sql}\n{} rows, {} from scratch; {differs:#?}", ours.len(), theirs.len());
            }
        }
        for (ours, theirs) in scratch.report().iter().zip(fresh.report()) {
            assert!(*ours == theirs, "{story:#?}\nreport/{} and {}", ours.0, theirs.0);
        }
    }
}
