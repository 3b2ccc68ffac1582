//! The vote of the last 15 minutes, and how far it ever is from neutral.

use cabin::{Lanes, Real};

/// Seconds between two votes; in between they are taken as linear.
pub(crate) const VOTE_S: usize = 5;
/// Until then a vote is taken every second: the mean over a few seconds shows every one of them.
pub(crate) const FIRST_S: u32 = 60;
/// Length of the average in s: 15 minutes, a typical ride (paper, section "Validation of the Steady-State Assumption").
const WINDOW_S: usize = 900;
const NODES: usize = WINDOW_S / VOTE_S;

/// The trailing mean over the last [`WINDOW_S`] seconds, or over as many as there are.
#[derive(Debug, Clone)]
pub(crate) struct TrailingVotes<const W: usize> {
    /// The votes, the oldest at `next` once the window is full.
    nodes: [Lanes<W>; NODES],
    next: usize,
    /// The newest vote, and the one just before the oldest.
    last: Lanes<W>,
    before: Lanes<W>,
    seconds: usize,
    sum: Lanes<W>,
    /// Largest absolute mean while somebody is on board.
    pub max_abs: Lanes<W>,
    /// Whether anybody ever was.
    pub any_on_board: bool,
}

/// The votes of [`VOTE_S`] seconds, or their trailing means.
pub(crate) type Votes<const W: usize> = [Lanes<W>; VOTE_S];

impl<const W: usize> TrailingVotes<W> {
    /// Begins with the vote of the first instant.
    pub fn new(first: Lanes<W>) -> Self {
        Self {
            nodes: [Lanes::ZERO; NODES],
            next: 0,
            last: first,
            before: first,
            seconds: 0,
            sum: Lanes::ZERO,
            max_abs: Lanes::ZERO,
            any_on_board: false,
        }
    }

    /// The votes of the next `seconds`, the last of which has the given one.
    #[inline(always)]
    pub fn up_to(&self, vote: Lanes<W>, seconds: usize) -> Votes<W> {
        let mut votes = [vote; VOTE_S];
        for (j, between) in votes.iter_mut().enumerate().take(seconds) {
            *between = (vote - self.last).mul_add((j + 1) as f64 / seconds as f64, self.last);
        }
        votes
    }

    /// Takes the votes of [`VOTE_S`] seconds, or of fewer at the very end, and gives their trailing means; `on_board` says of each
    /// second how many passengers are.
    #[inline(always)]
    pub fn push(&mut self, votes: &Votes<W>, on_board: &[f64]) -> Votes<W> {
        let mut means = *votes;
        let is_full = self.seconds >= WINDOW_S;
        let oldest = if is_full { self.nodes[self.next] } else { Lanes::ZERO };
        let before = if is_full { self.before } else { Lanes::ZERO };
        for (j, passengers) in on_board.iter().enumerate() {
            let share = (j + 1) as f64 / VOTE_S as f64;
            self.sum = self.sum + (votes[j] - (oldest - before).mul_add(share, before));
            let seconds = (self.seconds + j + 1).min(WINDOW_S);
            means[j] = self.sum * (1.0 / seconds as f64);
            if *passengers >= 1.0 {
                self.any_on_board = true;
                self.max_abs = self.max_abs.max(means[j].abs());
            }
        }
        self.seconds += VOTE_S;
        if is_full {
            self.before = oldest;
        }
        self.nodes[self.next] = votes[VOTE_S - 1];
        self.last = votes[VOTE_S - 1];
        self.next += 1;
        if self.next == NODES {
            self.next = 0;
            self.add_up();
        }
        means
    }

    /// Sums the window anew, once a turn, so that rounding does not pile up over a day.
    fn add_up(&mut self) {
        let (mut sum, mut from) = (Lanes::ZERO, self.before);
        for to in self.nodes {
            // Of the seconds of a straight line without its beginning.
            let weight = (VOTE_S + 1) as f64 / 2.0;
            sum = sum + (from * (VOTE_S as f64 - weight) + to * weight);
            from = to;
        }
        self.sum = sum;
    }

    /// Largest absolute mean of a lane; `None` where nobody was ever on board.
    pub fn largest(&self, lane: usize) -> Option<f64> {
        debug_assert!(lane < W);
        self.any_on_board.then(|| self.max_abs.0[lane])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prop_the_mean_is_that_of_the_last_quarter_of_an_hour() {
        let vote = |second: usize| (second as f64 * 0.01).sin() - 1.0 + (second as f64 / 3e3);
        // Linear between the nodes, as the votes are taken.
        let taken = |second: usize| {
            let node = second / VOTE_S * VOTE_S;
            vote(node) + (vote(node + VOTE_S) - vote(node)) * (second - node) as f64 / VOTE_S as f64
        };
        let mut trailing = TrailingVotes::new(Lanes::<8>::splat(vote(0)));
        let mut largest: f64 = 0.0;
        for block in 0..2000 {
            let end = (block + 1) * VOTE_S;
            let on_board: [f64; VOTE_S] =
                std::array::from_fn(|j| if (block * VOTE_S + j).is_multiple_of(7) { 3.0 } else { 0.0 });
            let votes = trailing.up_to(Lanes::splat(vote(end)), VOTE_S);
            let means = trailing.push(&votes, &on_board);
            for j in 0..VOTE_S {
                let second = block * VOTE_S + j + 1;
                let window = second.saturating_sub(WINDOW_S) + 1..=second;
                let mean = window.clone().map(taken).sum::<f64>() / window.count() as f64;
                assert!((means[j].0[3] - mean).abs() < 1e-9, "{second}: {} {mean}", means[j].0[3]);
                assert!((votes[j].0[5] - taken(second)).abs() < 1e-12);
                if on_board[j] > 0.0 {
                    largest = largest.max(mean.abs());
                }
            }
        }
        assert!((trailing.largest(7).unwrap_or(0.0) - largest).abs() < 1e-9);
        assert_eq!(TrailingVotes::new(Lanes::<8>::ONE).largest(0), None);
    }
}
