//! The search for trouble: near a scene, another on which a method does worse; or the smallest move after which it is right.
//!
//! Candidates move objects, change their echoes against each other and draw other noise. The search draws a third of them anywhere within
//! reach, the others around the worst so far, in steps that grow with success and shrink without. Candidate `n` of a search depends on the
//! seed and on what the candidates of earlier batches came to, so that a search of so many tries repeats itself.

use super::Metrics;
use super::failure::{Failures, Fate};
use super::trial::Trial;
use crate::maps::Normalisation;
use crate::radar::Radar;
use crate::reconstruct::{ReconstructError, Reconstructor, Request};
use crate::scene::{Object, Scene, SceneError};
use crate::signal::Floor;
use crate::task::Task;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use rayon::prelude::*;
use std::f64::consts::TAU;
use std::fmt;
use std::str::FromStr;

/// Candidates that don't know of each other.
const BATCH: u32 = 8;
/// Part of the candidates that is drawn anywhere within reach.
const ANYWHERE: f64 = 1.0 / 3.0;
/// First steps, as a part of the reach.
const FIRST_STEP: f64 = 0.25;
/// Smallest steps, as a part of the reach.
const LEAST_STEP: f64 = 1e-4;
/// Echoes of an object change by at most this, dB of amplitude, either way.
const MOST_LOUDER_DB: f64 = 6.0;
/// How often other noise is drawn.
const OTHER_NOISE: f64 = 0.25;
/// A repaired squared error is at most this part of the one at the start.
const REPAIRED: f64 = 0.2;

/// What "worse" means.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Measure {
    /// A larger SE.
    #[default]
    SquaredError,
    /// More objects missed; among as many, a larger SE.
    Missed,
    /// More ghosts; among as many, a larger SE.
    Ghosts,
}

impl Measure {
    /// Every measure.
    pub const ALL: [Measure; 3] = [Measure::SquaredError, Measure::Missed, Measure::Ghosts];
}

impl fmt::Display for Measure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Measure::SquaredError => "squared-error",
            Measure::Missed => "missed",
            Measure::Ghosts => "ghosts",
        })
    }
}

impl FromStr for Measure {
    type Err = String;

    fn from_str(s: &str) -> Result<Self, String> {
        Measure::ALL
            .into_iter()
            .find(|m| m.to_string() == s)
            .ok_or_else(|| format!("unknown measure \"{s}\"; expected squared-error, missed or ghosts"))
    }
}

/// What is looked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Aim {
    /// The worst scene.
    #[default]
    Worsen,
    /// The smallest move, of objects alone, after which nothing is missed, or no ghost seen, or a fifth of the SE is left.
    Repair,
}

/// How a search goes.
#[derive(Debug, Clone)]
pub struct Search {
    /// The radar.
    pub radar: Radar,
    /// What lies beneath the reflectors.
    pub floor: Floor,
    /// How maps are normalised.
    pub normalisation: Normalisation,
    /// What is looked for.
    pub aim: Aim,
    /// What it is judged by.
    pub measure: Measure,
    /// How far any object may move, metres.
    pub within_metres: f64,
    /// Scenes to try.
    pub tries: u32,
    /// Picks the scenes.
    pub seed: u64,
}

impl Default for Search {
    /// 256 scenes in the tables' conventions, objects moved by up to 2 m.
    fn default() -> Self {
        Search {
            radar: Radar::default(),
            floor: Floor::Thesis,
            normalisation: Normalisation::MinMax,
            aim: Aim::default(),
            measure: Measure::default(),
            within_metres: 2.0,
            tries: 256,
            seed: 0,
        }
    }
}

/// A scene that was tried.
#[derive(Debug, Clone, PartialEq)]
pub struct Finding {
    /// The scene.
    pub scene: Scene,
    /// What the method made of it.
    pub metrics: Metrics,
    /// What kind of failure.
    pub failures: Failures,
    /// How far the object moved that moved farthest, metres.
    pub moved_metres: f64,
    /// After how many tries it was found; 0 for the start.
    pub tries: u32,
}

/// What came of a search.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// The start, and every scene that was better for the aim than all before it.
    pub path: Vec<Finding>,
    /// Scenes tried.
    pub tries: u32,
}

impl Outcome {
    /// The start, and the last of the path where there is one after it.
    pub fn ends(&self) -> Option<(&Finding, Option<&Finding>)> {
        let (start, rest) = self.path.split_first()?;
        Some((start, rest.last()))
    }
}

