//! The share of the road that lies in the shade.

use chrono::{
    DateTime, Datelike, Duration, DurationRound, NaiveDate, NaiveDateTime, NaiveTime, TimeZone, Timelike, Utc,
};
use std::io::Read;

use crate::hour_of_year;

const HOURS: usize = 8760;

/// Shadow fractions at the full hours of one reference year, repeated by calendar date.
///
/// Between full hours the fraction is linear (paper, section 2.1.3). 29 February takes the values of the 28th.
#[derive(Debug, Clone, PartialEq)]
pub struct ShadowYear {
    /// One value per hour of a year of 365 days, from 1 January 00:00 UTC.
    hourly: Vec<f64>,
}

/// Why a shadow file cannot be used. Lines count from 1, the header included.
#[derive(Debug, thiserror::Error)]
pub enum ShadowError {
    /// The file cannot be read as CSV.
    #[error("{0}; the file needs the comma-separated columns time_utc,shadow_fraction in UTF-8")]
    Csv(#[from] csv::Error),
    /// A column is missing.
    #[error("line 1: the column {0} is missing; the file needs time_utc,shadow_fraction, separated by commas")]
    Column(&'static str),
    /// A stamp is not a full hour in RFC 3339.
    #[error("line {line}, column time_utc: {text:?} is not a full hour in UTC such as 2022-01-01T13:00:00Z")]
    Time {
        /// Line of the file.
        line: u64,
        /// What stands there.
        text: String,
    },
    /// A fraction is not a number between 0 and 1.
    #[error("line {line}, column shadow_fraction: {text:?} is not a number from 0 (sun) to 1 (shade)")]
    Fraction {
        /// Line of the file.
        line: u64,
        /// What stands there.
        text: String,
    },
    /// The same hour of the calendar stands twice.
    #[error("line {line}: the hour {hour} (month-day hour, UTC) stands twice; keep one reference year only")]
    Twice {
        /// Line of the file.
        line: u64,
        /// The hour as `MM-DD HH:00`.
        hour: String,
    },
    /// The year is not complete.
    #[error(
        "{missing} of 8760 hours are missing, the first is {first} (month-day hour, UTC); give every full hour of one year"
    )]
    Incomplete {
        /// How many hours have no value.
        missing: usize,
        /// The first of them as `MM-DD HH:00`.
        first: String,
    },
}

impl ShadowYear {
    /// Reads `time_utc,shadow_fraction` with one row per full hour of one year; further columns are ignored.
    ///
    /// # Errors
    /// [`ShadowError`] names the line and what belongs there.
    pub fn read(source: impl Read) -> Result<Self, ShadowError> {
        // Lines end at \n, so that they count right in files with \r\n; trimming removes the \r.
        let mut reader =
            csv::ReaderBuilder::new().terminator(csv::Terminator::Any(b'\n')).trim(csv::Trim::All).from_reader(source);
        let header = reader.headers()?.clone();
        let column = |name: &'static str| {
            let found = header.iter().position(|h| h.trim_start_matches('\u{feff}') == name);
            found.ok_or(ShadowError::Column(name))
        };
        let (time, fraction) = (column("time_utc")?, column("shadow_fraction")?);

