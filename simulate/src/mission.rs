//! A mission, second by second.

use cabin::{Cabin, Design, Heating, Temperatures};
use solve::{OperatingMode, Operation};

use crate::average::MovingAverage;
use crate::{BusState, Commands, Dynamics, PiController, depot_temperature_k, step};

/// From a second of the mission on, so many passengers are on board and a door is open or not.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Change {
    /// Second since the start of the mission.
    pub second: u32,
    /// Passengers on board.
    pub passengers: f64,
    /// Whether at least one door is open.
    pub door_open: bool,
}

/// The steady-state optimum of a segment of the mission.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hour {
    /// What it prescribes, and what it foresees.
    pub optimum: Operation,
    /// Cabin temperatures in K between which its comfort window holds, with its heaters on or off.
    pub band_k: [f64; 2],
}

/// What happens to a bus on a mission.
#[derive(Debug, Clone, Copy)]
pub struct Mission<'m, 'v> {
    /// Loads, in the order of time; before the first the bus is empty and closed.
    pub changes: &'m [Change],
    /// The cabin under the weather of each minute, without load.
    pub minutes: &'m [Cabin<'v>],
    /// The optima of the segments, one after the other from the start.
    pub hours: &'m [Hour],
    /// Length of a segment in s, a multiple of 60.
    pub segment_s: u32,
    /// Share of the doors that open when a door is open.
    pub door_open_share: f64,
}

/// How the bus is run. The paper's validation is all three of its habits: start at depot temperature, power limits, and the
/// operating mode held within each segment. Taking them away one after the other tells what each one costs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Conduct {
    /// As in the paper.
    Paper,
    /// Starts in the steady state of the first segment instead of at depot temperature.
    WarmStart,
    /// And without power limits.
    Unlimited,
    /// And heats or cools whenever the cabin leaves the band that the comfort window allows.
    FreeMode,
}

impl Conduct {
    /// All of them, each one less bound than the one before.
    pub const ALL: [Self; 4] = [Self::Paper, Self::WarmStart, Self::Unlimited, Self::FreeMode];

    /// The name in the database.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Paper => "paper",
            Self::WarmStart => "warm-start",
            Self::Unlimited => "unlimited",
            Self::FreeMode => "free-mode",
        }
    }
}

/// What a second of a simulation looks like.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Instant {
    /// Second since the start of the mission.
    pub second: u32,
    /// The state at its end.
    pub state: BusState,
    /// The commands that held during it.
    pub commands: Commands,
    /// Power of the air curtains in W.
    pub air_curtain_power_w: f64,
    /// Passengers on board.
    pub passengers: f64,
    /// Fraction of the doors that is open.
    pub door_open_fraction: f64,
    /// Mean vote of the passengers.
    pub pmv: f64,
    /// Its mean over the last 15 minutes.
    pub pmv_15min: f64,
}

/// What a simulation comes to, beside what the steady-state optima foresee.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Summary {
    /// Simulated seconds.
    pub seconds: u32,
    /// Mean HVAC power in W (eq. `power-time-average`).
    pub mean_hvac_power_w: f64,
    /// The same of the steady-state optima in W.
    pub static_mean_hvac_power_w: f64,
    /// Largest absolute value of the 15-minute mean vote while at least one passenger is on board; `None` where none ever is.
    pub max_abs_pmv_15min: Option<f64>,
    /// Largest absolute vote of the steady-state optima.
    pub static_max_abs_pmv: f64,
    /// Share of the time in which the air unit wants more than its limit allows.
    pub saturated_fraction: f64,
    /// Root mean square of cabin temperature less setpoint in K, while the air unit is on.
    pub tracking_error_k: f64,
    /// Temperatures and air unit at the end.
    pub end: BusState,
}

