//! The grid of the default study and a year-like spread of disturbances, for benchmarks.

use cabin::{ComfortWindow, Cop, Design, Disturbances, Heating, kelvin};
use solve::Grid;

/// As many samples as the paper has.
pub const SAMPLES: usize = 7399;

pub fn grid() -> Grid {
    let design = |name: &str, heating, radiant_heaters, air_curtain| Design {
        name: name.to_owned(),
        heating,
        heating_cop: match heating {
            Heating::Ptc => Cop::Constant(1.0),
            Heating::HeatPump => cabin::named_heating_cops().swap_remove(0).1,
        },
        cooling_cop: cabin::named_cooling_cops().swap_remove(0).1,
        radiant_heaters,
        air_curtain,
    };
    let designs = vec![
        design("ptc", Heating::Ptc, false, false),
        design("ptc+rh", Heating::Ptc, true, false),
        design("hp", Heating::HeatPump, false, false),
        design("hp+rh", Heating::HeatPump, true, false),
        design("hp+curtain", Heating::HeatPump, false, true),
    ];
    let windows = (0..17).map(|i| ComfortWindow::symmetric(0.125 * f64::from(i)).expect("valid")).collect();
    Grid::new(designs, windows).expect("valid")
}

/// A year-like spread of disturbances without random numbers: incommensurable cycles.
pub fn samples() -> Vec<Disturbances> {
    let cycle = |i: usize, period: f64| 0.5 - 0.5 * (i as f64 * std::f64::consts::TAU / period).cos();
    (0..SAMPLES)
        .map(|i| {
            let day = cycle(i, 24.0);
            Disturbances {
                ambient_temperature_k: kelvin(-8.0 + 28.0 * cycle(i, 7399.0) + 9.0 * day + 4.0 * cycle(i, 131.7)),
                dni_w_m2: 850.0 * day * cycle(i, 71.3),
                dhi_w_m2: 250.0 * day,
                solar_altitude_rad: -0.2 + 1.2 * day,
                shadow_fraction: 1.0 - 0.7 * day,
                passengers: 40.0 * cycle(i, 9.1),
                door_open_fraction: 0.10 + 0.08 * cycle(i, 17.9),
            }
        })
        .collect()
}
