//! Scenes.

use crate::arrays::{owned, reflectors, rows_of};
use crate::errors::{named, scene_file, value, whole};
use crate::maps::Maps;
use crate::objects;
use crate::radar::Radar;
use crate::work::{self, Progress};
use apertura::maps::Normalisation;
use apertura::scene::file::{SceneFile, from_toml, load, save, to_toml};
use apertura::scene::generate::{Generator, Kind, Purpose, Reading};
use apertura::scene::presets::{ALL, Preset};
use apertura::scene::{self, Disturbances};
use apertura::share::{SharedScene, SharedView, VisiblePart};
use apertura::signal::{Floor, SimulationError, simulate_for};
use apertura::view::View;
use numpy::PyArray2;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList, PyType};
use std::path::PathBuf;

/// Objects before a radar, and the radar that looks at them.
///
/// Args:
///     objects: `Point`, `Line`, `Cluster`, `Wall`, `Box`, `Post` and `Polygon`, in order.
///     name: What the scene is called.
///     notes: What it is meant to show.
///     noise_seed: Picks the noise of the floor beneath it.
///     radar: The radar; that of table 3.1 where none is given.
///     elements: Elements as they are built (`Elements`); ideal where none are given.
///     interferer: Another radar that sends at the same time (`Interferer`).
///     mirror: A wall that mirrors (`Mirror`).
///     shadows: Whether bodies hide what stands behind them.
///
/// Raises:
///     TypeError: An object is none of these.
///     ValueError: The radar can't see the scene: the message names the object, what is wrong and what was expected.
#[pyclass(module = "apertura", frozen)]
#[derive(Clone, PartialEq)]
pub struct Scene(pub SceneFile);

pub fn purpose_of(name: &str) -> PyResult<Purpose> {
    let unknown = |_| value(format!("purpose is \"{name}\"; expected training, validation or test"));
    serde_json::from_value(name.into()).map_err(unknown)
}

pub fn reading_of(name: &str) -> PyResult<Reading> {
    let unknown = |_| value(format!("reading is \"{name}\"; expected program or text"));
    serde_json::from_value(name.into()).map_err(unknown)
}

/// A set's name, or its number.
pub fn set_name(set: &Bound<'_, PyAny>) -> PyResult<String> {
    set.str().map(|name| name.to_string())
}

/// Names of the kinds of random scenes, in the order in which they are shown.
///
/// Args:
///     training: Whether "world", which makes scenes for training and validation alone, is one of them.
///
/// Returns:
///     The names that `Scene.random`, `evaluate` and others take.
#[pyfunction]
#[pyo3(signature = (*, training=false))]
pub fn kinds(training: bool) -> Vec<String> {
    Kind::all().chain(training.then_some(Kind::World)).map(|kind| kind.to_string()).collect()
}

fn checked(file: SceneFile) -> PyResult<Scene> {
    file.scene.validate(&file.radar).map_err(value)?;
    Ok(Scene(file))
}

#[pymethods]
impl Scene {
    #[new]
    #[pyo3(signature = (objects=None, *, name="", notes="", noise_seed=0, radar=None, elements=None, interferer=None, mirror=None, shadows=true))]
    #[expect(clippy::too_many_arguments, reason = "one a field")]
    fn new(
        objects: Option<&Bound<'_, PyAny>>,
        name: &str,
        notes: &str,
        noise_seed: i128,
        radar: Option<&Radar>,
        elements: Option<&Bound<'_, PyAny>>,
        interferer: Option<&Bound<'_, PyAny>>,
        mirror: Option<&Bound<'_, PyAny>>,
        shadows: bool,
    ) -> PyResult<Self> {
        let mut made = Vec::new();
        if let Some(objects) = objects {
            for (index, object) in objects.try_iter()?.enumerate() {
                made.push(objects::object(&object?, index)?);
            }
        }
        let disturbances = Disturbances {
            elements: elements.map(objects::elements).transpose()?.unwrap_or_default(),
            interferer: interferer.map(objects::interferer).transpose()?,
            mirror: mirror.map(objects::mirror).transpose()?,
        };
        let (name, notes, noise_seed) = (name.to_owned(), notes.to_owned(), whole("noise_seed", noise_seed)?);
        let scene = scene::Scene { name, notes, noise_seed, shadows, disturbances, objects: made };
        checked(SceneFile { scene, radar: radar.map(|r| r.0.clone()).unwrap_or_default() })
    }

    /// A scene of points.
    ///
    /// Args:
    ///     points: Numbers `[points, 2]` (x and y in metres) or `[points, 3]` (and reflectivity).
    ///     radar: The radar; that of table 3.1 where none is given.
    ///
    /// Raises:
    ///     ValueError: The shape or dtype is another one, or the radar can't see the scene.
    #[staticmethod]
    #[pyo3(signature = (points, radar=None))]
    fn of_points(points: &Bound<'_, PyAny>, radar: Option<&Radar>) -> PyResult<Self> {
        let point = |r: scene::Reflector| {
            let scene::Reflector { x_metres, y_metres, reflectivity } = r;
            scene::Object::Point(scene::Point { reflectivity, ..scene::Point::new(x_metres, y_metres) })
        };
        let objects = reflectors(points, "points")?.into_iter().map(point).collect();
        let scene = scene::Scene { objects, ..scene::Scene::default() };
        checked(SceneFile { scene, radar: radar.map(|r| r.0.clone()).unwrap_or_default() })
    }

