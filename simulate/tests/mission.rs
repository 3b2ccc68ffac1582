//! The dynamic model: it settles on the optima, keeps its energy, and its step is short enough.

use cabin::{
    Cabin, ComfortWindow, Design, Disturbances, Heating, LoadChange, OperatingMode, Operation, PassengerViews,
    Temperatures, Vehicle, kelvin,
};
use simulate::{BusState, Commands, Dynamics, Instant, Mission, Replay, Segment, Summary, step};
use testing::{day, design, optimum, paper_designs};

fn segment(vehicle: &Vehicle, views: &PassengerViews, o: Operation, d: &Disturbances, limit: f64) -> Segment {
    let window = ComfortWindow::symmetric(limit).expect("valid");
    Segment::new(&Cabin::new(vehicle, views, d), &o, window)
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
        segments: &segments,
        segment_s: 3600,
        door_open_share: d.door_open_fraction,
    };
    let mut last = None;
    let summary = replay.run(&mission, design, &Dynamics::default(), |now| last = Some(*now)).expect("it has segments");
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
    let design = design("hp+rh", Heating::HeatPump, true, true);
    let d = day(-2.0, 150.0, 0.0, 0.0);
    let loads = stops(3600 * 3);
    let weather = Cabin::new(&vehicle, &views, &d);
    let depot = simulate::depot_temperature_k(d.ambient_temperature_k);
    let t = Temperatures {
        cabin_k: depot,
        interior_k: depot,
        shell_inside_k: depot,
        shell_outside_k: depot,
        radiant_heater_k: depot,
    };
    let start = BusState { temperatures: t, air_unit_heat_w: 0.0 };
    let commands = Commands { air_unit_power_w: 3500.0, radiant_heater_power_w: 1800.0, air_curtain_on: true };
    // What crosses the border of the bus; the flows inside must cancel.
    let across_w = |cabin: &Cabin<'_>, s: &BusState| {
        let f = cabin.flows(&s.temperatures, true, s.air_unit_heat_w, commands.radiant_heater_power_w);
        let gains = f.passengers_w + f.other_w + f.solar.interior_w + f.solar.shell_inside_w + f.solar.shell_outside_w;
        let losses = f.door_w + f.convection_shell_outside_w + f.radiation_shell_outside_w;
        (gains + f.air_unit_w + f.radiant_heater_power_w - losses, gains + f.air_unit_w + f.radiant_heater_power_w)
    };
    let (mut state, mut net_j, mut through_j) = (start, 0.0, 0.0);
    let mut next = loads.iter().peekable();
    let (mut passengers, mut doors) = (0.0, 0.0);
    for second in 0..3600 * 3 {
        while let Some(change) = next.next_if(|c| c.second <= second) {
            (passengers, doors) = (change.passengers, 0.6 * change.door_open);
        }
        let cabin = weather.with_load(passengers, doors);
        // Simpson's rule over halves of each second integrates what the step has taken in.
        for _ in 0..2 {
            let middle = step(&cabin, &design, &dynamics, &state, &commands, 0.25);
            let end = step(&cabin, &design, &dynamics, &state, &commands, 0.5);
            let [a, b, c] = [&state, &middle, &end].map(|s| across_w(&cabin, s));
            net_j += 0.5 / 6.0 * (a.0 + 4.0 * b.0 + c.0);
            through_j += 0.5 / 6.0 * (a.1 + 4.0 * b.1 + c.1);
            state = end;
        }
    }
    let rise = |f: fn(&Temperatures) -> f64| f(&state.temperatures) - f(&start.temperatures);
    let stored_j = dynamics.cabin_capacity_j_k * rise(|t| t.cabin_k)
        + dynamics.interior_capacity_j_k * rise(|t| t.interior_k)
        + dynamics.shell_inside_capacity_j_k * rise(|t| t.shell_inside_k)
        + dynamics.shell_outside_capacity_j_k * rise(|t| t.shell_outside_k)
        + dynamics.radiant_heater_capacity_j_k * rise(|t| t.radiant_heater_k);
    assert!((net_j - stored_j).abs() < 1e-6 * through_j, "{net_j} J taken in, {stored_j} J stored, of {through_j} J");
}

