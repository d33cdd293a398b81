//! Scenes as TOML: written for people, read with errors that name the line.
//!
//! A text may begin with `format = 1`. It is not written: whatever needs more than that format has is written with a higher number, which
//! older programs name in their message.

use super::content::{SceneFile, SceneTextError, one_line};
use super::objects::objects;
use crate::radar::{Convention, Radar};
use crate::scene::{Disturbances, Object, Scene, SceneError, yes};
use serde::de::{DeserializeOwned, IgnoredAny};
use serde::{Deserialize, Serialize};
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue, ValueDeserializer};

/// The format of scenes that this program knows. A text that says nothing else is of it; one that needs more will say so.
const FORMAT: i64 = 1;

/// Most values and tables that a text may ask for, told by the marks that come with each: the largest scene needs some three million.
const MAX_MARKS: usize = 4_000_000;

/// The scene as text; only what differs from table 3.1 is said of the radar.
///
/// # Errors
/// When a number is one that TOML can't hold (an integer above 2^63).
pub fn to_toml(file: &SceneFile) -> Result<String, toml::ser::Error> {
    #[derive(Serialize)]
    struct Document<'a> {
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
    toml::to_string_pretty(&Document { name, notes, noise_seed, shadows, radar, disturbances, object: objects })
}

/// What differs from table 3.1. The physical convention is said by its name where the spacing is its own.
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
        // The antennas say these.
        table.remove("elements");
        table.remove("element_spacing_metres");
    }
    Ok(table)
}

/// [`to_toml`] with a further table, called `key`, after it.
///
/// # Errors
/// As [`to_toml`].
pub fn to_toml_beside(file: &SceneFile, key: &str, value: &impl Serialize) -> Result<String, toml::ser::Error> {
    let beside = toml::Table::from_iter([(key.to_owned(), toml::Value::try_from(value)?)]);
    let scene = to_toml(file)?;
    // An empty list of objects is a line of its own and ends before the first table does.
    Ok(format!("{scene}\n{}", toml::to_string_pretty(&beside)?))
}

/// Reads a scene from text and checks that it can be simulated.
///
/// # Errors
/// [`SceneTextError`] names the line, the key or object, and what was expected.
pub fn from_toml(text: &str) -> Result<SceneFile, SceneTextError> {
    Ok(checked::<IgnoredAny>(text, None)?.0)
}

/// A scene that can be simulated, and the further table if the text has it.
fn checked<T: DeserializeOwned>(text: &str, beside: Option<&str>) -> Result<(SceneFile, Option<T>), SceneTextError> {
    let (file, other) = parse(text, beside)?;
    file.scene.validate(&file.radar).map_err(|error| {
        let span = match &error {
            SceneError::Value { object, field, .. } => object_spans(text, *object).field(field),
            SceneError::Outline { object, .. } => object_spans(text, *object).field("corners_metres"),
            SceneError::OnElement { object, .. } | SceneError::Covers { object, .. } => {
                object_spans(text, *object).whole
            }
            SceneError::Elements(_) | SceneError::Disturbance { .. } => disturbances_span(text),
            SceneError::TooMany { .. } | SceneError::Radar(_) => 0..0,
        };
        SceneTextError::at(text, span.start, error.to_string())
    })?;
    Ok((file, other))
}

/// Reads what [`to_toml_beside`] wrote; the second is `None` where the text has no `key`.
///
/// The scene need not be one that can be simulated: a user may have left a point on an element of the array.
///
/// # Errors
/// As [`from_toml`].
pub fn from_toml_beside<T: DeserializeOwned>(text: &str, key: &str) -> Result<(SceneFile, Option<T>), SceneTextError> {
    let (file, other) = parse(text, Some(key))?;
    file.scene.check_count().map_err(|e| SceneTextError::at(text, 0, e.to_string()))?;
    Ok((file, other))
}

/// [`from_toml`] of a file's bytes, and the table called `beside`.
pub(super) fn from_bytes<T: DeserializeOwned>(
    bytes: &[u8],
    beside: Option<&str>,
) -> Result<(SceneFile, Option<T>), SceneTextError> {
    checked(utf8(bytes)?, beside)
}

/// Text that is TOML and not too much of it, and its top-level table.
fn table(text: &str) -> Result<Spanned<DeTable<'_>>, SceneTextError> {
    let marks = text.bytes().filter(|b| b"=,.[{".contains(b)).count();
    if marks > MAX_MARKS {
        let message = format!("the text asks for {marks} values and tables; at most {MAX_MARKS} are read");
        return Err(SceneTextError::at(text, 0, message));
    }
    DeTable::parse(text).map_err(|e| of_toml(text, &e, 0))
}

