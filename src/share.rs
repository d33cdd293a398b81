//! Sharing of a scene with radar and view as one line of text, which can be pasted anywhere and opened by another copy of the program.
//!
//! The text is `apertura:1:` and a zlib stream of TOML in the alphabet of URLs (RFC 4648, section 5). The TOML is a scene file followed by a table `[shared]`.
//! The stream's checksum reveals a line that lost a letter. Line breaks within it, as in mails, don't matter.

use crate::maps::Normalisation;
use crate::maps::cfar::Cfar;
use crate::picture::ColourMap;
use crate::radar::LayoutKind;
use crate::scene::file::{SceneFile, SceneTextError, from_toml_beside, to_toml_beside};
use crate::scene::{SceneError, is_default};
use crate::signal::Floor;
use crate::view::{Projection, View};
use base64::Engine;
use base64::engine::general_purpose::URL_SAFE_NO_PAD;
use flate2::Compression;
use flate2::bufread::ZlibDecoder;
use flate2::write::ZlibEncoder;
use serde::{Deserialize, Serialize};
use std::io::{Read, Write};

/// The beginning of every shared text.
pub const PREFIX: &str = "apertura:";
/// The version that this program writes and reads.
pub const VERSION: &str = "1";
/// Largest TOML within a text, bytes: a scene of some fifty thousand objects.
pub const MAX_TOML_BYTES: usize = 4 << 20;
/// Longest text that is read, letters: the largest TOML without any compression.
pub const MAX_LINK_LETTERS: usize = 6 << 20;
const KEY: &str = "shared";
const MIN_EXTENT_PART: f32 = 0.005;

/// A scene with its radar and its view.
#[derive(Debug, Clone, PartialEq)]
pub struct SharedScene {
    pub file: SceneFile,
    pub view: SharedView,
}

/// View of a shared scene: conditions, method and visible parts.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SharedView {
    /// The floor beneath the reflectors.
    pub floor: Floor,
    pub normalisation: Normalisation,
    pub colours: ColourMap,
    /// Whether maps are drawn over x and y, not over cos(theta) and range.
    pub cartesian: bool,
    /// The visible part of range-angle maps; left is the first column.
    pub range_angle_part: VisiblePart,
    pub cartesian_part: VisiblePart,
    pub target_eta: f32,
    /// The detector in place of the thresholds, if one is in use.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cfar: Option<Cfar>,
    /// eta of the method, where it isn't the method's own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub eta: Option<f32>,
    pub method: String,
    /// The elements that methods use; `None` for the two ends.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub layout: Option<LayoutKind>,
    pub marks: bool,
    pub theory: bool,
    /// The step of a lesson that comes with the program.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lesson: Option<LessonPlace>,
    /// Time at which moving objects are looked at, seconds.
    #[serde(default, skip_serializing_if = "is_default")]
    pub time_seconds: f64,
}

/// Part of a map, as fractions of its width and height from the lower left.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct VisiblePart {
    pub left: f32,
    pub bottom: f32,
    pub right: f32,
    pub top: f32,
}

impl Default for VisiblePart {
    fn default() -> Self {
        VisiblePart { left: 0.0, bottom: 0.0, right: 1.0, top: 1.0 }
    }
}

#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LessonPlace {
    /// Name of the lesson.
    pub id: String,
    /// The step, from 1.
    pub step: usize,
}