        let mut hourly = vec![f64::NAN; HOURS];
        let mut record = csv::StringRecord::new();
        while reader.read_record(&mut record)? {
            let line = record.position().map_or(0, csv::Position::line);
            let text = &record[time];
            let bad_time = || ShadowError::Time { line, text: text.to_owned() };
            let stamp = utc(text).ok_or_else(bad_time)?;
            if stamp.minute() != 0 || stamp.second() != 0 || stamp.nanosecond() != 0 {
                return Err(bad_time());
            }
            let bad_fraction = || ShadowError::Fraction { line, text: record[fraction].to_owned() };
            let value: f64 = record[fraction].parse().map_err(|_| bad_fraction())?;
            if !(0.0..=1.0).contains(&value) {
                return Err(bad_fraction());
            }
            if stamp.month() == 2 && stamp.day() == 29 {
                continue;
            }
            let slot = &mut hourly[hour_of_year(stamp)];
            if !slot.is_nan() {
                return Err(ShadowError::Twice { line, hour: stamp.format("%m-%d %H:00").to_string() });
            }
            *slot = value;
        }
        if let Some(first) = hourly.iter().position(|v| v.is_nan()) {
            let missing = hourly.iter().filter(|v| v.is_nan()).count();
            return Err(ShadowError::Incomplete { missing, first: hour_label(first) });
        }
        Ok(Self { hourly })
    }

    /// A year from a function of the hour's number, 0 … 8759 from 1 January 00:00 UTC; values are limited to 0 … 1.
    #[must_use]
    pub fn from_fn(fraction: impl FnMut(usize) -> f64) -> Self {
        Self { hourly: (0..HOURS).map(fraction).map(|f| f.clamp(0.0, 1.0)).collect() }
    }

    /// The 8760 values from 1 January 00:00 UTC.
    #[must_use]
    pub fn hourly(&self) -> &[f64] {
        &self.hourly
    }

    /// The year as [`ShadowYear::read`] reads it, with the stamps of 2022.
    #[must_use]
    pub fn to_csv(&self) -> String {
        let start = Utc.with_ymd_and_hms(2022, 1, 1, 0, 0, 0).single().expect("1 January 2022 exists");
        let mut text = "time_utc,shadow_fraction\n".to_owned();
        for (hour, fraction) in self.hourly.iter().enumerate() {
            let time = (start + Duration::hours(hour as i64)).format("%Y-%m-%dT%H:%M:%SZ");
            text += &format!("{time},{fraction:.4}\n");
        }
        text
    }

    /// Shadow fraction at an instant, linear between full hours.
    #[must_use]
    pub fn at(&self, instant: DateTime<Utc>) -> f64 {
        let hour = full_hour(instant);
        let share = (instant - hour).as_seconds_f64() / 3600.0;
        let (before, after) = (self.at_full_hour(hour), self.at_full_hour(hour + Duration::hours(1)));
        before + share * (after - before)
    }

    /// Mean shadow fraction from `start` to `end`: the exact integral of the linear interpolation.
    /// For `end <= start` the value at `start`.
    #[must_use]
    pub fn mean(&self, start: DateTime<Utc>, end: DateTime<Utc>) -> f64 {
        if end <= start {
            return self.at(start);
        }
        let mut from = start;
        let mut integral = 0.0;
        while from < end {
            let to = (full_hour(from) + Duration::hours(1)).min(end);
            let seconds = (to - from).as_seconds_f64();
            integral += self.at(from + (to - from) / 2) * seconds;
            from = to;
        }
        integral / (end - start).as_seconds_f64()
    }

    /// What the shade from `start` to `end` is made of: a hash over the full hours that the span lies between. Shade elsewhere
    /// does not change it.
    #[must_use]
    pub fn key(&self, start: DateTime<Utc>, end: DateTime<Utc>) -> String {
        let mut hasher = blake3::Hasher::new();
        let mut hour = full_hour(start);
        while hour < end + Duration::hours(1) {
            hasher.update(&self.at_full_hour(hour).to_le_bytes());
            hour += Duration::hours(1);
        }
        hasher.finalize().to_hex().to_string()
    }

    fn at_full_hour(&self, hour: DateTime<Utc>) -> f64 {
        self.hourly[hour_of_year(hour)]
    }
}

/// `2022-01-01T13:00:00Z`, and what is close to it: with a space, without seconds, with an offset; without one it is UTC, as
/// the column's name says; a date alone is its midnight.
fn utc(text: &str) -> Option<DateTime<Utc>> {
    let text = text.replacen(' ', "T", 1).replace('Z', "+00:00");
    let with_offset = ["%Y-%m-%dT%H:%M:%S%.f%#z", "%Y-%m-%dT%H:%M%#z"];
    let bare = ["%Y-%m-%dT%H:%M:%S%.f", "%Y-%m-%dT%H:%M"];
    let found = with_offset.iter().find_map(|form| DateTime::parse_from_str(&text, form).ok()).map(|t| t.to_utc());
    let found = found
        .or_else(|| bare.iter().find_map(|form| NaiveDateTime::parse_from_str(&text, form).ok()?.and_utc().into()));
    found.or_else(|| Some(NaiveDate::parse_from_str(&text, "%Y-%m-%d").ok()?.and_time(NaiveTime::MIN).and_utc()))
}

fn full_hour(instant: DateTime<Utc>) -> DateTime<Utc> {
    instant.duration_trunc(Duration::hours(1)).expect("an hour divides every date that chrono can hold")
}

fn hour_label(hour_of_year: usize) -> String {
    let start = Utc.with_ymd_and_hms(2023, 1, 1, 0, 0, 0).single().expect("1 January 2023 exists");
    (start + Duration::hours(hour_of_year as i64)).format("%m-%d %H:00").to_string()
}
