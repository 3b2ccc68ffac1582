//! Designs and comfort windows.

use cabin::{ComfortWindow, Cop, Design, Devices, Heating, named_cooling_cops, named_heating_cops};
use solve::Grid;

/// A design with the default COP curves.
#[must_use]
pub fn design(name: &str, heating: Heating, radiant_heaters: bool, air_curtain: bool) -> Design {
    let heating_cop = match heating {
        Heating::Ptc => Cop::Constant(1.0),
        Heating::HeatPump => named_heating_cops().swap_remove(0).1,
    };
    let cooling_cop = named_cooling_cops().swap_remove(0).1;
    let devices = Devices { radiant_heaters, air_curtain };
    Design {
        name: name.to_owned(),
        heating,
        heating_cop,
        cooling_cop,
        devices,
        heating_limit: None,
        cooling_limit: None,
        backup_heater_w: 0.0,
    }
}

/// The five designs of the paper.
#[must_use]
pub fn paper_designs() -> Vec<Design> {
    vec![
        design("ptc", Heating::Ptc, false, false),
        design("ptc+rh", Heating::Ptc, true, false),
        design("hp", Heating::HeatPump, false, false),
        design("hp+rh", Heating::HeatPump, true, false),
        design("hp+curtain", Heating::HeatPump, false, true),
    ]
}

/// The designs of the paper, and one that has everything.
#[must_use]
pub fn all_designs() -> Vec<Design> {
    let mut designs = paper_designs();
    designs.push(design("hp+rh+curtain", Heating::HeatPump, true, true));
    designs
}

/// The 17 comfort windows of the paper.
#[must_use]
pub fn paper_windows() -> Vec<ComfortWindow> {
    (0..17).map(|i| ComfortWindow::symmetric(0.125 * f64::from(i)).expect("a limit on the scale")).collect()
}

/// The designs of the paper in its windows.
#[must_use]
pub fn paper_grid() -> Grid {
    Grid::new(paper_designs(), paper_windows()).expect("distinct designs and windows")
}