/// Why a search ended with nothing.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum WorsenError {
    /// The start can't be simulated.
    #[error("{0}")]
    Scene(#[from] SceneError),
    /// The method failed.
    #[error("{method}: {source}")]
    Method {
        /// Its name.
        method: &'static str,
        /// Why.
        source: ReconstructError,
    },
    /// Nothing to move.
    #[error("the scene is empty; expected an object to move")]
    Empty,
    /// The reach makes no sense.
    #[error("a reach of {0} m; expected more than 0 and at most 1000 m")]
    Reach(f64),
}

impl Measure {
    /// What is to be as large, or for a repair as small, as can be.
    fn of(self, finding: &Finding) -> (usize, f64) {
        let count = match self {
            Measure::SquaredError => 0,
            Measure::Missed => finding.failures.objects.iter().filter(|f| !f.is_right()).count(),
            Measure::Ghosts => finding.failures.ghosts.len(),
        };
        (count, finding.metrics.squared_error)
    }
}

impl Search {
    /// Searches near `scene` for `method`. `on_try` is called after every batch with the tries made and the path so far; when it answers false,
    /// the search ends there.
    ///
    /// # Errors
    /// [`WorsenError`] when the start itself can't be tried. Candidates that can't be simulated are passed over.
    pub fn run(
        &self,
        scene: &Scene,
        method: &dyn Reconstructor,
        task: &Task,
        mut on_try: impl FnMut(u32, &[Finding]) -> bool,
    ) -> Result<Outcome, WorsenError> {
        if scene.objects.is_empty() {
            return Err(WorsenError::Empty);
        }
        if !(self.within_metres > 0.0 && self.within_metres <= 1000.0) {
            return Err(WorsenError::Reach(self.within_metres));
        }
        let request =
            Request { floor: self.floor, normalisation: self.normalisation, task: task.clone(), ..Request::default() };
        let trial = self.trial(scene)?;
        let start = self.finding(scene, scene, &trial, method, &request, 0)?;
        let mut state = State { step: FIRST_STEP, path: vec![start], tries: 0 };
        while state.tries < self.tries && !self.is_reached(&state) && on_try(state.tries, &state.path) {
            let batch = state.tries..(state.tries + BATCH).min(self.tries);
            state.tries = batch.end;
            let trials: Vec<(u32, Scene, Trial)> = batch
                .into_par_iter()
                .filter_map(|n| {
                    let candidate = self.candidate(scene, &state, n);
                    let trial = self.trial(&candidate).ok()?;
                    Some((n, candidate, trial))
                })
                .collect();
            let mut better = false;
            for (n, candidate, trial) in trials {
                match self.finding(&candidate, scene, &trial, method, &request, n + 1) {
                    Ok(found) if self.is_better(&found, &state.path) => {
                        state.path.push(found);
                        better = true;
                    }
                    Ok(_) => {}
                    // Stopped: what was found stays.
                    Err(_) if task.is_cancelled() => return Ok(Outcome { path: state.path, tries: n }),
                    Err(error) => return Err(error),
                }
            }
            let factor = if better { 1.6 } else { 0.8 };
            state.step = (state.step * factor).clamp(LEAST_STEP, FIRST_STEP);
        }
        on_try(state.tries, &state.path);
        Ok(Outcome { path: state.path, tries: state.tries })
    }

    /// Nothing is left to repair.
    fn is_reached(&self, state: &State) -> bool {
        self.aim == Aim::Repair && state.path.len() == 1 && self.is_right(&state.path[0], &state.path[0])
    }

    fn trial(&self, scene: &Scene) -> Result<Trial, SceneError> {
        let trial = Trial::new(&self.radar, scene, self.floor, self.normalisation)?;
        if self.measure != Measure::SquaredError {
            trial.footprints();
        }
        Ok(trial)
    }

    fn finding(
        &self,
        scene: &Scene,
        start: &Scene,
        trial: &Trial,
        method: &dyn Reconstructor,
        request: &Request,
        tries: u32,
    ) -> Result<Finding, WorsenError> {
        let failed = |source| WorsenError::Method { method: method.name(), source };
        let answer = trial.ask(method, request).map_err(failed)?;
        let failures = match self.measure {
            Measure::SquaredError => Failures::default(),
            _ => trial.failures(&answer),
        };
        let moves = start.objects.iter().zip(&scene.objects).map(|(a, b)| distance(a, b));
        let moved_metres = moves.fold(0.0, f64::max);
        Ok(Finding { scene: scene.clone(), metrics: answer.metrics, failures, moved_metres, tries })
    }

