//! The dynamic model: it settles on the optima, keeps its energy, and its step is short enough.

use cabin::{
    Cabin, ComfortWindow, Design, Disturbances, Heating, LoadChange, OperatingMode, Operation, PassengerViews,
    Temperatures, Vehicle, celsius, kelvin,
};
use setpoints::{Curve, published};
use simulate::control::{AirCurtain, CausalController, Law};
use simulate::{BusState, Commands, Dynamics, Instant, Mission, Replay, Segment, Summary, simulate, simulate_with};
use simulate::{Limits, Scenario, Start, Variant, simulate_distinct};
use testing::{TestMission, day, design, optimum, paper_designs, simulate_finely, step};

fn segment(vehicle: &Vehicle, views: &PassengerViews, o: Operation, d: &Disturbances, limit: f64) -> Segment {
    let window = ComfortWindow::symmetric(limit).expect("valid");
    Segment::new(&Cabin::new(vehicle, views, d), &o, window)
}

/// A mission in one variant; `record` sees every second.
fn run(
    mission: &Mission<'_, '_>,
    design: &Design,
    segments: &[Segment],
    replay: Replay,
    mut record: impl FnMut(&Instant),
) -> Summary {
    let variants = [replay.of(design, segments)];
    simulate_with(mission, &Dynamics::default(), &variants, &mut |_, now| record(now))
        .expect("it has segments")
        .remove(0)
}

/// Constant inputs for so many hours.
fn constant(
    design: &Design,
    d: &Disturbances,
    limit: f64,
    hours: usize,
    replay: Replay,
) -> (Operation, Summary, Instant) {
    let vehicle = Vehicle::default();
    let views = PassengerViews::new(&vehicle);
    let o = optimum(&vehicle, &views, design, d, limit);
    let segments = vec![segment(&vehicle, &views, o, d, limit); hours];
    let minutes = vec![Cabin::new(&vehicle, &views, d); 60 * segments.len()];
    let loads = [LoadChange { second: 0, passengers: d.passengers, door_open: 1.0 }];
    let mission = Mission {
        loads: &loads,
        minutes: &minutes,
        segments: hours,
        segment_s: 3600,
        door_open_share: d.door_open_fraction,
    };
    let mut last = None;
    let summary = run(&mission, design, &segments, replay, |now| last = Some(*now));
    (o, summary, last.expect("it has seconds"))
}

#[test]
fn prop_with_constant_inputs_the_simulation_settles_on_the_optimum() {
    let days = [testing::winter_day(), testing::spring_day(), day(18.0, 200.0, 30.0, 0.2), testing::summer_day()];
    let mut modes = Vec::new();
    for design in paper_designs() {
        for d in &days {
            for limit in [0.0, 1.0] {
                let (o, _, end) = constant(&design, d, limit, 30, Replay::UNLIMITED);
                modes.push((o.mode, o.devices.radiant_heaters));
                let (a, b) = (o.temperatures, end.state.temperatures);
                let off_k = [
                    a.cabin_k - b.cabin_k,
                    a.interior_k - b.interior_k,
                    a.shell_inside_k - b.shell_inside_k,
                    a.shell_outside_k - b.shell_outside_k,
                    a.radiant_heater_k - b.radiant_heater_k,
                ];
                assert!(off_k.iter().all(|k| k.abs() < 1e-3), "{} {d:?}: {off_k:?}", design.name);
                let c = end.commands;
                let power_w = c.air_unit_power_w.abs() + c.radiant_heater_power_w + end.air_curtain_power_w;
                assert!(
                    (power_w - o.hvac_power_w()).abs() < 0.1,
                    "{} {d:?}: {power_w} {}",
                    design.name,
                    o.hvac_power_w()
                );
                assert!((end.pmv - o.pmv).abs() < 1e-3, "{} {}", end.pmv, o.pmv);
            }
        }
    }
    for mode in [OperatingMode::Heating, OperatingMode::Passive, OperatingMode::Cooling] {
        assert!(modes.iter().any(|m| m.0 == mode), "no optimum {mode:?}");
    }
    assert!(modes.iter().any(|m| m.1), "no optimum with radiant heaters");
}

/// A mission with stops: doors open for 20 s every 80 s, another load at each stop.
fn stops(seconds: u32) -> Vec<LoadChange> {
    (0..seconds / 40)
        .map(|i| LoadChange {
            second: 80 * (i / 2) + 20 * (i % 2),
            passengers: f64::from((i / 2 * 7) % 41),
            door_open: f64::from(i % 2 == 0),
        })
        .collect()
}

