//! Reconstruction methods.

use crate::arrays::{ends, layout_of, numbers};
use crate::errors::{argument, at, named, value};
use crate::function::{Function, Said, is_name};
use crate::radar::{Radar, or_default};
use crate::reconstruction::Reconstruction;
use crate::work::{self, Progress};
use apertura::external::{self, CommandLine};
use apertura::maps::Normalisation;
use apertura::reconstruct::{NoisePrior, Reconstructor, Request};
use apertura::signal::{LayoutSamples, TwoEnds};
use ndarray::Array2;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError, Weak};
use std::time::Duration;

/// A reconstruction method: the two ends' samples in, an estimate of the whole array's map out.
#[pyclass(module = "apertura", frozen)]
pub struct Method {
    pub inner: Arc<dyn Reconstructor>,
    made_of: MadeOf,
}

/// The source from which a method is made again in another process.
enum MadeOf {
    Name,
    Weights(PathBuf),
    /// A function, and its texts: description, told, answers and weights.
    Function(Py<PyAny>, [String; 4]),
}

/// The method called `name`.
///
/// Args:
///     name: One of `methods()`.
///     weights: A file of weights (safetensors) in the place of the shipped ones, for "live".
///     called: Name of the method with these weights; "live-" and the file's name without its ending where none is given. Both stand in one table.
///
/// Raises:
///     ValueError: There is none; the message lists those there are. Or the file is damaged, or for another network.
#[pyfunction]
#[pyo3(signature = (name, *, weights=None, called=None))]
pub fn method(name: &str, weights: Option<PathBuf>, called: Option<&str>) -> PyResult<Method> {
    if let Some(path) = weights {
        if name != apertura::network::live::method::NAME {
            return Err(value(format!("weights are for \"live\"; \"{name}\" takes none")));
        }
        return of_weights(path, called);
    }
    if let Some(called) = called {
        return Err(value(format!("called is \"{called}\"; expected it beside weights alone")));
    }
    by_name(name).map(|inner| Method { inner, made_of: MadeOf::Name })
}

fn by_name(name: &str) -> PyResult<Arc<dyn Reconstructor>> {
    apertura::methods::by_name(name).map_err(|error| {
        let burn = !cfg!(feature = "networks") && ["thesis", "thesis-1", "unet"].contains(&name);
        let how = if burn { "; this one needs a build with the feature \"networks\" (python/README.md)" } else { "" };
        value(format!("{error}{how}"))
    })
}

/// The live network with the weights of a file, under a name of its own.
fn of_weights(path: PathBuf, called: Option<&str>) -> PyResult<Method> {
    let name = called.map_or_else(|| apertura::network::name_of_weights(&path), str::to_owned);
    if !is_name(&name) || apertura::methods::by_name(&name).is_ok() {
        return Err(value(format!(
            "called is \"{name}\"; expected 1 to 40 letters, digits, \"-\", \"_\" or \".\", and no name of another method"
        )));
    }
    std::fs::File::open(&path).map_err(at(&path))?;
    let live = apertura::network::live_from_file(&path, &name).map_err(value)?;
    Ok(Method { inner: Arc::new(live), made_of: MadeOf::Weights(path) })
}

/// A method as arguments name it: a name, a `Method`, a file of weights or a function. `what` is the argument.
pub fn method_of(any: &Bound<'_, PyAny>, what: &str) -> PyResult<Arc<dyn Reconstructor>> {
    if let Ok(method) = any.cast::<Method>() {
        return Ok(method.get().inner.clone());
    }
    if let Ok(name) = any.extract::<String>() {
        return match name.ends_with(".safetensors") {
            true => of_weights(PathBuf::from(name), None).map(|method| method.inner),
            false => by_name(&name),
        };
    }
    if any.hasattr("__fspath__")? {
        return of_weights(any.extract()?, None).map(|method| method.inner);
    }
    if any.is_callable() {
        return Method::of_function(any, None, "", "", 0.9, "lambda", "").map(|method| method.inner);
    }
    Err(argument(
        any.py(),
        format!("{what} is {}; expected a name, a Method, a function or a file of weights", any.repr()?),
    ))
}

/// Methods as arguments name them, in a list.
pub fn methods_of(any: &Bound<'_, PyAny>) -> PyResult<Vec<Arc<dyn Reconstructor>>> {
    let single = any.cast::<Method>().is_ok() || any.extract::<String>().is_ok() || any.hasattr("__fspath__")?;
    let items = if single { None } else { any.try_iter().ok() };
    let Some(items) = items else {
        let shown = any.repr()?;
        return Err(argument(any.py(), format!("methods is {shown}; expected a list of methods, as in [{shown}]")));
    };
    items.enumerate().map(|(i, item)| method_of(&item?, &format!("methods[{i}]"))).collect()
}