/// Simulates a mission over all its segments; `record` sees every second.
///
/// `None` where there is no segment, or the minutes do not reach to the end of the last one.
pub fn simulate(
    mission: &Mission<'_, '_>,
    design: &Design,
    dynamics: &Dynamics,
    conduct: Conduct,
    mut record: impl FnMut(&Instant),
) -> Option<Summary> {
    let first = mission.hours.first()?;
    let end_s = mission.hours.len() as u32 * mission.segment_s;
    if mission.minutes.len() < (end_s as usize).div_ceil(60) {
        return None;
    }
    let weather = mission.minutes.first()?;
    let mut driver = Driver::new(design, dynamics, conduct);
    let mut state = match conduct {
        Conduct::Paper => {
            let depot_k = depot_temperature_k(weather.ambient_k());
            let temperatures = Temperatures {
                cabin_k: depot_k,
                interior_k: depot_k,
                shell_inside_k: depot_k,
                shell_outside_k: depot_k,
                radiant_heater_k: depot_k,
            };
            BusState { temperatures, air_unit_heat_w: 0.0 }
        }
        Conduct::WarmStart | Conduct::Unlimited | Conduct::FreeMode => {
            driver.settled(&first.optimum);
            BusState { temperatures: first.optimum.temperatures, air_unit_heat_w: first.optimum.air_unit_heat_w }
        }
    };
    let mut clothes = weather.clothes(&state.temperatures);
    let mut sums = Sums::new();
    let mut changes = mission.changes.iter().peekable();
    let (mut passengers, mut door_open_fraction) = (0.0, 0.0);
    for (h, hour) in mission.hours.iter().enumerate() {
        let from_s = h as u32 * mission.segment_s;
        driver.enter(hour);
        for second in from_s..from_s + mission.segment_s {
            while let Some(change) = changes.next_if(|c| c.second <= second) {
                passengers = change.passengers;
                door_open_fraction = if change.door_open { mission.door_open_share } else { 0.0 };
            }
            let cabin = mission.minutes[second as usize / 60].with_load(passengers, door_open_fraction);
            let (commands, held_back) = driver.command(hour, &state);
            state = step(&cabin, design, dynamics, &state, &commands, 1.0);
            let pmv = cabin.follow_vote(&state.temperatures, &mut clothes);
            let instant = Instant {
                second,
                state,
                commands,
                air_curtain_power_w: if commands.air_curtain_on { cabin.air_curtain_power_w() } else { 0.0 },
                passengers,
                door_open_fraction,
                pmv,
                pmv_15min: sums.average.push(pmv),
            };
            sums.add(&instant, hour, held_back);
            record(&instant);
        }
    }
    Some(sums.summary(mission, state))
}

/// The controllers with their states.
struct Driver<'d> {
    dynamics: &'d Dynamics,
    conduct: Conduct,
    cabin: PiController,
    heaters: PiController,
    heating_limit_w: f64,
    cooling_limit_w: f64,
    mode: OperatingMode,
    heaters_on: bool,
    cabin_integral_w: f64,
    heater_integral_w: f64,
    /// Target of the radiant heaters in K, that of the optimum while they are on.
    heater_target_k: f64,
}

impl<'d> Driver<'d> {
    fn new(design: &Design, dynamics: &'d Dynamics, conduct: Conduct) -> Self {
        let limited = matches!(conduct, Conduct::Paper | Conduct::WarmStart);
        let limit = |w: f64| if limited { w } else { f64::MAX };
        Self {
            dynamics,
            conduct,
            cabin: PiController { gain_w_k: dynamics.controller_gain_w_k, integral_s: dynamics.controller_integral_s },
            heaters: PiController { gain_w_k: dynamics.heater_gain_w_k, integral_s: dynamics.heater_integral_s },
            heating_limit_w: limit(match design.heating {
                Heating::Ptc => dynamics.ptc_limit_w,
                Heating::HeatPump => dynamics.heat_pump_limit_w,
            }),
            cooling_limit_w: limit(dynamics.cooling_limit_w),
            mode: OperatingMode::Passive,
            heaters_on: false,
            cabin_integral_w: 0.0,
            heater_integral_w: 0.0,
            heater_target_k: 0.0,
        }
    }

    /// The controllers as they stand after a long time in an optimum.
    fn settled(&mut self, o: &Operation) {
        self.mode = o.mode;
        self.heaters_on = o.radiant_heaters_on;
        self.cabin_integral_w = match o.mode {
            OperatingMode::Cooling => -o.air_unit_power_w,
            OperatingMode::Passive | OperatingMode::Heating => o.air_unit_power_w,
        };
        self.heater_integral_w = o.radiant_heater_power_w;
    }

    /// Takes over what the optimum of a new segment prescribes; what changes starts without memory.
    fn enter(&mut self, hour: &Hour) {
        let o = &hour.optimum;
        if self.conduct != Conduct::FreeMode && o.mode != self.mode {
            self.mode = o.mode;
            self.cabin_integral_w = 0.0;
        }
        if o.radiant_heaters_on != self.heaters_on {
            self.heaters_on = o.radiant_heaters_on;
            self.heater_integral_w = 0.0;
        }
        self.heater_target_k = o.temperatures.radiant_heater_k;
    }

