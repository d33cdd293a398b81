//! A value derived from what is on screen: computed on a thread of its own, kept with what it was computed of, and old as soon as that
//! is not on screen any more.
//!
//! ```text
//!   what is on screen ──► query ──► worker ──► (query, value)      the value is drawn until another takes its place
//! ```

use crate::platform::Instant;
use crate::task::{Cancelled, Generation, Reply, Task, Worker};
use std::time::Duration;

/// What is older than this on screen is marked as old: less would flicker.
pub const STALE: Duration = Duration::from_millis(400);

/// What a value depends on, and how it is computed. Equal queries have equal values.
pub trait Query: Clone + PartialEq + Send + 'static {
    /// What is computed.
    type Value: Send + 'static;
    /// What the thread keeps from one query to the next.
    type State: Default + 'static;
    /// Name of the thread.
    const THREAD: &'static str;
    /// What fails where it panics, as a sentence begins.
    const WHAT: &'static str;
    /// What the user may do then.
    const ADVICE: &'static str;

    /// Computes the value.
    ///
    /// # Errors
    /// Why there is none, as a panel tells it, or that `task` was cancelled.
    fn compute(&self, state: &mut Self::State, task: &Task) -> Result<Self::Value, Failure>;
}

/// Why a query has no value.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Failure {
    /// It was cancelled: another query waits.
    Cancelled,
    /// There is none, and why.
    Because(String),
}

impl From<Cancelled> for Failure {
    fn from(_: Cancelled) -> Self {
        Failure::Cancelled
    }
}

impl From<String> for Failure {
    fn from(why: String) -> Self {
        Failure::Because(why)
    }
}

/// A query, and its value or why it has none.
type Made<Q> = (Q, Result<<Q as Query>::Value, Failure>);

/// The worker of one kind of query, what it was asked last, and what it made last.
pub struct Derived<Q: Query> {
    worker: Worker<Q, Made<Q>>,
    asked: Option<Q>,
    made: Option<(Q, Result<Q::Value, String>)>,
    /// Requests without an answer and when they were made, the oldest first: since then, what was made last is old.
    waiting: Vec<(Generation, Instant)>,
    requests: u64,
}

impl<Q: Query> Derived<Q> {
    /// Starts the worker, which waits; `wake` is called from its thread.
    pub fn start(wake: impl Fn() + Send + Sync + 'static) -> Self {
        let work = |state: &mut Q::State, query: Q, task: &Task| {
            let value = query.compute(state, task);
            (query, value)
        };
        let worker = Worker::spawn(Q::THREAD, Q::State::default, work, wake);
        Derived { worker, asked: None, made: None, waiting: Vec::new(), requests: 0 }
    }

    /// Asks for the value that a panel of this frame draws, unless it was asked for last; `None` where none draws it.
    pub fn ask(&mut self, query: Option<Q>) {
        let is_back = self.asked.is_none();
        let Some(query) = query else {
            self.asked = None;
            self.waiting.clear();
            return;
        };
        if self.asked.as_ref() == Some(&query) {
            return;
        }
        let is_made = self.made.as_ref().is_some_and(|(of, _)| *of == query);
        if is_back && !is_made {
            // It was not drawn while the screen changed, so that its age is not known.
            self.made = None;
        }
        if !(is_back && is_made) {
            self.requests += 1;
            self.waiting.push((self.worker.request(query.clone()), Instant::now()));
        }
        self.asked = Some(query);
    }

    /// What was made last, or why there is nothing; nothing where no panel of the frame before drew it.
    pub fn value(&self) -> Option<Result<&Q::Value, &str>> {
        let (_, value) = self.made.as_ref().filter(|_| self.is_asked())?;
        Some(value.as_ref().map_err(String::as_str))
    }

    /// Whether a panel of the frame before drew it.
    pub fn is_asked(&self) -> bool {
        self.asked.is_some()
    }

    /// Whether what is drawn has been of something else than what is on screen for so long that it must be told.
    pub fn is_stale(&self) -> bool {
        self.waiting.first().is_some_and(|(_, since)| since.elapsed() > STALE)
    }

    /// Whether what was made last is the value of `query`.
    pub fn is_of(&self, query: Option<&Q>) -> bool {
        self.made.as_ref().map(|(of, _)| of) == query
    }

    /// Requests so far.
    pub fn requests(&self) -> u64 {
        self.requests
    }

