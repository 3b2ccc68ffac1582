//! Designs, windows, disturbances and the reference solver that the tests share.

#[allow(dead_code, reason = "not every test program needs it")]
pub mod reference;

use cabin::{
    ComfortWindow, Cop, Design, Disturbances, Heating, PassengerViews, Vehicle, kelvin, named_cooling_cops,
    named_heating_cops,
};
use proptest::prelude::*;
use solve::{Grid, Operation, Optimum, Outcome, SampleSolver};

pub fn design(name: &str, heating: Heating, radiant_heaters: bool, air_curtain: bool) -> Design {
    let heating_cop = match heating {
        Heating::Ptc => Cop::Constant(1.0),
        Heating::HeatPump => named_heating_cops().swap_remove(0).1,
    };
    let cooling_cop = named_cooling_cops().swap_remove(0).1;
    Design { name: name.to_owned(), heating, heating_cop, cooling_cop, radiant_heaters, air_curtain }
}

pub fn designs() -> Vec<Design> {
    vec![
        design("ptc", Heating::Ptc, false, false),
        design("ptc+rh", Heating::Ptc, true, false),
        design("hp", Heating::HeatPump, false, false),
        design("hp+rh", Heating::HeatPump, true, false),
        design("hp+curtain", Heating::HeatPump, false, true),
        design("hp+rh+curtain", Heating::HeatPump, true, true),
    ]
}

pub fn windows() -> Vec<ComfortWindow> {
    let symmetric = (0..=16).map(|i| ComfortWindow::symmetric(0.125 * f64::from(i)).expect("valid"));
    symmetric.chain([ComfortWindow::new(-0.5, 0.7).expect("valid")]).collect()
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
    let mut optima = vec![Optimum { design: 0, window: 0, outcome: Outcome::NotConverged }; grid.points()];
    SampleSolver::new(vehicle, views, grid).solve(d, &mut optima);
    optima
}

pub fn operation(optimum: &Optimum) -> Operation {
    match optimum.outcome {
        Outcome::Solved(operation, _) => operation,
        other => panic!("{other:?}"),
    }
}
