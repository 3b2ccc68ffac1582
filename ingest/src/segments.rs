//! The kernel of the mission reader: seconds of telemetry become means over segments.

/// What a mission's seconds are added up with.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Clock {
    /// Start of the mission in s since 1970.
    pub start_s: i64,
    /// End of the mission: one second after its last row.
    pub end_s: i64,
    /// Length of a segment in s.
    pub segment_s: i64,
}

/// Sums over one segment.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Sums {
    /// Passengers × s.
    pub passenger_seconds: f64,
    /// Seconds with an open door, or shares of the doors × s.
    pub door_seconds: f64,
    /// Seconds that a row stands for.
    pub observed_s: i64,
    /// Lines of the first and last row that lie in the segment.
    pub lines: Option<(u64, u64)>,
    /// Sum of the speeds in m/s, and of how many seconds.
    pub speed: (f64, i64),
    /// Sum of the powers in W, and of how many seconds.
    pub power: (f64, i64),
}

/// State of the bus, held until a row changes it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct State {
    /// Passengers on board: 0 before the first count.
    pub passengers: f64,
    /// How far doors are open, as [`cabin::LoadChange`] says it.
    pub door_open: f64,
}

/// What a row says of how the bus drives; NaN where it does not.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Drive {
    /// Speed in m/s.
    pub speed_m_s: f64,
    /// Electric power in W.
    pub power_w: f64,
}

/// Adds a mission up, row by row in rising time. The row at `t` stands for `[t, t + 1)`; where rows are missing the
/// state before holds.
#[derive(Debug)]
pub(crate) struct Adder {
    clock: Clock,
    segments: Vec<Sums>,
    /// The next second to be added up, its segment, and where that one ends.
    at_s: i64,
    segment: usize,
    segment_end_s: i64,
    state: State,
}

impl Adder {
    pub fn new(clock: Clock) -> Self {
        let count = (clock.end_s - clock.start_s + clock.segment_s - 1) / clock.segment_s;
        Self {
            clock,
            segments: vec![Sums::default(); usize::try_from(count).unwrap_or(0)],
            at_s: clock.start_s,
            segment: 0,
            segment_end_s: clock.start_s + clock.segment_s,
            state: State::default(),
        }
    }

    /// The next second without a row; a row that is added must not be earlier.
    pub fn next_s(&self) -> i64 {
        self.at_s
    }

    /// The state that holds.
    pub fn state(&self) -> State {
        self.state
    }

    /// Adds the row of a time, on a line of the file, within the clock's start and end; says in which segment it lies.
    pub fn add(&mut self, line: u64, time_s: i64, state: State, drive: Drive) -> usize {
        if time_s > self.at_s {
            self.advance(time_s, false);
        }
        self.state = state;
        self.advance(time_s + 1, true);
        let sums = &mut self.segments[self.segment];
        sums.lines = Some(sums.lines.map_or((line, line), |(first, _)| (first, line)));
        // A row speaks of its own second; what is not known of it is not held.
        for (sum, value) in [(&mut sums.speed, drive.speed_m_s), (&mut sums.power, drive.power_w)] {
            if !value.is_nan() {
                *sum = (sum.0 + value, sum.1 + 1);
            }
        }
        self.segment
    }

    /// The sums of all segments.
    pub fn finish(mut self) -> Vec<Sums> {
        self.advance(self.clock.end_s, false);
        self.segments
    }

    fn advance(&mut self, to_s: i64, observed: bool) {
        while self.at_s < to_s {
            if self.at_s == self.segment_end_s {
                self.segment += 1;
                self.segment_end_s += self.clock.segment_s;
            }
            let until = to_s.min(self.segment_end_s);
            let seconds = until - self.at_s;
            let sums = &mut self.segments[self.segment];
            sums.passenger_seconds += self.state.passengers * seconds as f64;
            sums.door_seconds += self.state.door_open * seconds as f64;
            sums.observed_s += if observed { seconds } else { 0 };
            self.at_s = until;
        }
    }
}
