//! Windows, disturbances and the reference solver that the tests share.

#[allow(dead_code, reason = "not every test program needs it")]
pub mod reference;

use cabin::{ComfortWindow, Disturbances, Optimum, PassengerViews, Vehicle, kelvin};
use proptest::prelude::*;
use solve::{Grid, SampleSolver};

pub fn windows() -> Vec<ComfortWindow> {
    let unequal = ComfortWindow::new(-0.5, 0.7).expect("valid");
    testing::paper_windows().into_iter().chain([unequal]).collect()
}

pub fn disturbances() -> impl Strategy<Value = Disturbances> {
    (-22.0..40.0_f64, 0.0..950.0_f64, 0.0..450.0_f64, -0.3..1.15_f64, 0.0..=1.0_f64, 0.0..100.0_f64, 0.0..0.3_f64)
        .prop_map(|(ambient_c, dni, dhi, altitude, shadow, passengers, doors)| Disturbances {
            ambient_temperature_k: kelvin(ambient_c),
            dni_w_m2: dni,
            dhi_w_m2: dhi,
            solar_altitude_rad: altitude,
            shadow_fraction: shadow,
            passengers,
            door_open_fraction: doors,
        })
}

pub fn solve(vehicle: &Vehicle, views: &PassengerViews, grid: &Grid, d: &Disturbances) -> Vec<Optimum> {
    let mut optima = vec![Optimum::UNSOLVED; grid.points()];
    SampleSolver::new(vehicle, views, grid).solve(d, &mut optima);
    optima
}
