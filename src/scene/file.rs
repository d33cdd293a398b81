//! Scene files: TOML that a person can write, and the thesis author's `.npz` archives.
//!
//! ```toml
//! name = "A pair and a wall"
//! notes = "What to look for."
//! noise_seed = 12          # optional; picks the noise of the floor, 0 otherwise
//!
//! [radar]                  # optional; only what differs from table 3.1
//! carrier = "two-way"
//!
//! [[object]]
//! kind = "point"           # or "line", "gaussian"
//! x_metres = -4.0
//! y_metres = 12.5
//! reflectivity = 0.5       # optional, 1 otherwise
//! ```
//!
//! Every error names the line and what was expected there.

use super::{GaussianCluster, Line, Object, Point, Scene, SceneError, npz};
use crate::files::{npz::NpzError, write_bytes};
use crate::radar::{Radar, RadarError};
use serde::{Deserialize, Serialize, de::IgnoredAny};
use std::io;
use std::ops::Range;
use std::path::{Path, PathBuf};
use toml::Spanned;
use toml::de::{DeTable, DeValue, ValueDeserializer};

/// A scene and the radar that looks at it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SceneFile {
    /// The scene.
    pub scene: Scene,
    /// The radar: table 3.1 unless the file says otherwise.
    pub radar: Radar,
}

/// What is wrong with a scene's text, and where.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("line {line}, column {column}: {message}")]
pub struct SceneTextError {
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// What is wrong and what was expected.
    pub message: String,
}

/// Why a scene file could not be read or written.
#[derive(Debug, thiserror::Error)]
pub enum SceneFileError {
    /// The system could not read or write the file.
    #[error("{}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// The TOML is not a scene.
    #[error("{}: {source}", path.display())]
    Text {
        /// The file.
        path: PathBuf,
        /// What and where.
        source: SceneTextError,
    },
    /// The archive is not a scene.
    #[error("{}: {source}", path.display())]
    Archive {
        /// The file.
        path: PathBuf,
        /// Which key, and what was expected.
        source: NpzError,
    },
    /// The archive's reflectors can't be simulated.
    #[error("{}: {source}", path.display())]
    Scene {
        /// The file.
        path: PathBuf,
        /// Which reflector, and why.
        source: SceneError,
    },
    /// The scene can't be written as TOML.
    #[error("{}: {source}", path.display())]
    Unwritable {
        /// The file.
        path: PathBuf,
        /// The value that TOML can't hold.
        source: toml::ser::Error,
    },
    /// Neither kind of scene file.
    #[error("{}: not a scene file by its name; expected one ending in .toml or .npz", path.display())]
    Extension {
        /// The file.
        path: PathBuf,
    },
}

/// The two kinds of scene file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Everything, readable.
    Toml,
    /// Positions only, as the thesis author's program reads and writes them.
    Npz,
}

impl Format {
    /// The format that a file's name asks for.
    ///
    /// # Errors
    /// [`SceneFileError::Extension`] for any ending but `.toml` and `.npz`.
    pub fn of_path(path: &Path) -> Result<Format, SceneFileError> {
        let extension = path.extension().map(|e| e.to_ascii_lowercase());
        match extension.as_deref().and_then(|e| e.to_str()) {
            Some("toml") => Ok(Format::Toml),
            Some("npz") => Ok(Format::Npz),
            _ => Err(SceneFileError::Extension { path: path.to_owned() }),
        }
    }
}

/// Reads a scene file and checks that it can be simulated.
///
/// # Errors
/// [`SceneFileError`] names the file, the line or key, and what was expected.
pub fn load(path: &Path) -> Result<SceneFile, SceneFileError> {
    let owned = || path.to_owned();
    match Format::of_path(path)? {
        Format::Toml => {
            let bytes = std::fs::read(path).map_err(|source| SceneFileError::Io { path: owned(), source })?;
            utf8(&bytes).and_then(from_toml).map_err(|source| SceneFileError::Text { path: owned(), source })
        }
        Format::Npz => {
            let scene = npz::read(path).map_err(|source| SceneFileError::Archive { path: owned(), source })?;
            let radar = Radar::default();
            scene.validate(&radar).map_err(|source| SceneFileError::Scene { path: owned(), source })?;
            Ok(SceneFile { scene, radar })
        }
    }
}

/// Writes a scene file in one step. An `.npz` keeps the reflectors' positions only.
///
/// # Errors
/// [`SceneFileError`] when the ending is neither `.toml` nor `.npz`, or the file can't be written.
pub fn save(path: &Path, file: &SceneFile) -> Result<(), SceneFileError> {
    let owned = || path.to_owned();
    match Format::of_path(path)? {
        Format::Toml => {
            let text = to_toml(file).map_err(|source| SceneFileError::Unwritable { path: owned(), source })?;
            write_bytes(path, text.as_bytes()).map_err(|source| SceneFileError::Io { path: owned(), source })
        }
        Format::Npz => {
            npz::write(path, &file.scene).map_err(|source| SceneFileError::Archive { path: owned(), source })
        }
    }
}

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
        #[serde(skip_serializing_if = "toml::Table::is_empty")]
        radar: toml::Table,
        object: &'a [Object],
    }
    let Scene { name, notes, noise_seed, objects } = &file.scene;
    let noise_seed = Some(*noise_seed).filter(|seed| *seed != 0);
    let usual = toml::Table::try_from(Radar::default())?;
    let mut radar = toml::Table::try_from(&file.radar)?;
    radar.retain(|key, value| usual.get(key) != Some(value));
    toml::to_string_pretty(&Document { name, notes, noise_seed, radar, object: objects })
}

