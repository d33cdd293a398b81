//! Scenes written as TOML, for people.

use super::content::SceneFile;
use super::read::FORMAT;
use crate::radar::{Convention, Radar};
use crate::scene::{Disturbances, Object, Scene};
use serde::Serialize;

/// The scene as text, with those keys of the radar that differ from table 3.1.
/// # Errors
/// An error for a number that TOML can't hold (an integer above 2^63).
pub fn to_toml(file: &SceneFile) -> Result<String, toml::ser::Error> {
    #[derive(Serialize)]
    struct Document<'a> {
        #[serde(skip_serializing_if = "Option::is_none")]
        format: Option<i64>,
        #[serde(skip_serializing_if = "str::is_empty")]
        name: &'a str,
        #[serde(skip_serializing_if = "str::is_empty")]
        notes: &'a str,
        #[serde(skip_serializing_if = "Option::is_none")]
        noise_seed: Option<u64>,
        #[serde(skip_serializing_if = "Option::is_none")]
        shadows: Option<bool>,
        #[serde(skip_serializing_if = "toml::Table::is_empty")]
        radar: toml::Table,
        #[serde(skip_serializing_if = "Disturbances::is_none")]
        disturbances: &'a Disturbances,
        object: &'a [Object],
    }
    let Scene { name, notes, noise_seed, shadows, disturbances, objects } = &file.scene;
    let shadows = Some(*shadows).filter(|shadows| !shadows);
    let noise_seed = Some(*noise_seed).filter(|seed| *seed != 0);
    let radar = radar_table(&file.radar)?;
    let format = objects.iter().any(|o| !o.name().is_empty()).then_some(FORMAT);
    toml::to_string_pretty(&Document { format, name, notes, noise_seed, shadows, radar, disturbances, object: objects })
}

/// The keys that differ from table 3.1. The physical convention is written by its name where the spacing is its own.
fn radar_table(radar: &Radar) -> Result<toml::Table, toml::ser::Error> {
    let usual = toml::Table::try_from(Radar::default())?;
    let mut table = toml::Table::try_from(radar)?;
    table.retain(|key, value| usual.get(key) != Some(value));
    let convention = radar.convention();
    if convention == Convention::Physical && radar.element_spacing_metres == radar.filled_spacing_metres() {
        table.remove("carrier");
        table.remove("element_spacing_metres");
        table.insert("convention".to_owned(), convention.name().into());
    }
    if !radar.is_monostatic() {
        // The number of elements follows from the antennas.
        table.remove("elements");
        table.remove("element_spacing_metres");
    }
    Ok(table)
}

/// [`to_toml`] with a further table, called `key`, after it.
/// # Errors
/// As [`to_toml`].
pub fn to_toml_beside(file: &SceneFile, key: &str, value: &impl Serialize) -> Result<String, toml::ser::Error> {
    let beside = toml::Table::from_iter([(key.to_owned(), toml::Value::try_from(value)?)]);
    let scene = to_toml(file)?;
    // An empty list of objects is a line of its own and ends before the first table does.
    Ok(format!("{scene}\n{}", toml::to_string_pretty(&beside)?))
}

#[cfg(test)]
mod tests {
    use super::super::read::{from_toml, from_toml_beside};
    use super::*;
    use crate::radar::Carrier;
    use crate::scene::{Block, GaussianCluster, Line, Point, Polygon, Post, Wall};
    use serde::de::IgnoredAny;

    fn scene() -> SceneFile {
        let objects = vec![
            Object::Point(Point { reflectivity: -2.5, ..Point::new(0.1 + 0.2, 1e-300) }),
            Object::Line(Line { direction_degrees: 30.0, ..Line::vertical(1.0, 2.0, 0.1, 75) }),
            Object::Gaussian(GaussianCluster { seed: 9, ..GaussianCluster::new([-5.0, 20.0], [1.0, 0.5], 40) }),
            Object::Wall(Wall { roughness_millimetres: 0.3, ..Wall::new(1.0, 9.0, 4.0, 0.0) }),
            Object::Box(Block { reflectivity: 0.5, seed: 3, ..Block::new([3.0, 9.0], [4.5, 1.8], 12.0) }),
            Object::Post(Post { name: "the \"post\"".to_owned(), ..Post::new(-3.0, 9.0, 0.1) }),
            Object::Polygon(Polygon::new(vec![[-9.0, 9.0], [-8.0, 9.0], [-8.0, 10.5]])),
        ];
        let scene = Scene {
            name: "All \"three\"".to_owned(),
            notes: "First line.\nSecond: 'x'.".to_owned(),
            noise_seed: 9,
            shadows: false,
            disturbances: Disturbances {
                interferer: Some(crate::scene::Interferer { x_metres: -1.5, ..Default::default() }),
                mirror: Some(crate::scene::Mirror { reflection: 0.25, ..Default::default() }),
                ..Disturbances::default()
            },
            objects,
        };
        SceneFile { scene, radar: Radar { carrier: Carrier::TwoWay, ..Radar::default() } }
    }

    #[test]
    fn every_kind_round_trips() {
        let text = to_toml(&scene()).unwrap();
        assert!(text.contains("carrier = \"two-way\"") && !text.contains("bandwidth"), "{text}");
        assert_eq!(from_toml(&text).unwrap(), scene());
    }

    #[test]
    fn only_a_scene_with_named_objects_has_format_2() {
        let mut file = scene();
        assert!(to_toml(&file).unwrap().starts_with("format = 2\n"));
        file.scene.objects.iter_mut().for_each(|object| object.set_name(""));
        assert!(!to_toml(&file).unwrap().contains("format"));
    }

    #[test]
    fn a_convention_and_antennas_stand_for_what_follows_from_them() {
        let physical = Radar { elements: 64, ..Radar::default() }.in_convention(Convention::Physical);
        for (radar, said, follows) in [
            (physical, "convention = \"physical\"", "spacing_metres = 0.000"),
            (Radar::default().of_pairs(3, 4).unwrap(), "receiver_x_metres", "elements = 12"),
        ] {
            let file = SceneFile { radar, ..scene() };
            let text = to_toml(&file).unwrap();
            assert!(text.contains(said) && !text.contains(follows), "{text}");
            assert_eq!(from_toml(&text).unwrap(), file, "{said}");
        }
    }

    #[test]
    fn an_empty_file_is_an_empty_scene() {
        assert_eq!(from_toml("").unwrap(), SceneFile::default());
    }

    #[test]
    fn a_foreign_table_travels_along() {
        let beside = toml::Table::from_iter([("here".to_owned(), 3.into())]);
        for file in [scene(), SceneFile::default()] {
            let text = to_toml_beside(&file, "other", &beside).unwrap();
            assert_eq!(from_toml_beside(&text, "other").unwrap(), (file, Some(beside.clone())));
            assert!(from_toml(&text).unwrap_err().message.contains("other"));
        }
        let on_element =
            "[radar]\nelements = 7\nend_elements = 3\n[[object]]\nkind = \"point\"\nx_metres = 0\ny_metres = 0\n";
        assert!(from_toml(on_element).is_err());
        assert_eq!(from_toml_beside::<IgnoredAny>(on_element, "other").unwrap().0.scene.objects.len(), 1);
    }
}
