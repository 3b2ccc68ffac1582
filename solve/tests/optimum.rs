//! The optimum against brute force, and its properties.

mod common;

use cabin::{
    Cabin, ComfortWindow, Cop, Devices, Disturbances, Heating, Infeasible, OperatingMode, Outcome, PassengerViews,
    Vehicle, kelvin,
};
use common::reference::Reference;
use common::{disturbances, solve, windows};
use proptest::prelude::*;
use solve::{CertificateError, Grid, SampleSolver, certify};
use testing::{all_designs, design, gallery, operation};

proptest! {
    #![proptest_config(ProptestConfig::with_cases(8))]
    #[test]
    fn prop_a_dense_search_with_nested_bisection_finds_nothing_cheaper(d in disturbances(), limit in 0..17_usize) {
        nothing_is_cheaper("a random sample", &d, 0.125 * limit as f64)?;
    }
}

#[test]
fn prop_a_dense_search_finds_nothing_cheaper_in_any_named_case() -> Result<(), TestCaseError> {
    gallery().iter().try_for_each(|(name, d)| nothing_is_cheaper(name, d, 0.5))
}

fn nothing_is_cheaper(name: &str, d: &Disturbances, limit: f64) -> Result<(), TestCaseError> {
    let vehicle = Vehicle::default();
    let views = PassengerViews::from_view_factors(&[0.009, 0.013, 0.0142, 0.0165]);
    let window = ComfortWindow::symmetric(limit).expect("valid");
    let grid = Grid::new(all_designs(), vec![window]).expect("valid");
    for (optimum, design) in solve(&vehicle, &views, &grid, d).iter().zip(grid.designs()) {
        let allowed = Devices::CHOICES.iter().filter(|&&choice| design.devices.include(choice));
        let least_w = allowed
            .map(|choice| {
                Reference::new(&vehicle, &views, d, choice.radiant_heaters, choice.air_curtain)
                    .least_w(design, &window, 40)
            })
            .fold(f64::INFINITY, f64::min);
        let ours_w = operation(optimum).hvac_power_w();
        let off_w = (ours_w - least_w).abs();
        prop_assert!(off_w < 1e-6 * least_w.max(1.0), "{name}, {}: {ours_w} W, but {least_w} W", design.name);
    }
    Ok(())
}

proptest! {
    #[test]
    fn prop_balances_close_and_limits_hold_at_every_optimum(d in disturbances()) {
        let vehicle = Vehicle::default();
        let views = PassengerViews::from_view_factors(&[0.009, 0.013, 0.0142, 0.0165]);
        let grid = Grid::new(all_designs(), windows()).expect("valid");
        let cabin = Cabin::new(&vehicle, &views, &d);
        for optimum in solve(&vehicle, &views, &grid, &d) {
            let o = operation(&optimum);
            let window = grid.windows()[optimum.window];
            let flows = cabin.flows(&o.temperatures, o.devices.air_curtain, o.air_unit_heat_w, o.radiant_heater_power_w);
            prop_assert!(flows.net_w().iter().all(|w| w.abs() < 1e-6), "{:?}", flows.net_w());
            let vote = |&view| cabin.passenger_pmv(&o.temperatures, view);
            let mean = views.all().iter().map(vote).sum::<f64>() / views.all().len() as f64;
            prop_assert!((mean - o.pmv).abs() < 1e-8, "{mean} {}", o.pmv);
            prop_assert!(o.pmv > window.pmv_min() - 1e-12 && o.pmv < window.pmv_max() + 1e-12, "{} {window:?}", o.pmv);
            let design = &grid.designs()[optimum.design];
            prop_assert!(design.devices.include(o.devices));
            let mode = match o.air_unit_heat_w {
                w if w > 0.0 => OperatingMode::Heating,
                w if w < 0.0 => OperatingMode::Cooling,
                _ => OperatingMode::Passive,
            };
            prop_assert_eq!(o.mode, mode);
            if let Outcome::Solved(_, Some(gap_w)) = optimum.outcome {
                prop_assert!(gap_w >= 0.0);
            }
        }
    }

    #[test]
    fn prop_wider_windows_and_more_options_never_cost_more(d in disturbances()) {
        let vehicle = Vehicle::default();
        let views = PassengerViews::from_view_factors(&[0.009, 0.013, 0.0142, 0.0165]);
        let windows = windows();
        let grid = Grid::new(all_designs(), windows.clone()).expect("valid");
        let optima = solve(&vehicle, &views, &grid, &d);
        let power_w = |design: usize, window: usize| operation(&optima[design * windows.len() + window]).hvac_power_w();
        for design in 0..grid.designs().len() {
            for wider in 1..17 {
                prop_assert!(power_w(design, wider) <= power_w(design, wider - 1) + 1e-6);
            }
        }
        for window in 0..windows.len() {
            for (more, less) in [(1, 0), (3, 2), (4, 2), (5, 3), (5, 4)] {
                prop_assert!(power_w(more, window) <= power_w(less, window) + 1e-9, "{more} {less}");
            }
        }
    }
}

