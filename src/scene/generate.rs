//! Seeded random scenes: the thesis' test sets, the training scenes of its two experiments (sections 3.2, 4.1, 5.1), and named
//! kinds that cover the whole field.
//!
//! Purpose, kind and number name the random stream of each scene and of its noise ([`Scene::noise_seed`]). So training, validation and test
//! scenes are distinct, and scene 7 does not depend on scenes 0 to 6.

mod beyond;
mod field;
mod kind;
mod laws;
mod mixture;
mod things;
mod world;

pub use beyond::Beyond;
pub use kind::{Kind, NoRoom};
pub use mixture::Mixture;

use super::{Line, Object, Point, Scene};
use crate::radar::Radar;
use beyond::BeyondField;
use field::PlacementField;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;
use world::World;

/// The description of the thesis' scenes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Reading {
    /// The author's published program, which reproduces the printed tables.
    #[default]
    Program,
    Text,
}

/// The purpose of a scene. Scenes of different purposes come from disjoint random streams.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Purpose {
    /// Fitting weights.
    Training,
    /// Choosing thresholds, checkpoints and settings.
    Validation,
    /// Reported figures only.
    Test,
}

impl Purpose {
    pub(crate) fn number(self) -> u8 {
        match self {
            Purpose::Training => 1,
            Purpose::Validation => 2,
            Purpose::Test => 3,
        }
    }
}

/// Makes random scenes for one radar.
#[derive(Debug, Clone)]
pub struct Generator {
    max_range: f64,
    bin: f64,
    world: World,
    reading: Reading,
    purpose: Purpose,
    seed: u64,
}

const LINE_POINTS: usize = 75;

impl Generator {
    /// Scenes for `radar`; the same arguments give the same scenes on every machine.
    pub fn new(radar: &Radar, reading: Reading, purpose: Purpose, seed: u64) -> Self {
        let (max_range, bin) = (radar.max_range_metres(), radar.range_resolution_metres());
        Generator { max_range, bin, world: World::new(radar), reading, purpose, seed }
    }

    /// Random stream of one scene. Purposes get different keys, kinds and numbers different streams of that key.
    fn rng(&self, kind: Kind, number: u32) -> ChaCha8Rng {
        let mut key = [0u8; 32];
        key[..8].copy_from_slice(&self.seed.to_le_bytes());
        key[8] = self.purpose.number();
        let mut rng = ChaCha8Rng::from_seed(key);
        rng.set_stream(kind.stream() << 32 | u64::from(number));
        rng
    }

    /// Seed of the noise beneath a scene, below 2^53.
    fn noise_seed(&self, kind: Kind, number: u32) -> u64 {
        let mut rng = self.rng(kind, number);
        // This position lies far beyond the scene's own draws from the stream.
        rng.set_word_pos(1 << 40);
        rng.random::<u64>() >> 11
    }

    /// Scene `number` of a kind. Each scene of each purpose has its own [`Scene::noise_seed`], so that tests have other noise than training.
    pub fn scene(&self, kind: Kind, number: u32) -> Scene {
        let rng = &mut self.rng(kind, number);
        let objects = match kind {
            Kind::Set1 => vec![self.point(rng)],
            Kind::Set2 => (0..rng.random_range(3..=6)).map(|_| self.point(rng)).collect(),
            Kind::Set3 => {
                let count = rng.random_range(3..=6);
                let mut objects = self.line_and_neighbour(rng);
                objects.extend((2..count).map(|_| self.point_or_line(rng)));
                objects
            }
            Kind::Noise => Vec::new(),
            Kind::Points(count) => (0..count).map(|_| self.point(rng)).collect(),
            Kind::Mixed(count) => (0..count).map(|_| self.point_or_line(rng)).collect(),
            Kind::Bodies | Kind::Street | Kind::Rails | Kind::Occlusion | Kind::Rough => {
                things::objects(kind, self.max_range, rng)
            }
            Kind::World => self.world.objects(rng),
            Kind::Beyond(kind) => {
                BeyondField { max_range_metres: self.max_range, bin_metres: self.bin }.objects(kind, rng)
            }
            _ => PlacementField { max_range_metres: self.max_range, bin_metres: self.bin }.objects(kind, rng),
        };
        let name = format!("{kind:?} {number}, seed {}", self.seed);
        Scene { name, noise_seed: self.noise_seed(kind, number), objects, ..Scene::default() }
    }

