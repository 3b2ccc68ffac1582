//! Designs whose air unit is limited, and back-up heaters.

use cabin::{
    Cabin, ComfortWindow, Design, Devices, Disturbances, Heating, LimitOf, OperatingMode, Optimum, Outcome,
    PassengerViews, PowerLimit, Target, Vehicle, kelvin,
};
use solve::{Bus, Grid, SampleSolver, YearSamples, YearStates};
use std::sync::Arc;
use testing::{all_designs, design, gallery, operation, year};

fn limit(of: LimitOf, w: f64) -> Option<PowerLimit> {
    Some(PowerLimit::constant(of, w).expect("a limit"))
}

fn windows() -> Vec<ComfortWindow> {
    [(-1.0, 1.0), (0.2, 0.7), (-0.25, 0.25)].map(|(low, high)| ComfortWindow::new(low, high).expect("valid")).to_vec()
}

fn solve(designs: Vec<Design>, samples: &[Disturbances]) -> Vec<Vec<Optimum>> {
    let vehicle = Vehicle::default();
    let views = PassengerViews::new(&vehicle);
    let grid = Grid::new(designs, windows()).expect("valid");
    let mut solver = SampleSolver::new(&vehicle, &views, &grid);
    let solve = |sample: &Disturbances| {
        let mut optima = vec![Optimum::UNSOLVED; grid.points()];
        solver.solve(sample, &mut optima);
        optima
    };
    samples.iter().map(solve).collect()
}

fn samples() -> Vec<Disturbances> {
    gallery().into_iter().map(|(_, sample)| sample).chain(year().into_iter().step_by(397)).collect()
}

#[test]
fn prop_a_limit_that_never_binds_changes_no_bit() {
    let free = all_designs();
    for of in [LimitOf::Electric, LimitOf::Thermal] {
        let mut limited = free.clone();
        for design in &mut limited {
            (design.heating_limit, design.cooling_limit) = (limit(of, 1e6), limit(of, 1e6));
            design.backup_heater_w = 5e3;
        }
        assert_eq!(solve(limited, &samples()), solve(free.clone(), &samples()));
    }
}

/// The nearest state by a dense scan of cabin temperatures: of those that the unit can hold, the one whose vote is nearest to the
/// window, over all choices of devices.
#[test]
fn prop_no_state_that_the_limits_allow_is_nearer_to_the_window() {
    let vehicle = Vehicle::default();
    let views = PassengerViews::new(&vehicle);
    let mut hp = design("hp+all", Heating::HeatPump, true, true);
    hp.heating_limit = Some(PowerLimit::table(LimitOf::Electric, &[(-10.0, 500.0), (10.0, 1500.0)]).expect("a table"));
    hp.cooling_limit = limit(LimitOf::Thermal, 1500.0);
    let samples = samples();
    let mut seen = [0, 0];
    for (sample, optima) in samples.iter().zip(solve(vec![hp.clone()], &samples)) {
        let cabin = Cabin::new(&vehicle, &views, sample);
        for (window, optimum) in windows().iter().zip(&optima) {
            let o = operation(optimum);
            let miss = |pmv: f64| (window.pmv_min() - pmv).max(pmv - window.pmv_max()).max(0.0);
            seen[usize::from(o.unmet_heat_w > 0.0)] += 1;
            assert_eq!(o.unmet_heat_w > 0.0, miss(o.pmv) > 1e-9, "{o:?}");
            let words = if o.unmet_heat_w > 0.0 { "limited" } else { "solved" };
            assert_eq!(optimum.outcome.words(), words);
            for devices in Devices::CHOICES {
                let heaters = devices.heaters();
                for step in 0..400 {
                    let cabin_k = kelvin(-25.0 + 0.2 * f64::from(step));
                    let guess = cabin.rough_state(cabin_k);
                    let state = cabin.state(Target::CabinTemperature(cabin_k), heaters, &guess).expect("settles");
                    let t = &state.temperatures;
                    let heat_w = cabin.air_unit_heat_w(t, &state.slopes, devices.air_curtain).0;
                    let mode = if heat_w > 0.0 { OperatingMode::Heating } else { OperatingMode::Cooling };
                    let lift_k = mode.lift_k(cabin.ambient_k(), cabin_k);
                    let heater_w = if devices.radiant_heaters { cabin.radiant_heater_power_w(t) } else { 0.0 };
                    if heater_w < 0.0 || heat_w.abs() > hp.capacity_w(mode, cabin.ambient_k(), lift_k) {
                        continue;
                    }
                    assert!(miss(state.pmv) >= miss(o.pmv) - 1e-6, "{devices:?} at {cabin_k} K is nearer than {o:?}");
                    if miss(state.pmv) == 0.0 {
                        let curtain_w = if devices.air_curtain { cabin.air_curtain_power_w() } else { 0.0 };
                        let supply = hp.supply(mode, heat_w.abs(), cabin.ambient_k(), lift_k);
                        let power_w = supply.power_w + heater_w + curtain_w;
                        assert!(
                            power_w >= o.hvac_power_w() - 1e-6 * power_w.max(1.0),
                            "{power_w} W is less than {o:?}"
                        );
                    }
                }
            }
        }
    }
    assert!(seen.iter().all(|count| *count > 10), "{seen:?}");
}

