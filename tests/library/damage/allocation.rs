//! An allocator that counts the bytes that a thread holds, and their peak.
//!
//! Readers work on the thread that calls them, so that other tests beside them don't matter.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

thread_local! {
    static HELD_BYTES: Cell<isize> = const { Cell::new(0) };
    static PEAK_BYTES: Cell<isize> = const { Cell::new(0) };
    /// Name and number of the case that the thread is at, printed where it asks for too much memory.
    static PEAK_PLACE: Cell<(&'static str, u64)> = const { Cell::new(("", 0)) };
}

/// Requests above this size are reported before the system refuses them and the process ends.
const ABSURD_BYTES: usize = 1 << 32;

pub struct Counting;

fn add(bytes: isize) {
    // A thread that ends has no counters any more.
    let _ending = HELD_BYTES.try_with(|held| {
        held.set(held.get() + bytes);
        let _ending = PEAK_BYTES.try_with(|most| most.set(most.get().max(held.get())));
    });
}

fn tell_absurd(size: usize) {
    if size > ABSURD_BYTES {
        let _ending =
            PEAK_PLACE.try_with(|at| eprintln!("{size} bytes asked for at input {} of {}", at.get().1, at.get().0));
    }
}

// SAFETY: every call goes to the system's allocator as it came; counting allocates nothing.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        tell_absurd(layout.size());
        add(layout.size() as isize);
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        tell_absurd(layout.size());
        add(layout.size() as isize);
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        add(-(layout.size() as isize));
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        tell_absurd(size);
        // The old and the new block may be there at once.
        add(size as isize);
        add(-(layout.size() as isize));
        unsafe { System.realloc(pointer, layout, size) }
    }
}

/// Runs `work` on input `number` of `what`; the most bytes it held at once beside what the thread held before.
pub fn most_held<T>(what: &'static str, number: u64, work: impl FnOnce() -> T) -> (T, usize) {
    PEAK_PLACE.set((what, number));
    let before = HELD_BYTES.get();
    PEAK_BYTES.set(before);
    let result = work();
    (result, (PEAK_BYTES.get() - before).max(0) as usize)
}

#[test]
fn the_most_that_was_held_is_counted() {
    let (kept, most) = most_held("test", 0, || {
        drop(std::hint::black_box(vec![1u8; 1 << 20]));
        std::hint::black_box(vec![0u8; 1000])
    });
    assert!((1 << 20..(1 << 20) + 4096).contains(&most), "{most}");
    drop(kept);
}
