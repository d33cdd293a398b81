//! Values derived from the state on screen. Each is computed on a thread of its own and kept with its query. It is old as soon as the state gives another
//! query.
//!
//! ```text
//!   state on screen ──► query ──► worker ──► (query, value)      the value is drawn until the next one replaces it
//! ```

use crate::platform::Instant;
use crate::task::{Cancelled, Generation, Reply, Task, Worker};
use std::time::Duration;

/// Age at which a value is marked as old; a shorter one would flicker.
pub const STALE: Duration = Duration::from_millis(400);

/// Longest time of work for an earlier request; longer work is cancelled, but during a drag, so that the user sees what changes.
pub const MAX_OUTDATED_WORK_TIME: Duration = Duration::from_millis(400);

/// The inputs of a value, and its computation. Equal queries have equal values.
pub trait Query: Clone + PartialEq + Send + 'static {
    type Value: Send + 'static;
    /// State that the thread keeps between queries.
    type State: Default + 'static;
    /// Subject of the message about a panic, at the beginning of a sentence. It is the name of the thread, too.
    const WHAT: &'static str;
    /// The user's remedy after a panic, as a sentence.
    const ADVICE: &'static str = "Change the scene to try again.";

    /// Computes the value.
    ///
    /// # Errors
    /// The reason why there is no value, as a panel tells it, or that `task` was cancelled.
    fn compute(&self, state: &mut Self::State, task: &Task) -> Result<Self::Value, Failure>;
}

/// The reason why a query has no value.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Failure {
    Cancelled,
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

/// A query with its value, or the reason why it has none.
type Made<Q> = (Q, Result<<Q as Query>::Value, Failure>);

/// The worker of one kind of query, the last query asked, and the last value made.
pub struct Derived<Q: Query> {
    worker: Worker<Q, Made<Q>>,
    asked: Option<Q>,
    made: Option<(Q, Result<Q::Value, String>)>,
    /// Requests without an answer and their times, the oldest first. The value is old since the oldest one.
    waiting: Vec<(Generation, Instant)>,
    requests: u64,
}

impl<Q: Query> Derived<Q> {
    /// Starts the worker, idle at first; `wake` is called from its thread.
    pub fn start(wake: impl Fn() + Send + Sync + 'static) -> Self {
        let work = |state: &mut Q::State, query: Q, task: &Task| {
            let value = query.compute(state, task);
            (query, value)
        };
        let worker = Worker::spawn(Q::WHAT, Q::State::default, work, wake);
        Derived { worker, asked: None, made: None, waiting: Vec::new(), requests: 0 }
    }

    /// Asks for the value that a panel of this frame draws, unless it was the last one asked for; `None` where no panel draws it.
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
            // The value was not drawn while the screen changed, so its age is unknown.
            self.made = None;
        }
        if !(is_back && is_made) {
            self.requests += 1;
            self.waiting.push((self.worker.request(query.clone()), Instant::now()));
        }
        self.asked = Some(query);
    }

    /// The last value, or the reason why there is none; `None` where no panel of the last frame drew it.
    pub fn value(&self) -> Option<Result<&Q::Value, &str>> {
        self.made().map(|(_, value)| value.as_ref().map_err(String::as_str))
    }

    /// The same with its query.
    pub fn made(&self) -> Option<&(Q, Result<Q::Value, String>)> {
        self.made.as_ref().filter(|_| self.asked.is_some())
    }

    /// Whether the value has belonged to an earlier query for so long that it must be marked.
    pub fn is_stale(&self) -> bool {
        self.waiting.first().is_some_and(|(_, since)| since.elapsed() > STALE)
    }

    /// Whether a value is drawn as fresh that belongs to another query than `now`.
    pub fn is_fresh_but_old(&self, now: Option<&Q>) -> bool {
        self.value().is_some() && !self.is_stale() && self.made.as_ref().map(|(of, _)| of) != now
    }

    pub fn requests(&self) -> u64 {
        self.requests
    }

    fn take_in(&mut self, generation: Generation, made: (Q, Result<Q::Value, String>)) {
        self.waiting.retain(|(number, _)| *number > generation);
        self.made = Some(made);
    }

    /// Takes in the value made since the last frame. Returns a message for the user.
    pub fn poll(&mut self) -> Option<String> {
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

    pub fn is_busy(&self) -> bool {
        self.worker.is_busy()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The square of a number; 13 has none, and 7 panics.
    #[derive(Debug, Clone, PartialEq)]
    struct Square(u32);

    impl Query for Square {
        type Value = u32;
        type State = u32;
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

    fn rest(squares: &mut Derived<Square>) -> Option<String> {
        let deadline = Instant::now() + Duration::from_secs(20);
        while squares.is_busy() {
            assert!(Instant::now() < deadline, "it never ends");
            std::thread::yield_now();
        }
        squares.poll()
    }

    #[test]
    fn a_value_is_computed_once_though_it_was_out_of_sight() {
        let mut squares = Derived::start(|| ());
        for query in [Some(Square(4)), Some(Square(4)), None, Some(Square(4))] {
            let value = query.is_some().then_some(Ok(&16));
            squares.ask(query);
            rest(&mut squares);
            assert_eq!((squares.value(), squares.requests()), (value, 1));
        }
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
