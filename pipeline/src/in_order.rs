//! Work on a list by several threads, with the results taken in the order of the list.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;

/// Does `work` on every item by `threads` threads and gives the results to `take`, in the order of the items. Each
/// thread keeps a value of its own, such as a buffer, from item to item; it starts as the default. Ends early, with the
/// error, where `take` fails.
///
/// Plain threads, not rayon's: a rayon worker that waits, such as for memory, starts on the next
/// item meanwhile, and then every file is in memory at once.
///
/// # Errors
/// What `take` ends with.
pub fn in_order<T, L, R, E>(
    items: &[T],
    threads: usize,
    work: impl Fn(&mut L, &T) -> R + Sync,
    mut take: impl FnMut(R) -> Result<(), E>,
) -> Result<(), E>
where
    T: Sync,
    L: Default,
    R: Send,
{
    let next = AtomicUsize::new(0);
    let (sender, results) = mpsc::channel();
    std::thread::scope(|scope| {
        for _ in 0..threads.max(1) {
            let (sender, next, work) = (sender.clone(), &next, &work);
            scope.spawn(move || {
                let mut local = L::default();
                loop {
                    let i = next.fetch_add(1, Ordering::Relaxed);
                    // Nobody listens any more once `take` has failed.
                    let Some(item) = items.get(i) else { break };
                    if sender.send((i, work(&mut local, item))).is_err() {
                        break;
                    }
                }
            });
        }
        drop(sender);
        let mut early = BTreeMap::new();
        let mut due = 0;
        // Ends when every thread has dropped its sender. Dropped here on an error, so that the threads end too.
        for (i, result) in results {
            early.insert(i, result);
            while let Some(result) = early.remove(&due) {
                take(result)?;
                due += 1;
            }
        }
        Ok(())
    })
}

#[cfg(test)]
mod tests {
    use super::in_order;

    #[test]
    fn prop_results_come_in_order_from_any_number_of_threads() {
        let items: Vec<u64> = (0..500).collect();
        for threads in [0, 1, 2, 7] {
            let mut taken = Vec::new();
            let uneven = |calls: &mut u64, &i: &u64| {
                *calls += 1;
                std::hint::black_box((0..(i * 7919) % 5000).sum::<u64>());
                i
            };
            in_order(&items, threads, uneven, |i| {
                taken.push(i);
                Ok::<(), ()>(())
            })
            .expect("nothing fails");
            assert_eq!(taken, items);
        }
    }

    #[test]
    fn prop_a_failure_ends_the_work() {
        let items: Vec<u32> = (0..1000).collect();
        let end = in_order(&items, 3, |(), &i| i, |i| if i < 5 { Ok(()) } else { Err(i) });
        assert_eq!(end, Err(5));
    }
}
