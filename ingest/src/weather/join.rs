//! Weather files become one series: joined value by value on one axis, short gaps filled, irradiance split.

use chrono::{DateTime, Datelike};

use super::WeatherOptions;
use super::series::{Calendar, Weather};
use super::table::Table;
use super::values::{MISSING, Quantity, Values};
use crate::irradiance::{BeamAndDiffuse, closure, erbs};
use crate::{FileRecord, Finding, FindingKind};

/// How global irradiance is split where the diffuse one is not measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum IrradianceSplit {
    /// [`erbs`].
    Erbs,
}

const LIGHT: [Quantity; 3] = [Quantity::Global, Quantity::Diffuse, Quantity::Direct];

/// Joins the files on one axis, fills short gaps, and splits the irradiance. Of two values the first part's counts.
pub(super) fn join(
    parts: &[(Table, usize)],
    records: &mut [FileRecord],
    options: &WeatherOptions,
) -> Result<Weather, String> {
    let (first, first_record) = &parts[0];
    let interval_s = first.interval_s;
    let starts = parts.iter().flat_map(|(table, _)| table.intervals.iter().map(|i| i.start_s));
    let (calendar, length) = Calendar::of(first.order, interval_s, first.phase_s, starts)?;
    let mut values = vec![MISSING; length];
    for (table, record) in parts {
        let twice = take(table, calendar, &mut values);
        if twice > 0 {
            let message = "the same interval again; the file that was checked before, or the first one by name, counts";
            records[*record].findings.push(Finding::whole(FindingKind::DuplicateRow, message).times(twice));
        }
    }
    let max_run = (i64::from(options.max_gap_s) / interval_s) as usize;
    let cyclic = matches!(calendar, Calendar::Year { .. });
    let mut interpolated = vec![false; length];
    fill_gaps(&mut values, &[Quantity::Temperature], max_run, cyclic, &mut interpolated);
    fill_gaps(&mut values, &LIGHT, max_run, cyclic, &mut interpolated);
    let is_whole = |v: &Values| !v.temperature.is_nan() && has_light(v);
    let (filled, missing) = values.iter().zip(&interpolated).fold((0, 0), |(filled, missing), (v, &i)| {
        (filled + u64::from(i && is_whole(v)), missing + u64::from(!is_whole(v)))
    });
    let record = &mut records[*first_record];
    if filled > 0 {
        let message = format!("intervals in gaps of up to {} s, interpolated linearly", options.max_gap_s);
        record.findings.push(Finding::whole(FindingKind::Interpolated, message).times(filled));
    }
    if missing > 0 {
        let message = format!(
            "intervals in gaps longer than {} s within all files; samples there are excluded",
            options.max_gap_s
        );
        record.findings.push(Finding::whole(FindingKind::TimeGap, message).times(missing));
    }
    let mut weather = Weather {
        calendar,
        interval_s,
        max_gap_s: options.max_gap_s,
        temperature_k: Vec::with_capacity(length),
        dni_w_m2: Vec::with_capacity(length),
        dhi_w_m2: Vec::with_capacity(length),
        interpolated,
    };
    for (slot, value) in values.iter().enumerate() {
        let split = split(value, calendar.start(slot, interval_s) + interval_s / 2, options)?;
        weather.temperature_k.push(value.temperature + 273.15);
        weather.dni_w_m2.push(split.dni_w_m2);
        weather.dhi_w_m2.push(split.dhi_w_m2);
    }
    Ok(weather)
}

/// Takes what is missing from a table, and says in how many intervals it had nothing new to say.
fn take(table: &Table, calendar: Calendar, values: &mut [Values]) -> u64 {
    let mut twice = 0;
    for interval in &table.intervals {
        let Some(slot) = calendar.slot(interval.start_s, table.interval_s, values.len()) else { continue };
        let (mut new, mut old) = (false, false);
        for quantity in Quantity::ALL {
            let (here, there) = (values[slot].get_mut(quantity), *interval.values.get(quantity));
            if there.is_nan() {
                continue;
            }
            if here.is_nan() {
                *here = there;
                new = true;
            } else {
                old = true;
            }
        }
        twice += u64::from(old && !new);
    }
    twice
}

/// Whether an interval's direct and diffuse irradiance are known, or can be modelled.
fn has_light(values: &Values) -> bool {
    !values.global.is_nan() || !(values.diffuse.is_nan() || values.direct.is_nan())
}

/// Direct and diffuse irradiance at a second since 1970: as measured; else from what is measured of them and the global one;
/// else from the global one alone.
fn split(value: &Values, second: i64, options: &WeatherOptions) -> Result<BeamAndDiffuse, String> {
    if !(value.diffuse.is_nan() || value.direct.is_nan()) {
        return Ok(BeamAndDiffuse { dni_w_m2: value.direct, dhi_w_m2: value.diffuse });
    }
    if value.global.is_nan() {
        return Ok(BeamAndDiffuse { dni_w_m2: f64::NAN, dhi_w_m2: f64::NAN });
    }
    let instant = DateTime::from_timestamp(second, 0).ok_or("a stamp is out of range")?;
    let altitude = options.site.sun(instant).altitude_rad;
    let IrradianceSplit::Erbs = options.split;
    Ok(if !value.diffuse.is_nan() {
        closure(value.global, value.diffuse, altitude, instant.ordinal())
    } else if !value.direct.is_nan() {
        let diffuse = value.global - value.direct * altitude.sin().max(0.0);
        BeamAndDiffuse { dni_w_m2: value.direct, dhi_w_m2: diffuse.max(0.0) }
    } else {
        erbs(value.global, altitude, instant.ordinal())
    })
}

/// Fills runs of up to `max_run` intervals that lack the quantities, linearly from their neighbours: the temperature, or the
/// light, of which an interval lacks nothing where the rest can be modelled.
fn fill_gaps(values: &mut [Values], quantities: &[Quantity], max_run: usize, cyclic: bool, filled: &mut [bool]) {
    let n = values.len();
    let is_known = |v: &Values| match quantities {
        [Quantity::Temperature] => !v.temperature.is_nan(),
        _ => has_light(v),
    };
    let known: Vec<usize> = (0..n).filter(|&i| is_known(&values[i])).collect();
    let inner = known.windows(2).map(|w| (w[0], w[1]));
    let around = match (cyclic, known.first(), known.last()) {
        (true, Some(&first), Some(&last)) => Some((last, first + n)),
        _ => None,
    };
    for (before, after) in inner.chain(around) {
        let run = after - before - 1;
        if run == 0 || run > max_run {
            continue;
        }
        let (from, to) = (values[before], values[after % n]);
        for i in before + 1..after {
            let share = (i - before) as f64 / (after - before) as f64;
            for &quantity in quantities {
                let (from, to) = (*from.get(quantity), *to.get(quantity));
                *values[i % n].get_mut(quantity) = from + share * (to - from);
            }
            filled[i % n] = is_known(&values[i % n]);
        }
    }
}
