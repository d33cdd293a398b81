//! Scenes read from TOML, with errors that name the line. Format 1 has no key `format`; format 2, with names of objects, is written where one has a name.

use super::content::{SceneFile, SceneTextError, one_line};
use super::objects::objects;
use crate::radar::Radar;
use crate::scene::{Disturbances, Scene, SceneError, yes};
use serde::Deserialize;
use serde::de::{DeserializeOwned, IgnoredAny};
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue, ValueDeserializer};

/// The latest format of scenes that this program knows.
pub(super) const FORMAT: i64 = 2;

type ReadScene<T> = Result<(SceneFile, Option<T>), SceneTextError>;

/// Most values and tables of a text, counted by the punctuation marks that come with each: the largest scene needs some three million.
const MAX_MARKS: usize = 4_000_000;

/// Reads a scene from text and checks that it can be simulated.
/// # Errors
/// [`SceneTextError`] names the line, the key or object, and what was expected.
pub fn from_toml(text: &str) -> Result<SceneFile, SceneTextError> {
    Ok(checked::<IgnoredAny>(text, None)?.0)
}

fn checked<T: DeserializeOwned>(text: &str, beside: Option<&str>) -> ReadScene<T> {
    let (file, other) = parse(text, beside)?;
    file.scene.validate(&file.radar).map_err(|error| {
        let span = match &error {
            SceneError::Value { object, field, .. } => span_of(text, "object", Some(*object), field),
            SceneError::Outline { object, .. } => span_of(text, "object", Some(*object), "corners_metres"),
            SceneError::OnElement { object, .. } | SceneError::Covers { object, .. } => {
                span_of(text, "object", Some(*object), "")
            }
            SceneError::Elements(_) | SceneError::Disturbance { .. } => span_of(text, "disturbances", None, ""),
            SceneError::TooMany { .. } | SceneError::Radar(_) => 0..0,
        };
        SceneTextError::at(text, span.start, error.to_string())
    })?;
    Ok((file, other))
}

/// Reads a text of [`to_toml_beside`](super::to_toml_beside); the second is `None` where the text has no `key`.
///
/// The scene need not be one that can be simulated: a user may have left a point on an element of the array.
/// # Errors
/// As [`from_toml`].
pub fn from_toml_beside<T: DeserializeOwned>(text: &str, key: &str) -> ReadScene<T> {
    let (file, other) = parse(text, Some(key))?;
    file.scene.check_count().map_err(|e| SceneTextError::at(text, 0, e.to_string()))?;
    Ok((file, other))
}

pub(super) fn from_bytes<T: DeserializeOwned>(bytes: &[u8], beside: Option<&str>) -> ReadScene<T> {
    checked(utf8(bytes)?, beside)
}

fn table(text: &str) -> Result<Spanned<DeTable<'_>>, SceneTextError> {
    let marks = text.bytes().filter(|b| b"=,.[{".contains(b)).count();
    if marks > MAX_MARKS {
        let message = format!("the text asks for {marks} values and tables; at most {MAX_MARKS} are read");
        return Err(SceneTextError::at(text, 0, message));
    }
    DeTable::parse(text).map_err(|e| of_toml(text, &e, 0))
}

fn parse<T: DeserializeOwned>(text: &str, beside: Option<&str>) -> ReadScene<T> {
    /// All keys but the objects, which are read one by one. Their field, and the app's of a recording, are for the message about an unknown key.
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
    if let Some(recording) = document.get("recording") {
        let message = "this is a recording; expected a scene".to_owned();
        return Err(SceneTextError::at(text, recording.span().start, message));
    }
    check_format(text, &document)?;
    document.remove("format");
    let entries = document.remove("object");
    let start = span.start;
    let wrong = |e: toml::de::Error| of_toml(text, &e, start);
    let other = beside.and_then(|key| document.remove(key)).map(|v| T::deserialize(ValueDeserializer::from(v)));
    let other = other.transpose().map_err(wrong)?;
    let head = ValueDeserializer::from(Spanned::new(span.clone(), DeValue::Table(document)));
    let head = Head::deserialize(head).map_err(wrong)?;
    head.radar.validate().map_err(|error| {
        SceneTextError::at(text, span_of(text, "radar", None, error.field()).start, error.to_string())
    })?;
    let objects = entries.map(|e| objects(text, e)).transpose()?.unwrap_or_default();
    let Head { name, notes, noise_seed, shadows, radar, disturbances, .. } = head;
    let scene = Scene { name, notes, noise_seed, shadows, disturbances, objects };
    Ok((SceneFile { scene, radar }, other))
}

/// Refuses a scene of a later format before its unknown keys.
fn check_format(text: &str, document: &DeTable<'_>) -> Result<(), SceneTextError> {
    let Some(format) = document.get("format") else { return Ok(()) };
    let number = match format.get_ref() {
        DeValue::Integer(number) => i64::from_str_radix(number.as_str(), number.radix()).ok(),
        _ => None,
    };
    let message = match number {
        Some(1..=FORMAT) => return Ok(()),
        Some(later) if later > FORMAT => {
            format!("format is {later}, of a later version of apertura; this one reads formats 1 to {FORMAT}")
        }
        _ => format!("format is no version; expected 1 to {FORMAT}"),
    };
    Err(SceneTextError::at(text, format.span().start, message))
}

/// The place of a field of a table, or of the object with this index under `key`, in a text read before; else that of the table. For errors only.
pub(super) fn span_of(text: &str, key: &str, index: Option<usize>, field: &str) -> Range<usize> {
    let document = table(text).ok();
    let value = document.as_ref().and_then(|document| document.get_ref().get(key));
    let value = value.and_then(|value| match index {
        Some(index) => value.get_ref().as_array()?.get(index),
        None => Some(value),
    });
    let field = match value.map(Spanned::get_ref) {
        Some(DeValue::Table(table)) => table.get(field),
        _ => None,
    };
    field.or(value).map_or(0..0, Spanned::span)
}