#[test]
fn prop_heaters_can_have_their_optimum_inside_the_window() {
    // A mild day: with the heaters on the air unit has nothing to do at a vote inside the window.
    let vehicle = Vehicle::default();
    let views = PassengerViews::new(&vehicle);
    let window = ComfortWindow::symmetric(1.0).expect("valid");
    let grid = Grid::new(vec![design("ptc+rh", Heating::Ptc, true, false)], vec![window]).expect("valid");
    let mut inside = 0;
    for tenth in 0..150 {
        let d = Disturbances {
            ambient_temperature_k: kelvin(0.1 * f64::from(tenth)),
            dni_w_m2: 0.0,
            dhi_w_m2: 60.0,
            solar_altitude_rad: 0.4,
            shadow_fraction: 0.5,
            passengers: 30.0,
            door_open_fraction: 0.1,
        };
        let o = operation(&solve(&vehicle, &views, &grid, &d)[0]);
        if o.devices.radiant_heaters && o.mode == OperatingMode::Passive && o.pmv.abs() < 0.999 {
            inside += 1;
        }
    }
    assert!(inside > 0, "no optimum inside the window");
}

#[test]
fn prop_a_window_out_of_reach_is_a_status() {
    let vehicle = Vehicle { other_heat_w: 200_000.0, ..Vehicle::default() };
    let views = PassengerViews::new(&vehicle);
    let hot = ComfortWindow::new(3.0, 3.0).expect("valid");
    let grid = Grid::new(all_designs(), vec![hot]).expect("valid");
    let d = Disturbances {
        ambient_temperature_k: kelvin(-70.0),
        dni_w_m2: 0.0,
        dhi_w_m2: 0.0,
        solar_altitude_rad: 0.0,
        shadow_fraction: 0.0,
        passengers: 0.0,
        door_open_fraction: 1.0,
    };
    // Light clothing at −70 °C: a vote of 3 needs a cabin beyond 60 °C.
    let thin = Vehicle { clothing_floor_clo: 0.0, convection_inside_w_m2_k: 0.5, ..vehicle };
    let outcomes: Vec<_> = solve(&thin, &views, &grid, &d).into_iter().map(|o| o.outcome).collect();
    let cold = Outcome::Infeasible(Infeasible::TooCold);
    assert!(outcomes.iter().all(|o| *o == cold || matches!(o, Outcome::Solved(..))), "{outcomes:?}");
}

#[test]
fn prop_the_candidates_contain_the_optimum() {
    let vehicle = Vehicle::default();
    let views = PassengerViews::new(&vehicle);
    let grid = Grid::new(all_designs(), windows()).expect("valid");
    let d = Disturbances {
        ambient_temperature_k: kelvin(2.0),
        dni_w_m2: 100.0,
        dhi_w_m2: 50.0,
        solar_altitude_rad: 0.3,
        shadow_fraction: 0.5,
        passengers: 15.0,
        door_open_fraction: 0.14,
    };
    let optima = solve(&vehicle, &views, &grid, &d);
    for optimum in optima {
        let mut solver = SampleSolver::new(&vehicle, &views, &grid);
        let candidates = solver.candidates(&d, optimum.design, optimum.window);
        let cheapest_w = candidates
            .iter()
            .filter(|c| c.available)
            .filter_map(|c| c.operation.map(|o| o.hvac_power_w()))
            .fold(f64::INFINITY, f64::min);
        assert_eq!(cheapest_w, operation(&optimum).hvac_power_w());
    }
}

