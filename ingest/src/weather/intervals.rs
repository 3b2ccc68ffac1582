//! From rows to intervals: what the layout says of stamps is checked against them.

use chrono::{DateTime, Datelike, Timelike};
use std::collections::BTreeMap;

use super::format::{IntervalGrid, Layout, RowOrder, TimeLabel};
use super::notes::{MAX_UNUSABLE_SHARE, Notes, are_too_many};
use super::rows::Row;
use super::values::{MISSING, Quantity, Values};
use crate::{Finding, FindingKind};

/// So far may a stamp lie beside the interval that it means, in s.
const MAX_MOVED_S: i64 = 60;
/// A step of time this long is no gap but another year, in s.
const OTHER_YEAR_S: i64 = 300 * 86_400;
/// Share of a full interval that others must cover where they are spread over it.
const LEAST_COVERED: f64 = 0.95;

/// One interval of a file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Interval {
    /// Its start in s since 1970.
    pub start_s: i64,
    /// The line that says it.
    pub line: u64,
    /// What was measured in it.
    pub values: Values,
}

/// Intervals in the order of the file, each once, and how they make a series.
pub(crate) fn intervals(
    rows: &[Row],
    layout: &Layout,
    notes: &mut Notes,
) -> Result<(Vec<Interval>, RowOrder), Finding> {
    check_step(rows, layout)?;
    let (moved, refused) = match layout.grid {
        IntervalGrid::Clock => on_the_clock(rows, layout, notes)?,
        IntervalGrid::Free => (rows.iter().map(|row| interval(row, 0, layout)).collect(), 0),
    };
    let order = match layout.order {
        RowOrder::AsFound if is_reference_year(&moved, rows, layout) => {
            let message = "months of several years, one after the other: read as a reference year, repeated by date";
            notes.list.push(Finding::whole(FindingKind::ReferenceYear, message).in_column(&layout.time[0]));
            RowOrder::ReferenceYear
        }
        RowOrder::AsFound => RowOrder::Series,
        order => order,
    };
    let kept = if order == RowOrder::ReferenceYear { moved } else { rising(moved, layout, notes) };
    let unusable = rows.len() - kept.len();
    if are_too_many(unusable as u64, rows.len() as u64) {
        return Err(too_few(unusable, rows, refused, layout, notes));
    }
    let kept = if layout.grid == IntervalGrid::Free { spread(&kept, layout.interval_s) } else { kept };
    Ok((kept, order))
}

fn interval(row: &Row, moved_s: i64, layout: &Layout) -> Interval {
    let start_s = row.second + moved_s - layout.label.shift_s(layout.interval_s);
    Interval { start_s, line: row.line, values: row.values }
}

/// The usual step between stamps must be the interval.
fn check_step(rows: &[Row], layout: &Layout) -> Result<(), Finding> {
    let steps = || rows.windows(2).map(|pair| (pair[1].wall_s - pair[0].wall_s, pair[1].line)).filter(|(s, _)| *s > 0);
    let Some((usual_s, count)) = most_frequent(steps().map(|(step_s, _)| step_s)) else { return Ok(()) };
    if usual_s == layout.interval_s || 2 * count <= steps().count() || count < 3 {
        return Ok(());
    }
    let line = steps().find(|(step_s, _)| *step_s == usual_s).map_or(0, |(_, line)| line);
    let message = format!(
        "the stamps are {usual_s} s apart, but an interval is {} s: `interval_s = {usual_s}`, or another column",
        layout.interval_s
    );
    Err(Finding::whole(FindingKind::WrongStamps, message).in_column(&layout.time[0]).at_line(line))
}

/// The most frequent value and how often it is there; of equals the smallest.
fn most_frequent(values: impl Iterator<Item = i64>) -> Option<(i64, usize)> {
    let mut counts: BTreeMap<i64, usize> = BTreeMap::new();
    values.for_each(|value| *counts.entry(value).or_default() += 1);
    counts.into_iter().max_by_key(|&(value, count)| (count, std::cmp::Reverse(value)))
}

/// Intervals whose stamps lie on full intervals of the clock; stamps close to one are moved to it.
fn on_the_clock(rows: &[Row], layout: &Layout, notes: &mut Notes) -> Result<(Vec<Interval>, usize), Finding> {
    let (length_s, time) = (layout.interval_s, &layout.time[0]);
    let near_s = MAX_MOVED_S.min(length_s / 10);
    let beside = |row: &Row| (row.wall_s - layout.label.shift_s(length_s)).rem_euclid(length_s);
    // How far to the nearest full interval.
    let to_grid = |beside_s: i64| if 2 * beside_s < length_s { -beside_s } else { length_s - beside_s };
    if let Some((usual_s, count)) = most_frequent(rows.iter().map(beside))
        && to_grid(usual_s).abs() > near_s
        && 2 * count > rows.len()
    {
        let example = rows.iter().find(|row| beside(row) == usual_s).map_or(rows[0], |row| *row);
        let remedy = match (2 * usual_s == length_s, layout.label) {
            (true, TimeLabel::Middle) => "at full intervals: `time_label = \"start\"` or `\"end\"`".to_owned(),
            (true, _) => "in the middle of their intervals: `time_label = \"middle\"`".to_owned(),
            _ => {
                format!("{usual_s} s beside full intervals of {length_s} s; check interval_s, or export full intervals")
            }
        };
        let message = format!("{}: the stamps lie {remedy}", clock_text(example.wall_s));
        return Err(Finding::whole(FindingKind::WrongStamps, message).in_column(time).at_line(example.line));
    }
    let (mut kept, mut refused) = (Vec::with_capacity(rows.len()), 0);
    let mut grid_s = None;
    for row in rows {
        let moved_s = to_grid(beside(row));
        let next = interval(row, moved_s, layout);
        let on_grid = *grid_s.get_or_insert(next.start_s.rem_euclid(length_s)) == next.start_s.rem_euclid(length_s);
        if moved_s.abs() > near_s || !on_grid {
            refused += 1;
            let message = || format!("the stamp is no multiple of {length_s} s; check interval and file");
            notes.add(FindingKind::RefusedRow, time, row.line, message);
            continue;
        }
        if moved_s != 0 {
            let message = || format!("{}: taken as the full interval beside it", clock_text(row.wall_s));
            notes.add(FindingKind::MovedStamp, time, row.line, message);
        }
        kept.push(next);
    }
    Ok((kept, refused))
}

