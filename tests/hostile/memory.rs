//! How much memory something asks for.

#![allow(unsafe_code, reason = "an allocator is an unsafe trait")]

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

/// The system's allocator; each thread remembers what it holds and the most that it ever held.
struct Counting;

#[global_allocator]
static COUNTING: Counting = Counting;

thread_local! {
    static HELD: Cell<i64> = const { Cell::new(0) };
    static MOST: Cell<i64> = const { Cell::new(0) };
    static TIMES: Cell<u64> = const { Cell::new(0) };
}

/// The most bytes that the current thread held during `work`, above what it held before.
pub fn peak_of(work: impl FnOnce()) -> i64 {
    let before = HELD.get();
    MOST.set(before);
    work();
    MOST.get() - before
}

/// How often the current thread asked for memory during `work`.
pub fn times_in(work: impl FnOnce()) -> u64 {
    let before = TIMES.get();
    work();
    TIMES.get() - before
}

fn count(bytes: usize, sign: i64) {
    // What one thread asks for another may give back, and a thread that ends counts no more.
    let _ = TIMES.try_with(|times| times.set(times.get() + u64::from(sign > 0)));
    let _ = HELD.try_with(|held| {
        held.set(held.get() + sign * bytes as i64);
        MOST.try_with(|most| most.set(most.get().max(held.get())))
    });
}

// SAFETY: everything is the system allocator's; counting asks for no memory, since its cells are constants
// that nothing has to be done for at a thread's end.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count(layout.size(), 1);
        // SAFETY: the caller's promise.
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        count(layout.size(), 1);
        // SAFETY: the caller's promise.
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn realloc(&self, old: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count(size, 1);
        count(layout.size(), -1);
        // SAFETY: the caller's promise.
        unsafe { System.realloc(old, layout, size) }
    }

    unsafe fn dealloc(&self, old: *mut u8, layout: Layout) {
        count(layout.size(), -1);
        // SAFETY: the caller's promise.
        unsafe { System.dealloc(old, layout) }
    }
}
