//! The loop: a mission, second by second, in eight variants abreast, or four where few are left over.
//!
//! They share weather, sun, doors and passengers; states, setpoints, limits and devices are numbers of the lanes. No lane sees
//! another, so that a variant comes out the same to the bit in whatever company.

use cabin::{Cabin, Heating, Lanes, OperatingMode, Real, Temperatures};
use pulp::{Arch, Simd, WithSimd};

use crate::average::{FIRST_S, TrailingVotes, VOTE_S, Votes};
use crate::control::{Demand, Loops};
use crate::judge::Judge;
use crate::lanes::{FEW, LANES};
use crate::model::{AirUnits, Rates, Second, Vector, temperatures};
use crate::summary::Sums;
use crate::{BusState, Commands, Dynamics, Instant, Mission, Start, Summary, Used, Variant, depot_temperature_k};

/// Whoever sees every second of every variant, by its place.
pub type Record<'r> = dyn FnMut(usize, &Instant) + 'r;

/// Simulates a mission in all its variants, over all its segments; what comes of each, in their order.
///
/// `None` where there is no segment, or the minutes do not reach to the end of the last one.
pub fn simulate(mission: &Mission<'_, '_>, dynamics: &Dynamics, variants: &[Variant<'_>]) -> Option<Vec<Summary>> {
    abreast(mission, dynamics, variants, None)
}

/// As [`simulate`](fn@simulate); `record` sees every second of every variant, by its place, in the order of time.
pub fn simulate_with(
    mission: &Mission<'_, '_>,
    dynamics: &Dynamics,
    variants: &[Variant<'_>],
    record: &mut Record<'_>,
) -> Option<Vec<Summary>> {
    abreast(mission, dynamics, variants, Some(record))
}

fn abreast(
    mission: &Mission<'_, '_>,
    dynamics: &Dynamics,
    variants: &[Variant<'_>],
    mut record: Option<&mut Record<'_>>,
) -> Option<Vec<Summary>> {
    let seconds = mission.segments * mission.segment_s as usize;
    let reaches = |variant: &Variant<'_>| variant.segments.len() == mission.segments;
    if seconds == 0 || mission.minutes.len() < seconds.div_ceil(60) || !variants.iter().all(reaches) {
        return None;
    }
    let mut summaries = Vec::with_capacity(variants.len());
    for (n, some) in variants.chunks(LANES).enumerate() {
        let mut of_lane = record.as_mut().map(|record| {
            move |lane: usize, now: &Instant| {
                if lane < some.len() {
                    record(n * LANES + lane, now);
                }
            }
        });
        let of_lane = of_lane.as_mut().map(|record| record as &mut Record<'_>);
        summaries.extend(match some.len() {
            ..=FEW => together::<FEW>(mission, dynamics, some, of_lane),
            _ => together::<LANES>(mission, dynamics, some, of_lane),
        });
    }
    Some(summaries)
}

/// Some variants, at most as many as there are lanes. Those that are left over drive the last one once more.
fn together<'r, const W: usize>(
    mission: &Mission<'_, '_>,
    dynamics: &Dynamics,
    some: &[Variant<'_>],
    record: Option<&'r mut Record<'r>>,
) -> Vec<Summary> {
    let lanes: [Variant<'_>; W] = std::array::from_fn(|lane| some[lane.min(some.len() - 1)]);
    let mut judge = Judge::new(&lanes);
    let drive = Drive::new(mission, dynamics, lanes);
    let end = Arch::new().dispatch(Run { drive, judge: &mut judge, record });
    let summary = |(lane, variant): (usize, &Variant<'_>)| end.summary(lane, mission, variant, &judge);
    some.iter().enumerate().map(summary).collect()
}

/// A drive that is compiled once for each set of vector instructions, and runs with what the machine has. All of them round
/// alike: a product and a sum are one operation where the code says so, and nowhere else.
struct Run<'a, 'm, 'v, 'r, const W: usize> {
    drive: Drive<'a, 'm, 'v, W>,
    judge: &'a mut Judge<W>,
    record: Option<&'r mut Record<'r>>,
}

impl<const W: usize> WithSimd for Run<'_, '_, '_, '_, W> {
    type Output = End<W>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Self::Output {
        self.drive.run(self.judge, self.record)
    }
}

/// Variants on their way.
struct Drive<'a, 'm, 'v, const W: usize> {
    mission: &'a Mission<'m, 'v>,
    rates: Rates,
    variants: [Variant<'a>; W],
    x: Vector<W>,
    loops: Loops<W>,
    air_units: AirUnits<'a, W>,
    sums: Sums<W>,
    /// [`Cabin::door_loss_share`] with air curtains.
    with_curtain: Lanes<W>,
}

/// All lanes as a drive ends. What it adds up in every second is only moved here: a reference to it would keep it in memory
/// instead of registers, which costs a fifth of the time.
struct End<const W: usize> {
    x: Vector<W>,
    sums: Sums<W>,
    max_abs_pmv_15min: [Option<f64>; W],
    used: [Used; W],
}

impl<const W: usize> End<W> {
    fn summary(&self, lane: usize, mission: &Mission<'_, '_>, variant: &Variant<'_>, judge: &Judge<W>) -> Summary {
        let seconds = mission.segments as u32 * mission.segment_s;
        let votes = (self.max_abs_pmv_15min[lane], judge.rides(lane, variant.windows.len()));
        self.sums.summary(lane, seconds, variant.segments, votes, (self.used[lane], BusState::of(&self.x, lane)))
    }
}

/// What a second of all lanes looks like, for whoever records it.
#[derive(Clone, Copy)]
struct Past<const W: usize> {
    x: Vector<W>,
    demand: Demand<W>,
    air_curtain_power_w: Lanes<W>,
    curtain: Lanes<W>,
    /// Sign of the mode, and setpoint in K.
    followed: (Lanes<W>, Lanes<W>),
    passengers: f64,
    door_open_fraction: f64,
}

impl<'a, 'm, 'v, const W: usize> Drive<'a, 'm, 'v, W> {
    fn new(mission: &'a Mission<'m, 'v>, dynamics: &Dynamics, variants: [Variant<'a>; W]) -> Self {
        let limits = variants.map(|v| v.scenario.limits.of(v.design, dynamics));
        let mut loops = Loops::new(dynamics, limits);
        let mut x = [Lanes::ZERO; 6];
        for (lane, variant) in variants.iter().enumerate() {
            let optimum = &variant.segments[0].optimum;
            let state = match variant.scenario.start {
                Start::Depot => in_depot(&mission.minutes[0]),
                Start::SteadyState => {
                    loops.settle(lane, optimum);
                    let at_once = optimum.mode == OperatingMode::Heating && variant.design.heating == Heating::Ptc;
                    let machine_heat_w = if at_once { 0.0 } else { optimum.air_unit_heat_w };
                    BusState { temperatures: optimum.temperatures, machine_heat_w }
                }
            };
            state.put(&mut x, lane);
        }
        let air_units = AirUnits::new(variants.map(|v| v.design), *loops.modes());
        let rates = Rates::new(dynamics);
        let with_curtain = Lanes::splat(mission.minutes[0].door_loss_share(true));
        Self { mission, rates, variants, x, loops, air_units, sums: Sums::new(), with_curtain }
    }

    #[inline(always)]
    fn run<'r>(mut self, judge: &mut Judge<W>, mut record: Option<&'r mut Record<'r>>) -> End<W> {
        let mission = self.mission;
        let mut clothes = mission.minutes[0].clothes(&temperatures(&self.x));
        let first = mission.minutes[0].step_vote(&temperatures(&self.x), &mut clothes);
        let mut trailing = TrailingVotes::new(first);
        let mut loads = mission.loads.iter().peekable();
        let (mut passengers, mut door_open_fraction) = (0.0, 0.0);
        let seconds = mission.segments as u32 * mission.segment_s;
        let mut cabin = mission.minutes[0];
        for from_s in (0..seconds).step_by(VOTE_S) {
            if from_s % 60 == 0 {
                cabin = mission.minutes[from_s as usize / 60].with_load(passengers, door_open_fraction);
                self.begin_minute(from_s, &cabin);
            }
            let length = VOTE_S.min((seconds - from_s) as usize);
            let mut on_board = [0.0; VOTE_S];
            let mut past = [None; VOTE_S];
            let mut votes = [Lanes::ZERO; VOTE_S];
            for (j, (on_board, past)) in on_board.iter_mut().zip(&mut past).enumerate().take(length) {
                while let Some(load) = loads.next_if(|l| l.second <= from_s + j as u32) {
                    passengers = load.passengers;
                    door_open_fraction = load.door_open * mission.door_open_share;
                    cabin = cabin.with_load(passengers, door_open_fraction);
                }
                *on_board = passengers;
                let demand = self.second(&cabin);
                if from_s < FIRST_S {
                    votes[j] = cabin.step_vote(&temperatures(&self.x), &mut clothes);
                }
                if record.is_some() {
                    let (x, curtain) = (self.x, self.loops.curtain);
                    let air_curtain_power_w = curtain * cabin.air_curtain_power_w();
                    let followed = self.loops.followed();
                    *past = Some(Past {
                        x,
                        demand,
                        air_curtain_power_w,
                        curtain,
                        followed,
                        passengers,
                        door_open_fraction,
                    });
                }
            }
            if from_s >= FIRST_S {
                let vote = cabin.step_vote(&temperatures(&self.x), &mut clothes);
                votes = trailing.up_to(vote, length);
            }
            let means = trailing.push(&votes, &on_board[..length]);
            judge.add(&means, &on_board[..length]);
            if let Some(record) = &mut record {
                tell(from_s, &past, [&votes, &means], record);
            }
        }
        judge.judge_windows();
        End {
            x: self.x,
            sums: self.sums,
            max_abs_pmv_15min: std::array::from_fn(|lane| trailing.largest(lane)),
            used: *self.loops.used(),
        }
    }

    /// A minute begins, and with some of them a segment.
    fn begin_minute(&mut self, second: u32, cabin: &Cabin<'_>) {
        let segment_s = self.mission.segment_s;
        let begins_segment = second.is_multiple_of(segment_s);
        for lane in 0..W {
            let variant = &self.variants[lane];
            if begins_segment || variant.law.is_causal() {
                let segment = &variant.segments[(second / segment_s) as usize];
                self.loops.begin(lane, variant.law.setting(segment, cabin.ambient_k()), self.x[2]);
                if !variant.law.is_causal() {
                    self.sums.begin(lane, segment);
                }
            }
        }
        self.follow();
    }

    /// Air units and sums follow the modes of the loops.
    fn follow(&mut self) {
        self.air_units.follow(self.loops.modes());
        let (sign, setpoint_k) = self.loops.followed();
        for (lane, variant) in self.variants.iter().enumerate() {
            if variant.law.is_causal() {
                self.sums.track(lane, (sign.0[lane], setpoint_k.0[lane]));
            }
        }
    }

    /// A second passes.
    #[inline(always)]
    fn second(&mut self, cabin: &Cabin<'_>) -> Demand<W> {
        if self.loops.want_another_mode(self.x[2]) {
            self.loops.choose_modes(self.x[2]);
            self.follow();
        }
        let demand = self.loops.command(self.x[2], self.x[0], cabin.ambient_k());
        let second = Second {
            cabin,
            air_units: &self.air_units,
            air_unit_power_w: demand.air_unit_power_w,
            radiant_heater_power_w: demand.radiant_heater_power_w,
            door_loss_share: self.loops.curtain.above(Lanes::ZERO, self.with_curtain, Lanes::ONE),
        };
        self.x = second.step(&self.rates, &self.x);
        self.sums.add(&demand, self.loops.curtain * cabin.air_curtain_power_w(), self.x[2]);
        demand
    }
}

/// Everything at depot temperature, the machine at rest.
fn in_depot(minute: &Cabin<'_>) -> BusState {
    let depot_k = depot_temperature_k(minute.ambient_k());
    let temperatures = Temperatures {
        cabin_k: depot_k,
        interior_k: depot_k,
        shell_inside_k: depot_k,
        shell_outside_k: depot_k,
        radiant_heater_k: depot_k,
    };
    BusState { temperatures, machine_heat_w: 0.0 }
}

fn tell<const W: usize>(
    from_s: u32,
    past: &[Option<Past<W>>; VOTE_S],
    [votes, means]: [&Votes<W>; 2],
    record: &mut Record<'_>,
) {
    for (j, past) in past.iter().enumerate() {
        let Some(past) = past else { continue };
        for lane in 0..W {
            let commands = Commands {
                air_unit_power_w: past.demand.air_unit_power_w.0[lane],
                radiant_heater_power_w: past.demand.radiant_heater_power_w.0[lane],
                air_curtain_on: past.curtain.0[lane] != 0.0,
            };
            let now = Instant {
                second: from_s + j as u32,
                state: BusState::of(&past.x, lane),
                setpoint_k: (past.followed.0.0[lane] != 0.0).then_some(past.followed.1.0[lane]),
                commands,
                air_curtain_power_w: past.air_curtain_power_w.0[lane],
                passengers: past.passengers,
                door_open_fraction: past.door_open_fraction,
                pmv: votes[j].0[lane],
                pmv_15min: means[j].0[lane],
            };
            record(lane, &now);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Replay, Segment};
    use cabin::{
        ComfortWindow, Cop, Design, Devices, Disturbances, LoadChange, Operation, PassengerViews, StandardRange,
        Vehicle, kelvin,
    };

    /// What is stored does not depend on the machine: with all vector instructions that it has, and with none.
    #[test]
    fn prop_all_instructions_round_alike() {
        let vehicle = Vehicle::default();
        let views = PassengerViews::new(&vehicle);
        let d = Disturbances {
            ambient_temperature_k: kelvin(-3.0),
            dni_w_m2: 120.0,
            dhi_w_m2: 60.0,
            solar_altitude_rad: 0.4,
            shadow_fraction: 0.3,
            passengers: 0.0,
            door_open_fraction: 0.0,
        };
        let minutes = [Cabin::new(&vehicle, &views, &d); 60];
        let design = |heating, heating_cop| Design {
            name: String::new(),
            heating,
            heating_cop,
            cooling_cop: Cop::Linear { at_zero: 3.0, slope_per_k: 0.09, min: 1.0, max: 4.0 },
            devices: Devices { radiant_heaters: true, air_curtain: true },
            heating_limit: None,
            cooling_limit: None,
            backup_heater_w: 0.0,
        };
        let hyperbola = Cop::Hyperbola { numerator_k: 74.0, offset_k: 17.0, min: 1.0, max: 4.5 };
        let designs = [design(Heating::HeatPump, hyperbola), design(Heating::Ptc, Cop::Constant(1.0))];
        let temperatures = minutes[0].rough_state(kelvin(18.0)).temperatures;
        let optimum = Operation {
            mode: OperatingMode::Heating,
            devices: designs[0].devices,
            air_unit_power_w: 3000.0,
            radiant_heater_power_w: 800.0,
            air_curtain_power_w: 100.0,
            backup_heater_power_w: 0.0,
            air_unit_heat_w: 7500.0,
            unmet_heat_w: 0.0,
            temperatures,
            mean_radiant_temperature_k: kelvin(16.0),
            pmv: -0.5,
            standard_range: StandardRange::Inside,
        };
        let segments = [Segment { optimum, band_k: [kelvin(18.0), kelvin(19.0)] }];
        let stop = |i: u32| LoadChange { second: 40 * i, passengers: f64::from(i % 23), door_open: f64::from(i % 2) };
        let loads: Vec<LoadChange> = (0..90).map(stop).collect();
        let mission = Mission { loads: &loads, minutes: &minutes, segments: 1, segment_s: 3600, door_open_share: 0.6 };
        let windows = [ComfortWindow::symmetric(0.5).expect("a limit on the scale")];
        let variant =
            |lane: usize| Variant { windows: &windows, ..Replay::ALL[lane % 4].of(&designs[lane / 4], &segments) };
        let variants = std::array::from_fn(variant);
        let driven = |way: fn(Run<'_, '_, '_, '_, LANES>) -> End<LANES>| {
            let mut judge = Judge::new(&variants);
            let drive = Drive::new(&mission, &Dynamics::default(), variants);
            let end = way(Run { drive, judge: &mut judge, record: None });
            variants.iter().enumerate().map(|(lane, v)| end.summary(lane, &mission, v, &judge)).collect::<Vec<_>>()
        };
        let with_all = driven(|run| Arch::new().dispatch(run));
        assert_eq!(with_all, driven(|run| run.with_simd(pulp::Scalar)));
        #[cfg(target_arch = "x86_64")]
        if pulp::x86::V3::try_new().is_some() {
            assert_eq!(
                with_all,
                driven(|run| Simd::vectorize(pulp::x86::V3::try_new().expect("the machine has it"), run))
            );
        }
        // As few as four come out as eight do.
        assert_eq!(with_all[..FEW], together::<FEW>(&mission, &Dynamics::default(), &variants[..FEW], None));
        assert_ne!(with_all[0], with_all[4]);
        assert!(with_all.iter().any(|s| s.rides.hours_outside[0] > 0.0));
    }
}
