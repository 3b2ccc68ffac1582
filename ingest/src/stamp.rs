//! Stamps as people's tools write them, and what a stamp without an offset means.

use chrono::{DateTime, LocalResult, NaiveDate, NaiveDateTime, NaiveTime, Offset, TimeDelta, TimeZone, Utc};
use chrono_tz::Tz;

use crate::parse::second;

/// What a stamp without an offset of its own means.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Clock {
    /// UTC.
    #[default]
    Utc,
    /// So many seconds ahead of UTC, the whole year.
    Offset(i32),
    /// Local time, with summer time where there is one.
    Zone(Tz),
}

/// A stamp as it was written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Stamp {
    /// What the clock showed.
    pub wall: NaiveDateTime,
    /// Seconds ahead of UTC, where the stamp says it.
    pub offset_s: Option<i32>,
}

impl Stamp {
    /// A stamp without an offset.
    pub fn bare(wall: NaiveDateTime) -> Self {
        Self { wall, offset_s: None }
    }

    /// A stamp in UTC.
    pub fn utc(wall: NaiveDateTime) -> Self {
        Self { wall, offset_s: Some(0) }
    }

    /// The same, later by so many seconds.
    pub fn later(self, seconds: i64) -> Option<Self> {
        Some(Self { wall: self.wall.checked_add_signed(TimeDelta::try_seconds(seconds)?)?, ..self })
    }

    /// `2022-12-31T23:00:00Z` and what is close to it: with a space, without seconds, with an offset or bare, a date alone
    /// (midnight), `24:00`, `31.12.2022 23:00`, `20221231:2300`, and seconds since 1970.
    pub fn parse(text: &str) -> Option<Self> {
        if text.len() >= 9
            && !text.contains(['-', ':'])
            && let Some(seconds) = second(text)
        {
            return Some(Self::utc(DateTime::from_timestamp(seconds, 0)?.naive_utc()));
        }
        let (text, offset_s) = split_offset(text);
        Some(Self { wall: wall(text.trim_end())?, offset_s })
    }
}

/// The offset at the end of a stamp, in s, and what stands before it.
fn split_offset(text: &str) -> (&str, Option<i32>) {
    if let Some(rest) = text.strip_suffix(['Z', 'z']).or_else(|| text.strip_suffix(" UTC")) {
        return (rest, Some(0));
    }
    // The last sign behind the time of day: dates have dashes of their own.
    let Some(at) = text.rfind(['+', '-', '\u{2212}']).filter(|&at| text[..at].contains(':')) else {
        return (text, None);
    };
    let sign = if text[at..].starts_with('+') { 1 } else { -1 };
    let digits = text[at..].trim_start_matches(['+', '-', '\u{2212}']).replace(':', "");
    let number = |part: Option<&str>| part.and_then(|p| p.parse::<i32>().ok());
    let offset_s = match (digits.len(), digits.is_ascii()) {
        (2, true) => number(Some(&digits)).map(|hours| 3600 * hours),
        (4, true) => number(digits.get(..2)).zip(number(digits.get(2..))).map(|(h, m)| 3600 * h + 60 * m),
        _ => None,
    };
    match offset_s.filter(|s| *s <= 14 * 3600) {
        Some(offset_s) => (&text[..at], Some(sign * offset_s)),
        None => (text, None),
    }
}

/// Date and time of day.
fn wall(text: &str) -> Option<NaiveDateTime> {
    if let Some((day, time)) = text.split_once(':').filter(|(day, _)| day.len() == 8) {
        return NaiveDate::parse_from_str(day, "%Y%m%d").ok()?.and_time(time_of_day(time)?.0).into();
    }
    let (day, time) = match text.split_once(['T', 't', ' ']) {
        Some((day, time)) => (day, time_of_day(time.trim())?),
        None => (text, (NaiveTime::MIN, false)),
    };
    let form = if day.contains('.') { "%d.%m.%Y" } else { "%Y-%m-%d" };
    let date = NaiveDate::parse_from_str(day, form).ok().filter(|_| day.len() == 10)?;
    let date = if time.1 { date.succ_opt()? } else { date };
    Some(date.and_time(time.0))
}

/// `23:00`, `23:00:00`, `2300`; and whether it is the midnight of the next day, `24:00`. A fraction belongs to its second.
fn time_of_day(text: &str) -> Option<(NaiveTime, bool)> {
    let (text, fraction) = text.split_once('.').unwrap_or((text, ""));
    if !fraction.bytes().all(|b| b.is_ascii_digit()) {
        return None;
    }
    if matches!(text, "24:00" | "24:00:00" | "2400") {
        return Some((NaiveTime::MIN, true));
    }
    let time = ["%H:%M:%S", "%H:%M", "%H%M"].iter().find_map(|form| NaiveTime::parse_from_str(text, form).ok())?;
    Some((time, false))
}

