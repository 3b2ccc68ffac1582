//! The simulation once more, for tests: one variant at a time, plain numbers, laws as branches, the classical Runge-Kutta method
//! with as many steps a second as wanted, and a vote every second that is settled. It shares the flows of the cabin with the
//! program, and nothing else.

use cabin::{Cabin, Design, Heating, OperatingMode, Operation, Temperatures, celsius, kelvin};
use simulate::control::{AirCurtain, Law};
use simulate::{
    BusState, Commands, Dynamics, Instant, Limits, Mission, Rides, Segment, Start, Summary, Used, Variant,
    depot_temperature_k,
};

/// Heaters, interior, cabin, inside and outside of the shell in K, heat of the machine in W; or their slopes.
type Vector = [f64; 6];

fn vector(state: &BusState) -> Vector {
    let t = &state.temperatures;
    [t.radiant_heater_k, t.interior_k, t.cabin_k, t.shell_inside_k, t.shell_outside_k, state.machine_heat_w]
}

fn state([heater, interior, cabin, inside, outside, machine_heat_w]: Vector) -> BusState {
    let temperatures = Temperatures {
        cabin_k: cabin,
        interior_k: interior,
        shell_inside_k: inside,
        shell_outside_k: outside,
        radiant_heater_k: heater,
    };
    BusState { temperatures, machine_heat_w }
}

/// The state after `seconds` with loads, weather and commands held: the classical Runge-Kutta method of fourth order.
#[must_use]
pub fn step(
    cabin: &Cabin<'_>,
    design: &Design,
    dynamics: &Dynamics,
    from: &BusState,
    commands: &Commands,
    seconds: f64,
) -> BusState {
    let slope = |x: &Vector| derivative(cabin, design, dynamics, x, commands);
    let x = vector(from);
    let along = |k: &Vector, h: f64| std::array::from_fn(|i| x[i] + h * k[i]);
    let k1 = slope(&x);
    let k2 = slope(&along(&k1, 0.5 * seconds));
    let k3 = slope(&along(&k2, 0.5 * seconds));
    let k4 = slope(&along(&k3, seconds));
    state(std::array::from_fn(|i| x[i] + seconds / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i])))
}

fn derivative(cabin: &Cabin<'_>, design: &Design, d: &Dynamics, x: &Vector, c: &Commands) -> Vector {
    let BusState { temperatures: t, machine_heat_w } = state(*x);
    let lift_k = t.cabin_k - cabin.ambient_k();
    let heats = c.air_unit_power_w >= 0.0;
    let cop = if heats { design.heating_cop.at(lift_k) } else { design.cooling_cop.at(-lift_k) };
    let given_w = cop * c.air_unit_power_w;
    // A resistive heater does not lag.
    let (at_once_w, lagging_w) = if heats && design.heating == Heating::Ptc { (given_w, 0.0) } else { (0.0, given_w) };
    let net_w = cabin.flows(&t, c.air_curtain_on, machine_heat_w + at_once_w, c.radiant_heater_power_w).net_w();
    [
        net_w[0] / d.radiant_heater_capacity_j_k,
        net_w[1] / d.interior_capacity_j_k,
        net_w[2] / d.cabin_capacity_j_k,
        net_w[3] / d.shell_inside_capacity_j_k,
        net_w[4] / d.shell_outside_capacity_j_k,
        (lagging_w - machine_heat_w) / d.air_unit_time_constant_s,
    ]
}

/// A PI loop: the command within `low … high` and how far it is held back; the integral stands still where it would wind up.
fn pi(gain: f64, integral_s: f64, error_k: f64, integral_w: &mut f64, low: f64, high: f64) -> (f64, f64) {
    let next_w = *integral_w + gain * error_k / integral_s;
    let wanted_w = gain * error_k + next_w;
    let command_w = wanted_w.clamp(low, high);
    let beyond_w = wanted_w - command_w;
    if beyond_w * error_k <= 0.0 {
        *integral_w = next_w;
    }
    (command_w, beyond_w)
}

struct Controller<'c> {
    law: Law<'c>,
    mode: OperatingMode,
    heaters_on: bool,
    cabin_integral_w: f64,
    heater_integral_w: f64,
    setpoint_k: f64,
}

