//! A moving average over the last seconds.

/// Length of the average in s: 15 minutes, a typical ride (paper, section "Validation of the Steady-State Assumption").
const WINDOW_S: usize = 900;

/// The mean of the last [`WINDOW_S`] values, or of as many as there are.
#[derive(Debug, Clone)]
pub(crate) struct MovingAverage {
    values: [f64; WINDOW_S],
    next: usize,
    count: usize,
    sum: f64,
}

impl MovingAverage {
    pub fn new() -> Self {
        Self { values: [0.0; WINDOW_S], next: 0, count: 0, sum: 0.0 }
    }

    #[inline]
    pub fn push(&mut self, value: f64) -> f64 {
        self.sum += value - self.values[self.next];
        self.values[self.next] = value;
        self.next += 1;
        if self.next == WINDOW_S {
            self.next = 0;
            // Sum anew once a turn, so that rounding does not pile up over a day.
            self.sum = self.values.iter().sum();
        }
        self.count = (self.count + 1).min(WINDOW_S);
        self.sum / self.count as f64
    }
}
