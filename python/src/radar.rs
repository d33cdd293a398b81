//! The radar.

use crate::arrays::owned;
use crate::budget::{LinkBudget, budget_of, link_figures};
use crate::errors::{at, scene_file, value, whole};
use crate::radar_fields::{antennas_of, carrier_of, convention_of, fields_of, replaced, text_of, usual_of, window_of};
use apertura::files::read_bounded;
use apertura::radar::presets::{ALL, RadarPreset};
use apertura::radar::{self, Antennas, Carrier, Convention, WindowFunction};
use apertura::scene;
use apertura::scene::file::{MAX_FILE_BYTES, SceneFile, radar_of};
use ndarray::Array1;
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyType};
use std::path::PathBuf;

/// A radar with a uniform line array on the x axis, centred on x = 0. Without arguments it is that of the thesis' table 3.1.
///
/// Args:
///     transmit_power_watts: Transmit power in watts.
///     bandwidth_hz: Swept bandwidth in hertz.
///     carrier_hz: Carrier frequency in hertz.
///     element_spacing_metres: Distance between neighbouring elements in metres; that of table 3.1 at any carrier where neither it nor convention is given.
///     elements: Elements of the whole array, also the columns of every map.
///     end_elements: Elements of each of the two ends.
///     samples: Samples of a chirp, also the range bins of every map.
///     chirp_seconds: Time that the samples of a chirp span, in seconds. No echo at rest depends on it.
///     budget: A `LinkBudget`, or a dict of its fields. Without one, levels are those of the thesis' convention.
///     carrier: "one-way" (the thesis' convention) or "two-way" (the physical convention).
///     convention: "thesis" or "physical" in place of carrier. Without element_spacing_metres the elements are filled for it.
///     window: "hann", "hamming", "blackman" or "rectangular".
///     transmitter_x_metres: Places of transmitters that stand apart from receivers. Each pair is an element halfway between both, and the
///         pairs must stand at even places: they say elements and element_spacing_metres.
///     receiver_x_metres: Places of the receivers.
///     transmitter_y_metres: How far each transmitter stands off the array's line, towards the scene. All stand on it where nothing is said.
///     receiver_y_metres: The same of each receiver.
///     focus_off_line: Whether maps bring elements that stand off the line into phase towards the direction of each column. Else each counts as
///         the nearest place on the line.
///     chirps: Chirps that are sent one after another; `range_doppler` sees all of them, everything else the first.
///     chirp_interval_seconds: From the beginning of a chirp to that of the next: at least chirp_seconds where there are several.
///
/// Raises:
///     ValueError: A field is out of range, or the radar asks for too much memory.
///     ArgumentError: A name is no text.
#[pyclass(module = "apertura", frozen)]
#[derive(Clone, PartialEq)]
pub struct Radar(pub radar::Radar);

/// float64 of one axis.
type Numbers<'py> = Bound<'py, PyArray1<f64>>;

fn each(py: Python<'_>, count: usize, of: impl Fn(usize) -> f64) -> Numbers<'_> {
    owned(py, (0..count).map(of).collect::<Array1<f64>>())
}

impl Radar {
    fn of_antennas<'py>(&self, py: Python<'py>, of: fn(&Antennas) -> &[f64]) -> Option<Numbers<'py>> {
        self.0.antennas.as_ref().map(|antennas| owned(py, Array1::from(of(antennas).to_vec())))
    }
}

/// The radar given, or that of table 3.1.
pub fn or_default(radar: Option<&Radar>) -> radar::Radar {
    radar.map(|r| r.0.clone()).unwrap_or_default()
}