#[test]
fn prop_energy_is_conserved_over_a_mission() {
    let vehicle = Vehicle::default();
    let views = PassengerViews::new(&vehicle);
    let dynamics = Dynamics::default();
    let d = day(-2.0, 150.0, 20.0, 0.15);
    let loads = stops(3600 * 3);
    let minutes = vec![Cabin::new(&vehicle, &views, &d); 180];
    let mission = Mission { loads: &loads, minutes: &minutes, segments: 3, segment_s: 3600, door_open_share: 0.6 };
    for design in paper_designs() {
        let o = optimum(&vehicle, &views, &design, &d, 1.0);
        let segments = vec![segment(&vehicle, &views, o, &d, 1.0); 3];
        let mut seconds: Vec<Instant> = Vec::new();
        run(&mission, &design, &segments, Replay::PAPER, |now| seconds.push(*now));
        // What crosses the border of the bus; the flows inside must cancel. Heat of the air unit is COP · power less what its
        // machine has not given yet.
        let (mut net_j, mut through_j) = (0.0, 0.0);
        for pair in seconds.windows(2) {
            let (before, now) = (&pair[0].state, &pair[1].state);
            let middle = |f: fn(&Temperatures) -> f64| 0.5 * (f(&before.temperatures) + f(&now.temperatures));
            let t = Temperatures {
                cabin_k: middle(|t| t.cabin_k),
                interior_k: middle(|t| t.interior_k),
                shell_inside_k: middle(|t| t.shell_inside_k),
                shell_outside_k: middle(|t| t.shell_outside_k),
                radiant_heater_k: middle(|t| t.radiant_heater_k),
            };
            let c = &pair[1].commands;
            let at_once = design.heating == Heating::Ptc;
            let air_unit_w =
                if at_once { c.air_unit_power_w } else { 0.5 * (before.machine_heat_w + now.machine_heat_w) };
            let cabin = minutes[0].with_load(pair[1].passengers, pair[1].door_open_fraction);
            let f = cabin.flows(&t, c.air_curtain_on, air_unit_w, c.radiant_heater_power_w);
            let gains =
                f.passengers_w + f.other_w + f.solar.interior_w + f.solar.shell_inside_w + f.solar.shell_outside_w;
            let losses = f.door_w + f.convection_shell_outside_w + f.radiation_shell_outside_w;
            net_j += gains + f.air_unit_w + f.radiant_heater_power_w - losses;
            through_j += gains + f.air_unit_w.abs() + f.radiant_heater_power_w;
        }
        let rise = |f: fn(&Temperatures) -> f64| {
            f(&seconds[seconds.len() - 1].state.temperatures) - f(&seconds[0].state.temperatures)
        };
        let stored_j = dynamics.cabin_capacity_j_k * rise(|t| t.cabin_k)
            + dynamics.interior_capacity_j_k * rise(|t| t.interior_k)
            + dynamics.shell_inside_capacity_j_k * rise(|t| t.shell_inside_k)
            + dynamics.shell_outside_capacity_j_k * rise(|t| t.shell_outside_k)
            + dynamics.radiant_heater_capacity_j_k * rise(|t| t.radiant_heater_k);
        let name = &design.name;
        assert!(
            (net_j - stored_j).abs() < 1e-4 * through_j,
            "{name}: {net_j} J in, {stored_j} J stored, of {through_j} J"
        );
    }
}

