//! Work shared out among threads, the dearest first.

use std::cmp::Reverse;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};

/// What `work` makes of item 0, 1, …, in this order. `costs` has an estimate for each item, in any unit.
///
/// The threads of the current rayon pool take items out of one queue, those with the highest estimate first and
/// equal ones by their index, so that a batch does not end with all but one waiting for a giant that was begun last.
/// On m threads this takes at most 4/3 - 1/(3m) of the least time that there is if the estimates are right (Graham
/// 1969, LPT rule); any other order may take 2 - 1/m of it.
///
/// If `work` panics, so does this, once the other threads have done the rest.
pub fn dearest_first<T: Send + Sync>(costs: &[u64], work: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let mut queue: Vec<usize> = (0..costs.len()).collect();
    queue.sort_by_key(|&item| Reverse(costs[item]));
    let begun = AtomicUsize::new(0);
    let results: Vec<OnceLock<T>> = costs.iter().map(|_| OnceLock::new()).collect();
    let work_off = || {
        while let Some(&item) = queue.get(begun.fetch_add(1, Ordering::Relaxed)) {
            // Nobody else is given this item.
            let _ = results[item].set(work(item));
        }
    };
    rayon::scope(|scope| {
        for _ in 0..rayon::current_num_threads().min(costs.len()) {
            scope.spawn(|_| work_off());
        }
    });
    let done = results.into_iter().map(OnceLock::into_inner);
    done.map(|result| result.expect("the queue was worked off to its end")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::panic::{AssertUnwindSafe, catch_unwind};
    use std::sync::Mutex;
    use std::sync::mpsc::{Receiver, channel};
    use std::time::Duration;

    const LONG: Duration = Duration::from_secs(30);

    fn on_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
        rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(work)
    }

    #[test]
    fn one_thread_begins_the_dearest_first_and_equal_ones_by_their_index() {
        let order = Mutex::new(Vec::new());
        let costs = [3, 0, 9, 3, 1, 9];
        on_threads(1, || dearest_first(&costs, |item| order.lock().unwrap().push(item)));
        assert_eq!(order.into_inner().unwrap(), [2, 5, 0, 3, 4, 1]);
    }

    #[test]
    fn every_item_is_worked_on_once_and_the_results_are_in_the_order_given() {
        for threads in [1, 2, 5] {
            for items in [0, 1, 2, 1_000_u64] {
                let costs: Vec<u64> = (0..items).map(|item| item * 7919 % 13).collect();
                let times: Vec<AtomicUsize> = costs.iter().map(|_| AtomicUsize::new(0)).collect();
                let work = |item: usize| {
                    times[item].fetch_add(1, Ordering::Relaxed);
                    item
                };
                let results = on_threads(threads, || dearest_first(&costs, work));
                assert!(results.into_iter().eq(0..costs.len()), "{items} on {threads}");
                assert!(times.iter().all(|times| times.load(Ordering::Relaxed) == 1));
            }
        }
    }

    #[test]
    fn as_many_items_are_worked_on_at_a_time_as_there_are_threads() {
        let (senders, receivers): (Vec<_>, Vec<_>) =
            (0..3).map(|_| channel()).map(|(s, r)| (s, Mutex::new(r))).unzip();
        let hears = |from: &Mutex<Receiver<()>>| from.lock().unwrap().recv_timeout(LONG).is_ok();
        // Each waits for the one before it, the first for the last: no two of them can take turns.
        let met = on_threads(3, || {
            dearest_first(&[1; 3], |item| {
                senders[(item + 1) % 3].send(()).unwrap();
                hears(&receivers[item])
            })
        });
        assert_eq!(met, [true; 3]);
    }

    #[test]
    fn a_panic_comes_through_after_the_other_threads_have_done_the_rest() {
        let done = AtomicUsize::new(0);
        let work = |item: usize| match item {
            3 => panic!("item 3 is rotten"),
            _ => done.fetch_add(1, Ordering::Relaxed),
        };
        on_threads(2, || {
            let outcome = catch_unwind(AssertUnwindSafe(|| dearest_first(&[1; 40], work)));
            assert_eq!(outcome.unwrap_err().downcast_ref(), Some(&"item 3 is rotten"));
            assert_eq!(done.load(Ordering::Relaxed), 39);
            assert_eq!(dearest_first(&[1; 3], |item| item), [0, 1, 2]);
        });
    }
}
