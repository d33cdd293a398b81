//! Detection of a scene at rest: nothing is dragged, and its samples have not changed for a moment.

use super::source::Source;
use crate::platform::Instant;
use std::time::Duration;

/// Time without a change until a scene rests. It is longer than the time between two repeats of a held key, so that nudging stays as quick as dragging.
const QUIET_TIME: Duration = Duration::from_millis(100);

/// The last source on screen and the time of its last change.
#[derive(Default)]
pub struct Rest(Option<(Source, Instant)>);

impl Rest {
    /// Time until the scene rests, zero once it does: `source` is compared with the last one at `now`. `None` while an object is `held`.
    pub fn time_until_rest(&mut self, source: &Source, held: bool, now: Instant) -> Option<Duration> {
        if held {
            self.0 = None;
            return None;
        }
        let (_, since) = match self.0.take() {
            Some(still) if still.0 == *source => self.0.insert(still),
            _ => self.0.insert((source.clone(), now)),
        };
        Some(QUIET_TIME.saturating_sub(now.saturating_duration_since(*since)))
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
    fn looks() -> impl FnMut(usize, Floor, bool, Duration) -> Option<Duration> {
        let scenes = [Scene::default(), Scene::default()].map(Shared::new);
        let (mut rest, start) = (Rest::default(), Instant::now());
        move |scene, floor, held, after| {
            let source = Source { radar: Radar::default(), scene: scenes[scene].clone(), recording: None, floor };
            rest.time_until_rest(&source, held, start + after)
        }
    }

    fn at(milliseconds: u64) -> Duration {
        Duration::from_millis(milliseconds)
    }

    #[test]
    fn a_scene_rests_a_moment_after_its_last_change_or_hold() {
        let mut look = looks();
        assert_eq!(look(0, Floor::Thesis, false, at(0)), Some(QUIET_TIME));
        assert_eq!(look(0, Floor::Thesis, false, at(40)), Some(at(60)));
        assert_eq!(look(0, Floor::Thesis, false, at(100)), Some(at(0)));
        assert_eq!(look(1, Floor::Thesis, false, at(101)), Some(QUIET_TIME), "another scene");
        assert_eq!(look(1, Floor::Exact, false, at(150)), Some(QUIET_TIME), "another floor");
        assert_eq!(look(1, Floor::Exact, false, at(250)), Some(at(0)));
        assert_eq!(look(1, Floor::Exact, true, at(900)), None);
        assert_eq!(look(1, Floor::Exact, false, at(901)), Some(QUIET_TIME), "let go just now");
    }
}