/// How far the simulation is from the fine reference; `BUSCLIMATE_MISSIONS` says for how many missions.
#[test]
fn prop_the_errors_of_stored_values_are_below_what_is_stated() {
    let vehicle = Vehicle::default();
    let views = PassengerViews::new(&vehicle);
    let designs = paper_designs();
    let dynamics = Dynamics::default();
    let count: usize = std::env::var("BUSCLIMATE_MISSIONS").ok().and_then(|n| n.parse().ok()).unwrap_or(2);
    // Largest errors: of mean power in W and as a share of what is allowed, of the 15-minute vote, of the share of saturated
    // time, of tracking in K.
    let mut largest = [0.0_f64; 5];
    for n in 0..count {
        // Two or three hours, spread over the year and the hours of the day.
        let test = TestMission::new(&vehicle, &views, &designs, 30 + n * (7300 / count), 2 + n % 2);
        let (mission, variants) = (test.mission(), test.variants(&designs));
        let summaries = simulate(&mission, &dynamics, &variants).expect("it has segments");
        for (variant, ours) in variants.iter().zip(&summaries) {
            let fine = simulate_finely(&mission, &dynamics, variant, 20, |_| ());
            let power_w = (ours.mean_hvac_power_w - fine.mean_hvac_power_w).abs();
            let pmv = |s: &Summary| s.max_abs_pmv_15min.unwrap_or(0.0);
            let errors = [
                power_w,
                power_w / (0.1 + 2e-4 * fine.mean_hvac_power_w),
                (pmv(ours) - pmv(&fine)).abs(),
                (ours.saturated_fraction - fine.saturated_fraction).abs(),
                (ours.tracking_error_k - fine.tracking_error_k).abs(),
            ];
            for (largest, error) in largest.iter_mut().zip(errors) {
                *largest = largest.max(error);
            }
            let name = (&variant.design.name, variant.scenario, variant.law, n);
            assert!(errors[1] <= 1.0, "{name:?}: {} {} W", ours.mean_hvac_power_w, fine.mean_hvac_power_w);
            assert!(errors[2] <= 0.002, "{name:?}: {ours:?} {fine:?}");
            assert_eq!(ours.max_abs_pmv_15min.is_some(), fine.max_abs_pmv_15min.is_some());
        }
    }
    let [power_w, of_allowed, pmv, saturated, tracking_k] = largest;
    println!(
        "{count} missions, largest errors: mean power {power_w:.2e} W ({of_allowed:.2e} of what is allowed), 15-minute vote \
         {pmv:.2e}, saturated share {saturated:.2e}, tracking {tracking_k:.2e} K"
    );
}

#[test]
fn prop_a_variant_comes_out_the_same_in_whatever_company() {
    let vehicle = Vehicle::default();
    let views = PassengerViews::new(&vehicle);
    let mut designs = paper_designs();
    // Curves of all kinds, among them those that have no formula abreast.
    for (design, name) in designs.iter_mut().zip(["vecto-continuous-exponential", "vecto-r744-rows", "eflips"]) {
        let named = cabin::named_heating_cops().into_iter().find(|(n, ..)| *n == name);
        design.heating_cop = named.expect("a named curve").1;
    }
    let test = TestMission::new(&vehicle, &views, &designs, 3000, 2);
    let (mission, variants) = (test.mission(), test.variants(&designs));
    let together = simulate(&mission, &Dynamics::default(), &variants).expect("it has segments");
    for (n, variant) in variants.iter().enumerate().step_by(3) {
        let alone = simulate(&mission, &Dynamics::default(), std::slice::from_ref(variant)).expect("it has segments");
        assert_eq!(alone, together[n..=n], "{n}");
    }
    let fine = simulate_finely(&mission, &Dynamics::default(), &variants[20], 20, |_| ());
    assert!((fine.mean_hvac_power_w - together[20].mean_hvac_power_w).abs() < 0.5, "{fine:?}");
}

#[test]
fn prop_variants_that_are_driven_once_come_out_as_each_by_itself() {
    let vehicle = Vehicle::default();
    let views = PassengerViews::new(&vehicle);
    let designs = paper_designs();
    let (mut held_back, mut at_rest) = (0, 0);
    for first in [30, 2100, 3700, 6600] {
        let test = TestMission::new(&vehicle, &views, &designs, first, 4);
        let mission = test.mission();
        let mut variants = test.variants(&designs);
        let controllers: Vec<CausalController> =
            published().iter().take(3).map(CausalController::published).chain([causal()]).collect();
        let windows = [0.5, 1.0].map(|limit| ComfortWindow::symmetric(limit).expect("valid"));
        for (law, design) in controllers.iter().map(Law::Causal).flat_map(|law| designs.iter().map(move |d| (law, d))) {
            let depot = Replay::PAPER.of(design, variants[0].segments);
            variants.push(Variant { law, windows: &windows, ..depot });
        }
        // Limits that some of them come up to.
        for dynamics in [Dynamics::default(), Dynamics { heat_pump_limit_w: 3000.0, ..Dynamics::default() }] {
            let each = simulate(&mission, &dynamics, &variants).expect("it has segments");
            let distinct = simulate_distinct(&mission, &dynamics, &variants).expect("it has segments");
            assert_eq!(each, distinct, "hour {first}");
            held_back += each.iter().filter(|s| s.used.limit).count();
            at_rest += each.iter().filter(|s| !(s.used.heating || s.used.cooling)).count();
        }
    }
    assert!(held_back > 100 && at_rest > 20, "{held_back} {at_rest}");
}