    /// The commands of a second, and whether a limit holds the air unit back.
    fn command(&mut self, hour: &Hour, state: &BusState) -> (Commands, bool) {
        let t = &state.temperatures;
        if self.conduct == Conduct::FreeMode {
            self.choose_mode(hour, t.cabin_k);
        }
        let setpoint_k = match (self.conduct, self.mode) {
            (Conduct::FreeMode, OperatingMode::Heating) => hour.band_k[0],
            (Conduct::FreeMode, OperatingMode::Cooling) => hour.band_k[1],
            _ => hour.optimum.temperatures.cabin_k,
        };
        let (low, high) = match self.mode {
            OperatingMode::Heating => (0.0, self.heating_limit_w),
            OperatingMode::Cooling => (-self.cooling_limit_w, 0.0),
            OperatingMode::Passive => (0.0, 0.0),
        };
        let (air_unit_power_w, beyond_w) = if self.mode == OperatingMode::Passive {
            (0.0, 0.0)
        } else {
            self.cabin.command_w(setpoint_k - t.cabin_k, &mut self.cabin_integral_w, low, high)
        };
        let held_back = match self.mode {
            OperatingMode::Heating => beyond_w > 0.0,
            OperatingMode::Cooling => beyond_w < 0.0,
            OperatingMode::Passive => false,
        };
        let radiant_heater_power_w = if self.heaters_on {
            let error_k = self.heater_target_k - t.radiant_heater_k;
            self.heaters.command_w(error_k, &mut self.heater_integral_w, 0.0, self.dynamics.heater_limit_w).0
        } else {
            0.0
        };
        let commands =
            Commands { air_unit_power_w, radiant_heater_power_w, air_curtain_on: hour.optimum.air_curtain_on };
        (commands, held_back)
    }

    /// Heats below the band and cools above it; goes on until the controller has nothing left to do.
    fn choose_mode(&mut self, hour: &Hour, cabin_k: f64) {
        let [low_k, high_k] = hour.band_k;
        let idle = match self.mode {
            OperatingMode::Passive => true,
            OperatingMode::Heating => {
                self.cabin_integral_w + self.cabin.gain_w_k * (low_k - cabin_k) <= 0.0 && cabin_k > low_k
            }
            OperatingMode::Cooling => {
                self.cabin_integral_w + self.cabin.gain_w_k * (high_k - cabin_k) >= 0.0 && cabin_k < high_k
            }
        };
        if !idle {
            return;
        }
        let mode = if cabin_k < low_k {
            OperatingMode::Heating
        } else if cabin_k > high_k {
            OperatingMode::Cooling
        } else {
            OperatingMode::Passive
        };
        if mode != self.mode {
            self.mode = mode;
            self.cabin_integral_w = 0.0;
        }
    }
}

/// What is added up over a mission.
struct Sums {
    average: MovingAverage,
    seconds: u32,
    energy_j: f64,
    saturated_s: u32,
    max_abs_pmv: Option<f64>,
    tracked_s: u32,
    square_error: f64,
}

impl Sums {
    fn new() -> Self {
        Self {
            average: MovingAverage::new(),
            seconds: 0,
            energy_j: 0.0,
            saturated_s: 0,
            max_abs_pmv: None,
            tracked_s: 0,
            square_error: 0.0,
        }
    }

    fn add(&mut self, now: &Instant, hour: &Hour, held_back: bool) {
        let c = &now.commands;
        self.seconds += 1;
        self.energy_j += c.air_unit_power_w.abs() + c.radiant_heater_power_w + now.air_curtain_power_w;
        self.saturated_s += u32::from(held_back);
        if now.passengers >= 1.0 {
            let pmv = now.pmv_15min.abs();
            self.max_abs_pmv = Some(self.max_abs_pmv.map_or(pmv, |m| m.max(pmv)));
        }
        if hour.optimum.mode != OperatingMode::Passive {
            let error_k = now.state.temperatures.cabin_k - hour.optimum.temperatures.cabin_k;
            self.tracked_s += 1;
            self.square_error += error_k * error_k;
        }
    }

    fn summary(&self, mission: &Mission<'_, '_>, end: BusState) -> Summary {
        let hours = mission.hours.len() as f64;
        let share = |part: u32, of: u32| if of > 0 { f64::from(part) / f64::from(of) } else { 0.0 };
        let tracked = f64::from(self.tracked_s.max(1));
        Summary {
            seconds: self.seconds,
            mean_hvac_power_w: self.energy_j / f64::from(self.seconds.max(1)),
            static_mean_hvac_power_w: mission.hours.iter().map(|h| h.optimum.hvac_power_w()).sum::<f64>() / hours,
            max_abs_pmv_15min: self.max_abs_pmv,
            static_max_abs_pmv: mission.hours.iter().map(|h| h.optimum.pmv.abs()).fold(0.0, f64::max),
            saturated_fraction: share(self.saturated_s, self.seconds),
            tracking_error_k: (self.square_error / tracked).sqrt(),
            end,
        }
    }
}
