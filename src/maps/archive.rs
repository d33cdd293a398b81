//! A scene's samples and maps as a NumPy archive with the keys of the thesis author's program, the axes and the radar's constants.

use super::focus::map_of;
use super::{Aperture, LogMap, RangeAngleMap, channels_map, network_input};
use crate::files::npz::{Npz, NpzError, NpzOutput, write_npz};
use crate::radar::{Antennas, CHIRP_SECONDS, Carrier, End, LinkBudget, Radar, WindowFunction};
use crate::scene::{Scene, npz};
use crate::signal::{BeatSignal, LayoutSamples, TwoEnds};
use ndarray::{Array1, Axis, Ix0, Ix1, arr0};
use std::path::Path;

/// Version of the archive's keys. Version 1 has neither this key nor axes nor constants; version 2 is for single antennas and has no keys of pairs.
pub const FORMAT_VERSION: i64 = 3;
/// Version of archives of radars whose elements are single antennas.
const MONOSTATIC_VERSION: i64 = 2;

/// Keys of the antennas, in the order of [`Antennas::new`].
const ANTENNA_KEYS: [&str; 2] = ["transmitter_x_metres", "receiver_x_metres"];
/// Keys of the antennas' distances from the line, in the order of [`Antennas::off_line`].
const OFF_LINE_KEYS: [&str; 2] = ["transmitter_y_metres", "receiver_y_metres"];
/// Key that is 1 where `polar_full` is focused, and missing otherwise.
const FOCUS_KEY: &str = "focus_off_line";

const BUDGET_KEYS: [&str; 3] = ["transmit_power_dbm", "antenna_gain_dbi", "noise_figure_db"];
const WIDTH_KEY: &str = "half_power_width_degrees";

/// Key of whether columns run from left to right; older archives lack it.
const COLUMNS_KEY: &str = "columns_left_to_right";

const VERSION_KEY: &str = "format_version";

/// Writes the author's keys: `all_point_x`, `all_point_y` (f64 `[L]`, metres), `sub0`, `sub1` (complex128 `[samples, end elements]`, the
/// samples of the two ends), `polar_full` (f64 `[1, range bins, columns]`, log10 magnitude of the whole array, not normalised) and
/// `polar_partial_mag_phase` (f64 `[4, range bins, columns]`, the network's input). Where there is one, `output` (f32 `[1, range bins,
/// columns]`) is Lambda as a method estimates it. Arrays are in NumPy's usual (C) order.
///
/// The axes are `range_metres` (f64 `[range bins]`), `cos_theta` (f64 `[columns]`; squint may shift an echo in the map from its true direction),
/// `columns_left_to_right` (i64: 1 where `cos_theta` rises from column to column, 0 where it falls and
/// `polar_full[..., ::-1]` is the map as it is drawn), `element_x_metres` (f64 `[elements]`; `sub0` has the first of them, `sub1` the last). Each
/// constant of the radar is a number of its own: `carrier_hz`, `bandwidth_hz`, `element_spacing_metres`, `transmit_power_watts` (f64),
/// `chirp_seconds` (f64, where it is another than [`CHIRP_SECONDS`]), `elements`, `end_elements`, `samples` (i64), `carrier_turns_per_wavelength`
/// (f64, -1 for the one-way and +2 for the two-way reading). `sample_window` (f64 `[samples]`) and `element_window` (f64 `[elements]`) are the
/// weights of the two transforms. Where transmitters stand apart from receivers, `transmitter_x_metres` and `receiver_x_metres` (f64) are their
/// places; an element stands halfway between its two antennas. Where some stand off the line, `transmitter_y_metres` and `receiver_y_metres` say
/// how far; `focus_off_line` (i64) is 1 where `polar_full` is focused ([`super::focus`]). A link budget is `transmit_power_dbm`,
/// `antenna_gain_dbi`, `noise_figure_db` and, where elements have a pattern, `half_power_width_degrees` (f64). `format_version` is
/// [`FORMAT_VERSION`], or 2 without such antennas. The samples of a layout are `heard` (complex128 `[elements of the layout, samples]`), and `layout`
/// (i64) has the elements' numbers.
///
/// Returns `polar_full`.
/// # Errors
/// [`NpzError`] where the file can't be written. No incomplete file remains.
pub fn write_maps(
    path: &Path,
    radar: &Radar,
    scene: &Scene,
    signal: &BeatSignal,
    layout_samples: Option<&LayoutSamples>,
    output: Option<&RangeAngleMap>,
) -> Result<LogMap, NpzError> {
    let full = map_of(radar, &scene.disturbances.elements, signal, Aperture::Full).log_magnitude();
    write_npz(path, |out| {
        npz::add_positions(out, scene)?;
        add_recorded(out, radar, &signal.two_ends(radar), Some(&full), layout_samples, output)
    })?;
    Ok(full)
}