/// A controller whose setpoints and thresholds all matter on some day of the year.
fn causal() -> CausalController {
    CausalController {
        heating: Curve::through(&[(-10.0, 17.0), (10.0, 18.5), (25.0, 21.0)]).expect("three pairs"),
        cooling: Curve::through(&[(10.0, 23.0), (35.0, 26.0)]).expect("two pairs"),
        dead_band_k: 0.0,
        cools_above_c: f64::NEG_INFINITY,
        hysteresis_k: 1.0,
        air_curtain: AirCurtain::Above { heating_k: 4.8, cooling_k: 4.1 },
        heaters_below_c: Some(4.0),
        radiant_heater_k: 343.15,
    }
}

const FROM_DEPOT: Scenario = Scenario { start: Start::Depot, limits: Limits::Rated };

#[test]
fn prop_a_causal_controller_comes_out_as_in_the_reference() {
    let vehicle = Vehicle::default();
    let views = PassengerViews::new(&vehicle);
    let designs = [paper_designs().swap_remove(4), design("all", Heating::Ptc, true, true)];
    let one_setpoint = Curve::through(&[(0.0, 20.0), (35.0, 27.0)]).expect("two pairs");
    let single = CausalController {
        heating: one_setpoint.clone(),
        cooling: one_setpoint,
        dead_band_k: 1.0,
        cools_above_c: 17.0,
        ..causal()
    };
    let (mut heats, mut cools, mut curtains, mut heaters, mut outside) = (0, 0, 0, 0, 0.0);
    let windows = [0.25, 0.5, 1.0].map(|limit| ComfortWindow::symmetric(limit).expect("valid"));
    for first in [30, 1200, 2500, 3700, 5300] {
        let test = TestMission::new(&vehicle, &views, &designs, first, 3);
        let mission = test.mission();
        // One variant of each design; what its optima are does not matter.
        let variants = test.variants(&designs);
        let of_design = |d: usize| variants[d * variants.len() / 2];
        for (variant, controller) in [(of_design(0), &causal()), (of_design(1), &causal()), (of_design(0), &single)] {
            let variant = Variant { scenario: FROM_DEPOT, law: Law::Causal(controller), windows: &windows, ..variant };
            let mut record = |_: usize, now: &Instant| {
                heats += u32::from(now.commands.air_unit_power_w > 0.0);
                cools += u32::from(now.commands.air_unit_power_w < 0.0);
                curtains += u32::from(now.commands.air_curtain_on);
                heaters += u32::from(now.commands.radiant_heater_power_w > 0.0);
                let ambient_c = celsius(mission.minutes[now.second as usize / 60].ambient_k());
                let setpoints_k = [&controller.heating, &controller.cooling].map(|curve| kelvin(curve.at(ambient_c)));
                match now.setpoint_k {
                    Some(k) if now.commands.air_unit_power_w > 0.0 => assert_eq!(k, setpoints_k[0]),
                    Some(k) if now.commands.air_unit_power_w < 0.0 => assert_eq!(k, setpoints_k[1]),
                    Some(k) => assert!(setpoints_k.contains(&k)),
                    None => assert_eq!(now.commands.air_unit_power_w, 0.0),
                }
            };
            let ours = simulate_with(&mission, &Dynamics::default(), &[variant], &mut record)
                .expect("it has segments")
                .remove(0);
            let fine = simulate_finely(&mission, &Dynamics::default(), &variant, 10, |_| ());
            let off_w = (ours.mean_hvac_power_w - fine.mean_hvac_power_w).abs();
            assert!(off_w < 0.1 + 2e-4 * fine.mean_hvac_power_w, "{first}: {ours:?} {fine:?}");
            assert!((ours.tracking_error_k - fine.tracking_error_k).abs() < 1e-3, "{first}: {ours:?} {fine:?}");
            let votes = [&ours, &fine].map(|s| s.max_abs_pmv_15min.unwrap_or(0.0));
            assert!((votes[0] - votes[1]).abs() < 0.002, "{first}: {votes:?}");
            let votes = [&ours, &fine].map(|s| s.rides.mean_abs_pmv.unwrap_or(0.0));
            assert!((votes[0] - votes[1]).abs() < 0.001, "{first}: {votes:?}");
            let [ours, fine] = [ours.rides, fine.rides];
            assert!((ours.passenger_hours - fine.passenger_hours).abs() < 1e-9, "{first}: {ours:?} {fine:?}");
            assert_eq!(ours.hours_outside.len(), windows.len());
            let of_windows = ours.hours_outside.iter().zip(&fine.hours_outside);
            for (ours, fine_hours) in of_windows {
                // A vote that stays near a limit for long may count on either side.
                assert!((ours - fine_hours).abs() <= 0.01 * fine.passenger_hours, "{first}: {ours} {fine:?}");
                outside += ours;
            }
        }
    }
    assert!(outside > 10.0, "{outside}");
    assert!(heats > 1000 && cools > 1000 && curtains > 1000 && heaters > 1000, "{heats} {cools} {curtains} {heaters}");
}

