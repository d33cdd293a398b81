//! The next scene to try: moved objects, turned bodies, changed echoes, new noise.

use super::wanted::{Finding, WorseningGoal, WorseningSearch};
use crate::scene::{Object, Scene};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use std::f64::consts::TAU;

/// Candidates between two changes of the step.
pub(super) const BATCH_CANDIDATES: u32 = 8;
/// Part of the candidates that are drawn anywhere within reach, not around the worst scene so far.
const ANYWHERE_PART: f64 = 1.0 / 3.0;
/// Initial scale of steps, as a part of the reach.
pub(super) const FIRST_STEP_PART: f64 = 0.25;
/// Scale of steps, as a part of the reach, below which the search begins anew with the initial one.
pub(super) const MIN_STEP_PART: f64 = 1e-3;
/// Echoes of an object change by at most this, dB of amplitude, either way.
const MAX_GAIN_CHANGE_DB: f64 = 6.0;
/// Bodies turn by at most this much, either way, degrees.
const MAX_TURN_DEGREES: f64 = 45.0;
/// A repair's reach grows with the tries, to all of it after half of so many or half of all, whichever is fewer.
const GROWTH_STEPS: u32 = 256;
/// Part of the candidates that get another noise seed.
const OTHER_NOISE_PART: f64 = 0.25;

pub(super) struct WorseningState {
    /// Scale of steps of the search, as a part of the reach.
    pub step: f64,
    pub path: Vec<Finding>,
    pub tries: u32,
}

impl WorseningSearch {
    pub(super) fn candidate(&self, start: &Scene, state: &WorseningState, n: u32) -> Scene {
        let mut rng = ChaCha8Rng::seed_from_u64(self.seed);
        rng.set_stream(u64::from(n) + 1);
        match self.goal {
            WorseningGoal::Worsen => self.worse_candidate(start, state, &mut rng),
            WorseningGoal::Repair => self.repair_candidate(start, state, &mut rng),
        }
    }

    fn worse_candidate(&self, start: &Scene, state: &WorseningState, rng: &mut ChaCha8Rng) -> Scene {
        let anywhere = rng.random::<f64>() < ANYWHERE_PART || state.path.len() == 1;
        let (from, reach) = match state.path.last() {
            Some(worst) if !anywhere => (&worst.scene, state.step * self.within_metres),
            _ => (start, self.within_metres),
        };
        let mut scene = from.clone();
        for (object, home) in scene.objects.iter_mut().zip(&start.objects) {
            let [dx, dy] = if anywhere { in_disc(rng, reach) } else { [0, 1].map(|_| reach * normal(rng)) };
            object.translate(dx, dy);
            keep_within(object, home, self.within_metres);
        }
        for (object, home) in scene.objects.iter_mut().zip(&start.objects).filter(|(object, _)| object.can_turn()) {
            let part = if anywhere { rng.random_range(-1.0..=1.0) } else { state.step * normal(rng) };
            let now = object.turned_degrees(home);
            let then = (now + MAX_TURN_DEGREES * part).clamp(-MAX_TURN_DEGREES, MAX_TURN_DEGREES);
            object.turn(then - now);
        }
        // Making all objects louder together changes nothing.
        if scene.objects.len() > 1 {
            for (object, home) in scene.objects.iter_mut().zip(&start.objects) {
                let db = MAX_GAIN_CHANGE_DB * rng.random_range(-1.0..=1.0);
                let part = if anywhere { 1.0 } else { state.step };
                let at_home = home.reflectivity();
                let now = object.reflectivity() * 10f64.powf(part * db / 20.0);
                let most = 10f64.powf(MAX_GAIN_CHANGE_DB / 20.0);
                let (low, high) = (at_home.abs() / most, at_home.abs() * most);
                object.set_reflectivity(now.abs().clamp(low, high).copysign(at_home));
            }
        }
        if rng.random::<f64>() < OTHER_NOISE_PART {
            scene.noise_seed = rng.random::<u64>() >> 11;
        }
        scene
    }

    fn repair_candidate(&self, start: &Scene, state: &WorseningState, rng: &mut ChaCha8Rng) -> Scene {
        let best = state.path.get(1..).and_then(<[Finding]>::last);
        let mut scene = start.clone();
        if let Some(best) = best.filter(|_| rng.random::<f64>() < 0.5) {
            // A part of the shift that is known to repair.
            let part = rng.random_range(0.2..1.0);
            for (object, end) in scene.objects.iter_mut().zip(&best.scene.objects) {
                let ([x, y], [to_x, to_y]) = (object.centre_metres(), end.centre_metres());
                object.translate(part * (to_x - x), part * (to_y - y));
            }
            return scene;
        }
        // Small moves first; never farther than the smallest shift known to repair.
        let growing = f64::from(state.tries + BATCH_CANDIDATES) / f64::from(self.tries.clamp(1, GROWTH_STEPS)) * 2.0;
        let reach = best.map_or(self.within_metres * growing.min(1.0), |b| b.moved_metres);
        let alone = (rng.random::<f64>() < 0.5).then(|| rng.random_range(0..scene.objects.len()));
        for (i, object) in scene.objects.iter_mut().enumerate() {
            let [dx, dy] = in_disc(rng, reach);
            if alone.is_none_or(|a| a == i) {
                object.translate(dx, dy);
            }
        }
        scene
    }
}

fn normal(rng: &mut ChaCha8Rng) -> f64 {
    StandardNormal.sample(rng)
}

fn in_disc(rng: &mut ChaCha8Rng, radius: f64) -> [f64; 2] {
    let (angle, part) = (TAU * rng.random::<f64>(), rng.random::<f64>().sqrt());
    [radius * part * angle.cos(), radius * part * angle.sin()]
}

pub(super) fn distance(a: &Object, b: &Object) -> f64 {
    let ([ax, ay], [bx, by]) = (a.centre_metres(), b.centre_metres());
    (bx - ax).hypot(by - ay)
}

fn keep_within(object: &mut Object, home: &Object, within_metres: f64) {
    let away = distance(home, object);
    if away > within_metres {
        let ([x, y], [home_x, home_y]) = (object.centre_metres(), home.centre_metres());
        let back = 1.0 - within_metres / away;
        object.translate(back * (home_x - x), back * (home_y - y));
    }
}