fn parse<T: DeserializeOwned>(text: &str, beside: Option<&str>) -> Result<(SceneFile, Option<T>), SceneTextError> {
    /// All but the objects, which need a closer look; the field is there for the message about an unknown one. So is that of the
    /// recording that a scene is laid over, which is the app's.
    #[derive(Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Head {
        #[serde(default)]
        name: String,
        #[serde(default)]
        notes: String,
        #[serde(default)]
        noise_seed: u64,
        #[serde(default = "yes")]
        shadows: bool,
        #[serde(default)]
        radar: Radar,
        #[serde(default)]
        disturbances: Disturbances,
        #[serde(default, rename = "object")]
        _objects: Option<IgnoredAny>,
        #[serde(default, rename = "over")]
        _over: Option<IgnoredAny>,
    }

    let document = table(text)?;
    let span = document.span();
    let mut document = document.into_inner();
    check_format(text, &document)?;
    document.remove("format");
    let radar_spans = document.get("radar").map(Spans::of);
    let entries = document.remove("object");
    let start = span.start;
    let wrong = |e: toml::de::Error| of_toml(text, &e, start);
    let other = beside.and_then(|key| document.remove(key)).map(|v| T::deserialize(ValueDeserializer::from(v)));
    let other = other.transpose().map_err(wrong)?;
    let head = ValueDeserializer::from(Spanned::new(span.clone(), DeValue::Table(document)));
    let head = Head::deserialize(head).map_err(wrong)?;
    head.radar.validate().map_err(|error| {
        let span = radar_spans.as_ref().map_or(0..0, |s| s.field(error.field()));
        SceneTextError::at(text, span.start, error.to_string())
    })?;
    let objects = entries.map(|e| objects(text, e)).transpose()?.unwrap_or_default();
    Ok((
        SceneFile {
            scene: Scene {
                name: head.name,
                notes: head.notes,
                noise_seed: head.noise_seed,
                shadows: head.shadows,
                disturbances: head.disturbances,
                objects,
            },
            radar: head.radar,
        },
        other,
    ))
}

/// Refuses a scene of a later format before its unknown keys are.
fn check_format(text: &str, document: &DeTable<'_>) -> Result<(), SceneTextError> {
    let Some(format) = document.get("format") else { return Ok(()) };
    let number = match format.get_ref() {
        DeValue::Integer(number) => i64::from_str_radix(number.as_str(), number.radix()).ok(),
        _ => None,
    };
    let message = match number {
        Some(FORMAT) => return Ok(()),
        Some(later) if later > FORMAT => {
            format!("format is {later}, of a later version of apertura; this one reads format {FORMAT}")
        }
        _ => format!("format is no version; expected {FORMAT}"),
    };
    Err(SceneTextError::at(text, format.span().start, message))
}

/// Where object `index` stands in a text that was read before. Looked up when something is wrong with it only.
fn object_spans(text: &str, index: usize) -> Spans {
    let document = table(text).ok();
    let entries = document.as_ref().and_then(|d| d.get_ref().get("object")).and_then(|e| e.get_ref().as_array());
    entries.and_then(|e| e.get(index)).map_or(Spans { whole: 0..0, fields: Vec::new() }, Spans::of)
}

/// Where the table of disturbances stands in a text that was read before.
fn disturbances_span(text: &str) -> Range<usize> {
    table(text).ok().and_then(|d| d.get_ref().get("disturbances").map(Spanned::span)).unwrap_or(0..0)
}

/// Where a table and its keys stand in the text.
struct Spans {
    whole: Range<usize>,
    fields: Vec<(String, Range<usize>)>,
}

impl Spans {
    fn of(value: &Spanned<DeValue<'_>>) -> Spans {
        let fields = match value.get_ref() {
            DeValue::Table(table) => table.iter().map(|(k, v)| (k.get_ref().to_string(), v.span())).collect(),
            _ => Vec::new(),
        };
        Spans { whole: value.span(), fields }
    }

    /// The value of `name`, or the whole table where it is not written out.
    fn field(&self, name: &str) -> Range<usize> {
        self.fields.iter().find(|(n, _)| n == name).map_or_else(|| self.whole.clone(), |(_, s)| s.clone())
    }
}

fn of_toml(text: &str, error: &toml::de::Error, otherwise: usize) -> SceneTextError {
    SceneTextError::at(text, error.span().map_or(otherwise, |s| s.start), one_line(error.message()))
}

