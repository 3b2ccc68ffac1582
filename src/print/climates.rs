//! The same bus in other places, in words.

use pipeline::Climates;
use std::path::Path;

use crate::console::say;
use crate::failure::{Ending, Failure};

pub fn climates(of: &Climates, folder: Option<&Path>) -> Result<Ending, Failure> {
    let window = of.windows[of.shown];
    say(format_args!("annual mean power in W at PMV {} … {}", window.pmv_min(), window.pmv_max()))?;
    let name_width = of.all.iter().map(|c| c.name.chars().count()).max().unwrap_or(0);
    let blank = "";
    say(format_args!("{blank:name_width$} {:>7}  {}", "°C", of.designs.join("  ")))?;
    for climate in &of.all {
        let cell = |(design, name): (usize, &String)| {
            let power = of.power_w(climate, design).map_or_else(|| "–".to_owned(), |w| format!("{w:.0}"));
            format!("{power:>width$}", width = name.chars().count())
        };
        let powers = of.designs.iter().enumerate().map(cell).collect::<Vec<_>>().join("  ");
        say(format_args!("{:name_width$} {:>7.1}  {powers}", climate.name, climate.ambient_temperature_c))?;
        if let Some(reason) = &climate.exclusion {
            say(format_args!("  {} segments give no sample there, the first one: {reason}", climate.excluded))?;
        }
    }
    if let Some(folder) = folder {
        say(format_args!("climates.csv and climates.svg are in {}", folder.display()))?;
    }
    Ok(Ending::of(of.all.iter().all(|climate| climate.excluded == 0)))
}