/// The archive of a recording: [`write_maps`] without reflectors, and with `polar_full` where all elements were recorded.
/// # Errors
/// As [`write_maps`].
pub fn write_recorded_maps(
    path: &Path,
    radar: &Radar,
    ends: &TwoEnds,
    full: Option<&LogMap>,
    layout_samples: Option<&LayoutSamples>,
    output: Option<&RangeAngleMap>,
) -> Result<(), NpzError> {
    write_npz(path, |out| add_recorded(out, radar, ends, full, layout_samples, output))
}

/// Writes the maps of a recording's frames: `polar_full` (f64 `[frames, samples, elements]`), with the axes of [`write_maps`]. `next` computes the map
/// of each frame in order; one is in memory at a time.
/// # Errors
/// The error of `next`, or [`NpzError::Io`].
pub fn write_frames(
    path: &Path,
    radar: &Radar,
    frames: usize,
    mut next: impl FnMut(usize) -> Result<LogMap, NpzError>,
) -> Result<(), NpzError> {
    let shape = [frames, radar.samples, radar.elements];
    write_npz(path, |out| {
        out.add_stack("polar_full", shape, |n| Ok(next(n)?.decades().clone()))?;
        add_axes(out, radar)
    })
}

/// The radar of an archive that [`write_maps`] wrote; `None` for one without the radar's constants: version 1, or the author's own.
/// # Errors
/// [`NpzError`] names a constant that is missing, damaged or of another type, or a fault of the radar.
pub fn read_radar(archive: &mut Npz) -> Result<Option<Radar>, NpzError> {
    if !archive.has(VERSION_KEY) {
        return Ok(None);
    }
    let version = number(archive, VERSION_KEY)?;
    if version > FORMAT_VERSION as f64 {
        return Err(expected(VERSION_KEY, version, format!("at most {FORMAT_VERSION}, what this program writes")));
    }
    let turns = number(archive, "carrier_turns_per_wavelength")?;
    let carrier = [Carrier::OneWay, Carrier::TwoWay].into_iter().find(|c| c.turns_per_wavelength() == turns);
    let mut count = |key: &str| Ok::<_, NpzError>(number(archive, key)? as usize);
    let (elements, end_elements, samples) = (count("elements")?, count("end_elements")?, count("samples")?);
    let chirp_seconds = optional(archive, "chirp_seconds")?;
    let radar = Radar {
        transmit_power_watts: number(archive, "transmit_power_watts")?,
        bandwidth_hz: number(archive, "bandwidth_hz")?,
        carrier_hz: number(archive, "carrier_hz")?,
        element_spacing_metres: number(archive, "element_spacing_metres")?,
        elements,
        end_elements,
        samples,
        chirp_seconds: chirp_seconds.unwrap_or(CHIRP_SECONDS),
        carrier: carrier.ok_or_else(|| expected("carrier_turns_per_wavelength", turns, "-1 or 2".to_owned()))?,
        window: WindowFunction::default(),
        antennas: read_antennas(archive)?,
        focus_off_line: optional(archive, FOCUS_KEY)?.is_some_and(|focused| focused != 0.0),
        budget: read_budget(archive)?,
        ..Radar::default()
    };
    check_columns(archive, &radar)?;
    radar.validate().map_err(|e| NpzError::Damaged { key: e.field().to_owned(), reason: e.to_string() })?;
    let weights = archive.reals::<Ix1>("element_window")?;
    let like = |window: &WindowFunction| window.weights(elements) == weights.to_vec();
    let window = WindowFunction::ALL.into_iter().find(like).ok_or_else(|| NpzError::Damaged {
        key: "element_window".to_owned(),
        reason: "its weights are those of no window that this program knows".to_owned(),
    })?;
    Ok(Some(Radar { window, ..radar }))
}