fn utf8(bytes: &[u8]) -> Result<&str, SceneTextError> {
    std::str::from_utf8(bytes).map_err(|error| {
        let good = &bytes[..error.valid_up_to()];
        let text = String::from_utf8_lossy(good);
        SceneTextError::at(&text, text.len(), "not text; expected TOML in UTF-8".to_owned())
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radar::Carrier;
    use crate::scene::{Block, GaussianCluster, Line, Point, Polygon, Post, Wall};
    use proptest::prelude::*;

    fn scene() -> SceneFile {
        let objects = vec![
            Object::Point(Point { reflectivity: -2.5, ..Point::new(0.1 + 0.2, 1e-300) }),
            Object::Line(Line { direction_degrees: 30.0, ..Line::vertical(1.0, 2.0, 0.1, 75) }),
            Object::Gaussian(GaussianCluster { seed: 9, ..GaussianCluster::new([-5.0, 20.0], [1.0, 0.5], 40) }),
            Object::Wall(Wall { roughness_millimetres: 0.3, ..Wall::new(1.0, 9.0, 4.0, 0.0) }),
            Object::Box(Block { reflectivity: 0.5, seed: 3, ..Block::new([3.0, 9.0], [4.5, 1.8], 12.0) }),
            Object::Post(Post::new(-3.0, 9.0, 0.1)),
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
    fn the_physical_convention_is_written_by_its_name() {
        let radar = Radar { elements: 64, ..Radar::default() }.in_convention(Convention::Physical);
        let file = SceneFile { radar, ..scene() };
        let text = to_toml(&file).unwrap();
        assert!(text.contains("convention = \"physical\"") && !text.contains("spacing_metres = 0.000"), "{text}");
        assert_eq!(from_toml(&text).unwrap(), file);
    }

    #[test]
    fn antennas_are_written_in_place_of_the_elements_they_make() {
        let file = SceneFile { radar: Radar::default().of_pairs(3, 4).unwrap(), ..scene() };
        let text = to_toml(&file).unwrap();
        assert!(text.contains("receiver_x_metres") && !text.contains("elements = 12"), "{text}");
        assert_eq!(from_toml(&text).unwrap(), file);
    }

    #[test]
    fn a_line_without_a_direction_leads_straight_ahead() {
        let text = "[[object]]\nkind = \"line\"\nx_metres = 1\ny_start_metres = 2\nspacing_metres = 0.5\ncount = 3\n";
        let line = Object::Line(Line::vertical(1.0, 2.0, 0.5, 3));
        let file = from_toml(text).unwrap();
        assert_eq!(file.scene.objects, [line]);
        assert!(!to_toml(&file).unwrap().contains("direction"));
    }

    #[test]
    fn a_cross_section_is_read_as_reflectivity_and_a_budget_is_kept() {
        let text = "[radar]\nchirp_seconds = 5e-5\n[radar.budget]\nantenna_gain_dbi = 13\nhalf_power_width_degrees = 70\n[[object]]\n\
                    kind = \"point\"\nx_metres = 1\ny_metres = 2\ncross_section_dbsm = 20\n";
        let file = from_toml(text).unwrap();
        assert!((file.scene.objects[0].reflectivity() - 10.0).abs() < 1e-12);
        let budget = file.radar.budget.unwrap();
        assert_eq!((budget.antenna_gain_dbi, budget.half_power_width_degrees), (13.0, Some(70.0)));
        let written = to_toml(&file).unwrap();
        assert_eq!(from_toml(&written).unwrap(), file, "{written}");
    }

    #[test]
    fn an_empty_file_is_an_empty_scene() {
        assert_eq!(from_toml("").unwrap(), SceneFile::default());
        assert_eq!(from_toml(&to_toml(&SceneFile::default()).unwrap()).unwrap(), SceneFile::default());
    }

    #[test]
    fn faults_name_place_with_expectation() {
        let point = "[[object]]\nkind = \"point\"\nx_metres = 1\n";
        let crowd =
            |kind: &str, keys| format!("[[object]]\nkind = \"{kind}\"\nx_metres = 1\n{keys}\ncount = 1000000000000\n");
        for (text, line, parts) in [
            ("name = 3", 1, vec!["integer", "string"]),
            ("\ncolour = 3", 2, vec!["colour", "object", "radar"]),
            ("[radar]\ncarier = \"one-way\"", 2, vec!["carier", "carrier"]),
            ("[radar]\nelements = 1024\ncarrier_hz = -5", 3, vec!["carrier_hz", "above 0"]),
            ("[radar]\nelements = 3", 2, vec!["elements", "between 6"]),
            ("object = 3", 1, vec!["[[object]]"]),
            ("object = [3]", 1, vec!["object 1", "[[object]]"]),
            ("[[object]]\nx_metres = 1", 1, vec!["object 1", "kind", "gaussian"]),
            ("[[object]]\nkind = \"sphere\"", 2, vec!["sphere", "gaussian"]),
            (point, 1, vec!["object 1", "y_metres"]),
            (&format!("{point}y_metres = \"two\"\n"), 4, vec!["object 1", "string", "f64"]),
            (&format!("{point}y_metres = 2\ncolour = 1\n"), 5, vec!["object 1", "colour", "reflectivity"]),
            (&format!("{point}y_metres = nan\n"), 4, vec!["object 1", "y_metres", "NaN", "finite"]),
            (&format!("{point}y_metres = 2\n{point}y_metres = 1e13\n"), 8, vec!["object 2", "1e12"]),
            (
                "[[object]]\nkind = \"line\"\nx_metres = 1\ny_start_metres = 1\nspacing_metres = 1\ncount = -4",
                6,
                vec!["object 1", "-4"],
            ),
            ("[radar]\nsamples = 65536\nelements = 65536", 3, vec!["65536 elements", "1.0 TiB", "4.0 GiB"]),
            ("[radar]\nsamples = 65536\nelements = 65535", 2, vec!["samples"]),
            ("[radar]\nelements = 10000000000000", 2, vec!["elements", "65536"]),
            (&crowd("line", "y_start_metres = 1\nspacing_metres = 1"), 1, vec!["1000000000000 reflectors", "200000"]),
            (&crowd("gaussian", "y_metres = 1\nx_std_metres = 1\ny_std_metres = 1"), 1, vec!["reflectors", "200000"]),
            (&format!("notes = \"{}\"", ".".repeat(MAX_MARKS)), 1, vec!["values and tables"]),
            ("[[object]", 1, vec!["]"]),
            (
                "[[object]]\nkind = \"polygon\"\ncorners_metres = [[0, 5], [1, 6], [1, 5], [0, 6]]",
                3,
                vec!["object 1 (polygon)", "cross"],
            ),
            ("[[object]]\nkind = \"wall\"\nx_metres = 0\ny_metres = 5", 1, vec!["object 1", "length_metres"]),
            (
                "[[object]]\nkind = \"post\"\nx_metres = 0\ny_metres = 0\nradius_metres = 3",
                1,
                vec!["object 1 (post)", "element 0"],
            ),
            ("shadows = 3", 1, vec!["boolean"]),
            ("a = 1\na = 2", 2, vec!["duplicate"]),
        ] {
            let error = from_toml(text).unwrap_err();
            assert_eq!(error.line, line, "{text}\n{error}");
            assert!(parts.iter().all(|p| error.message.contains(p)), "{text}\n{error}");
        }
    }

    #[test]
    fn faults_of_the_link_budget_name_what_is_allowed() {
        let point = "[[object]]\nkind = \"point\"\nx_metres = 1\n";
        for (text, line, parts) in [
            (
                format!("{point}y_metres = 2\ncross_section_dbsm = nan\n"),
                5,
                vec!["object 1", "is NaN", "-2000 to 2000"],
            ),
            (
                format!("{point}y_metres = 2\nreflectivity = 1\ncross_section_dbsm = 0\n"),
                6,
                vec!["object 1", "beside reflectivity", "one of the two"],
            ),
            (
                "[[object]]\nkind = \"wall\"\ncross_section_dbsm = 3\n".to_owned(),
                3,
                vec!["object 1", "a wall has no cross_section_dbsm", "shape"],
            ),
            (
                "[radar.budget]\nnoise_figure_db = -1".to_owned(),
                1,
                vec!["radar.budget.noise_figure_db is -1", "0 to 100 dB", "take some away"],
            ),
        ] {
            let error = from_toml(&text).unwrap_err();
            assert_eq!(error.line, line, "{text}\n{error}");
            assert!(parts.iter().all(|p| error.message.contains(p)), "{text}\n{error}");
        }
    }

    #[test]
    fn a_table_of_somebody_elses_travels_along() {
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

    proptest! {
        #[test]
        fn any_text_is_read_or_refused(text in "\\PC{0,40}(\n(\\[\\[object\\]\\]|kind = \"point\"|x_metres = [0-9e.-]{1,6}|\\PC{0,12})){0,6}") {
            if let Err(error) = from_toml(&text) {
                prop_assert!(error.line <= text.matches('\n').count() + 1);
            }
        }

        #[test]
        fn positions_keep_every_bit(x in -1e12f64..1e12, y in 1e-3f64..1e12, reflectivity in -1e100f64..1e100) {
            let objects = vec![Object::Point(Point { reflectivity, ..Point::new(x, y) })];
            let file = SceneFile { scene: Scene { objects, ..Scene::default() }, radar: Radar::default() };
            prop_assert_eq!(from_toml(&to_toml(&file).unwrap()).unwrap(), file);
        }
    }
}
