//! The loop: a mission, second by second, under any controller.

use cabin::{Design, Temperatures};

use crate::control::{Controller, Measurements};
use crate::summary::Sums;
use crate::{BusState, Dynamics, Instant, Mission, Start, Summary, depot_temperature_k, step};

/// Simulates a mission over all its segments; `record` sees every second.
///
/// `None` where there is no segment, or the minutes do not reach to the end of the last one.
pub fn simulate(
    mission: &Mission<'_, '_>,
    design: &Design,
    dynamics: &Dynamics,
    start: Start,
    controller: &mut impl Controller,
    mut record: impl FnMut(&Instant),
) -> Option<Summary> {
    let end_s = mission.segments.len() as u32 * mission.segment_s;
    if mission.minutes.len() < (end_s as usize).div_ceil(60) {
        return None;
    }
    let mut state = first_state(mission, start)?;
    let mut clothes = mission.minutes.first()?.clothes(&state.temperatures);
    let mut sums = Sums::new();
    let mut loads = mission.loads.iter().peekable();
    let (mut passengers, mut door_open_fraction) = (0.0, 0.0);
    for (i, segment) in mission.segments.iter().enumerate() {
        let from_s = i as u32 * mission.segment_s;
        for second in from_s..from_s + mission.segment_s {
            while let Some(load) = loads.next_if(|l| l.second <= second) {
                passengers = load.passengers;
                door_open_fraction = load.door_open * mission.door_open_share;
            }
            let cabin = mission.minutes[second as usize / 60].with_load(passengers, door_open_fraction);
            let t = &state.temperatures;
            let demand = controller.command(&Measurements {
                second,
                ambient_k: cabin.ambient_k(),
                cabin_k: t.cabin_k,
                radiant_heater_k: t.radiant_heater_k,
            });
            let commands = demand.commands;
            state = step(&cabin, design, dynamics, &state, &commands, 1.0);
            let pmv = cabin.step_vote(&state.temperatures, &mut clothes);
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
            sums.add(&instant, segment, demand.held_back);
            record(&instant);
        }
    }
    Some(sums.summary(mission, state))
}

fn first_state(mission: &Mission<'_, '_>, start: Start) -> Option<BusState> {
    let optimum = &mission.segments.first()?.optimum;
    Some(match start {
        Start::Depot => {
            let depot_k = depot_temperature_k(mission.minutes.first()?.ambient_k());
            let temperatures = Temperatures {
                cabin_k: depot_k,
                interior_k: depot_k,
                shell_inside_k: depot_k,
                shell_outside_k: depot_k,
                radiant_heater_k: depot_k,
            };
            BusState { temperatures, air_unit_heat_w: 0.0 }
        }
        Start::SteadyState => BusState { temperatures: optimum.temperatures, air_unit_heat_w: optimum.air_unit_heat_w },
    })
}