#[pymethods]
impl Radar {
    #[new]
    #[pyo3(signature = (*, transmit_power_watts=None, bandwidth_hz=None, carrier_hz=None, element_spacing_metres=None, elements=None,
                        end_elements=None, samples=None, carrier=None, window=None, convention=None, transmitter_x_metres=None,
                        receiver_x_metres=None, transmitter_y_metres=None, receiver_y_metres=None, focus_off_line=None, chirp_seconds=None,
                        chirps=None, chirp_interval_seconds=None, budget=None))]
    #[expect(clippy::too_many_arguments, reason = "one a field")]
    fn new(
        transmit_power_watts: Option<f64>,
        bandwidth_hz: Option<f64>,
        carrier_hz: Option<f64>,
        element_spacing_metres: Option<f64>,
        elements: Option<i128>,
        end_elements: Option<i128>,
        samples: Option<i128>,
        #[pyo3(from_py_with = carrier_of)] carrier: Option<Carrier>,
        #[pyo3(from_py_with = window_of)] window: Option<WindowFunction>,
        #[pyo3(from_py_with = convention_of)] convention: Option<Convention>,
        transmitter_x_metres: Option<Vec<f64>>,
        receiver_x_metres: Option<Vec<f64>>,
        transmitter_y_metres: Option<Vec<f64>>,
        receiver_y_metres: Option<Vec<f64>>,
        focus_off_line: Option<bool>,
        chirp_seconds: Option<f64>,
        chirps: Option<i128>,
        chirp_interval_seconds: Option<f64>,
        budget: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let count = |name, number: Option<i128>| number.map(|number| whole::<usize>(name, number)).transpose();
        let (elements, end_elements) = (count("elements", elements)?, count("end_elements", end_elements)?);
        let (samples, chirps) = (count("samples", samples)?, count("chirps", chirps)?);
        let usual = usual_of(convention, carrier, carrier_hz, bandwidth_hz)?;
        let radar = radar::Radar {
            transmit_power_watts: transmit_power_watts.unwrap_or(usual.transmit_power_watts),
            bandwidth_hz: bandwidth_hz.unwrap_or(usual.bandwidth_hz),
            carrier_hz: carrier_hz.unwrap_or(usual.carrier_hz),
            element_spacing_metres: element_spacing_metres.unwrap_or(usual.element_spacing_metres),
            elements: elements.unwrap_or(usual.elements),
            end_elements: end_elements.unwrap_or(usual.end_elements),
            samples: samples.unwrap_or(usual.samples),
            chirp_seconds: chirp_seconds.unwrap_or(usual.chirp_seconds),
            carrier: carrier.unwrap_or(usual.carrier),
            window: window.unwrap_or(usual.window),
            antennas: None,
            focus_off_line: focus_off_line.unwrap_or(usual.focus_off_line),
            chirps: chirps.unwrap_or(usual.chirps),
            chirp_interval_seconds: chirp_interval_seconds.unwrap_or(usual.chirp_interval_seconds),
            budget: budget.map(budget_of).transpose()?,
        };
        let along = [transmitter_x_metres, receiver_x_metres];
        let says_elements = elements.is_some() || element_spacing_metres.is_some();
        if says_elements && along.iter().all(Option::is_some) {
            return Err(value(
                "elements and element_spacing_metres are those of the antennas' pairs; expected neither",
            ));
        }
        let radar = match antennas_of(along, [transmitter_y_metres, receiver_y_metres])? {
            None => radar,
            Some(antennas) => {
                let radar = radar.with_antennas(antennas);
                radar::Radar { end_elements: end_elements.unwrap_or(radar.end_elements), ..radar }
            }
        };
        radar.validate().map_err(value)?;
        Ok(Radar(radar))
    }

    /// A radar that comes with the library.
    ///
    /// Raises:
    ///     ValueError: There is none of this name.
    #[staticmethod]
    fn preset(name: &str) -> PyResult<Self> {
        let known = || ALL.iter().map(|p| p.id).collect::<Vec<_>>().join(", ");
        let unknown = || value(format!("no radar is called \"{name}\"; expected {}", known()));
        RadarPreset::by_id(name).map(|p| Radar(p.radar.clone())).ok_or_else(unknown)
    }

    /// Names of the radars that come with the library.
    #[staticmethod]
    fn presets() -> Vec<&'static str> {
        ALL.iter().map(|p| p.id).collect()
    }

    /// The radar of a TOML file that holds one in a table [radar]: a scene, a recording, or nothing else. Keys that the table leaves out are table
    /// 3.1's.
    ///
    /// Raises:
    ///     OSError: The file can't be read.
    ///     ValueError: It holds no radar; the message names the line.
    #[staticmethod]
    fn load(path: PathBuf) -> PyResult<Self> {
        let bytes = read_bounded(&path, MAX_FILE_BYTES).map_err(at(&path))?;
        let told = |what: String| value(format!("{}: {what}", path.display()));
        let text = String::from_utf8(bytes).map_err(|_| told("is not text".to_owned()))?;
        radar_of(&text).map(|(radar, _)| Radar(radar)).map_err(told)
    }

    /// Writes the radar as a TOML file, in one step.
    ///
    /// Raises:
    ///     OSError: The file can't be written.
    ///     ValueError: Its name does not end in `.toml`.
    fn save(&self, path: PathBuf) -> PyResult<()> {
        if path.extension().is_none_or(|extension| extension != "toml") {
            return Err(value(format!("{}: expected a name that ends in .toml", path.display())));
        }
        scene::file::save(&path, &SceneFile { scene: scene::Scene::default(), radar: self.0.clone() })
            .map_err(scene_file)
    }

    /// The same radar with other fields, named as in the constructor. A convention brings its carrier and its spacing with it.
    #[pyo3(signature = (**fields))]
    fn replace<'py>(&self, py: Python<'py>, fields: Option<&Bound<'py, PyDict>>) -> PyResult<Bound<'py, PyAny>> {
        let all = replaced(&self.0, py, fields)?;
        PyType::new::<Radar>(py).call((), Some(&all))
    }

    /// Transmit power in watts.
    #[getter]
    fn transmit_power_watts(&self) -> f64 {
        self.0.transmit_power_watts
    }

    /// Swept bandwidth in hertz.
    #[getter]
    fn bandwidth_hz(&self) -> f64 {
        self.0.bandwidth_hz
    }

    /// Carrier frequency in hertz.
    #[getter]
    fn carrier_hz(&self) -> f64 {
        self.0.carrier_hz
    }

    /// Distance between neighbouring elements in metres.
    #[getter]
    fn element_spacing_metres(&self) -> f64 {
        self.0.element_spacing_metres
    }

    /// Elements of the whole array, and columns of every map.
    #[getter]
    fn elements(&self) -> usize {
        self.0.elements
    }

    /// Elements of each of the two ends.
    #[getter]
    fn end_elements(&self) -> usize {
        self.0.end_elements
    }

    /// Samples of a chirp, and range bins of every map.
    #[getter]
    fn samples(&self) -> usize {
        self.0.samples
    }

    /// Time that the samples of a chirp span, in seconds.
    #[getter]
    fn chirp_seconds(&self) -> f64 {
        self.0.chirp_seconds
    }

    /// Figures of the radar equation; None in the thesis' convention.
    #[getter]
    fn budget(&self) -> Option<LinkBudget> {
        self.0.budget.map(LinkBudget)
    }

    /// An echo by the radar equation, with the radar's budget or the usual one: levels and signal-to-noise ratios in decibels.
    ///
    /// Args:
    ///     range_metres: Range of the object in metres.
    ///     cross_section_dbsm: Its radar cross section in decibels over a square metre.
    ///     angle_degrees: Its direction off broadside in degrees.
    ///
    /// Returns:
    ///     received_dbm, noise_dbm, sample_snr_db, range_snr_db (in a range bin), end_snr_db and array_snr_db (by one end and by
    ///     the whole array, their elements added in phase). The loss of an echo between two cells is left out.
    ///
    /// Raises:
    ///     ValueError: The range is not above 0, or a number is not finite.
    #[pyo3(signature = (range_metres, cross_section_dbsm=0.0, angle_degrees=0.0))]
    fn link<'py>(
        &self,
        py: Python<'py>,
        range_metres: f64,
        cross_section_dbsm: f64,
        angle_degrees: f64,
    ) -> PyResult<Bound<'py, PyDict>> {
        link_figures(&self.0, py, range_metres, cross_section_dbsm, angle_degrees)
    }

    /// "one-way" or "two-way".
    #[getter]
    fn carrier(&self) -> &'static str {
        self.0.carrier.name()
    }

    /// "thesis" or "physical": which way the phases of echoes follow their ranges.
    #[getter]
    fn convention(&self) -> &'static str {
        self.0.convention().name()
    }

    /// Places of the transmitters in metres, float64 `[transmitters]`; None where every element sends and hears by itself.
    #[getter]
    fn transmitter_x_metres<'py>(&self, py: Python<'py>) -> Option<Numbers<'py>> {
        self.of_antennas(py, Antennas::transmitter_x_metres)
    }

    /// Places of the receivers in metres, float64 `[receivers]`; None where every element sends and hears by itself.
    #[getter]
    fn receiver_x_metres<'py>(&self, py: Python<'py>) -> Option<Numbers<'py>> {
        self.of_antennas(py, Antennas::receiver_x_metres)
    }

    /// How far each transmitter stands off the array's line, towards the scene, metres, float64 `[transmitters]`; None where every element
    /// sends and hears by itself.
    #[getter]
    fn transmitter_y_metres<'py>(&self, py: Python<'py>) -> Option<Numbers<'py>> {
        self.of_antennas(py, Antennas::transmitter_y_metres)
    }

    /// How far each receiver stands off the array's line, towards the scene, metres, float64 `[receivers]`; None where every element sends and
    /// hears by itself.
    #[getter]
    fn receiver_y_metres<'py>(&self, py: Python<'py>) -> Option<Numbers<'py>> {
        self.of_antennas(py, Antennas::receiver_y_metres)
    }

    /// Whether maps focus elements that stand off the array's line.
    #[getter]
    fn focus_off_line(&self) -> bool {
        self.0.focus_off_line
    }

    /// Name of the window.
    #[getter]
    fn window(&self) -> &'static str {
        self.0.window.name()
    }

    /// Chirps that are sent one after another.
    #[getter]
    fn chirps(&self) -> usize {
        self.0.chirps
    }

    /// From one chirp to the next, seconds.
    #[getter]
    fn chirp_interval_seconds(&self) -> f64 {
        self.0.chirp_interval_seconds
    }

    /// Radial velocities below this one have a column of their own, metres a second.
    #[getter]
    fn unambiguous_velocity_metres_per_second(&self) -> f64 {
        self.0.unambiguous_velocity_metres_per_second()
    }

    /// Radial velocities of the columns of a range-Doppler map, away from the radar positive, float64 `[chirps]`.
    #[getter]
    fn velocity_metres_per_second<'py>(&self, py: Python<'py>) -> Numbers<'py> {
        each(py, self.0.chirps, |column| self.0.velocity_of_column_metres_per_second(column as f64))
    }

    /// Wavelength of the carrier in metres.
    #[getter]
    fn wavelength_metres(&self) -> f64 {
        self.0.wavelength_metres()
    }

    /// Distance between neighbouring range bins in metres.
    #[getter]
    fn range_resolution_metres(&self) -> f64 {
        self.0.range_resolution_metres()
    }

    /// Range at which range bins wrap around, in metres.
    #[getter]
    fn max_range_metres(&self) -> f64 {
        self.0.max_range_metres()
    }

    /// Distance between the first and the last element in metres.
    #[getter]
    fn aperture_metres(&self) -> f64 {
        self.0.aperture_metres()
    }

    /// Positions of the elements on the x axis in metres, float64 `[elements]`.
    #[getter]
    fn element_x_metres<'py>(&self, py: Python<'py>) -> Numbers<'py> {
        each(py, self.0.elements, |n| self.0.element_x_metres(n))
    }

    /// Ranges of the bins of a map in metres, float64 `[samples]`.
    #[getter]
    fn range_metres<'py>(&self, py: Python<'py>) -> Numbers<'py> {
        each(py, self.0.samples, |bin| self.0.range_of_bin_metres(bin as f64))
    }

    /// Cosines, from the array's axis, of the columns of a map, float64 `[elements]`.
    ///
    /// They rise from column to column under the one-way carrier and fall under the two-way carrier: `map[:, radar.rising_columns]` has left on the
    /// left with either. A map in NumPy, Z being `samples` of `Maps` and H and E the weights of the window over samples and elements:
    /// `Y = numpy.fft.fftshift(numpy.fft.fft(numpy.fft.fft(Z * H, axis=1) * E[:, None], axis=0), axes=0).T`, each transform over the root of its
    /// length; `Maps.complex` is it.
    #[getter]
    fn cos_theta<'py>(&self, py: Python<'py>) -> Numbers<'py> {
        each(py, self.0.elements, |column| self.0.cos_of_column(column as f64))
    }

    /// Numbers of the columns of a map from left to right, int64 `[elements]`: cos(theta) rises along `map[:, radar.rising_columns]`. The same brings
    /// the columns back. Column 0, whose cosine is 1 and -1 alike, stays the first.
    #[getter]
    fn rising_columns<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        let elements = self.0.elements as i64;
        let falls = self.0.cos_of_column(0.0) > 0.0;
        owned(py, (0..elements).map(|k| if falls && k > 0 { elements - k } else { k }).collect::<Array1<i64>>())
    }

    fn __eq__(&self, other: &Bound<'_, PyAny>) -> bool {
        other.cast::<Radar>().is_ok_and(|other| *other.get() == *self)
    }

    fn __hash__(&self) -> u64 {
        use std::hash::{DefaultHasher, Hash, Hasher};
        let mut hasher = DefaultHasher::new();
        (self.0.elements, self.0.samples, self.0.carrier_hz.to_bits()).hash(&mut hasher);
        hasher.finish()
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        text_of(&self.0, py)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (Bound<'py, PyDict>,))> {
        Ok((py.import("apertura._pickle")?.getattr("radar")?, (fields_of(&self.0, py)?,)))
    }
}