    fn point(&self, rng: &mut ChaCha8Rng) -> Object {
        let normal: f64 = StandardNormal.sample(rng);
        let range = self.max_range / 2.0 + 0.3 * self.max_range * normal;
        let far = 0.8 * self.max_range;
        let range = if range < 0.2 * self.max_range { far } else { range.min(far) };
        let angle: f64 = StandardNormal.sample(rng);
        let angle = angle.clamp(-0.8 * PI, 0.8 * PI);
        Object::Point(Point::new(range * angle.cos(), range * angle.sin()))
    }

    /// Start of a line: (x, y) in metres before clipping.
    fn line_start(&self, rng: &mut ChaCha8Rng) -> (f64, f64) {
        let y_part = match self.reading {
            Reading::Program => 1.0,
            Reading::Text => 0.8,
        };
        (rng.random_range(-1.0..1.0) * self.max_range, rng.random_range(0.0..1.0) * y_part * self.max_range)
    }

    fn line(&self, (x, y): (f64, f64)) -> Object {
        let (spacing_metres, y_start_metres) = match self.reading {
            Reading::Program => {
                let spacing = 1.5 * self.bin;
                (spacing, y.min(0.9 * self.max_range - LINE_POINTS as f64 * spacing))
            }
            Reading::Text => (self.bin, y),
        };
        let edge = 0.8 * self.max_range;
        Object::Line(Line::vertical(x.clamp(-edge, edge), y_start_metres, spacing_metres, LINE_POINTS))
    }

    /// Set 3's first two objects: a line, and a point up to 50 bins behind the range of the line's start.
    fn line_and_neighbour(&self, rng: &mut ChaCha8Rng) -> Vec<Object> {
        let start = self.line_start(rng);
        let range = start.0.hypot(start.1) + rng.random_range(0.0..1.0) * 50.0 * self.bin;
        let angle = rng.random_range(-0.5..0.5) * PI;
        vec![self.line(start), Object::Point(Point::new(range * angle.cos(), range * angle.sin()))]
    }

