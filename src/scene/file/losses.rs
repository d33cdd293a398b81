//! Losses of a file format: properties of a scene that it can't store, reported before the scene is written.

use super::content::{SceneFile, SceneFormat};
use crate::radar::Radar;
use crate::scene::{Object, Scene};
use std::fmt;

/// A property of a scene that a file would not give back.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs)] // Names of fields say what is in them.
pub enum FileLoss {
    /// The scene's name.
    Name,
    /// The scene's notes.
    Notes,
    /// The number that picks the floor's noise: reopened, it is 0.
    NoiseSeed,
    /// A radar other than table 3.1's: reopened, the scene stands before the usual one.
    Radar,
    /// Elements as they are built, an interferer or a mirror: reopened, there are none.
    Disturbances,
    /// The recording that the scene is laid over: reopened, it lies over none.
    Recording,
    /// Reflectivities other than 1: reopened, they are 1.
    Reflectivity { objects: usize },
    /// Names: reopened, objects are called by kind and number.
    Named { objects: usize },
    /// Velocities: reopened, everything rests.
    Velocity {
        /// Objects that move.
        objects: usize,
    },
    /// Bodies that hide nothing: reopened, there are no bodies.
    Shadows,
    /// Bodies: reopened, they are points where the array's middle sees them echo, which hide nothing.
    Bodies {
        /// Walls, boxes, posts and polygons.
        objects: usize,
        /// Points they become.
        points: usize,
    },
    /// Lines and clusters: reopened, they are points.
    Structure {
        /// Lines and clusters.
        objects: usize,
        /// Points they become.
        points: usize,
    },
}

impl fmt::Display for FileLoss {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            FileLoss::Name => f.write_str("the scene's name"),
            FileLoss::Notes => f.write_str("its notes"),
            FileLoss::NoiseSeed => f.write_str("its noise seed"),
            FileLoss::Radar => f.write_str("its radar"),
            FileLoss::Shadows => f.write_str("that its bodies hide nothing"),
            FileLoss::Bodies { objects: 1, points } => {
                write!(f, "one body, which becomes {points} points where it echoes")
            }
            FileLoss::Bodies { objects, points } => {
                write!(f, "{objects} bodies, which become {points} points where they echo")
            }
            FileLoss::Disturbances => f.write_str("what disturbs it"),
            FileLoss::Recording => f.write_str("the recording that it is laid over"),
            FileLoss::Reflectivity { objects: 1 } => f.write_str("the reflectivity of one object"),
            FileLoss::Reflectivity { objects } => write!(f, "the reflectivity of {objects} objects"),
            FileLoss::Named { objects: 1 } => f.write_str("the name of one object"),
            FileLoss::Named { objects } => write!(f, "the names of {objects} objects"),
            FileLoss::Velocity { objects: 1 } => f.write_str("the velocity of one object"),
            FileLoss::Velocity { objects } => write!(f, "the velocity of {objects} objects"),
            FileLoss::Structure { objects: 1, points } => {
                write!(f, "one line or cluster, which becomes {points} points")
            }
            FileLoss::Structure { objects, points } => {
                write!(f, "{objects} lines and clusters, which become {points} points")
            }
        }
    }
}

impl SceneFormat {
    /// The parts of `file` that a file of this format loses; empty for none.
    pub fn losses(self, file: &SceneFile) -> Vec<FileLoss> {
        let SceneFile { scene, radar } = file;
        let Scene { name, notes, noise_seed, shadows, disturbances, objects } = scene;
        if self == SceneFormat::Toml {
            return Vec::new();
        }
        let mut losses = Vec::new();
        losses.extend((!name.is_empty()).then_some(FileLoss::Name));
        losses.extend((!notes.is_empty()).then_some(FileLoss::Notes));
        losses.extend((*noise_seed != 0).then_some(FileLoss::NoiseSeed));
        losses.extend((*radar != Radar::default()).then_some(FileLoss::Radar));
        losses.extend((!disturbances.is_none()).then_some(FileLoss::Disturbances));
        let reflective = objects.iter().filter(|o| o.reflectivity() != 1.0).count();
        losses.extend((reflective > 0).then_some(FileLoss::Reflectivity { objects: reflective }));
        let named = objects.iter().filter(|o| !o.name().is_empty()).count();
        losses.extend((named > 0).then_some(FileLoss::Named { objects: named }));
        let moving = objects.iter().filter(|o| o.is_moving()).count();
        losses.extend((moving > 0).then_some(FileLoss::Velocity { objects: moving }));
        losses.extend((!shadows).then_some(FileLoss::Shadows));
        let bodies: Vec<_> = objects.iter().filter_map(Object::body).collect();
        let points = bodies.iter().map(|b| b.echo_places_metres([0.0, 0.0]).len()).sum();
        losses.extend((!bodies.is_empty()).then_some(FileLoss::Bodies { objects: bodies.len(), points }));
        let structured = || objects.iter().filter(|o| o.body().is_none() && !matches!(o, Object::Point(_)));
        let (structures, points) = (structured().count(), structured().map(Object::reflector_count).sum());
        losses.extend((structures > 0).then_some(FileLoss::Structure { objects: structures, points }));
        losses
    }
}