#[test]
fn prop_the_cheaper_source_comes_first_and_nothing_is_lost() {
    let mut hp = design("hp", Heating::HeatPump, false, false);
    hp.heating_limit = limit(LimitOf::Thermal, 3e3);
    hp.backup_heater_w = 2e3;
    let heating = |heat_w: f64| hp.supply(OperatingMode::Heating, heat_w, kelvin(0.0), 18.0);
    let cop = hp.heating_cop.at(18.0);
    assert_eq!((heating(2e3).power_w, heating(2e3).backup_w), (2e3 / cop, 0.0));
    assert_eq!((heating(4e3).power_w, heating(4e3).backup_w, heating(4e3).unmet_w), (3e3 / cop + 1e3, 1e3, 0.0));
    assert_eq!((heating(6e3).power_w, heating(6e3).unmet_w), (3e3 / cop + 2e3, 1e3));
    // Where the heat pump is worse than the back-up heater, that comes first.
    hp.heating_cop = cabin::Cop::Constant(0.5);
    let worse = hp.supply(OperatingMode::Heating, 3e3, kelvin(0.0), 18.0);
    assert_eq!((worse.backup_w, worse.power_w), (2e3, 2e3 + 1e3 / 0.5));
    assert_eq!(hp.supply(OperatingMode::Cooling, 3e3, kelvin(0.0), 1.0).backup_w, 0.0);
}

#[test]
fn prop_more_help_never_misses_more() {
    let mut limited = design("hp", Heating::HeatPump, false, true);
    limited.heating_limit = limit(LimitOf::Thermal, 3e3);
    let mut helped = limited.clone();
    (helped.name, helped.backup_heater_w) = ("helped".to_owned(), 4e3);
    let mut counts = [0, 0];
    for optima in solve(vec![limited, helped], &samples()) {
        for (less, more) in optima[..3].iter().zip(&optima[3..]) {
            let (less, more) = (operation(less), operation(more));
            assert!(more.unmet_heat_w <= less.unmet_heat_w);
            assert!(more.backup_heater_power_w <= more.air_unit_power_w && less.backup_heater_power_w == 0.0);
            counts[0] += usize::from(less.unmet_heat_w > 0.0);
            counts[1] += usize::from(more.unmet_heat_w > 0.0);
        }
    }
    assert!(counts[0] > counts[1] && counts[1] > 0, "{counts:?}");
}

#[test]
fn prop_years_of_many_limited_buses_are_those_of_their_optima() {
    let vehicle = Vehicle::default();
    let mut designs = all_designs();
    for design in &mut designs {
        (design.heating_limit, design.cooling_limit) = (limit(LimitOf::Electric, 1200.0), limit(LimitOf::Thermal, 2e3));
        design.backup_heater_w = 800.0;
    }
    let grid = Grid::new(designs, windows()).expect("valid");
    let of_year: Vec<Disturbances> = year().into_iter().step_by(53).collect();
    let mut all = YearSamples::default();
    for (i, sample) in of_year.iter().enumerate() {
        all.add((i % 12) as u8 + 1, *sample);
    }
    let bus = Bus {
        vehicle: vehicle.clone(),
        views: Arc::new(PassengerViews::new(&vehicle)),
        designs: grid.designs().to_vec(),
    };
    let near = YearStates::new(&all, &vehicle, &grid).means(&bus, |sample| *sample);
    for (near, mean) in near.iter().zip(all.means(&vehicle, &grid)) {
        let (a, b) = (near.hvac_power_w.expect("solved"), mean.hvac_power_w.expect("solved"));
        assert!((a - b).abs() < 1e-8 * b.max(1.0), "{near:?} {mean:?}");
        assert_eq!((near.unsolved, near.limited), (mean.unsolved, mean.limited));
    }
    let mut limited = vec![0; grid.points()];
    for optima in solve(grid.designs().to_vec(), &of_year) {
        for (count, optimum) in limited.iter_mut().zip(&optima) {
            *count += u64::from(optimum.outcome.words() == "limited");
        }
    }
    assert_eq!(near.iter().map(|mean| mean.limited).collect::<Vec<_>>(), limited);
    assert!(limited.iter().any(|count| *count > 0));
}

#[test]
fn prop_a_table_that_is_no_limit_is_said() {
    let said = |rows: &[(f64, f64)]| PowerLimit::table(LimitOf::Thermal, rows).expect_err("none").to_string();
    assert!(said(&[]).contains("empty"));
    assert!(said(&[(0.0, -1.0)]).starts_with("row 1 is [0, -1]"));
    assert!(said(&[(0.0, 1.0), (0.0, 2.0)]).starts_with("row 2: 0 °C is not above"));
    let table = PowerLimit::table(LimitOf::Thermal, &[(-10.0, 2e3), (10.0, 4e3)]).expect("a table");
    assert_eq!([-20.0, -5.0, 30.0].map(|c| table.at_w(kelvin(c))), [2e3, 2500.0, 4e3]);
    let unsolved = Outcome::NotConverged;
    assert_eq!(unsolved.words(), "not converged");
}
