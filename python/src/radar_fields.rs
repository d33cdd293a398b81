//! The fields of a radar under their Python names: names of choices, lists of places, and the constructor's dict.

use crate::budget::LinkBudget;
use crate::errors::{argument, value};
use apertura::radar::{self, Carrier, Convention, WindowFunction};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// The carrier that the argument of this name says; `None` where it says none.
pub fn carrier_of(said: &Bound<'_, PyAny>) -> PyResult<Option<Carrier>> {
    if said.extract::<f64>().is_ok() {
        let told = format!("carrier is {}; expected one-way or two-way: its frequency is carrier_hz", said.repr()?);
        return Err(argument(said.py(), told));
    }
    choice("carrier", said, &[Carrier::OneWay, Carrier::TwoWay], Carrier::name)
}

/// The convention that the argument of this name says; `None` where it says none.
pub fn convention_of(said: &Bound<'_, PyAny>) -> PyResult<Option<Convention>> {
    choice("convention", said, &Convention::ALL, Convention::name)
}

/// The window that the argument of this name says; `None` where it says none.
pub fn window_of(said: &Bound<'_, PyAny>) -> PyResult<Option<WindowFunction>> {
    choice("window", said, &WindowFunction::ALL, WindowFunction::name)
}

/// The one of `all` whose name the argument `name` says.
fn choice<T: Copy>(
    name: &str,
    said: &Bound<'_, PyAny>,
    all: &[T],
    name_of: fn(T) -> &'static str,
) -> PyResult<Option<T>> {
    if said.is_none() {
        return Ok(None);
    }
    let expected = all.iter().map(|one| name_of(*one)).collect::<Vec<_>>().join(" or ");
    let Ok(text) = said.extract::<String>() else {
        return Err(argument(said.py(), format!("{name} is {}; expected {expected}", said.repr()?)));
    };
    let found = all.iter().find(|one| name_of(**one) == text).copied();
    found.map(Some).ok_or_else(|| value(format!("{name} is \"{text}\"; expected {expected}")))
}

/// Transmitters and receivers by their places along the line and off it.
pub fn antennas_of(along: [Option<Vec<f64>>; 2], off: [Option<Vec<f64>>; 2]) -> PyResult<Option<radar::Antennas>> {
    let (transmitters, receivers) = match along {
        [Some(transmitters), Some(receivers)] => (transmitters, receivers),
        [None, None] if off.iter().any(Option::is_some) => {
            let expected =
                "transmitter_y_metres and receiver_y_metres belong to lists of x; expected those beside them";
            return Err(value(expected));
        }
        [None, None] => return Ok(None),
        _ => return Err(value("transmitter_x_metres and receiver_x_metres go together; expected both or neither")),
    };
    let [of_transmitters, of_receivers] = off;
    let of_transmitters = of_transmitters.unwrap_or_else(|| vec![0.0; transmitters.len()]);
    let of_receivers = of_receivers.unwrap_or_else(|| vec![0.0; receivers.len()]);
    let antennas = radar::Antennas::new(&transmitters, &receivers).map_err(value)?;
    antennas.off_line(&of_transmitters, &of_receivers).map(Some).map_err(value)
}

/// The constructor's arguments for this radar, as a dict.
pub fn fields_of<'py>(radar: &radar::Radar, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
    let fields = PyDict::new(py);
    fields.set_item("transmit_power_watts", radar.transmit_power_watts)?;
    fields.set_item("bandwidth_hz", radar.bandwidth_hz)?;
    fields.set_item("carrier_hz", radar.carrier_hz)?;
    match &radar.antennas {
        Some(antennas) => {
            fields.set_item("transmitter_x_metres", antennas.transmitter_x_metres().to_vec())?;
            fields.set_item("receiver_x_metres", antennas.receiver_x_metres().to_vec())?;
            if !antennas.is_on_line() {
                fields.set_item("transmitter_y_metres", antennas.transmitter_y_metres().to_vec())?;
                fields.set_item("receiver_y_metres", antennas.receiver_y_metres().to_vec())?;
            }
        }
        None => {
            fields.set_item("element_spacing_metres", radar.element_spacing_metres)?;
            fields.set_item("elements", radar.elements)?;
        }
    }
    fields.set_item("end_elements", radar.end_elements)?;
    fields.set_item("samples", radar.samples)?;
    fields.set_item("chirp_seconds", radar.chirp_seconds)?;
    fields.set_item("chirps", radar.chirps)?;
    fields.set_item("chirp_interval_seconds", radar.chirp_interval_seconds)?;
    if radar.focus_off_line {
        fields.set_item("focus_off_line", true)?;
    }
    if let Some(budget) = radar.budget {
        fields.set_item("budget", LinkBudget(budget).into_pyobject(fields.py())?)?;
    }
    fields.set_item("carrier", radar.carrier.name())?;
    fields.set_item("window", radar.window.name())?;
    Ok(fields)
}

/// The fields of a radar that names none of them, in a convention if one is given.
pub fn usual_of(
    convention: Option<Convention>,
    carrier: Option<Carrier>,
    carrier_hz: Option<f64>,
    bandwidth_hz: Option<f64>,
) -> PyResult<radar::Radar> {
    let usual = radar::Radar::default();
    let Some(convention) = convention else { return Ok(usual) };
    if carrier.is_some_and(|c| c != convention.carrier()) {
        let expected = convention.carrier().name();
        let said = convention.name();
        return Err(value(format!("carrier is another than that of the {said} convention, {expected}")));
    }
    let carrier_hz = carrier_hz.unwrap_or(usual.carrier_hz);
    let bandwidth_hz = bandwidth_hz.unwrap_or(usual.bandwidth_hz);
    Ok(radar::Radar { carrier_hz, bandwidth_hz, ..usual }.in_convention(convention))
}

/// The constructor's arguments for `radar` with other `fields`.
pub fn replaced<'py>(
    radar: &radar::Radar,
    py: Python<'py>,
    fields: Option<&Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyDict>> {
    let all = fields_of(radar, py)?;
    if let Some(fields) = fields {
        let is_said = |key: &str| Ok::<_, PyErr>(fields.get_item(key)?.is_some_and(|v| !v.is_none()));
        if is_said("convention")? {
            all.del_item("carrier")?;
            if radar.is_monostatic() {
                all.del_item("element_spacing_metres")?;
            }
        }
        if is_said("transmitter_x_metres")? || is_said("receiver_x_metres")? {
            for key in ["elements", "element_spacing_metres", "transmitter_y_metres", "receiver_y_metres"] {
                if all.contains(key)? {
                    all.del_item(key)?;
                }
            }
        }
        all.update(fields.as_mapping())?;
    }
    Ok(all)
}

/// `Radar(...)` with the fields that differ from table 3.1.
pub fn text_of(radar: &radar::Radar, py: Python<'_>) -> PyResult<String> {
    let usual = fields_of(&radar::Radar::default(), py)?;
    let mut parts = Vec::new();
    for (key, own) in fields_of(radar, py)? {
        if !own.eq(usual.get_item(&key)?)? {
            parts.push(format!("{key}={}", own.repr()?));
        }
    }
    Ok(format!("Radar({})", parts.join(", ")))
}