impl Clock {
    /// `+01:00`, `-05:30` or `Z`.
    #[must_use]
    pub fn of_offset(text: &str) -> Option<Self> {
        let stamp = Stamp::parse(&format!("2000-01-01T00:00{text}"))?;
        stamp.offset_s.map(Self::Offset)
    }

    /// Seconds since 1970 of a stamp that follows one at `last_s`; `None` for a time of day that the zone leaves out. Of the two
    /// hours that a zone has twice in autumn, the second follows the first.
    pub(crate) fn resolve(self, stamp: Stamp, last_s: i64) -> Option<i64> {
        let utc_s = stamp.wall.and_utc().timestamp();
        match (stamp.offset_s, self) {
            (Some(offset_s), _) | (None, Self::Offset(offset_s)) => Some(utc_s - i64::from(offset_s)),
            (None, Self::Utc) => Some(utc_s),
            (None, Self::Zone(zone)) => match zone.from_local_datetime(&stamp.wall) {
                LocalResult::Single(instant) => Some(instant.timestamp()),
                LocalResult::Ambiguous(first, second) => {
                    let instant = if first.timestamp() > last_s { first } else { second };
                    Some(instant.timestamp())
                }
                LocalResult::None => None,
            },
        }
    }

    /// Seconds ahead of UTC at an instant.
    pub(crate) fn offset_s(self, second: i64) -> i64 {
        match self {
            Self::Utc => 0,
            Self::Offset(offset_s) => i64::from(offset_s),
            Self::Zone(zone) => {
                let offset =
                    |t: DateTime<Utc>| i64::from(zone.offset_from_utc_datetime(&t.naive_utc()).fix().local_minus_utc());
                DateTime::from_timestamp(second, 0).map_or(0, offset)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prop_stamps_of_common_tools_are_read() {
        let noon = |text| Stamp::parse(text).map(|s| (Clock::Utc.resolve(s, 0).unwrap(), s.offset_s));
        let at = DateTime::parse_from_rfc3339("2021-02-10T12:00:00Z").unwrap().timestamp();
        for (text, offset_s) in [
            ("2021-02-10T12:00:00Z", Some(0)),
            ("2021-02-10T12:00Z", Some(0)),
            ("2021-02-10 12:00:00+00:00", Some(0)),
            ("2021-02-10T13:00+0100", Some(3600)),
            ("2021-02-10T13:00:00+01", Some(3600)),
            ("2021-02-10T06:30:00-05:30", Some(-19_800)),
            ("2021-02-10 12:00:00 UTC", Some(0)),
            ("2021-02-10T12:00:00.000Z", Some(0)),
            ("2021-02-10 12:00:00", None),
            ("2021-02-10T12:00", None),
            ("10.02.2021 12:00", None),
            ("20210210:1200", None),
            ("1612958400", Some(0)),
            ("1612958400.0", Some(0)),
        ] {
            assert_eq!(noon(text), Some((at, offset_s)), "{text}");
        }
        let midnight = at + 12 * 3600;
        for text in ["2021-02-11", "2021-02-10 24:00", "2021-02-10T24:00:00", "2021-02-11T00:00"] {
            assert_eq!(noon(text), Some((midnight, None)), "{text}");
        }
        for text in [
            "noon",
            "",
            "10/02/2021 12:00",
            "2021-02-30",
            "2021-2-1",
            "2021-02-10T12:00:00.x",
            "2021-02-10T25:00",
            "-05:00",
        ] {
            assert_eq!(Stamp::parse(text), None, "{text}");
        }
    }

    #[test]
    fn prop_local_time_has_an_hour_less_in_spring_and_one_twice_in_autumn() {
        let zurich = Clock::Zone(chrono_tz::Europe::Zurich);
        let at = |text, last| zurich.resolve(Stamp::parse(text).unwrap(), last);
        let utc = |text| DateTime::parse_from_rfc3339(text).unwrap().timestamp();
        assert_eq!(at("2021-03-28T03:00", 0), Some(utc("2021-03-28T01:00:00Z")));
        assert_eq!(at("2021-03-28T02:30", 0), None);
        let first = utc("2021-10-31T00:30:00Z");
        assert_eq!(at("2021-10-31T02:30", first - 1800), Some(first));
        assert_eq!(at("2021-10-31T02:30", first), Some(first + 3600));
        assert_eq!(Clock::of_offset("+05:30"), Some(Clock::Offset(19_800)));
        assert_eq!((Clock::of_offset("5"), Clock::of_offset("Z")), (None, Some(Clock::Offset(0))));
    }
}
