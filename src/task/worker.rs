//! A thread that always works on the latest request.
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
use std::cell::{Cell, RefCell};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// Number of a request, one higher than the last one's.
pub type Generation = u64;

#[derive(Debug)]
pub enum Reply<T> {
    Done { generation: Generation, result: T, elapsed: Duration },
    Panicked { generation: Generation, message: String },
}

struct Running {
    generation: Generation,
    task: Task,
    began: Instant,
}

struct Slot<Q, T> {
    pending: Option<(Generation, Q, Task)>,
    running: Option<Running>,
    replies: Vec<Reply<T>>,
    generation: Generation,
    stop: bool,
}

struct Shared<Q, T> {
    slot: Mutex<Slot<Q, T>>,
    ready: Condvar,
    /// Makes the work with new state.
    step: Box<dyn Fn() -> Step<Q, T> + Send + Sync>,
    wake: Box<dyn Fn() + Send + Sync>,
}

/// Turns one request into its reply; the state of the work is inside.
type Step<Q, T> = Box<dyn FnMut(Generation, Q, &Task) -> Reply<T>>;

enum Place<Q, T> {
    Thread { name: String, started: Cell<bool> },
    Here(RefCell<Step<Q, T>>),
}

/// A thread that turns requests `Q` into results `T`, the latest first, until dropped. A page without threads works when replies are asked for.
pub struct Worker<Q, T> {
    shared: Arc<Shared<Q, T>>,
    place: Place<Q, T>,
}