#[cfg(test)]
mod tests {
    use super::super::{load, save};
    use super::*;
    use crate::radar::Carrier;
    use crate::scene::{Block, GaussianCluster, Line, Point, Polygon, Post, Wall};
    use proptest::prelude::*;

    fn object() -> impl Strategy<Value = Object> {
        let reflectivity = prop_oneof![3 => Just(1.0), 1 => 0.01f64..3.0];
        (0..12, -20.0f64..20.0, 4.0f64..30.0, reflectivity).prop_map(|(kind, x_metres, y_metres, reflectivity)| {
            match kind {
                0 => Object::Line(Line { reflectivity, ..Line::vertical(x_metres, y_metres, 0.1, 4) }),
                1 => Object::Gaussian(GaussianCluster {
                    seed: 5,
                    reflectivity,
                    ..GaussianCluster::new([x_metres, y_metres], [1.0, 1.0], 3)
                }),
                2 => Object::Wall(Wall { reflectivity, ..Wall::new(x_metres, y_metres, 3.0, y_metres) }),
                3 => Object::Box(Block { reflectivity, seed: 4, ..Block::new([x_metres, y_metres], [4.5, 1.8], 20.0) }),
                4 => Object::Post(Post {
                    reflectivity,
                    roughness_millimetres: 0.5,
                    ..Post::new(x_metres, y_metres, 0.2)
                }),
                5 => {
                    let corners = [[0.0, 0.0], [1.0, 0.0], [0.2, 0.2], [0.0, 1.0]];
                    let corners = corners.map(|[x, y]| [x + x_metres, y + y_metres]).to_vec();
                    Object::Polygon(Polygon { reflectivity, ..Polygon::new(corners) })
                }
                6 => {
                    let velocity_y_metres_per_second = x_metres;
                    Object::Point(Point { velocity_y_metres_per_second, ..Point::new(x_metres, y_metres) })
                }
                _ => Object::Point(Point { reflectivity, ..Point::new(x_metres, y_metres) }),
            }
        })
    }

    fn file() -> impl Strategy<Value = SceneFile> {
        let text = || prop_oneof![2 => Just(String::new()), 1 => "[a-z]{1,5}"];
        let carrier = prop_oneof![2 => Just(Carrier::OneWay), 1 => Just(Carrier::TwoWay)];
        let objects = prop::collection::vec(object(), 0..4);
        let noise_seed = prop_oneof![2 => Just(0u64), 1 => 1..99u64];
        (text(), text(), noise_seed, objects, carrier, any::<bool>()).prop_map(
            |(name, notes, noise_seed, objects, carrier, shadows)| SceneFile {
                scene: Scene { name, notes, noise_seed, shadows, objects, ..Scene::default() },
                radar: Radar { carrier, ..Radar::default() },
            },
        )
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(48))]

        #[test]
        fn what_is_not_told_comes_back(file in file()) {
            let folder = tempfile::tempdir().unwrap();
            for (name, format) in [("a.toml", SceneFormat::Toml), ("a.npz", SceneFormat::Npz)] {
                let path = folder.path().join(name);
                save(&path, &file).unwrap();
                prop_assert_eq!(format.losses(&file).is_empty(), load(&path).unwrap() == file, "{}", name);
            }
        }
    }

    #[test]
    fn losses_are_told_in_words() {
        let line = Line { reflectivity: 0.05, ..Line::vertical(0.0, 9.0, 0.1, 40) };
        let objects = vec![Object::Line(line), Object::Wall(Wall::new(0.0, 20.0, 5.0, 0.0))];
        let scene = Scene { notes: "n".to_owned(), shadows: false, objects, ..Scene::default() };
        let file = SceneFile { scene, radar: Radar { elements: 64, ..Radar::default() } };
        let told: Vec<String> = SceneFormat::Npz.losses(&file).iter().map(FileLoss::to_string).collect();
        let points = "one body, which becomes 3 points where it echoes; one line or cluster, which becomes 40 points";
        let others = "its notes; its radar; the reflectivity of one object; that its bodies hide nothing";
        assert_eq!(told.join("; "), format!("{others}; {points}"));
    }
}
