//! The program from outside, and beside other people's programs. All files are one test program, which is linked once and
//! keeps all cores busy; `cargo test --release --test outside FILE::` runs the tests of a file.

mod common;

mod bad_input;
mod compare;
mod control;
mod damage;
mod docs;
mod edits;
mod energy;
mod exports;
mod faults;
mod fetch;
mod field;
mod hostile;
mod identity;
mod library;
mod loop_peers;
mod month;
mod nights;
mod offers;
mod one_run;
mod page;
mod peers;
mod questions;
mod readers;
mod real_mission;
mod sensitivity;
mod shards;
mod stale;
mod study;
mod tables;
mod tools;
mod uncertainty;
mod verify;
mod weather_peers;