    fn is_better(&self, found: &Finding, path: &[Finding]) -> bool {
        let [start, .., last] = path else {
            let start = &path[0];
            return match self.aim {
                Aim::Worsen => self.measure.of(found) > self.measure.of(start),
                Aim::Repair => self.is_right(found, start),
            };
        };
        match self.aim {
            Aim::Worsen => self.measure.of(found) > self.measure.of(last),
            Aim::Repair => self.is_right(found, start) && found.moved_metres < last.moved_metres,
        }
    }

    fn is_right(&self, found: &Finding, start: &Finding) -> bool {
        match self.measure {
            Measure::SquaredError => found.metrics.squared_error <= REPAIRED * start.metrics.squared_error,
            _ => self.measure.of(found).0 == 0,
        }
    }

    /// Candidate `n`, from the state before its batch.
    fn candidate(&self, start: &Scene, state: &State, n: u32) -> Scene {
        let mut rng = ChaCha8Rng::seed_from_u64(self.seed);
        rng.set_stream(u64::from(n) + 1);
        match self.aim {
            Aim::Worsen => self.worse_candidate(start, state, &mut rng),
            Aim::Repair => self.repair_candidate(start, state, &mut rng),
        }
    }

    fn worse_candidate(&self, start: &Scene, state: &State, rng: &mut ChaCha8Rng) -> Scene {
        let anywhere = rng.random::<f64>() < ANYWHERE || state.path.len() == 1;
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
        // All louder together changes nothing.
        if scene.objects.len() > 1 {
            for (object, home) in scene.objects.iter_mut().zip(&start.objects) {
                let db = MOST_LOUDER_DB * rng.random_range(-1.0..=1.0);
                let part = if anywhere { 1.0 } else { state.step };
                let (now, at_home) = (reflectivity(object), *reflectivity(&mut home.clone()));
                *now *= 10f64.powf(part * db / 20.0);
                let most = 10f64.powf(MOST_LOUDER_DB / 20.0);
                let (low, high) = (at_home.abs() / most, at_home.abs() * most);
                *now = now.abs().clamp(low, high).copysign(at_home);
            }
        }
        if rng.random::<f64>() < OTHER_NOISE {
            scene.noise_seed = rng.random::<u64>() >> 11;
        }
        scene
    }