/// Refuses maps with reversed columns: their samples and `polar_partial_mag_phase` would have another order than the radar's.
fn check_columns(archive: &mut Npz, radar: &Radar) -> Result<(), NpzError> {
    let own = f64::from(u8::from(!radar.columns_fall()));
    match optional(archive, COLUMNS_KEY)? {
        Some(found) if found != own => {
            let turns = radar.carrier.turns_per_wavelength();
            Err(expected(COLUMNS_KEY, found, format!("{own}, as carrier_turns_per_wavelength is {turns}")))
        }
        _ => Ok(()),
    }
}

fn read_budget(archive: &mut Npz) -> Result<Option<LinkBudget>, NpzError> {
    if !archive.has(BUDGET_KEYS[0]) {
        return Ok(None);
    }
    let half_power_width_degrees = optional(archive, WIDTH_KEY)?;
    let [power, gain, noise] = BUDGET_KEYS.map(|key| number(archive, key));
    let (transmit_power_dbm, antenna_gain_dbi, noise_figure_db) = (power?, gain?, noise?);
    Ok(Some(LinkBudget { transmit_power_dbm, antenna_gain_dbi, noise_figure_db, half_power_width_degrees }))
}

fn read_antennas(archive: &mut Npz) -> Result<Option<Antennas>, NpzError> {
    if !archive.has(ANTENNA_KEYS[0]) {
        return Ok(None);
    }
    let damaged = |key: &'static str| move |reason| NpzError::Damaged { key: key.to_owned(), reason };
    let [transmitters, receivers] = places(archive, ANTENNA_KEYS)?;
    let antennas = Antennas::new(&transmitters, &receivers).map_err(damaged(ANTENNA_KEYS[0]))?;
    if !archive.has(OFF_LINE_KEYS[0]) {
        return Ok(Some(antennas));
    }
    let [transmitters, receivers] = places(archive, OFF_LINE_KEYS)?;
    antennas.off_line(&transmitters, &receivers).map(Some).map_err(damaged(OFF_LINE_KEYS[0]))
}

fn places(archive: &mut Npz, keys: [&str; 2]) -> Result<[Vec<f64>; 2], NpzError> {
    Ok([archive.reals::<Ix1>(keys[0])?.to_vec(), archive.reals::<Ix1>(keys[1])?.to_vec()])
}

fn optional(archive: &mut Npz, key: &str) -> Result<Option<f64>, NpzError> {
    archive.has(key).then(|| number(archive, key)).transpose()
}

fn number(archive: &mut Npz, key: &str) -> Result<f64, NpzError> {
    Ok(archive.reals::<Ix0>(key)?.into_scalar())
}

fn expected(key: &str, found: f64, expected: String) -> NpzError {
    NpzError::Damaged { key: key.to_owned(), reason: format!("it is {found}; expected {expected}") }
}

/// Adds the directions of the columns of a map (`cos_theta`), and their order (`columns_left_to_right`).
/// # Errors
/// As [`NpzOutput::add`].
pub fn add_columns(out: &mut NpzOutput, radar: &Radar) -> Result<(), NpzError> {
    let cosines: Array1<f64> = (0..radar.elements).map(|column| radar.cos_of_column(column as f64)).collect();
    out.add("cos_theta", &cosines)?;
    out.add(COLUMNS_KEY, &arr0(i64::from(!radar.columns_fall())))
}

