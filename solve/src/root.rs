//! The root of a rising function.

/// What the search for a root ended with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Root {
    /// The root.
    At(f64),
    /// The function is positive over the whole bracket.
    Below,
    /// The function is negative over the whole bracket.
    Above,
    /// The function could not be evaluated, or the steps did not shrink.
    Lost,
}

/// Finds where a rising function is zero between `low` and `high`, starting at `guess`, by Newton's method kept inside
/// a bracket that every evaluation narrows. `function` gives value and slope, or `None` where it cannot be evaluated.
pub(crate) fn rising_root(
    mut low: f64,
    mut high: f64,
    guess: f64,
    mut function: impl FnMut(f64) -> Option<(f64, f64)>,
) -> Root {
    // Ends that no evaluation has confirmed yet: a step beyond them asks whether the root is there at all.
    let (mut low_known, mut high_known) = (false, false);
    let mut x = guess.clamp(low, high);
    for _ in 0..100 {
        let Some((value, slope)) = function(x) else { return Root::Lost };
        if value == 0.0 {
            return Root::At(x);
        }
        if value > 0.0 {
            if x <= low && !low_known {
                return Root::Below;
            }
            (high, high_known) = (x, true);
        } else {
            if x >= high && !high_known {
                return Root::Above;
            }
            (low, low_known) = (x, true);
        }
        let newton = x - value / slope;
        // Newton's error after a step is of the order of the step squared: below a microkelvin that is rounding.
        if (newton - x).abs() < 1e-7 {
            return Root::At(newton.clamp(low, high));
        }
        let next = if newton > low && newton < high {
            newton
        } else if newton <= low && !low_known {
            low
        } else if newton >= high && !high_known {
            high
        } else {
            0.5 * (low + high)
        };
        if high - low < 1e-12 * high.abs() {
            return Root::At(next);
        }
        x = next;
    }
    Root::Lost
}
