//! What the year depends on, in words.

use pipeline::{Sensitivities, SwingRow};

use crate::console::say;
use crate::failure::Failure;

/// Inputs that are named for each design; the report has all.
const NAMED: usize = 5;

pub fn sensitivities(all: &Sensitivities) -> Result<(), Failure> {
    for result in all.results.iter().filter(|r| r.of.quantity == "hvac_power_w") {
        let [low, high] = result.ends;
        say(format_args!(
            "{}: {:.0} W; over {} sets {:.0} ± {:.0} W, nine tenths between {low:.0} and {high:.0} W",
            result.of.design,
            result.base_value.unwrap_or(f64::NAN),
            result.sets,
            result.mean_value,
            result.sd_value
        ))?;
        if result.limited > 0 {
            let hours = result.limited as f64 / result.sets as f64;
            say(format_args!("  misses the window for want of power in {hours:.1} hours a set"))?;
        }
        let mut swings: Vec<&SwingRow> = all.swings.iter().filter(|s| s.of == result.of).collect();
        swings.sort_by(|a, b| b.width().total_cmp(&a.width()));
        for swing in swings.into_iter().take(NAMED) {
            let [_, low, high] = swing.inputs;
            let index = all.indices.iter().find(|i| i.of == swing.of && i.input == swing.input);
            let index = index.map_or_else(String::new, |i| format!("; S {:.2}, S_T {:.2}", i.first[0], i.total[0]));
            let [at_low, at_high] = swing.changes().map(|change| change.unwrap_or(f64::NAN));
            say(format_args!("  {} {low} … {high}: {at_low:+.0} … {at_high:+.0} W{index}", swing.input.name))?;
        }
    }
    Ok(())
}