/// Reads a scene from text and checks that it can be simulated.
///
/// # Errors
/// [`SceneTextError`] names the line, the key or object, and what was expected.
pub fn from_toml(text: &str) -> Result<SceneFile, SceneTextError> {
    /// All but the objects, which need a closer look; the field is there for the message about an unknown one.
    #[derive(Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Head {
        #[serde(default)]
        name: String,
        #[serde(default)]
        notes: String,
        #[serde(default)]
        noise_seed: u64,
        #[serde(default)]
        radar: Radar,
        #[serde(default, rename = "object")]
        _objects: Option<IgnoredAny>,
    }

    let at = |span: Range<usize>, message: String| SceneTextError::at(text, span.start, message);
    let of_toml = |error: toml::de::Error, fallback: &Range<usize>| {
        at(error.span().unwrap_or(fallback.clone()), one_line(error.message()))
    };
    let whole = 0..text.len();
    let document = DeTable::parse(text).map_err(|e| of_toml(e, &whole))?;
    let span = document.span();
    let mut document = document.into_inner();
    let radar_spans = document.get("radar").map(Spans::of);
    let entries = document.remove("object");
    let head = ValueDeserializer::from(Spanned::new(span.clone(), DeValue::Table(document)));
    let head = Head::deserialize(head).map_err(|e| of_toml(e, &span))?;

    head.radar.validate().map_err(|error| {
        let (RadarError::NotPositive { field, .. } | RadarError::Count { field, .. }) = &error;
        at(radar_spans.as_ref().map_or(0..0, |s| s.field(field)), error.to_string())
    })?;

    let (mut objects, mut spans) = (Vec::new(), Vec::new());
    if let Some(entries) = entries {
        let span = entries.span();
        let DeValue::Array(entries) = entries.into_inner() else {
            return Err(at(span, "\"object\" is not a list; expected [[object]] tables".to_owned()));
        };
        for (index, entry) in entries.into_iter().enumerate() {
            let place = Spans::of(&entry);
            let object = object(entry).map_err(|(span, message)| {
                at(span.unwrap_or(place.whole.clone()), format!("object {index}: {message}"))
            })?;
            objects.push(object);
            spans.push(place);
        }
    }
    let scene = Scene { name: head.name, notes: head.notes, noise_seed: head.noise_seed, objects };
    scene.validate(&head.radar).map_err(|error| {
        let span = match &error {
            SceneError::Value { object, field, .. } => spans[*object].field(field),
            SceneError::OnElement { object, .. } => spans[*object].whole.clone(),
            SceneError::TooMany { .. } => 0..0,
        };
        at(span, error.to_string())
    })?;
    Ok(SceneFile { scene, radar: head.radar })
}