    fn take_in(&mut self, generation: Generation, made: (Q, Result<Q::Value, String>)) {
        self.waiting.retain(|(number, _)| *number > generation);
        self.made = Some(made);
    }
}

/// What all derived values have in common.
pub trait Polled {
    /// Takes in what was made since the last frame. Returns a message for the user.
    fn poll(&mut self) -> Option<String>;

    /// Whether something is computed.
    fn is_busy(&self) -> bool;
}

impl<Q: Query> Polled for Derived<Q> {
    fn poll(&mut self) -> Option<String> {
        let mut message = None;
        for reply in self.worker.replies() {
            match reply {
                Reply::Done { result: (_, Err(Failure::Cancelled)), .. } => {}
                Reply::Done { generation, result: (query, Err(Failure::Because(why))), .. } => {
                    self.take_in(generation, (query, Err(why)));
                }
                Reply::Done { generation, result: (query, Ok(value)), .. } => {
                    self.take_in(generation, (query, Ok(value)));
                }
                Reply::Panicked { generation, message: said } => {
                    let told = format!("{} failed ({said}). {}", Q::WHAT, Q::ADVICE);
                    if let Some(query) = self.asked.clone() {
                        self.take_in(generation, (query, Err(told.clone())));
                    }
                    message = Some(told);
                }
            }
        }
        message
    }

    fn is_busy(&self) -> bool {
        self.worker.is_busy()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The square of a number; none of 13, and 7 panics.
    #[derive(Debug, Clone, PartialEq)]
    struct Square(u32);

    impl Query for Square {
        type Value = u32;
        type State = u32;
        const THREAD: &'static str = "squares";
        const WHAT: &'static str = "Squaring";
        const ADVICE: &'static str = "Choose another number.";

        fn compute(&self, computed: &mut u32, _: &Task) -> Result<u32, Failure> {
            *computed += 1;
            match self.0 {
                7 => panic!("seven"),
                13 => Err("no luck".to_owned().into()),
                number => Ok(number * number),
            }
        }
    }

    /// Waits until nothing is computed.
    fn rest(squares: &mut Derived<Square>) -> Option<String> {
        let deadline = Instant::now() + Duration::from_secs(20);
        while squares.is_busy() {
            assert!(Instant::now() < deadline, "it never ends");
            std::thread::yield_now();
        }
        squares.poll()
    }

    #[test]
    fn a_value_is_computed_once() {
        let mut squares = Derived::start(|| ());
        for _ in 0..3 {
            squares.ask(Some(Square(4)));
            rest(&mut squares);
        }
        assert_eq!((squares.value(), squares.requests()), (Some(Ok(&16)), 1));
    }

    #[test]
    fn what_comes_back_unchanged_is_not_computed_again() {
        let mut squares = Derived::start(|| ());
        for query in [Some(Square(4)), None, Some(Square(4))] {
            let is_drawn = query.is_some();
            squares.ask(query);
            rest(&mut squares);
            assert_eq!(squares.value().is_some(), is_drawn);
        }
        assert_eq!(squares.requests(), 1);
    }

    #[test]
    fn what_changed_out_of_sight_is_not_drawn() {
        let mut squares = Derived::start(|| ());
        squares.ask(Some(Square(4)));
        rest(&mut squares);
        squares.ask(None);
        squares.ask(Some(Square(5)));
        assert_eq!(squares.value(), None);
        rest(&mut squares);
        assert_eq!(squares.value(), Some(Ok(&25)));
    }

    #[test]
    fn a_value_is_old_until_its_successor_is_there() {
        let mut squares = Derived::start(|| ());
        squares.ask(Some(Square(4)));
        rest(&mut squares);
        squares.ask(Some(Square(5)));
        assert_eq!(squares.value(), Some(Ok(&16)), "drawn meanwhile");
        let since = squares.waiting[0].1;
        while since.elapsed() <= STALE {
            std::thread::yield_now();
        }
        assert!(squares.is_stale());
        rest(&mut squares);
        assert!(!squares.is_stale());
    }

    #[test]
    fn a_panic_takes_the_place_of_the_value() {
        let mut squares = Derived::start(|| ());
        squares.ask(Some(Square(13)));
        assert_eq!(rest(&mut squares), None);
        assert_eq!(squares.value(), Some(Err("no luck")));
        squares.ask(Some(Square(7)));
        let told = "Squaring failed (seven). Choose another number.";
        assert_eq!(rest(&mut squares).as_deref(), Some(told));
        assert_eq!(squares.value(), Some(Err(told)));
    }
}
