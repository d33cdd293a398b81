//! Losses of a file format: properties of a scene that it can't store, told before the scene is written.

use super::content::{SceneFile, SceneFormat};
use crate::radar::Radar;
use crate::scene::{Object, Scene};

impl SceneFormat {
    /// The parts of `file` that a file of this format loses, in words; empty for none.
    ///
    /// An archive gives back points of reflectivity 1 before the usual radar: bodies as the places where the array's middle sees them echo.
    pub fn losses(self, file: &SceneFile) -> Vec<String> {
        let SceneFile { scene, radar } = file;
        let Scene { name, notes, noise_seed, shadows, disturbances, objects } = scene;
        if self == SceneFormat::Toml {
            return Vec::new();
        }
        let count = |is: fn(&Object) -> bool| objects.iter().filter(|object| is(object)).count();
        let counted = |one: &str, many: &str, count: usize| match count {
            0 => None,
            1 => Some(format!("the {one} of one object")),
            _ => Some(format!("the {many} of {count} objects")),
        };
        let bodies: Vec<_> = objects.iter().filter_map(Object::body).collect();
        let places: usize = bodies.iter().map(|b| b.echo_places_metres([0.0, 0.0]).len()).sum();
        let is_structure = |o: &Object| o.body().is_none() && !matches!(o, Object::Point(_));
        let points: usize = objects.iter().filter(|o| is_structure(o)).map(Object::reflector_count).sum();
        let losses = [
            (!name.is_empty()).then(|| "the scene's name".to_owned()),
            (!notes.is_empty()).then(|| "its notes".to_owned()),
            (*noise_seed != 0).then(|| "its noise seed".to_owned()),
            (*radar != Radar::default()).then(|| "its radar".to_owned()),
            (!disturbances.is_none()).then(|| "what disturbs it".to_owned()),
            counted("reflectivity", "reflectivity", count(|o| o.reflectivity() != 1.0)),
            counted("name", "names", count(|o| !o.name().is_empty())),
            counted("velocity", "velocity", count(Object::is_moving)),
            (!shadows).then(|| "that its bodies hide nothing".to_owned()),
            match bodies.len() {
                0 => None,
                1 => Some(format!("one body, which becomes {places} points where it echoes")),
                n => Some(format!("{n} bodies, which become {places} points where they echo")),
            },
            match count(is_structure) {
                0 => None,
                1 => Some(format!("one line or cluster, which becomes {points} points")),
                n => Some(format!("{n} lines and clusters, which become {points} points")),
            },
        ];
        losses.into_iter().flatten().collect()
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
        let told = SceneFormat::Npz.losses(&file);
        let points = "one body, which becomes 3 points where it echoes; one line or cluster, which becomes 40 points";
        let others = "its notes; its radar; the reflectivity of one object; that its bodies hide nothing";
        assert_eq!(told.join("; "), format!("{others}; {points}"));
    }
}