fn clock_text(wall_s: i64) -> String {
    DateTime::from_timestamp(wall_s, 0).map_or_else(String::new, |t| t.format("%Y-%m-%d %H:%M").to_string())
}

/// Whether rows that rise by the calendar jump between years: typical months of several years.
fn is_reference_year(intervals: &[Interval], rows: &[Row], layout: &Layout) -> bool {
    if layout.interval_s != 3600 || intervals.is_empty() || rows.len() != intervals.len() {
        return false;
    }
    let shift_s = layout.label.shift_s(layout.interval_s);
    let date = |row: &Row| {
        let t = DateTime::from_timestamp(row.wall_s - shift_s, 0).unwrap_or_default();
        (t.month(), t.day(), t.hour())
    };
    let follows = |row: &Row, next: &Row| {
        let after = DateTime::from_timestamp(row.wall_s - shift_s + layout.interval_s, 0).unwrap_or_default();
        (after.month(), after.day(), after.hour()) == date(next)
    };
    let mut jumps = 0;
    for pair in rows.windows(2) {
        let (a, b) = (&pair[0], &pair[1]);
        if date(a) >= date(b) {
            return false;
        }
        let step_s = b.wall_s - a.wall_s;
        jumps += u32::from(step_s < 0 || (step_s > OTHER_YEAR_S && follows(a, b)));
    }
    jumps > 0
}

/// Intervals in rising time, the first of each.
fn rising(intervals: Vec<Interval>, layout: &Layout, notes: &mut Notes) -> Vec<Interval> {
    let mut last_s = i64::MIN;
    let mut kept = intervals;
    kept.retain(|interval| {
        if interval.start_s > last_s {
            last_s = interval.start_s;
            return true;
        }
        let (kind, message) = if interval.start_s == last_s {
            (FindingKind::DuplicateRow, "the same interval again; the first row counts")
        } else {
            (FindingKind::RefusedRow, "time runs backwards; sort the file by time")
        };
        notes.add(kind, &layout.time[0], interval.line, || message.to_owned());
        false
    });
    kept
}

/// The refusal of a file most of whose rows cannot be used.
fn too_few(unusable: usize, rows: &[Row], beside: usize, layout: &Layout, notes: &Notes) -> Finding {
    let twice = notes.count(FindingKind::DuplicateRow);
    let cause = if 2 * twice > unusable as u64 {
        "a row for each quantity or station (`format = \"ugz\"` reads those of Zürich), or the same export twice"
    } else if 2 * beside > unusable {
        "another interval_s"
    } else {
        "a file that is not sorted by time"
    };
    let first = notes.list.iter().find(|f| matches!(f.kind, FindingKind::DuplicateRow | FindingKind::RefusedRow));
    let line = first.and_then(|finding| finding.line).unwrap_or(rows[0].line);
    let message = format!(
        "{unusable} of {} rows cannot be used, more than {:.0} %; probably {cause}",
        rows.len(),
        100.0 * MAX_UNUSABLE_SHARE
    );
    Finding::whole(FindingKind::WrongStamps, message).in_column(&layout.time[0]).at_line(line).times(unusable as u64)
}

/// Full intervals from such as begin anywhere: means by overlap, where nearly all of an interval is covered.
fn spread(intervals: &[Interval], length_s: i64) -> Vec<Interval> {
    let mut full: BTreeMap<i64, (u64, [(f64, f64); 4])> = BTreeMap::new();
    for interval in intervals {
        let first_s = interval.start_s - interval.start_s.rem_euclid(length_s);
        for start_s in [first_s, first_s + length_s] {
            let overlap_s = length_s - (interval.start_s - start_s).abs();
            if overlap_s <= 0 {
                continue;
            }
            let (_, sums) = full.entry(start_s).or_insert((interval.line, [(0.0, 0.0); 4]));
            for (quantity, sum) in Quantity::ALL.into_iter().zip(sums) {
                let value = *interval.values.get(quantity);
                if !value.is_nan() {
                    sum.0 += overlap_s as f64;
                    sum.1 += overlap_s as f64 * value;
                }
            }
        }
    }
    let mean = |(start_s, (line, sums)): (i64, (u64, [(f64, f64); 4]))| {
        let mut values = MISSING;
        for (quantity, (weight, sum)) in Quantity::ALL.into_iter().zip(sums) {
            if weight >= LEAST_COVERED * length_s as f64 {
                *values.get_mut(quantity) = sum / weight;
            }
        }
        Interval { start_s, line, values }
    };
    full.into_iter().map(mean).collect()
}
