//! One thread that always works on the latest request.
//!
//! ```text
//!   request(c) ──► slot [b]  b is never started: c takes its place
//!                    │
//!                    ▼
//!                  thread: work(a) ──► reply(a) ──► wake()          a's result stays on screen until c's is there
//! ```
//!
//! A panic in the work becomes [`Reply::Panicked`] and the worker starts afresh with new state.

use super::Task;
use crate::platform::{self, Instant};
use std::any::Any;
use std::cell::RefCell;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// Number of a request: rises by one with each.
pub type Generation = u64;

/// What came of a request.
#[derive(Debug)]
pub enum Reply<T> {
    /// It is done.
    Done {
        /// Which request.
        generation: Generation,
        /// Its result.
        result: T,
        /// How long the work took.
        elapsed: Duration,
    },
    /// It panicked; the worker was started afresh and waits for the next request.
    Panicked {
        /// Which request.
        generation: Generation,
        /// What the panic said.
        message: String,
    },
}

struct Slot<Q, T> {
    pending: Option<(Generation, Q, Task)>,
    running: Option<(Task, Instant)>,
    replies: Vec<Reply<T>>,
    generation: Generation,
    stop: bool,
}

struct Shared<Q, T> {
    slot: Mutex<Slot<Q, T>>,
    ready: Condvar,
}

impl<Q, T> Shared<Q, T> {
    fn lock(&self) -> MutexGuard<'_, Slot<Q, T>> {
        self.slot.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Takes one request and gives its reply; the state of the work is inside.
type Step<Q, T> = Box<dyn FnMut(Generation, Q, &Task) -> Reply<T>>;

/// A thread that turns requests `Q` into results `T`, latest request first. Dropping it stops the thread. Where there are no threads the work
/// is done when replies are asked for.
pub struct Worker<Q, T> {
    shared: Arc<Shared<Q, T>>,
    /// The work and the waking, where there is no thread to do them.
    here: Option<(RefCell<Step<Q, T>>, Box<dyn Fn()>)>,
}

/// Does the work of one request; a panic drops the state.
fn step<S, Q, T>(
    start: impl Fn() -> S,
    mut work: impl FnMut(&mut S, Q, &Task) -> T,
) -> impl FnMut(Generation, Q, &Task) -> Reply<T> {
    let mut state = None;
    move |generation, request, task| {
        let began = Instant::now();
        match catch_unwind(AssertUnwindSafe(|| work(state.get_or_insert_with(&start), request, task))) {
            Ok(result) => Reply::Done { generation, result, elapsed: began.elapsed() },
            Err(panic) => {
                state = None;
                Reply::Panicked { generation, message: panic_message(panic.as_ref()) }
            }
        }
    }
}

impl<Q: Send + 'static, T: Send + 'static> Worker<Q, T> {
    /// Starts a thread called `name`. `start` makes the state that `work` keeps from request to request; `wake` is called from the
    /// thread after each reply.
    ///
    /// # Errors
    /// When the system can't start a thread.
    pub fn spawn<S: 'static>(
        name: &str,
        start: impl Fn() -> S + Send + 'static,
        work: impl FnMut(&mut S, Q, &Task) -> T + Send + 'static,
        wake: impl Fn() + Send + 'static,
    ) -> std::io::Result<Self> {
        let slot = Slot { pending: None, running: None, replies: Vec::new(), generation: 0, stop: false };
        let shared = Arc::new(Shared { slot: Mutex::new(slot), ready: Condvar::new() });
        if !platform::HAS_THREADS {
            return Ok(Worker { shared, here: Some((RefCell::new(Box::new(step(start, work))), Box::new(wake))) });
        }
        let theirs = shared.clone();
        platform::spawn(name, move || {
            let mut step = step(start, work);
            while let Some((generation, request, task)) = theirs.next() {
                theirs.reply(step(generation, request, &task));
                wake();
            }
        })?;
        Ok(Worker { shared, here: None })
    }

    /// Asks for `request` next; one that waits is replaced, one that runs goes on.
    pub fn request(&self, request: Q) -> Generation {
        self.request_for(Task::default(), request)
    }

    /// Asks for `request` next, on a task that the caller can cancel without touching any other's.
    pub fn request_for(&self, task: Task, request: Q) -> Generation {
        let mut slot = self.shared.lock();
        slot.generation += 1;
        let generation = slot.generation;
        slot.pending = Some((generation, request, task));
        self.shared.ready.notify_one();
        if let Some((_, wake)) = &self.here {
            wake();
        }
        generation
    }

    /// Cancels what runs and forgets what waits. The cancelled work still replies.
    pub fn cancel(&self) {
        let mut slot = self.shared.lock();
        slot.pending = None;
        if let Some((task, _)) = &slot.running {
            task.cancel();
        }
    }

    /// Cancels what runs if it began longer ago than `patience`, and says whether it did; what waits stays.
    pub fn cancel_older_than(&self, patience: Duration) -> bool {
        match &self.shared.lock().running {
            Some((task, began)) if began.elapsed() > patience => {
                task.cancel();
                true
            }
            _ => false,
        }
    }