fn add_axes(out: &mut NpzOutput, radar: &Radar) -> Result<(), NpzError> {
    let axis = |count: usize, at: &dyn Fn(usize) -> f64| (0..count).map(at).collect::<Array1<f64>>();
    let version = if radar.is_monostatic() { MONOSTATIC_VERSION } else { FORMAT_VERSION };
    out.add(VERSION_KEY, &arr0(version))?;
    if let Some(antennas) = &radar.antennas {
        let along = ANTENNA_KEYS.into_iter().zip([antennas.transmitter_x_metres(), antennas.receiver_x_metres()]);
        let ahead = OFF_LINE_KEYS.into_iter().zip([antennas.transmitter_y_metres(), antennas.receiver_y_metres()]);
        for (key, places) in along.chain(ahead.filter(|_| !antennas.is_on_line())) {
            out.add(key, &Array1::from(places.to_vec()))?;
        }
    }
    if radar.focus_off_line {
        out.add(FOCUS_KEY, &arr0(1i64))?;
    }
    out.add("range_metres", &axis(radar.samples, &|bin| radar.range_of_bin_metres(bin as f64)))?;
    add_columns(out, radar)?;
    out.add("element_x_metres", &axis(radar.elements, &|n| radar.element_x_metres(n)))?;
    out.add("sample_window", &Array1::from(radar.window.weights(radar.samples)))?;
    out.add("element_window", &Array1::from(radar.window.weights(radar.elements)))?;
    for (key, constant) in [
        ("carrier_hz", radar.carrier_hz),
        ("bandwidth_hz", radar.bandwidth_hz),
        ("element_spacing_metres", radar.element_spacing_metres),
        ("transmit_power_watts", radar.transmit_power_watts),
        ("carrier_turns_per_wavelength", radar.carrier.turns_per_wavelength()),
    ] {
        out.add(key, &arr0(constant))?;
    }
    if radar.chirp_seconds != CHIRP_SECONDS {
        out.add("chirp_seconds", &arr0(radar.chirp_seconds))?;
    }
    if let Some(budget) = &radar.budget {
        let numbers = [budget.transmit_power_dbm, budget.antenna_gain_dbi, budget.noise_figure_db];
        let pattern = budget.half_power_width_degrees.map(|width| (WIDTH_KEY, width));
        for (key, number) in BUDGET_KEYS.into_iter().zip(numbers).chain(pattern) {
            out.add(key, &arr0(number))?;
        }
    }
    for (key, count) in [("elements", radar.elements), ("end_elements", radar.end_elements), ("samples", radar.samples)]
    {
        out.add(key, &arr0(count as i64))?;
    }
    Ok(())
}