#[test]
fn prop_the_certificate_holds_for_the_paper_and_refuses_what_it_cannot_prove() {
    assert_eq!(certify(&Vehicle::default(), &all_designs()), Ok(()));
    let mut eager = design("eager", Heating::HeatPump, true, false);
    eager.heating_cop = Cop::Constant(40.0);
    assert!(matches!(
        certify(&Vehicle::default(), std::slice::from_ref(&eager)),
        Err(CertificateError::Heaters { .. })
    ));
    eager.devices.radiant_heaters = false;
    assert_eq!(certify(&Vehicle::default(), &[eager.clone()]), Ok(()));
    eager.heating_cop = Cop::Linear { at_zero: 2.0, slope_per_k: -0.1, min: 1.0, max: 9.0 };
    assert!(matches!(certify(&Vehicle::default(), &[eager]), Err(CertificateError::Cop(_))));
    let broken = Vehicle { shell_area_m2: 0.0, ..Vehicle::default() };
    assert!(matches!(certify(&broken, &all_designs()), Err(CertificateError::Vehicle(_))));
}

proptest! {
    #[test]
    fn prop_an_optimum_is_the_same_to_the_bit_whatever_else_the_grid_has(
        d in disturbances(),
        designs in proptest::sample::subsequence((0..all_designs().len()).collect::<Vec<_>>(), 1..=all_designs().len()),
        windows in proptest::sample::subsequence((0..windows().len() + 2).collect::<Vec<_>>(), 1..4),
    ) {
        let odd = [(-0.3, 0.7), (0.1, 2.93)].map(|(low, high)| ComfortWindow::new(low, high).expect("valid"));
        let grid = Grid::new(all_designs(), common::windows().into_iter().chain(odd).collect()).expect("valid");
        let vehicle = Vehicle::default();
        let views = PassengerViews::from_view_factors(&[0.009, 0.013, 0.0142, 0.0165]);
        let whole = solve(&vehicle, &views, &grid, &d);
        let part = solve(&vehicle, &views, &grid.part(&designs, &windows), &d);
        let all_windows = grid.windows().len();
        for (i, optimum) in part.iter().enumerate() {
            let (design, window) = (designs[i / windows.len()], windows[i % windows.len()]);
            prop_assert_eq!(optimum.outcome, whole[design * all_windows + window].outcome);
        }
    }
}

#[test]
fn prop_the_thread_count_does_not_show() {
    let vehicle = Vehicle::default();
    let grid = Grid::new(all_designs(), windows()).expect("valid");
    let samples: Vec<Disturbances> = (0..700)
        .map(|i| Disturbances {
            ambient_temperature_k: kelvin(-10.0 + 0.06 * f64::from(i)),
            dni_w_m2: f64::from(i % 7) * 100.0,
            dhi_w_m2: f64::from(i % 5) * 50.0,
            solar_altitude_rad: 0.1 * f64::from(i % 10),
            shadow_fraction: 0.1 * f64::from(i % 11),
            passengers: f64::from(i % 40),
            door_open_fraction: 0.01 * f64::from(i % 20),
        })
        .collect();
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        let mut all = Vec::new();
        pool.install(|| {
            solve::solve_blocks(&vehicle, &grid, &samples, |first, optima| {
                assert_eq!(first * grid.points(), all.len());
                all.extend_from_slice(optima);
                true
            })
        });
        all
    };
    let one = run(1);
    assert_eq!(one.len(), samples.len() * grid.points());
    assert_eq!(one, run(3));
}
