//! Named cases that tests and benchmarks share: designs, comfort windows, days, a year. For development only.

mod days;
mod designs;
mod missions;
mod optimum;
mod peer;
mod reference;
mod year;

pub use days::{
    cabin_equal_to_ambient, day, doors_open, full_load, gallery, night, spring_day, summer_day, sun_highest, winter_day,
};
pub use designs::{all_designs, design, paper_designs, paper_grid, paper_windows};
pub use missions::{SIMULATED_LIMITS, TestMission};
pub use optimum::{operation, optimum};
pub use peer::peer;
pub use reference::{simulate_finely, step};
pub use year::{YEAR_SAMPLES, year};