fn add_recorded(
    out: &mut NpzOutput,
    radar: &Radar,
    ends: &TwoEnds,
    full: Option<&LogMap>,
    layout_samples: Option<&LayoutSamples>,
    output: Option<&RangeAngleMap>,
) -> Result<(), NpzError> {
    let [first, last] = End::BOTH.map(|end| channels_map(radar, ends.end(end).view()));
    for (key, end) in [("sub0", End::First), ("sub1", End::Last)] {
        out.add(key, &ends.end(end).t().as_standard_layout())?;
    }
    if let Some(full) = full {
        out.add("polar_full", &full.decades().view().insert_axis(Axis(0)))?;
    }
    out.add("polar_partial_mag_phase", &network_input::mag_phase(&first, &last))?;
    if let Some(LayoutSamples { layout, samples }) = layout_samples {
        out.add("heard", samples)?;
        out.add("layout", &layout.iter().map(|number| *number as i64).collect::<Array1<i64>>())?;
    }
    if let Some(output) = output {
        out.add("output", &output.lambda.view().insert_axis(Axis(0)))?;
    }
    add_axes(out, radar)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::signal::exact;
    use ndarray::{Ix1, Ix3};

    fn small() -> Radar {
        let window = WindowFunction::Blackman;
        let counts = Radar { elements: 32, end_elements: 6, samples: 16, ..Radar::default() };
        let budget = Some(LinkBudget { half_power_width_degrees: Some(70.0), ..LinkBudget::default() });
        Radar { carrier: Carrier::TwoWay, chirp_seconds: 1e-4, window, budget, ..counts }
    }

    fn archive(radar: &Radar) -> (tempfile::TempDir, Npz) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("maps.npz");
        let scene = Scene::of_points([(0.0, 0.5)]);
        let signal = exact::beat_signal(radar, &scene.reflectors());
        write_maps(&path, radar, &scene, &signal, None, None).unwrap();
        let archive = Npz::open(&path).unwrap();
        (folder, archive)
    }

    #[test]
    fn the_axes_name_the_cell_of_the_peak() {
        let radar = Radar { elements: 32, end_elements: 6, samples: 16, ..Radar::default() };
        let (_folder, mut archive) = archive(&radar);
        let [range, cos, x] =
            ["range_metres", "cos_theta", "element_x_metres"].map(|key| archive.reals::<Ix1>(key).unwrap());
        let full = archive.reals::<Ix3>("polar_full").unwrap();
        let ((_, bin, column), _) = full.indexed_iter().max_by(|a, b| a.1.total_cmp(b.1)).unwrap();
        assert_eq!(full.dim(), (1, range.len(), cos.len()));
        assert!((range[bin] - 0.5).abs() <= radar.range_resolution_metres() / 2.0, "{}", range[bin]);
        assert!(cos[column].abs() < 1e-12, "{}", cos[column]);
        let spacing = radar.element_spacing_metres;
        assert!((x[31] - 15.5 * spacing).abs() < 1e-12 && (x[0] + 15.5 * spacing).abs() < 1e-12);
    }

    #[test]
    fn the_radar_is_read_back_as_it_was() {
        let pairs = Radar { end_elements: 6, samples: 16, ..Radar::default() }.of_pairs(4, 8).unwrap();
        let antennas = pairs.antennas.clone().unwrap().off_line(&[-0.01, 0.0, 0.0, -0.01], &[0.002; 8]).unwrap();
        let bent = Radar { focus_off_line: true, ..pairs.clone().with_antennas(antennas) };
        let own = |radar: Radar| Radar { elements: 32, end_elements: 6, samples: 16, ..radar };
        for radar in [own(Radar::default()), own(small()), pairs, bent] {
            let (_folder, mut archive) = archive(&radar);
            assert_eq!(read_radar(&mut archive).unwrap(), Some(radar));
        }
    }

    #[test]
    fn archives_say_how_their_columns_run() {
        for (radar, left_to_right) in [(Radar { carrier: Carrier::OneWay, ..small() }, 1.0), (small(), 0.0)] {
            let (_folder, mut archive) = archive(&radar);
            assert_eq!(number(&mut archive, COLUMNS_KEY).unwrap(), left_to_right);
            let cos = archive.reals::<Ix1>("cos_theta").unwrap();
            assert_eq!(cos[0] < cos[31], left_to_right == 1.0, "{cos}");
        }
    }

    #[test]
    fn columns_that_run_against_the_carrier_are_refused() {
        let (folder, _) = archive(&small());
        let path = folder.path().join("turned.npz");
        write_npz(&path, |out| out.add(COLUMNS_KEY, &arr0(1i64))).unwrap();
        let error = check_columns(&mut Npz::open(&path).unwrap(), &small()).unwrap_err().to_string();
        assert!(error.contains("columns_left_to_right") && error.contains("it is 1; expected 0"), "{error}");
    }

    #[test]
    fn older_archives_have_no_radar_and_later_ones_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.npz");
        npz::write(&path, &Scene::of_points([(1.0, 2.0)])).unwrap();
        assert_eq!(read_radar(&mut Npz::open(&path).unwrap()).unwrap(), None);
        write_npz(&path, |out| out.add(VERSION_KEY, &arr0(FORMAT_VERSION + 1))).unwrap();
        let error = read_radar(&mut Npz::open(&path).unwrap()).unwrap_err().to_string();
        assert!(error.contains("format_version") && error.contains("it is 4; expected at most 3"), "{error}");
    }
}
