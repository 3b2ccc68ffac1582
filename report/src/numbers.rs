//! Numbers as text, always the same way.

use cabin::ComfortWindow;
use chrono::{DateTime, SecondsFormat, Utc};

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

/// With a sign and so many decimals; nothing has no sign.
pub(crate) fn signed(value: f64, decimals: usize) -> String {
    let text = format!("{:.decimals$}", value.abs());
    match (text.chars().all(|c| matches!(c, '0' | '.')), value < 0.0) {
        (true, _) => text,
        (false, true) => format!("−{text}"),
        (false, false) => format!("+{text}"),
    }
}

/// A part of a whole in percent, with a sign.
pub(crate) fn signed_percent(part: f64, whole: f64) -> String {
    if whole > 0.0 { format!("{} %", signed(100.0 * part / whole, 1)) } else { "–".to_owned() }
}

/// A name of a month.
pub(crate) fn month(month: u8) -> &'static str {
    const NAMES: [&str; 12] = [
        "January",
        "February",
        "March",
        "April",
        "May",
        "June",
        "July",
        "August",
        "September",
        "October",
        "November",
        "December",
    ];
    NAMES.get(usize::from(month).wrapping_sub(1)).copied().unwrap_or("?")
}
