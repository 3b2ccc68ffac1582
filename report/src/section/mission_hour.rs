//! The hour of a mission that is shown, and where its heat flows (paper, figures `single-scenario`); the clock of a mission.

use cabin::{Cabin, HeatFlows, Operation, PassengerViews};
use chrono::{DateTime, TimeDelta, Timelike, Utc};
use chrono_tz::Tz;
use ingest::sample::Sample;
use store::MissionTrace;

use crate::StudyReport;
use crate::figure::HeatFlowFigure;
use crate::numbers::{signed, window};

/// Hours since the local midnight before.
pub(super) fn clock_h(start: DateTime<Utc>, zone: Tz) -> f64 {
    f64::from(start.with_timezone(&zone).num_seconds_from_midnight()) / 3600.0
}

/// What an axis of such hours is called.
pub(super) fn clock_label(start: DateTime<Utc>, zone: Tz) -> String {
    format!("local time on {} ({zone})", start.with_timezone(&zone).format("%-d %B %Y"))
}

/// The segment that the paper shows of its missions (figures `single-scenario`: 17:35 and 15:50), of others the one of most
/// power.
pub(super) fn shown_segment(trace: &MissionTrace, zone: Tz) -> Option<usize> {
    let of_paper_h = if trace.label == "cold" { 17.0 + 35.0 / 60.0 } else { 15.0 + 50.0 / 60.0 };
    let segments = trace.segments.iter().enumerate();
    if trace.of_paper {
        let off = |(sample, _): &(Sample, Operation)| (clock_h(sample.segment.start, zone) - of_paper_h).abs();
        return segments.min_by(|a, b| off(a.1).total_cmp(&off(b.1))).map(|(i, _)| i);
    }
    segments.max_by(|a, b| a.1.1.hvac_power_w().total_cmp(&b.1.1.hvac_power_w())).map(|(i, _)| i)
}

/// When each segment of a mission begins, by local time.
pub(super) fn starts(trace: &MissionTrace, zone: Tz) -> Vec<DateTime<Tz>> {
    trace.segments.iter().map(|(sample, _)| sample.segment.start.with_timezone(&zone)).collect()
}

/// The segment that is shown, its optimum and where its heat flows.
pub(super) fn shown_operation<'t>(
    trace: &'t MissionTrace,
    study: &StudyReport,
) -> Option<(&'t Sample, &'t Operation, HeatFlows)> {
    let (sample, o) = trace.segments.get(shown_segment(trace, study.zone)?)?;
    let views = PassengerViews::new(&study.vehicle);
    let cabin = Cabin::new(&study.vehicle, &views, &sample.disturbances);
    let flows = cabin.flows(&o.temperatures, o.devices.air_curtain, o.air_unit_heat_w, o.radiant_heater_power_w);
    Some((sample, o, flows))
}

/// The diagram of that segment.
pub(super) fn heat_flows(trace: &MissionTrace, study: &StudyReport) -> Option<HeatFlowFigure> {
    let (sample, o, flows) = shown_operation(trace, study)?;
    let d = &sample.disturbances;
    let start = sample.segment.start.with_timezone(&study.zone);
    let end = start + TimeDelta::seconds(sample.segment.duration_s.into());
    Some(HeatFlowFigure {
        title: format!("Heat flows of an hour, {} at PMV {}", trace.design, window(trace.window)),
        description: format!(
            "{} to {}; {:.1} passengers, {:.1} % of the doors open, shadow fraction {:.2}, PMV {}.",
            start.format("%-d %B %Y, %H:%M"),
            end.format("%H:%M"),
            d.passengers,
            100.0 * d.door_open_fraction,
            d.shadow_fraction,
            signed(o.pmv, 2)
        ),
        ambient_k: d.ambient_temperature_k,
        temperatures: o.temperatures,
        flows,
        air_unit_power_w: o.air_unit_power_w,
    })
}