/// An error of the library whose cause is the exception that a function raised.
pub fn caused(py: Python<'_>, error: PyErr, methods: &[Arc<dyn Reconstructor>]) -> PyErr {
    let raised = FUNCTIONS
        .lock()
        .unwrap_or_else(PoisonError::into_inner)
        .iter()
        .filter_map(Weak::upgrade)
        .filter(|function| methods.iter().any(|method| method.name() == function.name()))
        .find_map(|function| function.take_raised());
    error.set_cause(py, raised);
    error
}

/// Whether a function of this name is a method somewhere that says no weights.
pub fn is_function_without_weights(name: &str) -> bool {
    let functions = FUNCTIONS.lock().unwrap_or_else(PoisonError::into_inner);
    functions.iter().filter_map(Weak::upgrade).any(|function| function.name() == name && !function.has_weights())
}

/// The functions that are methods somewhere.
static FUNCTIONS: Mutex<Vec<Weak<Function>>> = Mutex::new(Vec::new());

/// Names of all methods.
#[pyfunction]
pub fn methods() -> Vec<&'static str> {
    apertura::methods::all().iter().map(|m| m.name()).collect()
}

#[pymethods]
impl Method {
    /// A program of one's own as a method: starts the command once, and knows it by the name that it says from then on
    /// (docs/own-network.md).
    ///
    /// Args:
    ///     command: Program and arguments, such as "python my_network.py".
    ///     seconds: How long it may take to start, and for each answer.
    ///
    /// Raises:
    ///     ValueError: The command can't be started or is no method; the message has the end of its standard error.
    #[staticmethod]
    #[pyo3(signature = (command, *, seconds=120.0))]
    fn of_command(py: Python<'_>, command: &str, seconds: f64) -> PyResult<Self> {
        if !(seconds > 0.0 && seconds <= 86_400.0) {
            return Err(value(format!("seconds is {seconds}; expected above 0, to 86400")));
        }
        let line: CommandLine = command.parse().map_err(value)?;
        let started = work::run(py, None, |task| external::start(line, Duration::from_secs_f64(seconds), task))?;
        let method: Arc<dyn Reconstructor> = Arc::new(started.map_err(value)?);
        apertura::methods::add(method.clone()).map_err(value)?;
        Ok(Method { inner: method, made_of: MadeOf::Name })
    }

    /// A function of one's own as a method of this process. Where a method is asked for, the function alone will do, under its own name.
    ///
    /// Args:
    ///     function: Called as `function(ends, radar)` or `function(ends, radar, request)`, as `serve` calls it: complex128
    ///         `[2, end_elements, samples]`, a `Radar` and a `Request`. It returns a map, numbers `[samples, elements]`, whose columns are those of
    ///         `radar.cos_theta`, or a pair of a map and its threshold. A tensor of PyTorch will do.
    ///     name: Name of the method: letters, digits, "-", "_" and "."; the function's where none is given.
    ///     description: One sentence for lists.
    ///     told: What it knows beside samples and radar, such as what it was trained on.
    ///     eta: Threshold of answers that bring none.
    ///     answers: What a map holds: "lambda", 0 to 1, or "decades" of amplitude, of which Lambda is made.
    ///     weights: Hexadecimal digits that tell its weights from others; rows hold them.
    ///
    /// Raises:
    ///     ValueError: A name or a number can't be used.
    #[staticmethod]
    #[pyo3(signature = (function, *, name=None, description="", told="", eta=0.9, answers="lambda", weights=""))]
    fn of_function(
        function: &Bound<'_, PyAny>,
        name: Option<&str>,
        description: &str,
        told: &str,
        eta: f32,
        answers: &str,
        weights: &str,
    ) -> PyResult<Self> {
        if !function.is_callable() {
            return Err(argument(function.py(), format!("function is {}; expected a function", function.repr()?)));
        }
        let own =
            || function.getattr("__name__").or_else(|_| function.get_type().getattr("__name__"))?.extract::<String>();
        let name = name.map_or_else(own, |name| Ok(name.to_owned()))?;
        let said = Said { name: &name, description, told, eta, answers, weights };
        let inner = Arc::new(Function::new(function, &said)?);
        let mut functions = FUNCTIONS.lock().unwrap_or_else(PoisonError::into_inner);
        functions.retain(|function| function.strong_count() > 0);
        functions.push(Arc::downgrade(&inner));
        let texts = [description, told, answers, weights].map(str::to_owned);
        Ok(Method { inner, made_of: MadeOf::Function(function.clone().unbind(), texts) })
    }