    fn point_or_line(&self, rng: &mut ChaCha8Rng) -> Object {
        if rng.random::<f64>() < 0.5 {
            self.point(rng)
        } else {
            let start = self.line_start(rng);
            self.line(start)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn generator(purpose: Purpose) -> Generator {
        Generator::new(&Radar::default(), Reading::Program, purpose, 5)
    }

    #[test]
    fn scenes_follow_from_purpose_seed_index() {
        let test = generator(Purpose::Test);
        assert_eq!(test.scene(Kind::Set2, 9), test.scene(Kind::Set2, 9));
        assert_ne!(test.scene(Kind::Set2, 9).objects, test.scene(Kind::Set2, 10).objects);
        let expected = generator(Purpose::Training).scene(Kind::Set1, 0).objects;
        assert_ne!(test.scene(Kind::Set1, 0).objects, expected, "purposes must not share scenes");
    }

    #[test]
    fn every_scene_of_every_purpose_has_its_own_noise() {
        let mut seeds = std::collections::HashSet::new();
        for purpose in [Purpose::Training, Purpose::Validation, Purpose::Test] {
            for kind in Kind::TEST_SETS.into_iter().chain([Kind::Noise, Kind::Points(2), Kind::Mixed(2)]) {
                for number in 0..100 {
                    let seed = generator(purpose).noise_seed(kind, number);
                    assert!(seed < 1 << 53 && seeds.insert(seed), "{purpose:?} {kind:?} {number}");
                }
            }
        }
    }

    #[test]
    fn sets_hold_what_the_thesis_says() {
        let g = generator(Purpose::Test);
        for number in 0..500 {
            let [r] = g.scene(Kind::Set1, number).reflectors()[..] else { panic!("one point") };
            let part = r.x_metres.hypot(r.y_metres) / Radar::default().max_range_metres();
            assert!((0.2 - 1e-9..=0.8 + 1e-9).contains(&part), "{part} of the maximum range");
            assert!((3..=6).contains(&g.scene(Kind::Set2, number).objects.len()));
            let set3 = g.scene(Kind::Set3, number).objects;
            assert!((3..=6).contains(&set3.len()));
            assert!(matches!((&set3[0], &set3[1]), (Object::Line(_), Object::Point(_))));
        }
    }

    #[test]
    fn the_text_reading_spaces_lines_by_one_bin() {
        let radar = Radar::default();
        let g = Generator::new(&radar, Reading::Text, Purpose::Test, 1);
        let Object::Line(line) = &g.scene(Kind::Set3, 0).objects[0] else { panic!("set 3 starts with a line") };
        assert_eq!((line.count, line.spacing_metres), (75, radar.range_resolution_metres()));
    }

    fn scenes(kind: Kind) -> Vec<Vec<Object>> {
        (0..40).map(|number| generator(Purpose::Test).scene(kind, number).objects).collect()
    }

    fn lines(objects: &[Object]) -> Vec<Line> {
        objects.iter().filter_map(|o| if let Object::Line(l) = o { Some(l.clone()) } else { None }).collect()
    }

    #[test]
    fn named_kinds_keep_to_the_field() {
        let radar = Radar::default();
        for kind in Kind::VARIED_KINDS.into_iter().chain(Kind::IRREGULAR_KINDS) {
            for (number, objects) in scenes(kind).into_iter().enumerate() {
                let scene = Scene { objects, ..Scene::default() };
                scene.validate(&radar).unwrap();
                for object in scene.objects.iter().filter(|o| !matches!(o, Object::Gaussian(_))) {
                    for r in object.reflectors() {
                        let range = r.x_metres.hypot(r.y_metres);
                        assert!((0.3..=0.9501 * radar.max_range_metres()).contains(&range), "{kind} {number}: {range}");
                        assert!(r.y_metres > 0.05, "{kind} {number}: {r:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn every_scene_of_bodies_can_be_simulated() {
        for kind in Kind::BODY_KINDS {
            let mut bodies = 0;
            for (number, objects) in scenes(kind).into_iter().enumerate() {
                let scene = Scene { objects, ..Scene::default() };
                scene.validate(&Radar::default()).unwrap_or_else(|e| panic!("{kind} {number}: {e}"));
                assert!(scene.has_bodies(), "{kind} {number}");
                bodies += scene.objects.iter().filter(|o| o.body().is_some()).count();
            }
            assert!(bodies >= 60, "{kind}: {bodies} in 40 scenes");
        }
        let rough = scenes(Kind::Rough).into_iter().flatten();
        let deviations: Vec<f64> =
            rough.filter_map(|o| Some(o.body()?.roughness_millimetres)).filter(|deviation| *deviation > 0.0).collect();
        assert!(deviations.len() >= 40 && deviations.iter().all(|d| (0.2..=1.5).contains(d)), "{deviations:?}");
    }

    #[test]
    fn only_walls_are_slanted() {
        let bin = Radar::default().range_resolution_metres();
        let slanted: Vec<Line> = scenes(Kind::Walls).iter().flat_map(|s| lines(s)).collect();
        let quadrant = |q: f64| slanted.iter().filter(|l| (l.direction_degrees / 90.0).floor() == q).count();
        assert!((0..4).all(|q| quadrant(f64::from(q)) > 5), "every quadrant gets its lines");
        let other: Vec<Line> = scenes(Kind::Spacings).iter().flat_map(|s| lines(s)).collect();
        assert!(other.iter().all(|l| l.direction_degrees == 90.0 && (l.spacing_metres / bin - 1.5).abs() > 0.09));
        for l in slanted.iter().chain(&other) {
            assert!((20..=100).contains(&l.count) && (0.5..=3.0).contains(&(l.spacing_metres / bin)), "{l:?}");
        }
    }

    #[test]
    fn corners_are_right_angles_that_share_an_end() {
        for objects in scenes(Kind::Corner) {
            let [a, b] = &lines(&objects)[..] else { panic!("two lines") };
            assert_eq!((a.x_metres, a.y_start_metres), (b.x_metres, b.y_start_metres));
            let ([ax, ay], [bx, by]) = (a.step_metres(), b.step_metres());
            assert!((ax * bx + ay * by).abs() < 1e-12);
            assert!(matches!(objects[2..], [Object::Gaussian(_), Object::Point(_)]));
        }
    }

    #[test]
    fn every_kind_is_drawn_at_the_range_it_needs() {
        for kind in Kind::all().chain([Kind::World]) {
            let bandwidth_hz = 512.0 * crate::radar::SPEED_OF_LIGHT / 2.0 / kind.needed_range_metres().max(1.0);
            let radar = Radar { bandwidth_hz, ..Radar::default() };
            let generator = Generator::new(&radar, Reading::Program, Purpose::Validation, 5);
            (0..20).for_each(|number| assert_eq!(generator.scene(kind, number).validate(&radar), Ok(()), "{kind}"));
        }
    }

    #[test]
    fn fences_are_two_rows_at_irregular_steps() {
        for objects in scenes(Kind::Fences) {
            let places: Vec<[f64; 2]> =
                objects.iter().flat_map(Object::reflectors).map(|r| [r.x_metres, r.y_metres]).collect();
            assert!((40..=900).contains(&places.len()), "{}", places.len());
            let steps: Vec<f64> =
                places.windows(2).map(|p| (p[1][0] - p[0][0]).hypot(p[1][1] - p[0][1])).take(15).collect();
            let (least, most) = steps.iter().fold((f64::MAX, 0.0f64), |(a, b), s| (a.min(*s), b.max(*s)));
            assert!(most > 1.1 * least, "{steps:?}");
        }
    }

    #[test]
    fn rain_is_weak_points_before_a_few_strong_ones() {
        for objects in scenes(Kind::Rain) {
            let strong = objects.iter().flat_map(Object::reflectors).filter(|r| r.reflectivity == 1.0).count();
            let weak = objects.iter().flat_map(Object::reflectors).filter(|r| (0.01..0.32).contains(&r.reflectivity));
            assert!((1..=4).contains(&strong) && (60..=240).contains(&weak.count()));
        }
    }

    #[test]
    fn every_kind_is_as_described() {
        assert!(scenes(Kind::Crowd).iter().all(|s| (12..=40).contains(&s.len())));
        for objects in scenes(Kind::Dynamic) {
            let sigma: Vec<f64> = objects.iter().flat_map(Object::reflectors).map(|r| r.reflectivity).collect();
            assert!(sigma.len() == 5 && sigma[0] == 1.0 && sigma.iter().all(|s| (0.01..=1.0).contains(s)), "{sigma:?}");
        }
        let near: Vec<f64> = scenes(Kind::Near)
            .iter()
            .flatten()
            .flat_map(Object::reflectors)
            .map(|r| r.x_metres.hypot(r.y_metres))
            .collect();
        assert!(near.iter().all(|r| (0.3..=8.0).contains(r)) && near.iter().any(|&r| r < 0.6), "{near:?}");
        for objects in scenes(Kind::Clusters) {
            let clusters = objects.iter().filter(|o| matches!(o, Object::Gaussian(g) if (15..=40).contains(&g.count)));
            assert!((1..=3).contains(&clusters.count()));
        }
    }
}
