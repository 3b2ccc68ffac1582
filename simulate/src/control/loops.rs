//! The state machine of the air unit and the PI loops of air unit and radiant heaters, of all lanes.
//!
//! A loop's command is gain · error + integral, within its limits. While a limit holds it and the error would drive it farther,
//! the integral stands still (anti-windup by conditional integration: a substitute, the paper does not name its own).

use cabin::{Lanes, OperatingMode, Operation, Real};

use super::{AirCurtain, Setting};
use crate::{Dynamics, PowerLimits, Used};

/// All loops with their states. What follows from mode and setting is ready as numbers of the lanes.
#[derive(Debug, Clone)]
pub(crate) struct Loops<const W: usize> {
    gains: [Gain; 2],
    limits: [PowerLimits; W],
    settings: [Setting; W],
    modes: [OperatingMode; W],
    /// Modes that there have been.
    used: [Used; W],
    /// 1 while heating, −1 while cooling, 0 otherwise.
    sign: Lanes<W>,
    setpoint_k: Lanes<W>,
    start_below_k: Lanes<W>,
    start_above_k: Lanes<W>,
    stop_beyond_k: Lanes<W>,
    /// What may still be wanted where a mode ends: nothing, or anything.
    stop_wanted_w: Lanes<W>,
    low_w: Lanes<W>,
    high_w: Lanes<W>,
    integral_w: Lanes<W>,
    heater_setpoint_k: Lanes<W>,
    heater_high_w: Lanes<W>,
    heater_integral_w: Lanes<W>,
    /// 1 where a cabin above ambient temperature is what counts for the curtains, −1 where it is one below.
    curtain_sign: Lanes<W>,
    curtain_above_k: Lanes<W>,
    /// 1 where the air curtains run, 0 elsewhere.
    pub curtain: Lanes<W>,
}

/// Gain in W/K, and gain over the integral time in W/(K s).
#[derive(Debug, Clone, Copy)]
struct Gain {
    w_k: f64,
    w_k_s: f64,
}

/// What the loops ask for in a second.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Demand<const W: usize> {
    /// Electric power of the air unit in W; negative where it cools.
    pub air_unit_power_w: Lanes<W>,
    /// Electric power of the radiant heaters in W.
    pub radiant_heater_power_w: Lanes<W>,
    /// 1 where a limit keeps the air unit from giving what is wanted, 0 elsewhere.
    pub held_back: Lanes<W>,
}

/// Everything off, for ever.
const OFF: Setting = Setting {
    heating_k: 0.0,
    cooling_k: 0.0,
    heat_below_k: f64::NEG_INFINITY,
    cool_above_k: f64::INFINITY,
    stop_beyond_k: f64::INFINITY,
    stops_idle: true,
    begins_anew: false,
    radiant_heater_k: None,
    air_curtain: AirCurtain::Off,
};

impl<const W: usize> Loops<W> {
    /// Loops without memory, everything off.
    pub fn new(dynamics: &Dynamics, limits: [PowerLimits; W]) -> Self {
        let gain = |w_k: f64, integral_s: f64| Gain { w_k, w_k_s: w_k / integral_s };
        let mut loops = Self {
            gains: [
                gain(dynamics.controller_gain_w_k, dynamics.controller_integral_s),
                gain(dynamics.heater_gain_w_k, dynamics.heater_integral_s),
            ],
            limits,
            settings: [OFF; W],
            modes: [OperatingMode::Passive; W],
            used: [Used::default(); W],
            sign: Lanes::ZERO,
            setpoint_k: Lanes::ZERO,
            start_below_k: Lanes::ZERO,
            start_above_k: Lanes::ZERO,
            stop_beyond_k: Lanes::ZERO,
            stop_wanted_w: Lanes::ZERO,
            low_w: Lanes::ZERO,
            high_w: Lanes::ZERO,
            integral_w: Lanes::ZERO,
            heater_setpoint_k: Lanes::ZERO,
            heater_high_w: Lanes::ZERO,
            heater_integral_w: Lanes::ZERO,
            curtain_sign: Lanes::ONE,
            curtain_above_k: Lanes::ZERO,
            curtain: Lanes::ZERO,
        };
        (0..W).for_each(|lane| loops.refresh(lane));
        loops
    }

    /// A lane as it stands after a long time in an optimum.
    pub fn settle(&mut self, lane: usize, o: &Operation) {
        self.modes[lane] = o.mode;
        self.settings[lane].radiant_heater_k = o.devices.radiant_heaters.then_some(o.temperatures.radiant_heater_k);
        self.integral_w.0[lane] = match o.mode {
            OperatingMode::Cooling => -o.air_unit_power_w,
            OperatingMode::Passive | OperatingMode::Heating => o.air_unit_power_w,
        };
        self.heater_integral_w.0[lane] = o.radiant_heater_power_w;
    }

