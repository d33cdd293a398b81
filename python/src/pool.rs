//! The threads that work: a pool a process, since a pool does not survive a fork.

use crate::errors::{runtime, whole};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::ptr;
use std::sync::atomic::{AtomicPtr, AtomicU32, AtomicUsize, Ordering};

const MAX_THREADS: usize = 1024;

/// A pool and the process whose threads it has.
struct Pool {
    process: u32,
    threads: usize,
    pool: ThreadPool,
}

/// The pool of the process that last worked. No lock: a forking thread may hold one.
static CURRENT: AtomicPtr<Pool> = AtomicPtr::new(ptr::null_mut());
/// The process that loaded the module.
static FIRST_PROCESS: AtomicU32 = AtomicU32::new(0);
/// Threads that `set_threads` asked for, 0 for none, and in which process.
static ASKED_THREADS: AtomicUsize = AtomicUsize::new(0);
static ASKED_IN: AtomicU32 = AtomicU32::new(0);

/// Stores the process that loaded the module: another one is a fork of it.
pub fn remember_process() {
    FIRST_PROCESS.store(std::process::id(), Ordering::Relaxed);
}

/// Threads for this process: those asked for, one in a fork, else as many as rayon takes.
fn wanted(process: u32) -> usize {
    match ASKED_THREADS.load(Ordering::Relaxed) {
        asked if asked > 0 && ASKED_IN.load(Ordering::Relaxed) == process => asked,
        _ if FIRST_PROCESS.load(Ordering::Relaxed) != process => 1,
        _ => 0,
    }
}

/// The pool of this process, made where there is none yet.
pub fn current() -> PyResult<&'static ThreadPool> {
    let process = std::process::id();
    let wanted = wanted(process);
    let there = CURRENT.load(Ordering::Acquire);
    // SAFETY: a stored pool is never freed.
    if let Some(pool) = unsafe { there.as_ref() }
        && pool.process == process
        && (wanted == 0 || wanted == pool.threads)
    {
        return Ok(&pool.pool);
    }
    let pool = ThreadPoolBuilder::new()
        .num_threads(wanted)
        .thread_name(|i| format!("apertura-{i}"))
        .build()
        .map_err(|e| runtime(format!("can't start the threads that work: {e}")))?;
    let threads = pool.current_num_threads();
    // A pool from before a fork has no threads here, and one that was replaced may be at work: neither is ever freed.
    let made: &'static Pool = Box::leak(Box::new(Pool { process, threads, pool }));
    CURRENT.store(ptr::from_ref(made).cast_mut(), Ordering::Release);
    Ok(&made.pool)
}

/// Sets how many threads work in this process.
///
/// Args:
///     count: 1 to 1024.
///
/// Raises:
///     ValueError: `count` is out of range.
#[pyfunction]
pub fn set_threads(count: i128) -> PyResult<()> {
    let count: usize = whole("count", count)?;
    if !(1..=MAX_THREADS).contains(&count) {
        return Err(PyValueError::new_err(format!("count is {count}; expected 1 to {MAX_THREADS} threads")));
    }
    ASKED_THREADS.store(count, Ordering::Relaxed);
    ASKED_IN.store(std::process::id(), Ordering::Relaxed);
    Ok(())
}

/// How many threads work in this process.
///
/// Returns:
///     As many as the machine has unless `set_threads` or the variable RAYON_NUM_THREADS says otherwise; one in a forked process.
#[pyfunction]
pub fn threads() -> PyResult<usize> {
    Ok(current()?.current_num_threads())
}
