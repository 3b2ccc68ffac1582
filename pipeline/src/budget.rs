//! How many bytes of input files are held at once, whatever the number of threads and the size of the files.

use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

/// Bytes of files in flight at most; one that is larger is alone.
pub(crate) const BUDGET_BYTES: u64 = 256 << 20;

/// Bytes that may still be taken.
#[derive(Debug)]
pub(crate) struct Budget {
    left: Mutex<u64>,
    given_back: Condvar,
}

/// Bytes that were taken; gives them back when it goes.
#[derive(Debug)]
pub(crate) struct Taken<'b> {
    budget: &'b Budget,
    bytes: u64,
}

impl Budget {
    pub fn new() -> Self {
        Self { left: Mutex::new(BUDGET_BYTES), given_back: Condvar::new() }
    }

    /// Waits until so many bytes are left, and takes them.
    pub fn take(&self, bytes: u64) -> Taken<'_> {
        let bytes = bytes.min(BUDGET_BYTES);
        let mut left = self.left();
        while *left < bytes {
            left = self.given_back.wait(left).unwrap_or_else(PoisonError::into_inner);
        }
        *left -= bytes;
        Taken { budget: self, bytes }
    }

    /// A number that another thread left behind when it panicked is still right.
    fn left(&self) -> MutexGuard<'_, u64> {
        self.left.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Drop for Taken<'_> {
    fn drop(&mut self) {
        *self.budget.left() += self.bytes;
        self.budget.given_back.notify_all();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicU64, Ordering};

    #[test]
    fn prop_no_more_is_held_than_the_budget() {
        let (budget, held, most) = (Budget::new(), AtomicU64::new(0), AtomicU64::new(0));
        std::thread::scope(|scope| {
            for i in 0..16_u64 {
                let (budget, held, most) = (&budget, &held, &most);
                scope.spawn(move || {
                    for k in 0..50 {
                        let bytes = ((i * 31 + k * 17) % 40 + 1) << 23;
                        let _taken = budget.take(bytes);
                        let bytes = bytes.min(BUDGET_BYTES);
                        let now = held.fetch_add(bytes, Ordering::SeqCst) + bytes;
                        most.fetch_max(now, Ordering::SeqCst);
                        std::thread::yield_now();
                        held.fetch_sub(bytes, Ordering::SeqCst);
                    }
                });
            }
        });
        let most = most.into_inner();
        assert!(most <= BUDGET_BYTES && most > BUDGET_BYTES / 2, "{most}");
    }
}