    /// Begins a setting. Radiant heaters that are switched on start without memory.
    pub fn begin(&mut self, lane: usize, setting: Setting, cabin: Lanes<W>) {
        if setting.radiant_heater_k.is_some() != self.settings[lane].radiant_heater_k.is_some() {
            self.heater_integral_w.0[lane] = 0.0;
        }
        self.settings[lane] = setting;
        if setting.begins_anew {
            self.choose(lane, cabin.0[lane]);
        }
        self.refresh(lane);
    }

    pub fn modes(&self) -> &[OperatingMode; W] {
        &self.modes
    }

    pub fn used(&self) -> &[Used; W] {
        &self.used
    }

    /// Whether any lane may not stay in its mode.
    #[inline(always)]
    pub fn want_another_mode(&self, cabin: Lanes<W>) -> bool {
        let (zero, one) = (Lanes::ZERO, Lanes::ONE);
        let starts = self.start_below_k.above(cabin, one, cabin.above(self.start_above_k, one, zero));
        let idle = self.wanted_w(cabin).above(self.stop_wanted_w, zero, one);
        let beyond_k = self.sign * (cabin - self.setpoint_k);
        (starts + beyond_k.above(self.stop_beyond_k, idle, zero)).any()
    }

    /// What the air unit would be asked for without limits, in the direction of its mode.
    #[inline(always)]
    fn wanted_w(&self, cabin: Lanes<W>) -> Lanes<W> {
        self.sign * (self.setpoint_k - cabin).mul_add(self.gains[0].w_k, self.integral_w)
    }

    /// Lets every lane that may not stay in its mode choose anew.
    pub fn choose_modes(&mut self, cabin: Lanes<W>) {
        let wanted_w = self.wanted_w(cabin);
        for lane in 0..W {
            let cabin_k = cabin.0[lane];
            let beyond_k = self.sign.0[lane] * (cabin_k - self.setpoint_k.0[lane]);
            let stops = beyond_k > self.stop_beyond_k.0[lane] && wanted_w.0[lane] <= self.stop_wanted_w.0[lane];
            if stops || self.modes[lane] == OperatingMode::Passive {
                self.choose(lane, cabin_k);
                self.refresh(lane);
            }
        }
    }

    /// A new mode starts without memory.
    fn choose(&mut self, lane: usize, cabin_k: f64) {
        let setting = &self.settings[lane];
        let mode = if cabin_k < setting.heat_below_k {
            OperatingMode::Heating
        } else if cabin_k > setting.cool_above_k {
            OperatingMode::Cooling
        } else {
            OperatingMode::Passive
        };
        if mode != self.modes[lane] {
            self.modes[lane] = mode;
            self.integral_w.0[lane] = 0.0;
        }
    }

    /// Makes ready what follows from mode and setting.
    fn refresh(&mut self, lane: usize) {
        let (s, limits) = (&self.settings[lane], &self.limits[lane]);
        self.used[lane].heating |= self.modes[lane] == OperatingMode::Heating;
        self.used[lane].cooling |= self.modes[lane] == OperatingMode::Cooling;
        let never = [f64::NEG_INFINITY, f64::INFINITY];
        let (sign, setpoint_k, [low_w, high_w], start_k) = match self.modes[lane] {
            OperatingMode::Heating => (1.0, s.heating_k, [0.0, limits.heating_w], never),
            OperatingMode::Cooling => (-1.0, s.cooling_k, [-limits.cooling_w, 0.0], never),
            OperatingMode::Passive => (0.0, s.heating_k, [0.0, 0.0], [s.heat_below_k, s.cool_above_k]),
        };
        self.sign.0[lane] = sign;
        self.setpoint_k.0[lane] = setpoint_k;
        [self.start_below_k.0[lane], self.start_above_k.0[lane]] = start_k;
        self.stop_beyond_k.0[lane] = s.stop_beyond_k;
        self.stop_wanted_w.0[lane] = if s.stops_idle { 0.0 } else { f64::INFINITY };
        [self.low_w.0[lane], self.high_w.0[lane]] = [low_w, high_w];
        self.heater_setpoint_k.0[lane] = s.radiant_heater_k.unwrap_or(0.0);
        self.heater_high_w.0[lane] = if s.radiant_heater_k.is_some() { limits.radiant_heaters_w } else { 0.0 };
        self.curtain_sign.0[lane] = if sign < 0.0 { -1.0 } else { 1.0 };
        self.curtain_above_k.0[lane] = match (s.air_curtain, self.modes[lane]) {
            (AirCurtain::On, _) => f64::NEG_INFINITY,
            (AirCurtain::Above { heating_k, .. }, OperatingMode::Heating) => heating_k,
            (AirCurtain::Above { cooling_k, .. }, OperatingMode::Cooling) => cooling_k,
            (AirCurtain::Off | AirCurtain::Above { .. }, _) => f64::INFINITY,
        };
    }

    /// The sign of each mode, and the setpoint that it follows in K.
    pub fn followed(&self) -> (Lanes<W>, Lanes<W>) {
        (self.sign, self.setpoint_k)
    }