    /// Whether a request waits or runs.
    pub fn is_busy(&self) -> bool {
        let slot = self.shared.lock();
        slot.pending.is_some() || slot.running.is_some()
    }

    /// Progress of what runs, 0 to 1; `None` when idle.
    pub fn progress(&self) -> Option<f32> {
        self.shared.lock().running.as_ref().map(|(task, _)| task.progress())
    }

    /// The replies since the last call, oldest first.
    pub fn replies(&self) -> Vec<Reply<T>> {
        self.work_here();
        std::mem::take(&mut self.shared.lock().replies)
    }

    /// Does what waits, where there is no thread to do it.
    fn work_here(&self) {
        let Some((step, _)) = &self.here else { return };
        let pending = self.shared.lock().pending.take();
        if let Some((generation, request, task)) = pending {
            let reply = (*step.borrow_mut())(generation, request, &task);
            self.shared.lock().replies.push(reply);
        }
    }
}

impl<Q, T> Shared<Q, T> {
    /// Hands over what came of the request that ran.
    fn reply(&self, reply: Reply<T>) {
        let mut slot = self.lock();
        slot.running = None;
        slot.replies.push(reply);
    }

    /// Waits for a request; `None` when told to stop.
    fn next(&self) -> Option<(Generation, Q, Task)> {
        let mut slot = self.lock();
        loop {
            if slot.stop {
                return None;
            }
            if let Some(next) = slot.pending.take() {
                slot.running = Some((next.2.clone(), Instant::now()));
                return Some(next);
            }
            slot = self.ready.wait(slot).unwrap_or_else(PoisonError::into_inner);
        }
    }
}

impl<Q, T> Drop for Worker<Q, T> {
    fn drop(&mut self) {
        let mut slot = self.shared.lock();
        slot.stop = true;
        if let Some((task, _)) = &slot.running {
            task.cancel();
        }
        drop(slot);
        // Nobody waits for the thread: work that doesn't look at its task would keep the window from closing.
        self.shared.ready.notify_all();
    }
}

/// What a caught panic said.
pub fn panic_message(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|s| (*s).to_owned());
    text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_else(|| "a panic without a message".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::mpsc;

    /// Waits for the next replies.
    fn wait<Q: Send + 'static, T: Send + 'static>(worker: &Worker<Q, T>, woken: &mpsc::Receiver<()>) -> Vec<Reply<T>> {
        woken.recv_timeout(Duration::from_secs(20)).unwrap();
        worker.replies()
    }

    #[test]
    fn the_latest_request_wins() {
        let (gate, entered) = (mpsc::channel::<()>(), mpsc::channel::<()>());
        let (wake, woken) = mpsc::channel();
        let worker = Worker::spawn(
            "test",
            || (),
            move |_, n: u32, _| {
                entered.0.send(()).unwrap();
                gate.1.recv().unwrap();
                n
            },
            move || wake.send(()).unwrap(),
        )
        .unwrap();
        worker.request(1);
        entered.1.recv().unwrap();
        for n in 2..=9 {
            worker.request(n);
        }
        assert!(worker.is_busy());
        gate.0.send(()).unwrap();
        gate.0.send(()).unwrap();
        let mut seen = Vec::new();
        while seen.len() < 2 {
            seen.extend(wait(&worker, &woken).into_iter().map(|r| match r {
                Reply::Done { generation, result, .. } => (generation, result),
                Reply::Panicked { message, .. } => panic!("{message}"),
            }));
        }
        assert_eq!(seen, [(1, 1), (9, 9)]);
    }

    #[test]
    fn the_worker_survives_a_panic() {
        let (wake, woken) = mpsc::channel();
        let work = |count: &mut u32, n: u32, _: &Task| {
            *count += 1;
            assert!(n != 13, "unlucky {n}");
            *count
        };
        let worker = Worker::spawn("test", || 0, work, move || wake.send(()).unwrap()).unwrap();
        let ask = |n| {
            worker.request(n);
            wait(&worker, &woken).remove(0)
        };
        assert!(matches!(ask(1), Reply::Done { result: 1, .. }));
        assert!(matches!(ask(2), Reply::Done { result: 2, .. }));
        assert!(matches!(ask(13), Reply::Panicked { generation: 3, message } if message == "unlucky 13"));
        assert!(matches!(ask(3), Reply::Done { result: 1, .. }), "fresh state");
    }

    #[test]
    fn cancel_reaches_what_runs() {
        let (wake, woken) = mpsc::channel();
        let (enter, entered) = mpsc::channel();
        let work = move |_: &mut (), (), task: &Task| {
            enter.send(()).unwrap();
            while !task.is_cancelled() {
                std::thread::yield_now();
            }
        };
        let worker = Worker::spawn("test", || (), work, move || wake.send(()).unwrap()).unwrap();
        worker.request(());
        entered.recv().unwrap();
        assert_eq!(worker.progress(), Some(0.0));
        worker.cancel();
        assert_eq!(wait(&worker, &woken).len(), 1);
        assert!(!worker.is_busy());
    }
}
