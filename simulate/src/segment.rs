//! What the steady-state optimum prescribes for a segment of a mission.

use cabin::{Cabin, ComfortWindow, Operation, Target};

/// The steady-state optimum of a segment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Segment {
    /// What it prescribes, and what it foresees.
    pub optimum: Operation,
    /// Cabin temperatures in K at the two limits of its comfort window, with its heaters on or off.
    pub band_k: [f64; 2],
}

impl Segment {
    /// The segment of an optimum; `cabin` is under the mean disturbances of the segment.
    #[must_use]
    pub fn new(cabin: &Cabin<'_>, optimum: &Operation, window: ComfortWindow) -> Self {
        let cabin_k = optimum.temperatures.cabin_k;
        let guess = cabin.rough_state(cabin_k);
        let at_limit = |pmv| {
            // The optimum settled on one of the limits or in between, so both exist.
            cabin.state(Target::Vote(pmv), optimum.heaters(), &guess).map_or(cabin_k, |s| s.temperatures.cabin_k)
        };
        Self { optimum: *optimum, band_k: [window.pmv_min(), window.pmv_max()].map(at_limit) }
    }
}