    /// The commands of a second.
    #[inline(always)]
    pub fn command(&mut self, cabin: Lanes<W>, radiant_heater: Lanes<W>, ambient_k: f64) -> Demand<W> {
        let difference_k = self.curtain_sign * (cabin - ambient_k);
        self.curtain = difference_k.above(self.curtain_above_k, Lanes::ONE, Lanes::ZERO);
        let [air_unit, heaters] = self.gains;
        let error_k = self.setpoint_k - cabin;
        let (air_unit_power_w, beyond_w) = air_unit.command_w(error_k, &mut self.integral_w, self.low_w, self.high_w);
        let error_k = self.heater_setpoint_k - radiant_heater;
        let (radiant_heater_power_w, _) =
            heaters.command_w(error_k, &mut self.heater_integral_w, Lanes::ZERO, self.heater_high_w);
        let held_back = (self.sign * beyond_w).above(Lanes::ZERO, Lanes::ONE, Lanes::ZERO);
        Demand { air_unit_power_w, radiant_heater_power_w, held_back }
    }
}

impl Gain {
    /// The command within `low … high`, and how far it is held back by them.
    #[inline(always)]
    fn command_w<const W: usize>(
        self,
        error_k: Lanes<W>,
        integral_w: &mut Lanes<W>,
        low: Lanes<W>,
        high: Lanes<W>,
    ) -> (Lanes<W>, Lanes<W>) {
        let next_w = error_k.mul_add(self.w_k_s, *integral_w);
        let wanted_w = error_k.mul_add(self.w_k, next_w);
        let command_w = wanted_w.max(low).min(high);
        let beyond_w = wanted_w - command_w;
        *integral_w = (beyond_w * error_k).above(Lanes::ZERO, *integral_w, next_w);
        (command_w, beyond_w)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::LANES;

    /// Pseudo-random numbers from −1 to 1.
    fn dice(seed: &mut u64) -> f64 {
        *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    #[test]
    fn prop_modes_switch_only_where_the_state_machine_says_and_no_faster() {
        const FASTEST_K_S: f64 = 0.05;
        let setting = Setting {
            heating_k: 291.0,
            cooling_k: 296.0,
            heat_below_k: 291.0,
            cool_above_k: 296.0,
            stop_beyond_k: 1.0,
            stops_idle: false,
            begins_anew: false,
            radiant_heater_k: None,
            air_curtain: AirCurtain::Above { heating_k: 4.8, cooling_k: 4.1 },
        };
        let limits = PowerLimits { heating_w: 12_000.0, cooling_w: 12_000.0, radiant_heaters_w: 0.0 };
        let mut loops = Loops::new(&Dynamics::default(), [limits; LANES]);
        let mut cabin = cabin::Lanes([293.0; LANES]);
        (0..LANES).for_each(|lane| loops.begin(lane, setting, cabin));
        let (mut seed, mut switches) = (1, 0);
        let mut since = [0_u32; LANES];
        let mut drift = [0.0; LANES];
        for second in 0..200_000_u32 {
            for (cabin_k, drift) in cabin.0.iter_mut().zip(&mut drift) {
                if dice(&mut seed) > 0.99 {
                    *drift = FASTEST_K_S * dice(&mut seed);
                }
                *cabin_k = (*cabin_k + *drift).clamp(285.0, 302.0);
            }
            let before = *loops.modes();
            if loops.want_another_mode(cabin) {
                loops.choose_modes(cabin);
            }
            let demand = loops.command(cabin, cabin, 290.0);
            for lane in 0..LANES {
                let (from, to, k) = (before[lane], loops.modes()[lane], cabin.0[lane]);
                let power_w = demand.air_unit_power_w.0[lane];
                assert!(
                    (0.0..=12_000.0).contains(&(power_w * loops.sign.0[lane]))
                        && (power_w == 0.0 || loops.sign.0[lane] != 0.0)
                );
                let curtain = loops.curtain.0[lane] == 1.0;
                assert_eq!(
                    curtain,
                    match to {
                        OperatingMode::Heating => k - 290.0 > 4.8,
                        OperatingMode::Cooling => 290.0 - k > 4.1,
                        OperatingMode::Passive => false,
                    }
                );
                // What must be is, whether it switched or not.
                match to {
                    OperatingMode::Heating => assert!(k <= 292.0 && (from == to || k < 291.0), "{from:?} {to:?} {k}"),
                    OperatingMode::Cooling => assert!(k >= 295.0 && (from == to || k > 296.0), "{from:?} {to:?} {k}"),
                    OperatingMode::Passive => assert!((291.0..=296.0).contains(&k), "{from:?} {k}"),
                }
                if from != to {
                    switches += 1;
                    // A kelvin takes its time.
                    let least_s = if from == OperatingMode::Passive { 0.0 } else { 1.0 / FASTEST_K_S - 1.0 };
                    assert!(
                        f64::from(second - since[lane]) >= least_s,
                        "{from:?} {to:?} after {} s",
                        second - since[lane]
                    );
                    since[lane] = second;
                }
            }
        }
        assert!(switches > 1000, "{switches}");
    }
}