/// Reads one `[[object]]`. Its kind is taken off first, so that the other keys are read with their places known.
fn object(entry: Spanned<DeValue<'_>>) -> Result<Object, (Option<Range<usize>>, String)> {
    const KINDS: &str = "expected \"point\", \"line\" or \"gaussian\"";
    let span = entry.span();
    let DeValue::Table(mut table) = entry.into_inner() else {
        return Err((Some(span), "not a table; expected [[object]] with a kind".to_owned()));
    };
    let Some(kind) = table.remove("kind") else {
        return Err((Some(span), format!("missing key \"kind\"; {KINDS}")));
    };
    let rest = ValueDeserializer::from(Spanned::new(span, DeValue::Table(table)));
    let object = match kind.get_ref().as_str() {
        Some("point") => Point::deserialize(rest).map(Object::Point),
        Some("line") => Line::deserialize(rest).map(Object::Line),
        Some("gaussian") => GaussianCluster::deserialize(rest).map(Object::Gaussian),
        Some(other) => return Err((Some(kind.span()), format!("unknown kind \"{other}\"; {KINDS}"))),
        None => return Err((Some(kind.span()), format!("\"kind\" is not a string; {KINDS}"))),
    };
    object.map_err(|e| (e.span(), one_line(e.message())))
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

impl SceneTextError {
    pub(crate) fn at(text: &str, offset: usize, message: String) -> Self {
        let before = text.get(..offset).unwrap_or(text);
        let line_start = before.rfind('\n').map_or(0, |i| i + 1);
        SceneTextError {
            line: before.matches('\n').count() + 1,
            column: before[line_start..].chars().count() + 1,
            message,
        }
    }
}

fn utf8(bytes: &[u8]) -> Result<&str, SceneTextError> {
    std::str::from_utf8(bytes).map_err(|error| {
        let good = &bytes[..error.valid_up_to()];
        let text = String::from_utf8_lossy(good);
        SceneTextError::at(&text, text.len(), "not text; expected TOML in UTF-8".to_owned())
    })
}

fn one_line(message: &str) -> String {
    message.lines().collect::<Vec<_>>().join(", ").replace('`', "\"")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radar::Carrier;
    use proptest::prelude::*;

    fn scene() -> SceneFile {
        let objects = vec![
            Object::Point(Point { x_metres: 0.1 + 0.2, y_metres: 1e-300, reflectivity: -2.5 }),
            Object::Line(Line { direction_degrees: 30.0, ..Line::vertical(1.0, 2.0, 0.1, 75) }),
            Object::Gaussian(GaussianCluster {
                x_metres: -5.0,
                y_metres: 20.0,
                x_std_metres: 1.0,
                y_std_metres: 0.5,
                count: 40,
                seed: 9,
                reflectivity: 1.0,
            }),
        ];
        let scene = Scene {
            name: "All \"three\"".to_owned(),
            notes: "First line.\nSecond: 'x'.".to_owned(),
            noise_seed: 9,
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
    fn a_line_without_a_direction_leads_straight_ahead() {
        let text = "[[object]]\nkind = \"line\"\nx_metres = 1\ny_start_metres = 2\nspacing_metres = 0.5\ncount = 3\n";
        let line = Object::Line(Line::vertical(1.0, 2.0, 0.5, 3));
        let file = from_toml(text).unwrap();
        assert_eq!(file.scene.objects, [line]);
        assert!(!to_toml(&file).unwrap().contains("direction"));
    }

    #[test]
    fn an_empty_file_is_an_empty_scene() {
        assert_eq!(from_toml("").unwrap(), SceneFile::default());
        assert_eq!(from_toml(&to_toml(&SceneFile::default()).unwrap()).unwrap(), SceneFile::default());
    }

    #[test]
    fn faults_name_their_place_and_what_was_expected() {
        let point = "[[object]]\nkind = \"point\"\nx_metres = 1\n";
        for (text, line, parts) in [
            ("name = 3", 1, vec!["integer", "string"]),
            ("\ncolour = 3", 2, vec!["colour", "object", "radar"]),
            ("[radar]\ncarier = \"one-way\"", 2, vec!["carier", "carrier"]),
            ("[radar]\nelements = 1024\ncarrier_hz = -5", 3, vec!["carrier_hz", "above 0"]),
            ("[radar]\nelements = 3", 2, vec!["elements", "between 6"]),
            ("object = 3", 1, vec!["[[object]]"]),
            ("object = [3]", 1, vec!["object 0", "[[object]]"]),
            ("[[object]]\nx_metres = 1", 1, vec!["object 0", "kind", "gaussian"]),
            ("[[object]]\nkind = \"sphere\"", 2, vec!["sphere", "gaussian"]),
            (point, 1, vec!["object 0", "y_metres"]),
            (&format!("{point}y_metres = \"two\"\n"), 4, vec!["object 0", "string", "f64"]),
            (&format!("{point}y_metres = 2\ncolour = 1\n"), 5, vec!["object 0", "colour", "reflectivity"]),
            (&format!("{point}y_metres = nan\n"), 4, vec!["object 0", "y_metres", "NaN", "finite"]),
            (&format!("{point}y_metres = 2\n{point}y_metres = 1e13\n"), 8, vec!["object 1", "1e12"]),
            (
                "[[object]]\nkind = \"line\"\nx_metres = 1\ny_start_metres = 1\nspacing_metres = 1\ncount = -4",
                6,
                vec!["object 0", "-4"],
            ),
            ("[[object]", 1, vec!["]"]),
            ("a = 1\na = 2", 2, vec!["duplicate"]),
        ] {
            let error = from_toml(text).unwrap_err();
            assert_eq!(error.line, line, "{text}\n{error}");
            assert!(parts.iter().all(|p| error.message.contains(p)), "{text}\n{error}");
        }
    }

    #[test]
    fn files_name_themselves() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.toml");
        assert!(load(&path).unwrap_err().to_string().contains("a.toml"));
        std::fs::write(&path, b"name = \"\xff\"").unwrap();
        assert!(load(&path).unwrap_err().to_string().contains("UTF-8"));
        assert!(load(Path::new("scene.yaml")).unwrap_err().to_string().contains(".toml or .npz"));
        save(&path, &scene()).unwrap();
        assert_eq!(load(&path).unwrap(), scene());
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
            let objects = vec![Object::Point(Point { x_metres: x, y_metres: y, reflectivity })];
            let file = SceneFile { scene: Scene { objects, ..Scene::default() }, radar: Radar::default() };
            prop_assert_eq!(from_toml(&to_toml(&file).unwrap()).unwrap(), file);
        }
    }
}