    /// Random scene `index` of a set: the one that the program makes of the same numbers.
    ///
    /// Args:
    ///     set: One of `kinds()`: "1", "2" and "3" are the thesis' test sets. "world" makes scenes for training and validation.
    ///     seed: Seed of the set.
    ///     index: Number of the scene, from 0.
    ///     purpose: "test", "validation" or "training": their scenes never meet.
    ///     reading: "program" or "text": after which description the thesis' sets are made.
    ///     radar: The radar; that of table 3.1 where none is given.
    ///
    /// Raises:
    ///     ValueError: A name is unknown, or the radar does not see far enough for the set's objects.
    #[staticmethod]
    #[pyo3(signature = (set, seed=0, index=0, *, purpose="test", reading="program", radar=None))]
    fn random(
        set: &Bound<'_, PyAny>,
        seed: i128,
        index: i128,
        purpose: &str,
        reading: &str,
        radar: Option<&Radar>,
    ) -> PyResult<Self> {
        let (name, purpose) = (set_name(set)?, purpose_of(purpose)?);
        let kind: Kind = match purpose {
            Purpose::Test => named(&name)?,
            _ => Kind::for_training(&name).map_err(value)?,
        };
        let radar = radar.map(|r| r.0.clone()).unwrap_or_default();
        kind.check_room(&radar).map_err(value)?;
        let generator = Generator::new(&radar, reading_of(reading)?, purpose, whole("seed", seed)?);
        checked(SceneFile { scene: generator.scene(kind, whole("index", index)?), radar })
    }

    /// A scene that comes with the library.
    ///
    /// Raises:
    ///     ValueError: There is none of this name.
    #[staticmethod]
    fn preset(name: &str) -> PyResult<Self> {
        let known = || Scene::presets().join(", ");
        let preset =
            Preset::by_id(name).ok_or_else(|| value(format!("no scene is called \"{name}\"; expected {}", known())))?;
        Ok(Scene(preset.load().map_err(value)?))
    }