#[test]
fn prop_published_setpoints_drive_a_mission_without_heating_against_cooling() {
    let vehicle = Vehicle::default();
    let views = PassengerViews::new(&vehicle);
    let designs = [paper_designs().swap_remove(4)];
    let (mut heats, mut cools) = (0, 0);
    for first in [30, 2500, 3700, 5300] {
        let test = TestMission::new(&vehicle, &views, &designs, first, 6);
        for published in published() {
            let controller = CausalController::published(&published);
            let variant = Variant { scenario: FROM_DEPOT, law: Law::Causal(&controller), ..test.variants(&designs)[0] };
            // Where the air unit last worked, and with what sign.
            let (mut last, mut turns): (Option<(f64, u32)>, Vec<u32>) = (None, Vec::new());
            let mut record = |_: usize, now: &Instant| {
                let power_w = now.commands.air_unit_power_w;
                if power_w == 0.0 {
                    return;
                }
                heats += u32::from(power_w > 0.0);
                cools += u32::from(power_w < 0.0);
                if let Some((_, second)) = last.filter(|(sign, _)| *sign != power_w.signum()) {
                    turns.push(now.second - second);
                }
                last = Some((power_w.signum(), now.second));
            };
            simulate_with(&test.mission(), &Dynamics::default(), &[variant], &mut record).expect("it has segments");
            assert!(turns.len() <= 2 && turns.iter().all(|s| *s > 300), "{} {first}: {turns:?}", published.name);
        }
    }
    assert!(heats > 10_000 && cools > 10_000, "{heats} {cools}");
}

#[test]
fn prop_the_past_of_a_causal_controller_does_not_know_the_future() {
    let vehicle = Vehicle::default();
    let views = PassengerViews::new(&vehicle);
    let designs = [paper_designs().swap_remove(4)];
    let controller = causal();
    // Two missions with the same first two hours.
    let [long, short] = [5, 2].map(|hours| TestMission::new(&vehicle, &views, &designs, 2490, hours));
    let seconds = |test: &TestMission<'_>, minutes: usize| {
        let mission = test.mission();
        let variant = Variant { scenario: FROM_DEPOT, law: Law::Causal(&controller), ..test.variants(&designs)[0] };
        let mut seconds = Vec::new();
        let mut record = |_: usize, now: &Instant| seconds.push(*now);
        simulate_with(&mission, &Dynamics::default(), &[variant], &mut record).expect("it has segments");
        seconds.truncate(60 * minutes);
        seconds
    };
    // Weather is linear between the middles of the hours: up to the middle of the last hour both have the same.
    assert_eq!(seconds(&long, 90), seconds(&short, 90));
}

