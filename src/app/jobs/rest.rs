//! When the scene on screen rests: nothing is dragged, and nothing that the samples depend on has changed for a moment.

use crate::platform::Instant;
use crate::radar::Radar;
use crate::scene::Scene;
use crate::signal::Floor;
use std::sync::Arc;
use std::time::Duration;

/// Longer than between two repeats of a held key, so that nudging stays as quick as dragging.
const QUIET: Duration = Duration::from_millis(100);

/// What was on screen last, and since when.
#[derive(Default)]
pub struct Rest {
    last: Option<Still>,
}

struct Still {
    scene: Arc<Scene>,
    radar: Radar,
    floor: Floor,
    since: Instant,
}

/// Whether the scene rests.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Motion {
    /// Somebody holds something of it.
    #[default]
    Held,
    /// It rests unless something changes within this time.
    RestsIn(Duration),
    /// It rests.
    AtRest,
}

impl Rest {
    /// Takes note of what is on screen at `now`; `held` while something is dragged.
    pub fn look(&mut self, scene: &Arc<Scene>, radar: &Radar, floor: Floor, held: bool, now: Instant) -> Motion {
        if held {
            self.last = None;
            return Motion::Held;
        }
        let same = |s: &Still| Arc::ptr_eq(&s.scene, scene) && s.radar == *radar && s.floor == floor;
        let since = match &self.last {
            Some(still) if same(still) => still.since,
            _ => {
                self.last = Some(Still { scene: scene.clone(), radar: radar.clone(), floor, since: now });
                now
            }
        };
        match QUIET.checked_sub(now.saturating_duration_since(since)) {
            Some(left) if !left.is_zero() => Motion::RestsIn(left),
            _ => Motion::AtRest,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Looks at one of two scenes, this long after the first look.
    fn looks() -> impl FnMut(usize, Floor, bool, Duration) -> Motion {
        let (radar, scenes) = (Radar::default(), [Arc::new(Scene::default()), Arc::new(Scene::default())]);
        let (mut rest, start) = (Rest::default(), Instant::now());
        move |scene, floor, held, after| rest.look(&scenes[scene], &radar, floor, held, start + after)
    }

    fn at(milliseconds: u64) -> Duration {
        Duration::from_millis(milliseconds)
    }

    #[test]
    fn a_scene_rests_a_moment_after_its_last_change() {
        let mut look = looks();
        assert_eq!(look(0, Floor::Thesis, false, at(0)), Motion::RestsIn(QUIET));
        assert_eq!(look(0, Floor::Thesis, false, at(40)), Motion::RestsIn(at(60)));
        assert_eq!(look(0, Floor::Thesis, false, at(100)), Motion::AtRest);
        assert_eq!(look(1, Floor::Thesis, false, at(101)), Motion::RestsIn(QUIET), "another scene");
        assert_eq!(look(1, Floor::Exact, false, at(150)), Motion::RestsIn(QUIET), "another floor");
        assert_eq!(look(1, Floor::Exact, false, at(250)), Motion::AtRest);
    }

    #[test]
    fn a_scene_that_is_held_never_rests() {
        let mut look = looks();
        assert_eq!(look(1, Floor::Exact, false, at(0)), Motion::RestsIn(QUIET));
        assert_eq!(look(1, Floor::Exact, true, at(900)), Motion::Held);
        assert_eq!(look(1, Floor::Exact, false, at(901)), Motion::RestsIn(QUIET), "let go just now");
    }
}