/// The reason why a text can't be opened, or a scene not be written as text.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ShareError {
    #[error("the text begins with \"{0}\"; expected \"{PREFIX}{VERSION}:\"")]
    Prefix(String),
    #[error(
        "the text is of version \"{0}\"; this program reads version {VERSION}: open it with the program that wrote it"
    )]
    Version(String),
    #[error("the text holds more than {} MiB; save the scene as a file instead", MAX_TOML_BYTES >> 20)]
    Large,
    #[error("the text is damaged ({0}): copy all of it again, from \"{PREFIX}\" to the last letter")]
    Damaged(String),
    #[error("the text holds no scene: {0}")]
    Scene(#[from] SceneTextError),
    #[error("the text's {0}")]
    Unusable(#[from] SceneError),
    #[error("the text's {field} {problem}")]
    View { field: &'static str, problem: String },
    #[error("the scene can't be written as text: {0}")]
    Unwritable(String),
}

/// Whether a text begins as a shared one.
pub fn is_shared(text: &str) -> bool {
    text.trim_start().starts_with(PREFIX)
}

impl SharedScene {
    /// The scene as text.
    /// # Errors
    /// [`ShareError::Large`] and [`ShareError::Unwritable`] for a scene with more than fits, or a number that TOML can't hold.
    pub fn to_text(&self) -> Result<String, ShareError> {
        let unwritable = |e: String| ShareError::Unwritable(e);
        let toml = to_toml_beside(&self.file, KEY, &self.view).map_err(|e| unwritable(e.to_string()))?;
        if toml.len() > MAX_TOML_BYTES {
            return Err(ShareError::Large);
        }
        let mut packed = ZlibEncoder::new(Vec::new(), Compression::best());
        let packed = packed.write_all(toml.as_bytes()).and_then(|()| packed.finish());
        let packed = packed.map_err(|e| unwritable(e.to_string()))?;
        Ok(format!("{PREFIX}{VERSION}:{}", URL_SAFE_NO_PAD.encode(packed)))
    }

    /// Reads a text, in bounded memory.
    /// # Errors
    /// [`ShareError`] with the error and the expected text.
    pub fn from_text(text: &str) -> Result<SharedScene, ShareError> {
        if text.len() > MAX_LINK_LETTERS {
            return Err(ShareError::Large);
        }
        let letters: String = text.chars().filter(|c| !c.is_whitespace()).collect();
        let parts = letters.strip_prefix(PREFIX).and_then(|rest| rest.split_once(':'));
        let wrong = || ShareError::Prefix(letters.chars().take(PREFIX.len() + 2).collect());
        let (version, packed) = parts.ok_or_else(wrong)?;
        if version != VERSION {
            return Err(ShareError::Version(version.chars().take(20).collect()));
        }
        let packed = URL_SAFE_NO_PAD.decode(packed).map_err(|e| ShareError::Damaged(e.to_string()))?;
        let toml = unpack(&packed)?;
        let (file, view) = from_toml_beside::<SharedView>(&toml, KEY)?;
        let view = view.ok_or(ShareError::View { field: "table [shared]", problem: "is missing".to_owned() })?;
        file.scene.validate(&file.radar)?;
        view.check()?;
        Ok(SharedScene { file, view })
    }
}

/// The text of a zlib stream; an error beyond [`MAX_TOML_BYTES`].
fn unpack(packed: &[u8]) -> Result<String, ShareError> {
    let damaged = |e: std::io::Error| ShareError::Damaged(e.to_string());
    let mut stream = ZlibDecoder::new(packed);
    let mut bytes = Vec::new();
    stream.by_ref().take(MAX_TOML_BYTES as u64 + 1).read_to_end(&mut bytes).map_err(damaged)?;
    if bytes.len() > MAX_TOML_BYTES {
        return Err(ShareError::Large);
    }
    if !stream.into_inner().is_empty() {
        return Err(ShareError::Damaged("more follows its end".to_owned()));
    }
    String::from_utf8(bytes).map_err(|e| ShareError::Damaged(e.to_string()))
}

impl SharedView {
    /// The shared part of a view: colours, conditions and method, the visible parts of maps over either coordinates, and a lesson.
    pub fn of(view: &View, parts: [VisiblePart; 2], lesson: Option<LessonPlace>) -> SharedView {
        let View { floor, normalisation, colours, projection, target_eta, cfar, .. } = *view;
        let [range_angle_part, cartesian_part] = parts;
        SharedView {
            floor,
            normalisation,
            colours,
            cartesian: projection == Projection::Cartesian,
            range_angle_part,
            cartesian_part,
            target_eta,
            cfar,
            eta: view.method_eta.get(&view.method).copied(),
            method: view.method.clone(),
            layout: view.layout.clone(),
            marks: view.show_reflectors,
            theory: view.show_theory,
            lesson,
            time_seconds: 0.0,
        }
    }

    /// Sets the shared values in a view; the others stay.
    pub fn show_in(self, view: &mut View) {
        view.set_method_eta(&self.method, self.eta);
        view.detect_by(self.cfar);
        (view.floor, view.normalisation, view.colours) = (self.floor, self.normalisation, self.colours);
        (view.target_eta, view.show_reflectors, view.show_theory) = (self.target_eta, self.marks, self.theory);
        view.projection = if self.cartesian { Projection::Cartesian } else { Projection::RangeAngle };
        (view.method, view.layout) = (self.method, self.layout);
    }

    /// Checks values from outside against the ranges that the app can show.
    fn check(&self) -> Result<(), ShareError> {
        let wrong = |field, problem: String| Err(ShareError::View { field, problem });
        // Both types check their bounds when they read their own names.
        if let Err(error) = self.floor.to_string().parse::<Floor>() {
            return wrong("floor", format!("can't be: {error}"));
        }
        if let Err(error) = self.normalisation.to_string().parse::<Normalisation>() {
            return wrong("normalisation", format!("can't be: {error}"));
        }
        for (field, eta) in [("target_eta", Some(self.target_eta)), ("eta", self.eta)] {
            if let Some(eta) = eta.filter(|eta| !(0.0..=1.0).contains(eta)) {
                return wrong(field, format!("is {eta}; expected 0 to 1"));
            }
        }
        if !(self.time_seconds.is_finite() && self.time_seconds >= 0.0) {
            return wrong("time_seconds", format!("is {}; expected 0 or more", self.time_seconds));
        }
        for (field, part) in [("range_angle_part", self.range_angle_part), ("cartesian_part", self.cartesian_part)] {
            let VisiblePart { left, bottom, right, top } = part;
            let inside = |low: f32, high: f32| low >= 0.0 && high <= 1.0 && high - low >= MIN_EXTENT_PART;
            if !(inside(left, right) && inside(bottom, top)) {
                let expected = "expected edges from 0 to 1, the right and the top ones larger";
                return wrong(field, format!("is {part:?}; {expected}"));
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radar::{Carrier, DecibelMilliwatts, Decibels, Radar};
    use crate::scene::{Object, Point, Scene, presets};
    use proptest::prelude::*;

    fn view() -> SharedView {
        SharedView {
            floor: Floor::Snr(Decibels(12.5)),
            normalisation: Normalisation::DynamicRange(Decibels(60.0)),
            colours: ColourMap::Viridis,
            cartesian: true,
            range_angle_part: VisiblePart { left: 0.25, ..VisiblePart::default() },
            cartesian_part: VisiblePart::default(),
            target_eta: 0.9,
            cfar: None,
            eta: Some(0.31),
            method: "nomp".to_owned(),
            layout: None,
            marks: true,
            theory: false,
            lesson: Some(LessonPlace { id: "near-field".to_owned(), step: 3 }),
            time_seconds: 1.5,
        }
    }

    fn shared() -> SharedScene {
        let scene = Scene { name: "Zwei Pfähle".to_owned(), ..Scene::of_points([(0.1 + 0.2, 20.0), (3.0, 4.0)]) };
        SharedScene {
            file: SceneFile { scene, radar: Radar { carrier: Carrier::TwoWay, ..Radar::default() } },
            view: view(),
        }
    }

    /// A text around any bytes in place of TOML.
    fn pack(toml: &[u8]) -> String {
        let mut packed = ZlibEncoder::new(Vec::new(), Compression::best());
        packed.write_all(toml).unwrap();
        format!("{PREFIX}{VERSION}:{}", URL_SAFE_NO_PAD.encode(packed.finish().unwrap()))
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        #[test]
        fn a_shared_scene_opens_as_it_was(
            places in prop::collection::vec((-30.0..30.0f64, 0.5..38.0f64, -5.0..5.0f64), 0..20),
            (seed, snr, range) in (0..1u64 << 62, -100.0..300.0f64, 1.0..400.0f64),
            (eta, target_eta) in (prop::option::of(0.0..=1.0f32), 0.0..=1.0f32),
            (cartesian, theory, marks, step) in (any::<bool>(), any::<bool>(), any::<bool>(), prop::option::of(1..9usize)),
            (name, samples) in ("\\PC{0,40}", 1..600usize),
        ) {
            let point = |(x_metres, y_metres, reflectivity)| Object::Point(Point { reflectivity, ..Point::new(x_metres, y_metres) });
            let objects = places.into_iter().map(point).collect();
            let scene = Scene { name, noise_seed: seed, objects, ..Scene::default() };
            let lesson = step.map(|step| LessonPlace { id: "a-line".to_owned(), step });
            let level = Floor::Level(DecibelMilliwatts(snr - 100.0));
            let floor = if marks { level } else { Floor::Snr(Decibels(snr)) };
            let normalisation = Normalisation::DynamicRange(Decibels(range));
            let cfar = marks.then(|| Cfar { guard: [samples, 2], ..Cfar::default() });
            let layout = theory.then_some(LayoutKind::Random { elements: samples, seed: 7 });
            let view = SharedView { cfar, layout, floor, normalisation, eta, target_eta, cartesian, theory, marks, lesson, ..view() };
            let shared = SharedScene { file: SceneFile { scene, radar: Radar { samples, ..Radar::default() } }, view };
            let text = shared.to_text().unwrap();
            prop_assert!(is_shared(&text) && !text.contains(char::is_whitespace));
            prop_assert_eq!(SharedScene::from_text(&text), Ok(shared));
        }

        /// A changed, lost or doubled letter is reported, but for one that differs only in bits without meaning at the stream's beginning.
        #[test]
        fn a_damaged_letter_is_told(at in 11..10_000usize, letter in "[A-Za-z0-9_-]") {
            let text = shared().to_text().unwrap();
            let at = 11 + at % (text.len() - 11);
            let changed = format!("{}{letter}{}", &text[..at], &text[at + 1..]);
            prop_assert!(SharedScene::from_text(&changed).is_ok_and(|read| read == shared()) || SharedScene::from_text(&changed).is_err());
            let lost = [&text[..at], &text[at + 1..]].concat();
            prop_assert!(SharedScene::from_text(&lost).is_err());
            prop_assert!(SharedScene::from_text(&text[..at]).is_err());
        }
    }

    #[test]
    fn line_breaks_of_a_mail_do_no_harm() {
        let text = shared().to_text().unwrap();
        let broken: Vec<&str> = text.as_bytes().chunks(60).map(|c| std::str::from_utf8(c).unwrap()).collect();
        assert_eq!(SharedScene::from_text(&format!("  {}\r\n", broken.join("\r\n "))), Ok(shared()));
        for preset in presets::ALL {
            let shared = SharedScene { file: preset.load().unwrap(), view: view() };
            let text = shared.to_text().unwrap();
            assert!(text.len() < 4000, "{}: {} letters", preset.id, text.len());
            assert_eq!(SharedScene::from_text(&text), Ok(shared));
        }
    }

    #[test]
    fn what_is_wrong_is_told() {
        let told = |text: &str| SharedScene::from_text(text).unwrap_err().to_string();
        assert!(told("hello").contains("expected \"apertura:1:\""));
        assert!(told("apertura:2:abc").contains("version \"2\""));
        assert!(told("apertura:1:ab%").contains("damaged"));
        assert!(told("apertura:1:").contains("damaged"));
        assert!(told(&pack(b"name = \"x\"\n")).contains("[shared] is missing"));
        assert!(told(&pack(b"\xff")).contains("damaged"));
        let valid = to_toml_beside(&shared().file, KEY, &view()).unwrap();
        for (from, to, part) in [
            ("x_metres = 3.0", "x_metres = nan", "x_metres"),
            ("marks = true", "marks = true\nsmell = 1", "smell"),
            ("target_eta = 0.8999999761581421", "target_eta = 1.5", "expected 0 to 1"),
            ("left = 0.25", "left = 0.9999", "expected edges"),
            ("snr = 12.5", "snr = nan", "floor"),
            ("snr = 12.5", "dbm = 1e4", "between -300 and 200"),
            ("dynamic-range = 60.0", "dynamic-range = 0.0", "normalisation"),
        ] {
            assert!(valid.contains(from), "{from} in\n{valid}");
            let message = told(&pack(valid.replace(from, to).as_bytes()));
            assert!(message.contains(part), "{part} in: {message}");
        }
    }

    #[test]
    fn a_small_text_that_unpacks_to_much_is_refused_early() {
        let bomb = pack(&vec![b'#'; 64 << 20]);
        assert!(bomb.len() < 200_000, "{} letters", bomb.len());
        assert_eq!(SharedScene::from_text(&bomb), Err(ShareError::Large));
        let long = "a".repeat(MAX_LINK_LETTERS + 1);
        assert_eq!(SharedScene::from_text(&long), Err(ShareError::Large));
        let many = Scene::of_points((0..200_000).map(|i| (f64::from(i) * 1e-4, 5.0)));
        let shared = SharedScene { file: SceneFile { scene: many, ..SceneFile::default() }, view: view() };
        assert_eq!(shared.to_text(), Err(ShareError::Large));
    }
}