#[test]
fn prop_a_shorter_step_changes_less_than_a_millikelvin_and_a_tenth_of_a_watt() {
    let vehicle = Vehicle::default();
    let views = PassengerViews::new(&vehicle);
    let dynamics = Dynamics::default();
    for design in paper_designs() {
        let weather = Cabin::new(&vehicle, &views, &day(-8.0, 0.0, 0.0, 0.0));
        let t = weather.rough_state(kelvin(6.0)).temperatures;
        let mut coarse = BusState { temperatures: t, air_unit_heat_w: 0.0 };
        let mut fine = coarse;
        let (mut heat_coarse, mut heat_fine, mut largest_k) = (0.0, 0.0, 0.0_f64);
        for second in 0..7200_u32 {
            // Commands jump as a controller's do at their worst.
            let commands = Commands {
                air_unit_power_w: if second / 37 % 2 == 0 { 12_000.0 } else { 500.0 },
                radiant_heater_power_w: if second / 91 % 2 == 0 { 4_000.0 } else { 0.0 },
                air_curtain_on: design.devices.air_curtain,
            };
            let cabin = weather.with_load(f64::from(second / 80 % 60), if second % 80 < 20 { 0.6 } else { 0.0 });
            coarse = step(&cabin, &design, &dynamics, &coarse, &commands, 1.0);
            for _ in 0..50 {
                fine = step(&cabin, &design, &dynamics, &fine, &commands, 0.02);
            }
            heat_coarse += coarse.air_unit_heat_w / 7200.0;
            heat_fine += fine.air_unit_heat_w / 7200.0;
            let (a, b) = (coarse.temperatures, fine.temperatures);
            let off_k = [
                a.cabin_k - b.cabin_k,
                a.interior_k - b.interior_k,
                a.shell_inside_k - b.shell_inside_k,
                a.radiant_heater_k - b.radiant_heater_k,
            ];
            largest_k = off_k.iter().fold(largest_k, |m, k| m.max(k.abs()));
        }
        assert!(largest_k < 1e-3, "{}: {largest_k} K", design.name);
        assert!((heat_coarse - heat_fine).abs() < 0.1, "{}: {heat_coarse} {heat_fine} W", design.name);
    }
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
fn xval_ode_solvers_the_step_of_a_second_is_short_enough() {
    let vehicle = Vehicle::default();
    let views = PassengerViews::new(&vehicle);
    let dynamics = Dynamics::default();
    let design = design("hp+curtain", Heating::HeatPump, false, true);
    let weather = Cabin::new(&vehicle, &views, &day(-8.0, 0.0, 0.0, 0.0));
    let t = weather.rough_state(kelvin(6.0)).temperatures;
    let mut ours = BusState { temperatures: t, air_unit_heat_w: 0.0 };
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
        mean_off_w += (ours.air_unit_heat_w - theirs[5]) / f64::from(seconds);
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
    let mission =
        Mission { loads: &loads, minutes: &minutes, segments: &segments, segment_s: 3600, door_open_share: 0.6 };
    let mut instants = Vec::new();
    let summary =
        replay.run(&mission, &design, &Dynamics::default(), |now| instants.push(*now)).expect("it has segments");
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
        Mission { loads: &loads, minutes: &minutes, segments: &segments, segment_s: 3600, door_open_share: 0.6 };
    let mut worst = (0, 0.0);
    Replay::WARM_START
        .run(&mission, &design, &Dynamics::default(), |now| {
            let excess = now.pmv_15min.abs() - limit;
            if excess > worst.1 {
                worst = (now.second / 3600, excess);
            }
        })
        .expect("it has segments");
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
    let mission =
        Mission { loads: &loads, minutes: &minutes, segments: &segments, segment_s: 3600, door_open_share: 0.6 };
    let (mut trace, mut seconds) = (simulate::Trace::default(), Vec::new());
    let record = |now: &Instant| {
        trace.add(now);
        seconds.push(*now);
    };
    Replay::PAPER.run(&mission, &design, &Dynamics::default(), record).expect("it has segments");
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
