//! Detection of a scene at rest: nothing is dragged, and its samples have not changed for a moment.

use super::source::Source;
use crate::platform::Instant;
use std::time::Duration;

/// Time without a change until a scene rests. It is longer than the time between two repeats of a held key, so that nudging stays as quick as dragging.
const QUIET: Duration = Duration::from_millis(100);

/// The last source on screen and the time of its last change.
#[derive(Default)]
pub struct Rest(Option<(Source, Instant)>);

/// State of motion of the scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Motion {
    #[default]
    Held,
    /// The scene rests after this time without a change.
    RestsIn(Duration),
    AtRest,
}

impl Rest {
    /// Compares `source` with the last one at `now`; `held` while an object is dragged.
    pub fn look(&mut self, source: &Source, held: bool, now: Instant) -> Motion {
        if held {
            self.0 = None;
            return Motion::Held;
        }
        let (_, since) = match self.0.take() {
            Some(still) if still.0 == *source => self.0.insert(still),
            _ => self.0.insert((source.clone(), now)),
        };
        match QUIET.checked_sub(now.saturating_duration_since(*since)) {
            Some(left) if !left.is_zero() => Motion::RestsIn(left),
            _ => Motion::AtRest,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::shared::Shared;
    use crate::radar::Radar;
    use crate::scene::Scene;
    use crate::signal::Floor;

    /// A look at one of two scenes, a duration after the first look.
    fn looks() -> impl FnMut(usize, Floor, bool, Duration) -> Motion {
        let scenes = [Scene::default(), Scene::default()].map(Shared::new);
        let (mut rest, start) = (Rest::default(), Instant::now());
        move |scene, floor, held, after| {
            let source = Source { radar: Radar::default(), scene: scenes[scene].clone(), recording: None, floor };
            rest.look(&source, held, start + after)
        }
    }

    fn at(milliseconds: u64) -> Duration {
        Duration::from_millis(milliseconds)
    }

    #[test]
    fn a_scene_rests_a_moment_after_its_last_change_or_hold() {
        let mut look = looks();
        assert_eq!(look(0, Floor::Thesis, false, at(0)), Motion::RestsIn(QUIET));
        assert_eq!(look(0, Floor::Thesis, false, at(40)), Motion::RestsIn(at(60)));
        assert_eq!(look(0, Floor::Thesis, false, at(100)), Motion::AtRest);
        assert_eq!(look(1, Floor::Thesis, false, at(101)), Motion::RestsIn(QUIET), "another scene");
        assert_eq!(look(1, Floor::Exact, false, at(150)), Motion::RestsIn(QUIET), "another floor");
        assert_eq!(look(1, Floor::Exact, false, at(250)), Motion::AtRest);
        assert_eq!(look(1, Floor::Exact, true, at(900)), Motion::Held);
        assert_eq!(look(1, Floor::Exact, false, at(901)), Motion::RestsIn(QUIET), "let go just now");
    }
}
