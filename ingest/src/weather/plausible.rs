//! Whether values can be what the layout says: temperatures on Earth, irradiance under the sun of its hour.

use super::format::Layout;
use super::intervals::Interval;
use super::notes::{MAX_UNUSABLE_SHARE, Notes, are_too_many};
use super::units::{IrradianceUnit, TemperatureUnit};
use super::values::Quantity;
use crate::{Finding, FindingKind};

/// Air temperatures on Earth, in °C.
const TEMPERATURE_RANGE: (f64, f64) = (-60.0, 60.0);
/// In half of all hours air changes by less, in K: by 0.3 to 1 in any climate.
const ROUGHEST_K_PER_H: f64 = 2.0;
/// Hours that such a median needs.
const LEAST_HOURS: usize = 24;
/// A pyranometer may read this much below zero at night, in W/m².
const NIGHT_OFFSET: f64 = -10.0;
/// No more arrives at the ground, in W/m².
const MAX_IRRADIANCE: f64 = 1500.0;

/// Puts the values of a file into °C and W/m².
pub(crate) fn convert(intervals: &mut [Interval], layout: &Layout) {
    let watts = layout.units.irradiance.watts(layout.interval_s);
    for Interval { values, .. } in intervals {
        values.temperature = layout.units.temperature.celsius(values.temperature);
        for quantity in [Quantity::Global, Quantity::Diffuse, Quantity::Direct] {
            *values.get_mut(quantity) *= watts;
        }
        if layout.global_lacks_diffuse {
            values.global += values.diffuse;
        }
    }
}

/// Refuses temperatures that are not in the unit declared; a few that cannot be are taken as missing.
pub(crate) fn check_temperatures(
    intervals: &mut [Interval],
    layout: &Layout,
    notes: &mut Notes,
) -> Result<(), Finding> {
    let column = layout.column(Quantity::Temperature);
    let (low, high) = TEMPERATURE_RANGE;
    let known: Vec<f64> = intervals.iter().map(|i| i.values.temperature).filter(|t| !t.is_nan()).collect();
    let impossible = |t: f64| t < low || t > high;
    let first = intervals.iter().find(|i| impossible(i.values.temperature)).or(intervals.first());
    let line = first.map_or(0, |i| i.line);
    let wrong = |message: String| {
        let remedy = fitting_temperature(&known, layout);
        Err(Finding::whole(FindingKind::WrongUnit, message + &remedy).in_column(column).at_line(line))
    };
    let count = known.iter().filter(|t| impossible(**t)).count();
    if are_too_many(count as u64, known.len() as u64) {
        return wrong(format!(
            "{count} of {} temperatures are outside {low} … {high} °C, more than {:.0} %",
            known.len(),
            100.0 * MAX_UNUSABLE_SHARE
        ));
    }
    if let Some(change) = hourly_change(intervals, layout.interval_s)
        && change > ROUGHEST_K_PER_H
    {
        return wrong(format!(
            "the temperature changes by more than {change:.1} K in half of all hours, more than air does"
        ));
    }
    for interval in intervals.iter_mut().filter(|i| impossible(i.values.temperature)) {
        let message = || format!("{}: outside {low} … {high} °C; taken as missing", interval.values.temperature);
        notes.add(FindingKind::OutOfRange, column, interval.line, message);
        interval.values.temperature = f64::NAN;
    }
    Ok(())
}

/// Median change of the temperature from one hour to the next, in K.
fn hourly_change(intervals: &[Interval], interval_s: i64) -> Option<f64> {
    let apart = usize::try_from(3600 / interval_s).unwrap_or(1).max(1);
    let expected_s = apart as i64 * interval_s;
    let pairs = intervals.iter().zip(intervals.iter().skip(apart)).filter(|(a, b)| b.start_s - a.start_s == expected_s);
    let mut changes: Vec<f64> = pairs.map(|(a, b)| (b.values.temperature - a.values.temperature).abs()).collect();
    changes.retain(|change| !change.is_nan());
    let middle = changes.len() / 2;
    if changes.len() < LEAST_HOURS * apart {
        return None;
    }
    let (_, median, _) = changes.select_nth_unstable_by(middle, f64::total_cmp);
    Some(*median * 3600.0 / expected_s as f64)
}

/// The unit that temperatures fit, as a remedy.
fn fitting_temperature(celsius: &[f64], layout: &Layout) -> String {
    let declared = layout.units.temperature;
    let raw = |t: f64| match declared {
        TemperatureUnit::Celsius => t,
        TemperatureUnit::Kelvin => t + 273.15,
        TemperatureUnit::Fahrenheit => 1.8 * t + 32.0,
        TemperatureUnit::TenthCelsius => 10.0 * t,
    };
    let fits = |unit: &TemperatureUnit| {
        let inside = |t: &&f64| (-45.0..=50.0).contains(&unit.celsius(raw(**t)));
        *unit != declared && celsius.iter().filter(inside).count() * 100 >= celsius.len() * 95
    };
    match TemperatureUnit::ALL.iter().find(|unit| fits(unit)) {
        Some(unit) => format!("; probably in another unit: `temperature_unit = {:?}`", unit.name()),
        None => "; probably another unit or column: correct the export".to_owned(),
    }
}

/// Takes irradiances that cannot be as missing, and those of a sensor's night as 0.
pub(crate) fn check_irradiances(intervals: &mut [Interval], layout: &Layout, notes: &mut Notes) -> Result<(), Finding> {
    for quantity in [Quantity::Global, Quantity::Diffuse, Quantity::Direct] {
        let column = layout.column(quantity);
        let (mut values, mut low, mut first_line) = (0, 0, 0);
        for interval in intervals.iter_mut() {
            let line = interval.line;
            let value = interval.values.get_mut(quantity);
            values += u64::from(!value.is_nan());
            if *value < NIGHT_OFFSET || *value > MAX_IRRADIANCE {
                let text = *value;
                let message = || format!("{text}: irradiance outside 0 … {MAX_IRRADIANCE} W/m²; taken as missing");
                notes.add(FindingKind::OutOfRange, column, line, message);
                first_line = if low == 0 { line } else { first_line };
                low += 1;
                *value = f64::NAN;
            } else if *value < 0.0 {
                let text = *value;
                let message = || format!("{text}: small negative irradiance of a sensor at night; taken as 0");
                notes.add(FindingKind::NegativeOffset, column, line, message);
                *value = 0.0;
            }
        }
        if are_too_many(low, values) {
            let message = format!(
                "{low} of {values} irradiances are outside 0 … {MAX_IRRADIANCE} W/m², more than {:.0} %; probably another unit, or \
                 a number that stands for a missing value: `irradiance_unit` of a csv, or correct the export",
                100.0 * MAX_UNUSABLE_SHARE
            );
            return Err(Finding::whole(FindingKind::WrongUnit, message)
                .in_column(column)
                .at_line(first_line)
                .times(low));
        }
    }
    Ok(())
}

/// The unit of a name, for messages.
pub(crate) fn other_units(declared: IrradianceUnit) -> impl Iterator<Item = IrradianceUnit> {
    IrradianceUnit::ALL.into_iter().filter(move |unit| *unit != declared)
}