#[test]
fn prop_a_last_part_of_any_length_is_simulated_to_its_end() {
    let vehicle = Vehicle::default();
    let views = PassengerViews::new(&vehicle);
    let (design, d) = (design("hp", Heating::HeatPump, false, false), day(-2.0, 0.0, 20.0, 0.15));
    let o = optimum(&vehicle, &views, &design, &d, 1.0);
    let segments = [segment(&vehicle, &views, o, &d, 1.0)];
    let (minutes, loads) = (vec![Cabin::new(&vehicle, &views, &d); 21], stops(1234));
    let mission = Mission { loads: &loads, minutes: &minutes, segments: 1, segment_s: 1234, door_open_share: 0.6 };
    let variant = Replay::PAPER.of(&design, &segments);
    let ours = &simulate(&mission, &Dynamics::default(), &[variant]).expect("it has a segment")[0];
    let fine = simulate_finely(&mission, &Dynamics::default(), &variant, 20, |_| ());
    assert_eq!(ours.seconds, 1234);
    assert!((ours.mean_hvac_power_w - fine.mean_hvac_power_w).abs() < 1.0, "{ours:?} {fine:?}");
    let pmv = [ours, &fine].map(|s| s.max_abs_pmv_15min.expect("somebody is on board"));
    assert!((pmv[0] - pmv[1]).abs() < 0.002, "{pmv:?}");
    assert_eq!(simulate(&Mission { segments: 0, ..mission }, &Dynamics::default(), &[]), None);
    assert_eq!(simulate(&Mission { minutes: &minutes[..20], ..mission }, &Dynamics::default(), &[variant]), None);
}

/// The equations once more, for a library that integrates them to a tight tolerance.
struct Equations<'a> {
    cabin: Cabin<'a>,
    design: &'a Design,
    dynamics: Dynamics,
    commands: Commands,
}

impl ode_solvers::System<f64, ode_solvers::Vector6<f64>> for Equations<'_> {
    fn system(&self, _: f64, y: &ode_solvers::Vector6<f64>, dy: &mut ode_solvers::Vector6<f64>) {
        let t = Temperatures {
            radiant_heater_k: y[0],
            interior_k: y[1],
            cabin_k: y[2],
            shell_inside_k: y[3],
            shell_outside_k: y[4],
        };
        let (c, d) = (&self.commands, &self.dynamics);
        let net_w = self.cabin.flows(&t, c.air_curtain_on, y[5], c.radiant_heater_power_w).net_w();
        let capacities = [
            d.radiant_heater_capacity_j_k,
            d.interior_capacity_j_k,
            d.cabin_capacity_j_k,
            d.shell_inside_capacity_j_k,
            d.shell_outside_capacity_j_k,
        ];
        for i in 0..5 {
            dy[i] = net_w[i] / capacities[i];
        }
        let cop = self.design.heating_cop.at(y[2] - self.cabin.ambient_k());
        dy[5] = (cop * c.air_unit_power_w - y[5]) / d.air_unit_time_constant_s;
    }
}

#[test]
fn xval_ode_solvers_the_reference_solves_the_equations() {
    let vehicle = Vehicle::default();
    let views = PassengerViews::new(&vehicle);
    let dynamics = Dynamics::default();
    let design = design("hp+curtain", Heating::HeatPump, false, true);
    let weather = Cabin::new(&vehicle, &views, &day(-8.0, 0.0, 0.0, 0.0));
    let t = weather.rough_state(kelvin(6.0)).temperatures;
    let mut ours = BusState { temperatures: t, machine_heat_w: 0.0 };
    let mut theirs = ode_solvers::Vector6::new(
        t.radiant_heater_k,
        t.interior_k,
        t.cabin_k,
        t.shell_inside_k,
        t.shell_outside_k,
        0.0,
    );
    let (mut largest_k, mut mean_off_w) = (0.0_f64, 0.0);
    let seconds = 3600_u32;
    for second in 0..seconds {
        let commands = Commands {
            air_unit_power_w: if second / 37 % 2 == 0 { 12_000.0 } else { 500.0 },
            radiant_heater_power_w: if second / 91 % 2 == 0 { 4_000.0 } else { 0.0 },
            air_curtain_on: second / 600 % 2 == 0,
        };
        let cabin = weather.with_load(f64::from(second / 80 % 60), if second % 80 < 20 { 0.6 } else { 0.0 });
        ours = step(&cabin, &design, &dynamics, &ours, &commands, 1.0);
        let equations = Equations { cabin, design: &design, dynamics, commands };
        let mut solver = ode_solvers::Dopri5::new(equations, 0.0, 1.0, 1.0, theirs, 1e-11, 1e-11);
        solver.integrate().expect("the equations are smooth within a second");
        theirs = *solver.y_out().last().expect("the end of the second");
        let o = ours.temperatures;
        for (a, b) in
            [o.radiant_heater_k, o.interior_k, o.cabin_k, o.shell_inside_k, o.shell_outside_k].iter().zip(&theirs)
        {
            largest_k = largest_k.max((a - b).abs());
        }
        mean_off_w += (ours.machine_heat_w - theirs[5]) / f64::from(seconds);
    }
    assert!(largest_k < 1e-3, "{largest_k} K");
    assert!(mean_off_w.abs() < 0.1, "{mean_off_w} W");
}