/// The work of a request as a function; a panic drops the state.
fn step<S, Q, T>(
    start: impl Fn() -> S,
    work: impl Fn(&mut S, Q, &Task) -> T,
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

fn serve<Q: Send + 'static, T: Send + 'static>(name: String, shared: Arc<Shared<Q, T>>) -> std::io::Result<()> {
    let called = name.clone();
    platform::spawn(&called, move || {
        let ours = shared.clone();
        platform::on_panic(move |message| {
            ours.give_up(message);
            if let Err(error) = serve(name, ours) {
                tracing::error!("a thread that ended by a panic can't be started afresh: {error}");
            }
        });
        let mut step = (shared.step)();
        while let Some((generation, request, task)) = shared.next() {
            shared.reply(step(generation, request, &task));
        }
    })
}

impl<Q: Send + 'static, T: Send + 'static> Worker<Q, T> {
    /// A worker whose thread is called `name` and starts with the first request. `start` makes the state that `work` keeps between requests; `wake` is called
    /// from the thread after each reply. A failure to start the thread is reported with the first reply.
    pub fn spawn<S: 'static>(
        name: &str,
        start: impl Fn() -> S + Send + Sync + 'static,
        work: impl Fn(&mut S, Q, &Task) -> T + Send + Sync + 'static,
        wake: impl Fn() + Send + Sync + 'static,
    ) -> Self {
        let (start, work) = (Arc::new(start), Arc::new(work));
        let again = move || -> Step<Q, T> {
            let (start, work) = (start.clone(), work.clone());
            Box::new(step(move || start(), move |state: &mut S, request, task: &Task| work(state, request, task)))
        };
        let place = match platform::has_threads() {
            true => Place::Thread { name: name.to_owned(), started: Cell::new(false) },
            false => Place::Here(RefCell::new(again())),
        };
        let slot = Slot { pending: None, running: None, replies: Vec::new(), generation: 0, stop: false };
        let (step, wake) = (Box::new(again), Box::new(wake));
        Worker { shared: Arc::new(Shared { slot: Mutex::new(slot), ready: Condvar::new(), step, wake }), place }
    }

    fn begin(&self) {
        match &self.place {
            Place::Here(_) => (self.shared.wake)(),
            Place::Thread { name, started } => {
                if !started.replace(true)
                    && let Err(error) = serve(name.clone(), self.shared.clone())
                {
                    started.set(false);
                    self.shared.give_up(format!("the thread \"{name}\" can't be started: {error}"));
                }
            }
        }
    }

    /// Asks for `request` next. A waiting request is replaced; a running one goes on.
    pub fn request(&self, request: Q) -> Generation {
        self.request_for(Task::default(), request)
    }

    /// Asks for `request` next, on a task that the caller can cancel apart from others.
    pub fn request_for(&self, task: Task, request: Q) -> Generation {
        let mut slot = self.shared.lock();
        slot.generation += 1;
        let generation = slot.generation;
        slot.pending = Some((generation, request, task));
        drop(slot);
        self.shared.ready.notify_one();
        self.begin();
        generation
    }

    /// Cancels the running request and drops the waiting one. The cancelled work still replies.
    pub fn cancel(&self) {
        let mut slot = self.shared.lock();
        slot.pending = None;
        if let Some(running) = &slot.running {
            running.task.cancel();
        }
    }

    /// Cancels the running request if it began longer ago than `max_age`; returns whether it did. A waiting one stays.
    pub fn cancel_older_than(&self, max_age: Duration) -> bool {
        match &self.shared.lock().running {
            Some(running) if running.began.elapsed() > max_age => {
                running.task.cancel();
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

    /// Progress of the running request, 0 to 1; `None` when idle.
    pub fn progress(&self) -> Option<f32> {
        self.shared.lock().running.as_ref().map(|running| running.task.progress())
    }

    /// The replies since the last call, oldest first.
    pub fn replies(&self) -> Vec<Reply<T>> {
        self.work_here();
        std::mem::take(&mut self.shared.lock().replies)
    }

    fn work_here(&self) {
        let Place::Here(step) = &self.place else { return };
        let pending = self.shared.lock().pending.take();
        if let Some((generation, request, task)) = pending {
            let reply = (*step.borrow_mut())(generation, request, &task);
            self.shared.lock().replies.push(reply);
        }
    }
}

impl<Q, T> Shared<Q, T> {
    fn lock(&self) -> MutexGuard<'_, Slot<Q, T>> {
        platform::lock(&self.slot)
    }

    fn reply(&self, reply: Reply<T>) {
        let mut slot = self.lock();
        slot.running = None;
        slot.replies.push(reply);
        drop(slot);
        (self.wake)();
    }

    /// Replies with a failure to the running request, or else to the waiting one.
    fn give_up(&self, message: String) {
        let mut slot = self.lock();
        let running = slot.running.take().map(|running| running.generation);
        let generation = running.or_else(|| slot.pending.take().map(|(generation, ..)| generation));
        slot.replies.extend(generation.map(|generation| Reply::Panicked { generation, message }));
        drop(slot);
        (self.wake)();
    }

    /// Waits for a request; `None` when told to stop.
    fn next(&self) -> Option<(Generation, Q, Task)> {
        let mut slot = self.lock();
        loop {
            if slot.stop {
                return None;
            }
            if let Some(next) = slot.pending.take() {
                slot.running = Some(Running { generation: next.0, task: next.2.clone(), began: Instant::now() });
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
        if let Some(running) = &slot.running {
            running.task.cancel();
        }
        drop(slot);
        // The thread is not joined: work that doesn't check its task would keep the window from closing.
        self.shared.ready.notify_all();
    }
}

pub fn panic_message(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|s| (*s).to_owned());
    text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_else(|| "a panic without a message".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::mpsc;

    fn wait<Q: Send + 'static, T: Send + 'static>(worker: &Worker<Q, T>, woken: &mpsc::Receiver<()>) -> Vec<Reply<T>> {
        woken.recv_timeout(Duration::from_secs(20)).unwrap();
        worker.replies()
    }

    #[test]
    fn the_latest_request_wins() {
        let ((open, gate), entered) = (mpsc::channel::<()>(), mpsc::channel::<()>());
        let gate = Mutex::new(gate);
        let (wake, woken) = mpsc::channel();
        let worker = Worker::spawn(
            "test",
            || (),
            move |_, n: u32, _| {
                entered.0.send(()).unwrap();
                gate.lock().unwrap().recv().unwrap();
                n
            },
            move || wake.send(()).unwrap(),
        );
        worker.request(1);
        entered.1.recv().unwrap();
        for n in 2..=9 {
            worker.request(n);
        }
        assert!(worker.is_busy());
        open.send(()).unwrap();
        open.send(()).unwrap();
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
    fn a_thread_starts_with_the_first_request() {
        let (wake, woken) = mpsc::channel();
        let (start, started) = mpsc::channel();
        let state = move || start.send(std::thread::current().id()).unwrap();
        let worker = Worker::spawn("test", state, |(), n: u32, _| n, move || wake.send(()).unwrap());
        assert!(started.recv_timeout(Duration::from_millis(50)).is_err());
        worker.request(3);
        assert!(matches!(wait(&worker, &woken)[..], [Reply::Done { result: 3, .. }]));
        assert_ne!(started.recv().unwrap(), std::thread::current().id());
    }

    #[test]
    fn the_worker_survives_a_panic() {
        let (wake, woken) = mpsc::channel();
        let work = |count: &mut u32, n: u32, _: &Task| {
            *count += 1;
            assert!(n != 13, "unlucky {n}");
            *count
        };
        let worker = Worker::spawn("test", || 0, work, move || wake.send(()).unwrap());
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
        let worker = Worker::spawn("test", || (), work, move || wake.send(()).unwrap());
        worker.request(());
        entered.recv().unwrap();
        assert_eq!(worker.progress(), Some(0.0));
        worker.cancel();
        assert_eq!(wait(&worker, &woken).len(), 1);
        assert!(!worker.is_busy());
    }
}
