//! Weather files become one series: joined on one axis, short gaps filled, irradiance split.

use chrono::{DateTime, Datelike};
use shading::Site;

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

/// How tables become a series.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct JoinOptions {
    /// Longest gap that is interpolated, in s.
    pub max_gap_s: u32,
    /// How global irradiance is split.
    pub split: IrradianceSplit,
    /// Where the sun is looked up for the split.
    pub site: Site,
}

/// Joins the files on one axis, fills short gaps, and splits the irradiance.
pub(crate) fn join(
    parts: &[(Table, usize)],
    records: &mut [FileRecord],
    options: &JoinOptions,
) -> Result<Weather, String> {
    let interval_s = parts[0].0.interval_s;
    let starts = parts.iter().flat_map(|(table, _)| table.rows.iter().map(|r| r.start_s));
    let (calendar, length) = Calendar::of(parts[0].0.calendar, interval_s, starts)?;
    let mut values = vec![MISSING; length];
    let mut taken = vec![0_u8; length];
    for (table, record) in parts {
        let mut twice = 0;
        for row in &table.rows {
            let Some(slot) = calendar.slot(row.start_s, interval_s, length) else { continue };
            if taken[slot] > 0 {
                twice += 1;
                continue;
            }
            taken[slot] = 1;
            values[slot] = row.values;
        }
        if twice > 0 {
            let message = "the same interval again; the first one counts";
            records[*record].findings.push(Finding::whole(FindingKind::DuplicateRow, message).times(twice));
        }
    }
    let used = &parts[0].0.used;
    let max_run = (i64::from(options.max_gap_s) / interval_s) as usize;
    let cyclic = calendar == Calendar::Year;
    let mut interpolated = vec![false; length];
    let quantities = || Quantity::ALL.into_iter().filter(|&q| *used.get(q));
    for quantity in quantities() {
        fill_gaps(&mut values, quantity, max_run, cyclic, &mut interpolated);
    }
    let (filled, missing) = values.iter().zip(&interpolated).fold((0, 0), |(filled, missing), (v, &i)| {
        let whole = quantities().all(|q| !v.get(q).is_nan());
        (filled + u64::from(i && whole), missing + u64::from(!whole))
    });
    let record = &mut records[parts[0].1];
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
        let middle = calendar.start(slot, interval_s) + interval_s / 2;
        let split = if used.diffuse && used.direct {
            BeamAndDiffuse { dni_w_m2: value.direct, dhi_w_m2: value.diffuse }
        } else if value.global.is_nan() || (used.diffuse && value.diffuse.is_nan()) {
            BeamAndDiffuse { dni_w_m2: f64::NAN, dhi_w_m2: f64::NAN }
        } else {
            let middle = DateTime::from_timestamp(middle, 0).ok_or("a stamp is out of range")?;
            let altitude = options.site.sun(middle).altitude_rad;
            let IrradianceSplit::Erbs = options.split;
            if used.diffuse {
                closure(value.global, value.diffuse, altitude, middle.ordinal())
            } else {
                erbs(value.global, altitude, middle.ordinal())
            }
        };
        weather.temperature_k.push(value.temperature + 273.15);
        weather.dni_w_m2.push(split.dni_w_m2);
        weather.dhi_w_m2.push(split.dhi_w_m2);
    }
    Ok(weather)
}

/// Fills runs of up to `max_run` missing values linearly from their neighbours.
fn fill_gaps(values: &mut [Values], quantity: Quantity, max_run: usize, cyclic: bool, filled: &mut [bool]) {
    let n = values.len();
    let known: Vec<usize> = (0..n).filter(|&i| !values[i].get(quantity).is_nan()).collect();
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
        let (from, to) = (*values[before].get(quantity), *values[after % n].get(quantity));
        for i in before + 1..after {
            let share = (i - before) as f64 / (after - before) as f64;
            *values[i % n].get_mut(quantity) = from + share * (to - from);
            filled[i % n] = true;
        }
    }
}