fn winter_mission(ambient_c: f64, limit: f64, hours: usize, replay: Replay) -> (Summary, Vec<Instant>, Operation) {
    let vehicle = Vehicle::default();
    let views = PassengerViews::new(&vehicle);
    let design = design("hp+curtain", Heating::HeatPump, false, true);
    // Doors 20 of 80 s, three fifths of them.
    let d = day(ambient_c, 0.0, 20.0, 0.15);
    let o = optimum(&vehicle, &views, &design, &d, limit);
    let segments = vec![segment(&vehicle, &views, o, &d, limit); hours];
    let minutes = vec![Cabin::new(&vehicle, &views, &d); 60 * segments.len()];
    let loads = stops(3600 * segments.len() as u32);
    let mission = Mission { loads: &loads, minutes: &minutes, segments: hours, segment_s: 3600, door_open_share: 0.6 };
    let mut instants = Vec::new();
    let summary = run(&mission, &design, &segments, replay, |now| instants.push(*now));
    (summary, instants, o)
}

#[test]
fn paper_the_controller_tracks_and_the_shell_follows_the_steady_state() {
    let (summary, instants, o) = winter_mission(-0.7, 1.0, 8, Replay::PAPER);
    // After the start-up the inside of the shell matches the steady state; doors leave short, small deviations.
    let later = &instants[4 * 3600..];
    for now in later {
        assert!((now.state.temperatures.shell_inside_k - o.temperatures.shell_inside_k).abs() < 0.5, "{now:?}");
    }
    let mean_k = later.iter().map(|n| n.state.temperatures.cabin_k).sum::<f64>() / later.len() as f64;
    assert!((mean_k - o.temperatures.cabin_k).abs() < 0.1, "{mean_k}");
    let largest = later.iter().map(|n| (n.pmv - o.pmv).abs()).fold(0.0, f64::max);
    let smoothed = later.iter().map(|n| (n.pmv_15min - o.pmv).abs()).fold(0.0, f64::max);
    assert!(largest > 2.0 * smoothed && smoothed < 0.1, "{largest} {smoothed}");
    assert!((summary.mean_hvac_power_w / summary.static_mean_hvac_power_w - 1.0).abs() < 0.15, "{summary:?}");
}

#[test]
fn paper_the_power_limit_shows_at_high_comfort_demands() {
    let missed = |limit| {
        let limited = winter_mission(-8.0, limit, 6, Replay::WARM_START).0;
        let free = winter_mission(-8.0, limit, 6, Replay::UNLIMITED).0;
        (limited.saturated_fraction, free.mean_hvac_power_w - limited.mean_hvac_power_w)
    };
    // On a cold day; at the paper's −0.7 °C it takes longer door openings than these.
    let (strict, loose) = (missed(0.0), missed(1.5));
    assert!(strict.0 > loose.0 + 0.01, "{strict:?} {loose:?}");
    assert!(loose.0 < 0.01, "{loose:?}");
    assert!(winter_mission(-8.0, 0.0, 6, Replay::UNLIMITED).0.saturated_fraction == 0.0);
}