pub(super) fn of_toml(text: &str, error: &toml::de::Error, otherwise: usize) -> SceneTextError {
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
    use super::super::write::to_toml;
    use super::*;
    use crate::scene::{Line, Object};

    #[test]
    fn a_line_without_a_direction_leads_straight_ahead() {
        let text = "[[object]]\nkind = \"line\"\nx_metres = 1\ny_start_metres = 2\nspacing_metres = 0.5\ncount = 3\n";
        let line = Object::Line(Line::vertical(1.0, 2.0, 0.5, 3));
        let file = from_toml(text).unwrap();
        assert_eq!(file.scene.objects, [line]);
        assert!(!to_toml(&file).unwrap().contains("direction"));
    }

    #[test]
    fn a_cross_section_is_read_as_reflectivity() {
        let text = "[[object]]\nkind = \"point\"\nx_metres = 1\ny_metres = 2\ncross_section_dbsm = 20\n";
        let file = from_toml(text).unwrap();
        assert!((file.scene.objects[0].reflectivity() - 10.0).abs() < 1e-12);
        assert_eq!(from_toml(&to_toml(&file).unwrap()).unwrap(), file);
    }

    #[test]
    fn faults_name_place_with_expectation() {
        let point = "[[object]]\nkind = \"point\"\nx_metres = 1\n";
        let crowd =
            |kind: &str, keys| format!("[[object]]\nkind = \"{kind}\"\nx_metres = 1\n{keys}\ncount = 1000000000000\n");
        let crossed = "[[object]]\nkind = \"polygon\"\ncorners_metres = [[0, 5], [1, 6], [1, 5], [0, 6]]";
        let inside = "[[object]]\nkind = \"post\"\nx_metres = 0\ny_metres = 0\nradius_metres = 3";
        let section = |keys: &str| format!("{point}y_metres = 2\n{keys}\n");
        let endless = crowd("line", "y_start_metres = 1\nspacing_metres = 1");
        let wall = "[[object]]\nkind = \"wall\"\ncross_section_dbsm = 3\n";
        for (text, line, parts) in [
            ("name = 3", 1, vec!["integer", "string"]),
            ("format = 3\n[recording]\nfile = \"a.npz\"", 2, vec!["this is a recording; expected a scene"]),
            ("\ncolour = 3", 2, vec!["colour", "object", "radar"]),
            ("[radar]\ncarier = \"one-way\"", 2, vec!["carier", "carrier"]),
            ("[radar]\nelements = 1024\ncarrier_hz = -5", 3, vec!["carrier_hz", "above 0"]),
            ("[radar]\nelements = 1", 2, vec!["elements", "between 2"]),
            ("object = 3", 1, vec!["[[object]]"]),
            ("object = [3]", 1, vec!["object 1", "[[object]]"]),
            ("[[object]]\nx_metres = 1", 1, vec!["object 1", "kind", "gaussian"]),
            ("[[object]]\nkind = \"sphere\"", 2, vec!["sphere", "gaussian"]),
            (point, 1, vec!["object 1", "y_metres"]),
            (&format!("{point}y_metres = \"two\"\n"), 4, vec!["object 1", "string", "f64"]),
            (&format!("{point}y_metres = 2\ncolour = 1\n"), 5, vec!["object 1", "colour", "reflectivity"]),
            (&format!("{point}y_metres = nan\n"), 4, vec!["object 1", "y_metres", "NaN", "finite"]),
            (&format!("{point}y_metres = 2\n{point}y_metres = 1e13\n"), 8, vec!["object 2", "1e12"]),
            (&endless.replace("1000000000000", "-4"), 6, vec!["object 1", "-4"]),
            ("[radar]\nsamples = 65536\nelements = 65536", 3, vec!["65536 elements", "1.0 TiB", "4.0 GiB"]),
            ("[radar]\nsamples = 65536\nelements = 65535", 2, vec!["samples"]),
            ("[radar]\nelements = 10000000000000", 2, vec!["elements", "65536"]),
            (&endless, 1, vec!["1000000000000 reflectors", "200000"]),
            (&crowd("gaussian", "y_metres = 1\nx_std_metres = 1\ny_std_metres = 1"), 1, vec!["reflectors", "200000"]),
            (&format!("notes = \"{}\"", ".".repeat(MAX_MARKS)), 1, vec!["values and tables"]),
            ("[[object]", 1, vec!["]"]),
            (crossed, 3, vec!["object 1 (polygon)", "cross"]),
            ("[[object]]\nkind = \"wall\"\nx_metres = 0\ny_metres = 5", 1, vec!["object 1", "length_metres"]),
            (inside, 1, vec!["object 1 (post)", "element 0"]),
            ("shadows = 3", 1, vec!["boolean"]),
            ("a = 1\na = 2", 2, vec!["duplicate"]),
            (&section("cross_section_dbsm = nan"), 5, vec!["object 1", "is NaN", "-2000 to 2000"]),
            (&section("reflectivity = 1\ncross_section_dbsm = 0"), 6, vec!["beside reflectivity"]),
            (wall, 3, vec!["a wall has no cross_section_dbsm", "shape"]),
            ("[radar.budget]\nnoise_figure_db = -1", 1, vec!["radar.budget.noise_figure_db is -1", "0 to 100 dB"]),
        ] {
            let error = from_toml(text).unwrap_err();
            assert_eq!(error.line, line, "{text}\n{error}");
            assert!(parts.iter().all(|p| error.message.contains(p)), "{text}\n{error}");
        }
    }
}