impl Controller<'_> {
    fn set_mode(&mut self, mode: OperatingMode) {
        if mode != self.mode {
            self.mode = mode;
            self.cabin_integral_w = 0.0;
        }
    }

    fn settled(&mut self, o: &Operation) {
        self.mode = o.mode;
        self.heaters_on = o.devices.radiant_heaters;
        self.cabin_integral_w = if o.mode == OperatingMode::Cooling { -o.air_unit_power_w } else { o.air_unit_power_w };
        self.heater_integral_w = o.radiant_heater_power_w;
    }

    /// Commands of a second, and whether a limit holds the air unit back.
    fn command(
        &mut self,
        variant: &Variant<'_>,
        d: &Dynamics,
        segment: &Segment,
        ambient_k: f64,
        t: &Temperatures,
    ) -> (Commands, bool) {
        let o = &segment.optimum;
        let heaters_on = match self.law {
            Law::HourlyMode | Law::ComfortBand => o.devices.radiant_heaters,
            Law::Causal(c) => c.heaters_below_c.is_some_and(|limit| celsius(ambient_k) < limit),
        };
        if heaters_on != self.heaters_on {
            self.heaters_on = heaters_on;
            self.heater_integral_w = 0.0;
        }
        let setpoint_k = match self.law {
            Law::HourlyMode => {
                self.set_mode(o.mode);
                o.temperatures.cabin_k
            }
            Law::ComfortBand => {
                let [low_k, high_k] = segment.band_k;
                let wanted = |integral: f64, limit: f64| integral + d.controller_gain_w_k * (limit - t.cabin_k);
                let idle = match self.mode {
                    OperatingMode::Passive => true,
                    OperatingMode::Heating => wanted(self.cabin_integral_w, low_k) <= 0.0 && t.cabin_k > low_k,
                    OperatingMode::Cooling => wanted(self.cabin_integral_w, high_k) >= 0.0 && t.cabin_k < high_k,
                };
                if idle {
                    self.set_mode(if t.cabin_k < low_k {
                        OperatingMode::Heating
                    } else if t.cabin_k > high_k {
                        OperatingMode::Cooling
                    } else {
                        OperatingMode::Passive
                    });
                }
                if self.mode == OperatingMode::Cooling { high_k } else { low_k }
            }
            Law::Causal(c) => {
                let [heat_k, cool_k] = [&c.heating, &c.cooling].map(|curve| kelvin(curve.at(celsius(ambient_k))));
                let ends = match self.mode {
                    OperatingMode::Passive => true,
                    OperatingMode::Heating => t.cabin_k > heat_k + c.hysteresis_k,
                    OperatingMode::Cooling => t.cabin_k < cool_k - c.hysteresis_k,
                };
                if ends {
                    let may_cool = celsius(ambient_k) >= c.cools_above_c;
                    self.set_mode(if t.cabin_k < heat_k - c.dead_band_k {
                        OperatingMode::Heating
                    } else if may_cool && t.cabin_k > cool_k + c.dead_band_k {
                        OperatingMode::Cooling
                    } else {
                        OperatingMode::Passive
                    });
                }
                if self.mode == OperatingMode::Cooling { cool_k } else { heat_k }
            }
        };
        let air_curtain_on = match self.law {
            Law::HourlyMode | Law::ComfortBand => o.devices.air_curtain,
            Law::Causal(c) => match (c.air_curtain, self.mode) {
                (AirCurtain::On, _) => true,
                (AirCurtain::Above { heating_k, .. }, OperatingMode::Heating) => t.cabin_k - ambient_k > heating_k,
                (AirCurtain::Above { cooling_k, .. }, OperatingMode::Cooling) => ambient_k - t.cabin_k > cooling_k,
                (AirCurtain::Off | AirCurtain::Above { .. }, _) => false,
            },
        };
        let heater_setpoint_k = match self.law {
            Law::HourlyMode | Law::ComfortBand => o.temperatures.radiant_heater_k,
            Law::Causal(c) => c.radiant_heater_k,
        };
        let (heating_w, cooling_w) = match (variant.scenario.limits, variant.design.heating) {
            (Limits::Unlimited, _) => (f64::MAX, f64::MAX),
            (Limits::Rated, Heating::Ptc) => (d.ptc_limit_w, d.cooling_limit_w),
            (Limits::Rated, Heating::HeatPump) => (d.heat_pump_limit_w, d.cooling_limit_w),
        };
        let (gain, integral_s) = (d.controller_gain_w_k, d.controller_integral_s);
        let error_k = setpoint_k - t.cabin_k;
        let integral = &mut self.cabin_integral_w;
        let (air_unit_power_w, held_back) = match self.mode {
            OperatingMode::Passive => (0.0, false),
            OperatingMode::Heating => {
                let (command, beyond) = pi(gain, integral_s, error_k, integral, 0.0, heating_w);
                (command, beyond > 0.0)
            }
            OperatingMode::Cooling => {
                let (command, beyond) = pi(gain, integral_s, error_k, integral, -cooling_w, 0.0);
                (command, beyond < 0.0)
            }
        };
        let radiant_heater_power_w = if self.heaters_on {
            let error_k = heater_setpoint_k - t.radiant_heater_k;
            let integral = &mut self.heater_integral_w;
            pi(d.heater_gain_w_k, d.heater_integral_s, error_k, integral, 0.0, d.heater_limit_w).0
        } else {
            0.0
        };
        self.setpoint_k = setpoint_k;
        (Commands { air_unit_power_w, radiant_heater_power_w, air_curtain_on }, held_back)
    }
}