#[test]
fn paper_the_largest_summer_violation_follows_a_mode_switch() {
    let vehicle = Vehicle::default();
    let views = PassengerViews::new(&vehicle);
    let design = design("hp+curtain", Heating::HeatPump, false, true);
    let limit = 0.5;
    // A clear day in July, from before dawn to night: ambient temperature in °C and direct irradiance in W/m² by the hour.
    let day_of = [
        (15.0, 0.0),
        (15.5, 100.0),
        (18.0, 350.0),
        (21.0, 550.0),
        (24.0, 700.0),
        (27.0, 800.0),
        (30.0, 800.0),
        (32.0, 750.0),
        (33.0, 600.0),
        (32.0, 350.0),
        (29.0, 100.0),
        (26.0, 0.0),
        (23.0, 0.0),
    ];
    let samples: Vec<Disturbances> = day_of.iter().map(|&(c, dni)| day(c, dni, 16.0, 0.15)).collect();
    let segments: Vec<Segment> = samples
        .iter()
        .map(|d| segment(&vehicle, &views, optimum(&vehicle, &views, &design, d, limit), d, limit))
        .collect();
    // Between the middles of the hours the weather is linear.
    let minutes: Vec<Cabin<'_>> = (0..60 * day_of.len())
        .map(|m| {
            let place = (m as f64 + 0.5) / 60.0 - 0.5;
            let before = (place.max(0.0) as usize).min(day_of.len() - 2);
            let share = (place - before as f64).clamp(0.0, 1.0);
            let mix =
                |f: fn(&(f64, f64)) -> f64| f(&day_of[before]) + share * (f(&day_of[before + 1]) - f(&day_of[before]));
            Cabin::new(&vehicle, &views, &day(mix(|h| h.0), mix(|h| h.1), 0.0, 0.0))
        })
        .collect();
    let loads: Vec<LoadChange> =
        stops(3600 * day_of.len() as u32).into_iter().map(|c| LoadChange { passengers: 16.0, ..c }).collect();
    let mission =
        Mission { loads: &loads, minutes: &minutes, segments: day_of.len(), segment_s: 3600, door_open_share: 0.6 };
    let mut worst = (0, 0.0);
    run(&mission, &design, &segments, Replay::WARM_START, |now| {
        let excess = now.pmv_15min.abs() - limit;
        if excess > worst.1 {
            worst = (now.second / 3600, excess);
        }
    });
    let modes: Vec<OperatingMode> = segments.iter().map(|h| h.optimum.mode).collect();
    let at = worst.0 as usize;
    assert!(modes.contains(&OperatingMode::Cooling) && modes.contains(&OperatingMode::Passive), "{modes:?}");
    // In the hour that it begins, or while the steady state already counts on the next one.
    let switches = at > 0 && modes[at] != modes[at - 1] || at + 1 < modes.len() && modes[at] != modes[at + 1];
    assert!(switches, "the largest violation, {worst:?}, lies in an hour of {modes:?} without a switch");
}

#[test]
fn prop_a_controller_changes_nothing_but_its_own_state() {
    let (a, _, _) = winter_mission(-0.7, 0.5, 3, Replay::FREE_MODE);
    let (b, _, _) = winter_mission(-0.7, 0.5, 3, Replay::FREE_MODE);
    assert_eq!(a, b);
    assert_eq!(
        Dynamics { air_unit_time_constant_s: 0.1, ..Dynamics::default() }.check().map_err(|e| e.name),
        Err("air_unit_time_constant_s")
    );
    assert_eq!(Dynamics::default().check(), Ok(()));
}

#[test]
fn prop_a_trace_is_the_mean_of_each_minute() {
    let vehicle = Vehicle::default();
    let views = PassengerViews::new(&vehicle);
    let design = design("hp", Heating::HeatPump, false, false);
    let d = testing::winter_day();
    let segments = vec![segment(&vehicle, &views, optimum(&vehicle, &views, &design, &d, 1.0), &d, 1.0)];
    let minutes = vec![Cabin::new(&vehicle, &views, &d); 60];
    let loads = stops(3600);
    let mission = Mission { loads: &loads, minutes: &minutes, segments: 1, segment_s: 3600, door_open_share: 0.6 };
    let (mut trace, mut seconds) = (simulate::Trace::default(), Vec::new());
    let record = |now: &Instant| {
        trace.add(now);
        seconds.push(*now);
    };
    run(&mission, &design, &segments, Replay::PAPER, record);
    let trace = trace.finish(&mission);
    assert_eq!(trace.len(), 60);
    for (minute, part) in trace.iter().zip(seconds.chunks(60)) {
        let mean = |f: &dyn Fn(&Instant) -> f64| part.iter().map(f).sum::<f64>() / 60.0;
        assert!((minute.cabin_k - mean(&|n| n.state.temperatures.cabin_k)).abs() < 1e-9, "{minute:?}");
        assert!((minute.pmv - mean(&|n| n.pmv)).abs() < 1e-9 && minute.ambient_k == d.ambient_temperature_k);
        assert!((minute.hvac_power_w - mean(&|n| n.hvac_power_w())).abs() < 1e-6);
        assert!((minute.door_open_fraction - mean(&|n| n.door_open_fraction)).abs() < 1e-12);
    }
}
