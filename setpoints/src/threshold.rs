//! From where on a device runs: the threshold that sorts the year's optima with the least error.

/// An hour in which a device runs or not.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Switch {
    /// What decides: a temperature difference in K, or a temperature in °C.
    pub value: f64,
    /// Whether it runs.
    pub is_on: bool,
    /// Share in the year, above 0.
    pub weight: f64,
}

/// A threshold above which a device runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Threshold {
    /// The threshold, in the middle between the hours on its two sides.
    pub value: f64,
    /// Weighted share of the hours that lie on the wrong side.
    pub misclassified: f64,
}

/// The threshold above which a device runs with the least misclassified weight; `None` without hours, or where the device
/// always or never runs and so none is seen.
#[must_use]
pub fn threshold(hours: &[Switch]) -> Option<Threshold> {
    if hours.iter().all(|h| h.is_on) || !hours.iter().any(|h| h.is_on) {
        return None;
    }
    let mut sorted: Vec<Switch> = hours.to_vec();
    sorted.sort_by(|a, b| a.value.total_cmp(&b.value));
    let total: f64 = sorted.iter().map(|h| h.weight).sum();
    // With the threshold below all of them, those that are off are wrong.
    let mut wrong: f64 = sorted.iter().filter(|h| !h.is_on).map(|h| h.weight).sum();
    let lowest = sorted[0].value;
    let mut best = (wrong, lowest, lowest);
    for (n, hour) in sorted.iter().enumerate() {
        wrong += if hour.is_on { hour.weight } else { -hour.weight };
        let next = sorted.get(n + 1).map_or(hour.value, |next| next.value);
        if next == hour.value && n + 1 < sorted.len() {
            continue;
        }
        if wrong < best.0 {
            best = (wrong, hour.value, next);
        }
    }
    let (wrong, low, high) = best;
    Some(Threshold { value: 0.5 * (low + high), misclassified: wrong.max(0.0) / total })
}
