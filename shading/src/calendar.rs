//! Hours of a reference year.

use chrono::{DateTime, Datelike, Timelike, Utc};

/// Number of the hour of an instant in a year of 365 days, from 0; 29 February counts as the 28th.
#[must_use]
pub fn hour_of_year(instant: DateTime<Utc>) -> usize {
    let leap_day = instant.month() == 2 && instant.day() == 29;
    let after_leap_day = instant.date_naive().leap_year() && instant.month() > 2;
    let day = instant.ordinal0() as usize - usize::from(leap_day || after_leap_day);
    day * 24 + instant.hour() as usize
}
