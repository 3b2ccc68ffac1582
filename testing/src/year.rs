//! A year.

use cabin::{Disturbances, kelvin};

/// As many samples as the paper has.
pub const YEAR_SAMPLES: usize = 7399;

/// A year-like spread of disturbances without random numbers: incommensurable cycles.
#[must_use]
pub fn year() -> Vec<Disturbances> {
    let cycle = |i: usize, period: f64| 0.5 - 0.5 * (i as f64 * std::f64::consts::TAU / period).cos();
    (0..YEAR_SAMPLES)
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
