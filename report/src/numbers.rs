//! Numbers as text, always the same way.

use cabin::ComfortWindow;
use chrono::{DateTime, SecondsFormat, Utc};
use store::{DrivenEnds, Ends};

/// `-0.5 … 0.7`, or `±1` for a symmetric window, `0` for neutral.
pub(crate) fn window(window: ComfortWindow) -> String {
    let (pmv_min, pmv_max) = (window.pmv_min(), window.pmv_max());
    if pmv_min == 0.0 && pmv_max == 0.0 {
        "0".to_owned()
    } else if window.is_symmetric() {
        format!("±{pmv_max}")
    } else {
        format!("{pmv_min} … {pmv_max}")
    }
}

/// A time as tables have it.
pub(crate) fn time(time: DateTime<Utc>) -> String {
    time.to_rfc3339_opts(SecondsFormat::Secs, true)
}

/// A number with every digit, or nothing.
pub(crate) fn optional(value: Option<f64>) -> String {
    value.map(|v| v.to_string()).unwrap_or_default()
}

/// Text from outside in a table of data: a spreadsheet must not take it for a formula.
pub(crate) fn text(cell: &str) -> String {
    let formula = cell.starts_with(['=', '+', '-', '@', '\t', '\r']);
    if formula { format!("'{cell}") } else { cell.to_owned() }
}

/// Watts without decimals, `–` where there are none.
pub(crate) fn watts(power_w: Option<f64>) -> String {
    // Adding 0 turns -0 into 0.
    power_w.map_or_else(|| "–".to_owned(), |p| format!("{}", p.round() + 0.0))
}

/// A share as percent with one decimal.
pub(crate) fn percent(share: Option<f64>) -> String {
    share.map_or_else(|| "–".to_owned(), |s| format!("{:.1} %", 100.0 * s + 0.0))
}

/// A number with as many digits as its interval lets stand, and the ends of this in the same digits.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Sure {
    pub value: String,
    pub ends: Option<[String; 2]>,
}

/// At most so many decimals: the last digit is the first one of half the interval's width; a number that is surer than by half
/// keeps two digits.
pub(crate) fn sure(value: f64, ends: Ends, decimals: i32) -> Sure {
    let Some([low, high]) = ends.filter(|[low, high]| high > low) else {
        return Sure { value: rounded(value, -decimals), ends: None };
    };
    let half = (high - low) / 2.0;
    let first = half.log10().floor() as i32;
    let second = || value.abs().log10().floor() as i32 - 1;
    let place = if half < 0.5 * value.abs() { first.min(second()) } else { first }.max(-decimals);
    Sure { value: rounded(value, place), ends: Some([rounded(low, place), rounded(high, place)]) }
}

/// The same in a line, with the interval in brackets.
pub(crate) fn within(value: f64, ends: Ends, decimals: i32) -> String {
    let Sure { value, ends } = sure(value, ends, decimals);
    ends.map_or_else(|| value.clone(), |[low, high]| format!("{value} ({low} … {high})"))
}

/// A share with its interval, in percent with at most one decimal.
pub(crate) fn percent_within(share: f64, ends: Ends) -> String {
    let of = ends.map(|ends| ends.map(|end| 100.0 * end));
    let text = within(100.0 * share, of, 1);
    text.split_once(" (").map_or_else(|| format!("{text} %"), |(value, rest)| format!("{value} % ({rest}"))
}

/// With four digits, without zeros that say nothing.
pub(crate) fn significant(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return if value == 0.0 { "0".to_owned() } else { "–".to_owned() };
    }
    let place = value.abs().log10().floor() as i32 - 3;
    let text = rounded(value, place);
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// To a power of ten.
fn rounded(value: f64, place: i32) -> String {
    let decimals = usize::try_from(-place).unwrap_or(0);
    let unit = 10_f64.powi(place.max(0));
    // Adding 0 turns -0 into 0.
    format!("{:.decimals$}", if place > 0 { (value / unit).round() * unit } else { value } + 0.0).replace('-', "−")
}

/// With a sign and so many decimals; nothing has no sign.
pub(crate) fn signed(value: f64, decimals: usize) -> String {
    let text = format!("{:.decimals$}", value.abs());
    match (text.chars().all(|c| matches!(c, '0' | '.')), value < 0.0) {
        (true, _) => text,
        (false, true) => format!("−{text}"),
        (false, false) => format!("+{text}"),
    }
}

/// A difference in percent of a whole, with a sign and its interval.
pub(crate) fn signed_percent_within(part: f64, whole: f64, ends: Ends) -> String {
    let text = signed_percent(part, whole);
    match ends {
        Some([low, high]) if whole > 0.0 => {
            format!("{text} ({} … {})", signed(100.0 * low, 1), signed(100.0 * high, 1))
        }
        _ => text,
    }
}

/// The intervals of what was driven so.
pub(crate) fn of_point<'e>(
    all: &'e [DrivenEnds],
    design: &str,
    window: ComfortWindow,
    controller: &str,
) -> Option<&'e DrivenEnds> {
    let is_it =
        |e: &&DrivenEnds| e.point.design == design && e.point.window == window && e.point.controller == controller;
    all.iter().find(is_it)
}

/// A part of a whole in percent, with a sign.
pub(crate) fn signed_percent(part: f64, whole: f64) -> String {
    if whole > 0.0 { format!("{} %", signed(100.0 * part / whole, 1)) } else { "–".to_owned() }
}

/// A name of a month.
pub(crate) fn month(month: u8) -> &'static str {
    chrono::Month::try_from(month).map_or("?", |month| month.name())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prop_an_interval_leaves_the_digits_that_stand() {
        // A four-digit number within ±15 % has two digits.
        assert_eq!(within(1234.0, Some([1050.0, 1420.0]), 0), "1200 (1100 … 1400)");
        assert_eq!(within(1314.9, Some([1243.6, 1391.5]), 0), "1310 (1240 … 1390)");
        assert_eq!(within(59.0, Some([58.5, 59.4]), 1), "59.0 (58.5 … 59.4)");
        assert_eq!(within(7.2, Some([3.1, 11.0]), 1), "7 (3 … 11)");
        assert_eq!(within(8034.0, Some([6980.0, 9130.0]), 0), "8000 (7000 … 9100)");
        assert_eq!(within(7.24, Some([6.1, 8.3]), 1), "7.2 (6.1 … 8.3)");
        assert_eq!(within(0.0, Some([0.0, 0.0]), 1), "0.0");
        assert_eq!(within(0.0, Some([0.0, 0.4]), 1), "0.0 (0.0 … 0.4)");
        assert_eq!(within(-8.562, Some([-8.785, -8.333]), 1), "−8.6 (−8.8 … −8.3)");
        assert_eq!(within(1234.6, None, 0), "1235");
        assert_eq!(
            [0.0, -0.125, 1234.56, 12345.6, 21.0, 0.1 + 0.2].map(significant),
            ["0", "−0.125", "1235", "12350", "21", "0.3"]
        );
    }
}