    fn repair_candidate(&self, start: &Scene, state: &State, rng: &mut ChaCha8Rng) -> Scene {
        let best = state.path.get(1..).and_then(<[Finding]>::last);
        let mut scene = start.clone();
        if let Some(best) = best.filter(|_| rng.random::<f64>() < 0.5) {
            // Part of the way that is known to help.
            let part = rng.random_range(0.2..1.0);
            for (object, end) in scene.objects.iter_mut().zip(&best.scene.objects) {
                let ([x, y], [to_x, to_y]) = (object.centre_metres(), end.centre_metres());
                object.translate(part * (to_x - x), part * (to_y - y));
            }
            return scene;
        }
        // Small moves first; never farther than what is known to help.
        let growing = f64::from(state.tries + BATCH) / f64::from(self.tries.max(1)) * 2.0;
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

/// Where a search stands.
struct State {
    /// Scale of steps, as a part of the reach.
    step: f64,
    path: Vec<Finding>,
    tries: u32,
}

fn normal(rng: &mut ChaCha8Rng) -> f64 {
    StandardNormal.sample(rng)
}

/// A place in a disc, all parts of it alike.
fn in_disc(rng: &mut ChaCha8Rng, radius: f64) -> [f64; 2] {
    let (angle, part) = (TAU * rng.random::<f64>(), rng.random::<f64>().sqrt());
    [radius * part * angle.cos(), radius * part * angle.sin()]
}

fn distance(a: &Object, b: &Object) -> f64 {
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

fn reflectivity(object: &mut Object) -> &mut f64 {
    match object {
        Object::Point(p) => &mut p.reflectivity,
        Object::Line(l) => &mut l.reflectivity,
        Object::Gaussian(g) => &mut g.reflectivity,
    }
}

/// How often each fate befell, in words: "2 found, 1 missed".
pub fn summary(failures: &Failures) -> String {
    let count = |name: &str| failures.objects.iter().filter(|f| f.name() == name).count();
    let fates = [Fate::Found, Fate::Missed, Fate::Merged { with: 0 }, Fate::WrongTooth { columns: 0 }, Fate::Hidden];
    let objects = fates.into_iter().map(|f| (count(f.name()), f.name().to_owned()));
    let ghosts = (failures.ghosts.len(), if failures.ghosts.len() == 1 { "ghost" } else { "ghosts" }.to_owned());
    let parts = objects.chain([ghosts]).filter(|(n, _)| *n > 0).map(|(n, name)| format!("{n} {name}"));
    parts.collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::maps::RangeAngleMap;
    use crate::reconstruct::{About, Reconstruction};
    use crate::signal::TwoEnds;

    fn radar() -> Radar {
        Radar { elements: 64, samples: 64, end_elements: 8, ..Radar::default() }
    }

    /// Answers with nothing where the strongest echo comes from beyond half the range, and with one end's map else.
    struct ShortSighted;

    impl Reconstructor for ShortSighted {
        fn about(&self) -> About {
            About { name: "short-sighted", description: "sees near objects only", told: "nothing", eta: 0.8 }
        }

        fn estimate(&self, radar: &Radar, ends: &TwoEnds, _: &Request) -> Result<Reconstruction, ReconstructError> {
            let map = crate::maps::channels_map(radar, ends.first.view()).log_magnitude();
            let (peak, _) = map.decades().indexed_iter().max_by(|a, b| a.1.total_cmp(b.1)).unwrap();
            let mut lambda = map.normalise(Normalisation::MinMax);
            if peak.0 > 32 {
                lambda = RangeAngleMap { lambda: lambda.lambda.mapv(|_| 0.0) };
            }
            Ok(Reconstruction { lambda, reflectors: Vec::new() })
        }
    }

    fn search(aim: Aim, measure: Measure) -> Search {
        Search { radar: radar(), aim, measure, tries: 80, seed: 4, ..Search::default() }
    }

    fn run(search: &Search, y_metres: f64) -> Outcome {
        let scene = Scene::of_points([(0.0, y_metres)]);
        search.run(&scene, &ShortSighted, &Task::default(), |_, _| true).unwrap()
    }

    /// Half the range is at 2.4 m.
    #[test]
    fn a_search_finds_where_the_method_stops_seeing() {
        for measure in Measure::ALL.into_iter().take(2) {
            let search = search(Aim::Worsen, measure);
            let found = run(&search, 1.7);
            let (start, worst) = found.ends().unwrap();
            let worst = worst.unwrap();
            assert!(worst.metrics.squared_error > start.metrics.squared_error);
            assert!(worst.scene.objects[0].centre_metres()[1] > 2.3 && worst.moved_metres <= 2.0 + 1e-9);
            assert!(found.path.is_sorted_by(|a, b| measure.of(a) < measure.of(b)));
            assert_eq!((found.tries, &found), (80, &run(&search, 1.7)), "the same seed gives the same search");
        }
    }

    #[test]
    fn a_repair_is_the_smallest_move_that_helps() {
        let found = run(&search(Aim::Repair, Measure::Missed), 3.0);
        let (start, end) = found.ends().unwrap();
        let end = end.unwrap();
        assert_eq!((start.failures.missed(), end.failures.missed()), (1, 0));
        // From 3.0 m to where the bin's middle is nearer than that of half the range, 2.44 m.
        assert!((0.5..0.75).contains(&end.moved_metres), "{}", end.moved_metres);
        assert!(found.path[1..].is_sorted_by(|a, b| a.moved_metres > b.moved_metres));
        assert_eq!(run(&search(Aim::Repair, Measure::Missed), 1.7).tries, 0, "nothing to repair");
    }

    #[test]
    fn a_search_that_makes_no_sense_is_refused_and_one_that_is_stopped_keeps_what_it_has() {
        let refuse = |search: &Search, scene: &Scene| {
            search.run(scene, &ShortSighted, &Task::default(), |_, _| true).unwrap_err()
        };
        let worsen = search(Aim::Worsen, Measure::SquaredError);
        assert_eq!(refuse(&worsen, &Scene::default()), WorsenError::Empty);
        let far = Search { within_metres: f64::NAN, ..worsen.clone() };
        assert!(matches!(refuse(&far, &Scene::of_points([(0.0, 2.0)])), WorsenError::Reach(_)));
        let scene = Scene::of_points([(0.0, 1.7)]);
        let stopped = worsen.run(&scene, &ShortSighted, &Task::default(), |tries, _| tries < 16).unwrap();
        assert_eq!(stopped.tries, 16);
        assert_eq!(stopped.path, run(&Search { tries: 16, ..worsen }, 1.7).path);
    }
}