    /// Short name.
    #[getter]
    fn name(&self) -> &'static str {
        self.inner.name()
    }

    /// One sentence.
    #[getter]
    fn description(&self) -> &'static str {
        self.inner.description()
    }

    /// The method's knowledge beside samples and radar.
    #[getter]
    fn told(&self) -> &'static str {
        self.inner.info().prior_knowledge
    }

    /// Hexadecimal digits that tell its weights from others, as rows hold them; "" where it has none, or doesn't say.
    #[getter]
    fn weights(&self) -> String {
        self.inner.weights(&apertura::radar::Radar::default()).unwrap_or_default().sha256
    }

    /// Threshold of an answer that brings none of its own, chosen on validation scenes.
    #[getter]
    fn eta(&self) -> f32 {
        self.inner.eta()
    }

    /// The reason for which the method can't work on samples of a radar, or None where it can.
    ///
    /// Args:
    ///     radar: The radar; that of table 3.1 where none is given.
    ///     layout: Name or numbers of the elements that are heard in place of the two ends (`layout`).
    ///
    /// Raises:
    ///     ValueError: The radar has no such layout.
    #[pyo3(signature = (radar=None, *, layout=None))]
    fn refusal(&self, radar: Option<&Radar>, layout: Option<&Bound<'_, PyAny>>) -> PyResult<Option<String>> {
        let radar = or_default(radar);
        let checked = match layout_of(layout, &radar)? {
            Some(layout) => self.inner.check_elements(&radar, &layout),
            None => self.inner.check_array(&radar),
        };
        Ok(checked.err().map(|error| error.to_string()))
    }

    /// Estimates the whole array's map from the samples of the two ends, or of a layout.
    ///
    /// Args:
    ///     ends: Complex numbers `[2, end_elements, samples]`, or `[elements of the layout, samples]`, of any gain; they are copied.
    ///     radar: The radar that sampled them; that of table 3.1 where none is given.
    ///     layout: Name or numbers of the elements that were heard in place of the two ends (`layout`), for methods that hear any, as `evaluate` says.
    ///     floor: What lies beneath them: "thesis", "exact", "thermal", "snr=DB", "dbm=LEVEL", "white" or "white=SIGMA". SIGMA is the root mean
    ///         square of the noise in a sample; the level of any other white noise the method measures.
    ///     normalisation: How the map is normalised: "min-max" or "db=RANGE".
    ///     snapshot_range_metres: Where the echoes of a single sample come from, if it is known.
    ///     progress: Called with the part that is done, 0 to 1.
    ///
    /// Raises:
    ///     ValueError: The shape is not the radar's, a sample is not finite, a name is unknown, or the method can't work on these samples.
    #[pyo3(signature = (ends, radar=None, *, layout=None, floor="thesis", normalisation="min-max", snapshot_range_metres=None, progress=None))]
    #[expect(clippy::too_many_arguments, reason = "named in Python")]
    fn reconstruct(
        &self,
        py: Python<'_>,
        ends: &Bound<'_, PyAny>,
        radar: Option<&Radar>,
        layout: Option<&Bound<'_, PyAny>>,
        floor: &str,
        normalisation: &str,
        snapshot_range_metres: Option<f64>,
        progress: Progress<'_, '_>,
    ) -> PyResult<Reconstruction> {
        let (noise, normalisation): (NoisePrior, Normalisation) = (named(floor)?, named(normalisation)?);
        let radar = or_default(radar);
        let (ends, layout_samples) = match layout_of(layout, &radar)? {
            None => (self::ends(ends, &radar)?, None),
            Some(layout) => {
                let samples = numbers(ends, "ends", &format!("[{}, {}]", layout.len(), radar.samples))?;
                let silence = || Array2::zeros((radar.end_elements, radar.samples));
                let layout_samples = Arc::new(LayoutSamples { layout, samples });
                (TwoEnds { first: silence(), last: silence() }, Some(layout_samples))
            }
        };
        let method = &self.inner;
        let answer = work::run(py, progress, |task| {
            let task = task.clone();
            let request = Request { noise, normalisation, snapshot_range_metres, layout_samples, task, ..Request::default() };
            method.reconstruct(&radar, &ends, &request)
        })?
        .map_err(|error| caused(py, value(error), std::slice::from_ref(method)))?;
        let eta = self.inner.eta_of(&answer);
        Ok(Reconstruction::new(answer, eta, radar))
    }

    fn __repr__(&self) -> String {
        format!("<Method {}: {}>", self.inner.name(), self.inner.description())
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (Bound<'py, PyDict>,))> {
        let fields = PyDict::new(py);
        match &self.made_of {
            MadeOf::Name => fields.set_item("name", self.inner.name())?,
            MadeOf::Weights(path) => {
                fields.set_item("name", apertura::network::live::method::NAME)?;
                fields.set_item("weights", path)?;
                fields.set_item("called", self.inner.name())?;
            }
            MadeOf::Function(function, texts) => {
                fields.set_item("function", function)?;
                fields.set_item("name", self.inner.name())?;
                fields.set_item("eta", self.inner.eta())?;
                for (key, text) in ["description", "told", "answers", "weights"].into_iter().zip(texts) {
                    fields.set_item(key, text)?;
                }
            }
        }
        Ok((py.import("apertura._pickle")?.getattr("method")?, (fields,)))
    }
}