    /// Names of the scenes that come with the library.
    #[staticmethod]
    fn presets() -> Vec<&'static str> {
        ALL.iter().map(|p| p.id).collect()
    }

    /// Reads a scene file, `.toml` or `.npz`.
    ///
    /// Raises:
    ///     OSError: The file can't be read.
    ///     ValueError: It is no scene: the message names the line, the key or object, and what was expected.
    #[staticmethod]
    fn load(path: PathBuf) -> PyResult<Self> {
        load(&path).map(Scene).map_err(scene_file)
    }

    /// Writes a scene file in one step. A `.npz` keeps the reflectors' positions only.
    ///
    /// Raises:
    ///     OSError: The file can't be written.
    ///     ValueError: Its name ends neither in `.toml` nor in `.npz`, or it would replace a recording.
    fn save(&self, path: PathBuf) -> PyResult<()> {
        save(&path, &self.0).map_err(scene_file)
    }

    /// Reads a scene from TOML.
    ///
    /// Raises:
    ///     ValueError: It is no scene.
    #[staticmethod]
    fn from_toml(text: &str) -> PyResult<Self> {
        from_toml(text).map(Scene).map_err(value)
    }

    /// The scene as TOML.
    ///
    /// Raises:
    ///     ValueError: It holds a number that TOML can't hold (an integer of 2^63 or more).
    fn to_toml(&self) -> PyResult<String> {
        to_toml(&self.0).map_err(value)
    }

    /// The scene as a line of text, as *Copy all as text* in the window writes it: `apertura TEXT` opens it, and so does a page behind `#`.
    ///
    /// Args:
    ///     floor: What lies beneath the reflectors.
    ///     normalisation: How the maps are normalised.
    ///     method: The method that is shown.
    ///
    /// Raises:
    ///     ValueError: A name is unknown, or the scene is too large for a text.
    #[pyo3(signature = (*, floor="thesis", normalisation="min-max", method="live"))]
    fn to_text(&self, floor: &str, normalisation: &str, method: &str) -> PyResult<String> {
        apertura::methods::by_name(method).map_err(value)?;
        let (floor, normalisation, method) = (named(floor)?, named(normalisation)?, method.to_owned());
        let view = View { floor, normalisation, method, ..View::default() };
        let view = SharedView::of(&view, [VisiblePart::default(); 2], None);
        SharedScene { file: self.0.clone(), view }.to_text().map_err(value)
    }

    /// The same scene with other fields, named as in the constructor.
    #[pyo3(signature = (**fields))]
    fn replace<'py>(&self, py: Python<'py>, fields: Option<&Bound<'py, PyDict>>) -> PyResult<Bound<'py, PyAny>> {
        let all = PyDict::new(py);
        all.set_item("objects", self.objects(py)?)?;
        all.set_item("name", self.name())?;
        all.set_item("notes", self.notes())?;
        all.set_item("noise_seed", self.noise_seed())?;
        all.set_item("radar", self.radar())?;
        all.set_item("elements", self.elements(py)?)?;
        all.set_item("interferer", self.interferer(py)?)?;
        all.set_item("mirror", self.mirror(py)?)?;
        all.set_item("shadows", self.shadows())?;
        if let Some(fields) = fields {
            all.update(fields.as_mapping())?;
        }
        PyType::new::<Scene>(py).call((), Some(&all))
    }

    /// The objects, in order.
    #[getter]
    fn objects<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let objects: PyResult<Vec<_>> = self.0.scene.objects.iter().map(|o| objects::of_object(py, o)).collect();
        PyList::new(py, objects?)
    }

    /// The scene's name.
    #[getter]
    fn name(&self) -> &str {
        &self.0.scene.name
    }

    /// Notes on the purpose of the scene.
    #[getter]
    fn notes(&self) -> &str {
        &self.0.scene.notes
    }

    /// Picks the noise of the floor beneath it.
    #[getter]
    fn noise_seed(&self) -> u64 {
        self.0.scene.noise_seed
    }

    /// The radar that looks at it.
    #[getter]
    fn radar(&self) -> Radar {
        Radar(self.0.radar.clone())
    }

    /// Elements as they are built, or None where they are ideal.
    #[getter]
    fn elements<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        let elements = &self.0.scene.disturbances.elements;
        (!elements.is_ideal()).then(|| objects::of_elements(py, elements)).transpose()
    }

    /// Another radar that sends at the same time, or None.
    #[getter]
    fn interferer<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.0.scene.disturbances.interferer.as_ref().map(|i| objects::of_interferer(py, i)).transpose()
    }

    /// A wall that mirrors, or None.
    #[getter]
    fn mirror<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.0.scene.disturbances.mirror.as_ref().map(|m| objects::of_mirror(py, m)).transpose()
    }

    /// Whether bodies hide what stands behind them.
    #[getter]
    fn shadows(&self) -> bool {
        self.0.scene.shadows
    }

    /// Every reflector of every object, float64 `[reflectors, 3]`: x and y in metres, reflectivity.
    #[getter]
    fn reflectors<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f64>> {
        owned(py, rows_of(&self.0.scene.reflectors()))
    }

    /// Samples of all elements over a floor, and the maps made of them: the bits that the program computes.
    ///
    /// Args:
    ///     radar: Another radar than the scene's own.
    ///     floor: "thesis" (the rounding floor of the thesis' program), "exact", "thermal", "snr=DB" or "dbm=LEVEL".
    ///     seed: Picks the floor's noise; the scene's `noise_seed` where none is given.
    ///     normalisation: How decades become Lambda: "min-max" (the thesis) or "db=RANGE" below the peak.
    ///     progress: Called with the part that is done, 0 to 1.
    ///
    /// Raises:
    ///     ValueError: A name is unknown, or the radar can't see the scene.
    #[pyo3(signature = (radar=None, *, floor="thesis", seed=None, normalisation="min-max", progress=None))]
    fn simulate(
        &self,
        py: Python<'_>,
        radar: Option<&Radar>,
        floor: &str,
        seed: Option<i128>,
        normalisation: &str,
        progress: Progress<'_, '_>,
    ) -> PyResult<Maps> {
        let (floor, normalisation): (Floor, Normalisation) = (named(floor)?, named(normalisation)?);
        let radar = radar.map_or_else(|| self.0.radar.clone(), |r| r.0.clone());
        let scene = &self.0.scene;
        let seed = seed.map_or(Ok(scene.noise_seed), |seed| whole("seed", seed))?;
        let signal = work::run(py, progress, |task| simulate_for(task, &radar, scene, floor, seed))?;
        let signal = signal.map_err(|error: SimulationError| value(error))?;
        Ok(Maps::new(radar, scene.disturbances.elements.clone(), signal, normalisation))
    }

    fn __len__(&self) -> usize {
        self.0.scene.objects.len()
    }

    fn __eq__(&self, other: &Bound<'_, PyAny>) -> bool {
        other.cast::<Scene>().is_ok_and(|other| *other.get() == *self)
    }

    fn __hash__(&self) -> PyResult<u64> {
        Err(PyTypeError::new_err("unhashable type: 'Scene'"))
    }

    fn __repr__(&self) -> String {
        let scene = &self.0.scene;
        format!("<Scene {:?}: {} objects, {} reflectors>", scene.name, scene.objects.len(), scene.reflector_count())
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (String,))> {
        Ok((py.import("apertura._pickle")?.getattr("scene")?, (self.to_toml()?,)))
    }
}