/// Simulates a mission in one variant with so many steps a second; `record` sees every second.
pub fn simulate_finely(
    mission: &Mission<'_, '_>,
    dynamics: &Dynamics,
    variant: &Variant<'_>,
    steps: u32,
    mut record: impl FnMut(&Instant),
) -> Summary {
    let optimum = &variant.segments[0].optimum;
    let mut controller = Controller {
        law: variant.law,
        mode: OperatingMode::Passive,
        heaters_on: false,
        cabin_integral_w: 0.0,
        heater_integral_w: 0.0,
        setpoint_k: 0.0,
    };
    let mut now = match variant.scenario.start {
        Start::Depot => {
            let depot_k = depot_temperature_k(mission.minutes[0].ambient_k());
            state([depot_k, depot_k, depot_k, depot_k, depot_k, 0.0])
        }
        Start::SteadyState => {
            controller.settled(optimum);
            let at_once = optimum.mode == OperatingMode::Heating && variant.design.heating == Heating::Ptc;
            let machine_heat_w = if at_once { 0.0 } else { optimum.air_unit_heat_w };
            BusState { temperatures: optimum.temperatures, machine_heat_w }
        }
    };
    let seconds = mission.segments as u32 * mission.segment_s;
    let mut loads = mission.loads.iter().peekable();
    let (mut passengers, mut door_open_fraction) = (0.0, 0.0);
    let mut votes: Vec<f64> = Vec::new();
    let (mut energy_j, mut held_back_s, mut tracked_s, mut square_error) = (0.0, 0, 0, 0.0);
    let mut max_abs: Option<f64> = None;
    let mut used = Used::default();
    let (mut passenger_s, mut abs_vote, mut outside_s) = (0.0, 0.0, vec![0.0; variant.windows.len()]);
    for second in 0..seconds {
        while let Some(load) = loads.next_if(|l| l.second <= second) {
            passengers = load.passengers;
            door_open_fraction = load.door_open * mission.door_open_share;
        }
        let cabin = mission.minutes[second as usize / 60].with_load(passengers, door_open_fraction);
        let segment = &variant.segments[(second / mission.segment_s) as usize];
        let (commands, held_back) =
            controller.command(variant, dynamics, segment, cabin.ambient_k(), &now.temperatures);
        for _ in 0..steps {
            now = step(&cabin, variant.design, dynamics, &now, &commands, 1.0 / f64::from(steps));
        }
        let mut clothes = cabin.clothes(&now.temperatures);
        votes.push(cabin.step_vote(&now.temperatures, &mut clothes));
        let window = &votes[votes.len().saturating_sub(900)..];
        let pmv_15min = window.iter().sum::<f64>() / window.len() as f64;
        let instant = Instant {
            second,
            state: now,
            setpoint_k: (controller.mode != OperatingMode::Passive).then_some(controller.setpoint_k),
            commands,
            air_curtain_power_w: if commands.air_curtain_on { cabin.air_curtain_power_w() } else { 0.0 },
            passengers,
            door_open_fraction,
            pmv: votes[votes.len() - 1],
            pmv_15min,
        };
        energy_j += instant.hvac_power_w();
        held_back_s += u32::from(held_back);
        used.heating |= controller.mode == OperatingMode::Heating;
        used.cooling |= controller.mode == OperatingMode::Cooling;
        used.limit |= held_back;
        passenger_s += passengers;
        abs_vote += passengers * pmv_15min.abs();
        for (outside_s, window) in outside_s.iter_mut().zip(variant.windows) {
            if !(window.pmv_min()..=window.pmv_max()).contains(&pmv_15min) {
                *outside_s += passengers;
            }
        }
        if passengers >= 1.0 {
            max_abs = Some(max_abs.unwrap_or(0.0).max(pmv_15min.abs()));
        }
        let (tracked_mode, tracked_k) = match variant.law {
            Law::HourlyMode | Law::ComfortBand => (segment.optimum.mode, segment.optimum.temperatures.cabin_k),
            Law::Causal(_) => (controller.mode, controller.setpoint_k),
        };
        if tracked_mode != OperatingMode::Passive {
            tracked_s += 1;
            square_error += (now.temperatures.cabin_k - tracked_k).powi(2);
        }
        record(&instant);
    }
    let optima = || variant.segments.iter().map(|s| &s.optimum);
    Summary {
        seconds,
        mean_hvac_power_w: energy_j / f64::from(seconds),
        static_mean_hvac_power_w: optima().map(|o| o.hvac_power_w()).sum::<f64>() / variant.segments.len() as f64,
        max_abs_pmv_15min: max_abs,
        static_max_abs_pmv: optima().map(|o| o.pmv.abs()).fold(0.0, f64::max),
        saturated_fraction: f64::from(held_back_s) / f64::from(seconds),
        tracking_error_k: (square_error / f64::from(tracked_s.max(1))).sqrt(),
        rides: Rides {
            passenger_hours: passenger_s / 3600.0,
            mean_abs_pmv: (passenger_s > 0.0).then(|| abs_vote / passenger_s),
            hours_outside: outside_s.iter().map(|s| s / 3600.0).collect(),
        },
        used,
        end: now,
    }
}
