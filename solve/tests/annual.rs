//! A year that is added up while it is solved.

use cabin::{ComfortWindow, Infeasible, OperatingMode, Optimum, Outcome, PassengerViews, Vehicle, kelvin};
use solve::{Bus, Grid, SampleSolver, YearSamples, YearStates};
use std::sync::Arc;
use testing::{all_designs, paper_designs, year};

/// Against plain sums over stored optima, months one after the other.
#[test]
fn prop_a_year_is_the_mean_of_its_optima() {
    let vehicle = Vehicle::default();
    let views = PassengerViews::new(&vehicle);
    let windows = [0.5, 1.0].map(|limit| ComfortWindow::symmetric(limit).expect("valid")).to_vec();
    let grid = Grid::new(paper_designs(), windows).expect("valid");
    // No August, which then does not weigh.
    let month = |i: usize| [1_u8, 2, 3, 4, 5, 6, 7, 9, 10, 11, 12][i * 11 / 700];
    let samples: Vec<_> = year().into_iter().step_by(11).take(672).enumerate().collect();
    let mut all = YearSamples::default();
    let mut solver = SampleSolver::new(&vehicle, &views, &grid);
    let mut rows: Vec<(u8, Vec<Optimum>)> = Vec::new();
    for (i, sample) in &samples {
        assert!(all.add(month(*i), *sample));
        let mut optima = vec![Optimum::UNSOLVED; grid.points()];
        solver.solve(sample, &mut optima);
        rows.push((month(*i), optima));
    }
    assert!(!all.add(0, samples[0].1) && !all.add(13, samples[0].1));
    let means = all.means(&vehicle, &grid);
    let days = [31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31];
    for (point, mean) in means.iter().enumerate() {
        let (mut weight, mut total, mut cooling) = (0.0, 0.0, 0.0);
        for month in 1..=12 {
            let of_month: Vec<_> = rows.iter().filter(|row| row.0 == month).map(|row| &row.1[point].outcome).collect();
            let solved: Vec<_> = of_month.iter().filter_map(|outcome| outcome.operation()).collect();
            if solved.is_empty() {
                continue;
            }
            let of = |cools: bool| -> f64 {
                let counts = |o: &&&cabin::Operation| cools == (o.mode == OperatingMode::Cooling);
                solved.iter().filter(counts).map(|o| o.hvac_power_w()).sum::<f64>() / solved.len() as f64
            };
            let share = f64::from(days[month as usize - 1]);
            weight += share;
            cooling += share * of(true);
            total += share * (of(true) + of(false));
        }
        assert_eq!(weight, 365.0 - 31.0);
        let close = |found: Option<f64>, own: f64| (found.expect("solved") - own).abs() <= 1e-12 * total / weight;
        assert!(close(mean.hvac_power_w, total / weight), "{point}: {mean:?} {}", total / weight);
        assert!(close(mean.cooling_power_w, cooling / weight), "{point}: {mean:?} {}", cooling / weight);
        assert!(close(mean.heating_power_w, (total - cooling) / weight), "{point}: {mean:?}");
        assert_eq!((mean.samples, mean.unsolved), (672, 0));
    }
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    assert_eq!(one.install(|| all.means(&vehicle, &grid)), means);
}

#[test]
fn prop_a_year_without_an_operation_has_no_mean() {
    // At work, in summer heat that the air hardly takes from the walls: a vote of −3 needs a cabin below −60 °C.
    let vehicle = Vehicle {
        metabolic_rate_met: 4.0,
        clothing_floor_clo: 2.0,
        convection_inside_w_m2_k: 0.5,
        ..Vehicle::default()
    };
    let views = PassengerViews::new(&vehicle);
    let grid = Grid::new(paper_designs(), vec![ComfortWindow::new(-3.0, -2.9).expect("valid")]).expect("valid");
    let mut sample = testing::summer_day();
    sample.ambient_temperature_k = kelvin(60.0);
    let mut optima = vec![Optimum::UNSOLVED; grid.points()];
    SampleSolver::new(&vehicle, &views, &grid).solve(&sample, &mut optima);
    assert!(matches!(optima[0].outcome, Outcome::Infeasible(Infeasible::TooWarm)), "{:?}", optima[0].outcome);
    let mut all = YearSamples::default();
    all.add(3, sample);
    let means = all.means(&vehicle, &grid);
    assert_eq!((means[0].hvac_power_w, means[0].samples, means[0].unsolved), (None, 1, 1));
    assert_eq!(YearSamples::default().means(&vehicle, &grid)[0].samples, 0);
}

/// Every device, unequal windows, and a bus that has little to do with the one that its states are sought from.
#[test]
fn prop_a_year_sought_from_another_bus_is_the_same() {
    let vehicle = Vehicle::default();
    let windows = [(-1.0, 1.0), (0.2, 0.7), (-1.5, -0.5), (0.0, 0.0)];
    let windows = windows.map(|(low, high)| ComfortWindow::new(low, high).expect("valid")).to_vec();
    let grid = Grid::new(all_designs(), windows).expect("valid");
    let mut all = YearSamples::default();
    for (i, sample) in year().into_iter().step_by(17).enumerate() {
        all.add((i % 12) as u8 + 1, sample);
    }
    let states = YearStates::new(&all, &vehicle, &grid);
    let other =
        Vehicle { conduction_shell_w_m2_k: 1.5, window_transmissivity: 0.9, other_heat_w: 4e3, ..vehicle.clone() };
    for vehicle in [vehicle, other] {
        let views = Arc::new(PassengerViews::new(&vehicle));
        let bus = Bus { vehicle: vehicle.clone(), views, designs: grid.designs().to_vec() };
        let near = states.means(&bus, |sample| *sample);
        for (near, mean) in near.iter().zip(all.means(&vehicle, &grid)) {
            let scale = mean.hvac_power_w.expect("solved").max(1.0);
            let close = |a: Option<f64>, b: Option<f64>| (a.expect("solved") - b.expect("solved")).abs() < 1e-9 * scale;
            assert!(close(near.hvac_power_w, mean.hvac_power_w), "{near:?} {mean:?}");
            assert!(close(near.heating_power_w, mean.heating_power_w), "{near:?} {mean:?}");
            assert!(close(near.cooling_power_w, mean.cooling_power_w), "{near:?} {mean:?}");
            assert_eq!((near.samples, near.unsolved), (mean.samples, mean.unsolved));
        }
    }
}
