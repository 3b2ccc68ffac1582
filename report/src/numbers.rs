//! Numbers as text, always the same way.

/// `-0.5 … 0.7`, or `±1` for a symmetric window, `0` for neutral.
pub(crate) fn window((pmv_min, pmv_max): (f64, f64)) -> String {
    if pmv_min == 0.0 && pmv_max == 0.0 {
        "0".to_owned()
    } else if pmv_min == -pmv_max {
        format!("±{pmv_max}")
    } else {
        format!("{pmv_min} … {pmv_max}")
    }
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
