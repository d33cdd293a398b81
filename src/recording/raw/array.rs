//! Arrays without a TOML: the kinds of their axes by evidence, and the TOML with them.

use super::axes::{Reading, readings};
use super::beside;
use super::boards::Board;
use super::imported::Imported;
use super::line::{ElementLine, element_line, uniform};
use super::text::{self, Subject};
use crate::recording::layout::{Certainty, Counts};
use crate::recording::numbers::Numbers;
use crate::recording::profile::RadarProfile;
use crate::recording::recording_text::open_file;
use crate::recording::{AxisKind, Fault, Origin, ReadingOption, RecordingError, hdf5, numpy};
use crate::scene::npz::X_KEY;
use std::io::BufReader;
use std::path::{Path, PathBuf};

const MAX_OFFERS: usize = 4;

pub(super) const ENDINGS: [&str; 5] = ["npy", "npz", "mat", "h5", "hdf5"];

/// Finds the ways to read the largest array of the file `data`.
pub(super) fn import(
    data: &Path,
    config: Option<PathBuf>,
    profile: Option<&RadarProfile>,
    board: Option<&'static Board>,
) -> Result<Imported, RecordingError> {
    let (key, mut numbers) = largest(data).map_err(|fault| fault.of(data))?;
    let mut doubts: Vec<String> = numbers.restore_signs().into_iter().collect();
    let shape = numbers.shape().to_vec();
    let mut all = readings(&numbers, profile);
    all.truncate(MAX_OFFERS);
    let Some(best) = all.first() else {
        let expected = "2 to 5 axes, none of length 0: samples and elements, with chirps, frames or transmitters";
        return Err(Fault::key("the array", format!("has shape {shape:?}"), expected).of(data));
    };
    let mut sentences = vec![format!(
        "The array{} holds {}.",
        key.as_ref().map_or(String::new(), |k| format!(" \"{k}\"")),
        best.description(&shape)
    )];
    sentences.extend(best.reasons.iter().cloned());
    doubts.extend(all.get(1).and_then(|next| doubt_of_axes(best, next, &shape)));
    if profile.is_none() {
        doubts.push(
            "No .cfg says the carrier and the slope: a bin of range is shown as one metre, and directions are those of elements half a \
             wavelength apart."
                .to_owned(),
        );
    }
    let offer = |reading: &Reading| {
        let turn_transmitters = turn_transmitters(reading, &shape, profile);
        let element_line = line_of(reading, &shape, turn_transmitters, profile, board);
        let subject = Subject { data, profile, line: &element_line, sentences: &sentences };
        let array = text::Array { reading, shape: &shape, key: key.as_deref(), turn_transmitters };
        let (description, power) = (reading.description(&shape), reading.power.clone());
        (
            ReadingOption { description, log_odds: reading.log_odds, power, toml: text::of_array(&array, &subject) },
            element_line,
        )
    };
    let (offers, lines): (Vec<ReadingOption>, Vec<ElementLine>) = all.iter().map(offer).unzip();
    lines.first().map_or(Ok(()), |line| check_directions(line, best, &shape, data)).map_err(|fault| fault.of(data))?;
    let board = lines.first().and_then(|element_line| element_line.board);
    doubts.extend(lines.into_iter().take(1).flat_map(|element_line| element_line.doubts));
    let frames = best.len(AxisKind::Frame, &shape) as u64;
    let data = data.to_owned();
    let origin = Origin { data, config, offers, sentences, doubts, board, frames, ..Origin::default() };
    Ok(Imported { origin, found: None })
}

/// A sentence on the `next` reading where the `best` is not sure.
fn doubt_of_axes(best: &Reading, next: &Reading, shape: &[usize]) -> Option<String> {
    let [how, or] = Certainty::of(Some(best.log_odds - next.log_odds)).doubt()?;
    Some(format!("The meaning of the axes is {how}. {or}: {}.", next.description(shape)))
}

/// Refuses a single element, and names the TOML that describes the array where there is one.
fn check_directions(line: &ElementLine, best: &Reading, shape: &[usize], data: &Path) -> Result<(), Fault> {
    if line.transmitter_x_metres.len() * line.receiver_x_metres.len() > 1 {
        return Ok(());
    }
    let found = format!("is read as {}, which tell ranges and no directions", best.description(shape));
    let toml = beside::toml_of(data);
    let instead = toml.map_or_else(String::new, |toml| format!(", or {}, which describes this file", toml.display()));
    Err(Fault::key("the array", found, format!("two elements or more{instead}")))
}

/// The array with the most numbers of the file, and its name where it has one.
fn largest(data: &Path) -> Result<(Option<String>, Numbers), Fault> {
    let open = || open_file(data).map(BufReader::new);
    let ending = data.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
    let all = match ending.as_str() {
        "npy" => return Ok((None, numpy::read_npy(open()?)?)),
        "npz" => numpy::shapes(open()?)?,
        "mat" => hdf5::mat_shapes(open()?)?,
        _ => hdf5::h5_shapes(open()?)?,
    };
    if ending == "npz" && holds_own(&all) {
        let expected = "samples alone; `apertura maps` and `apertura reconstruct` read archives of their own";
        return Err(Fault::key("the archive", "holds a scene or maps of this program", expected));
    }
    let count = |shape: &[usize]| shape.iter().fold(1usize, |n, len| n.saturating_mul(*len));
    let (key, _) = all
        .into_iter()
        .max_by_key(|(_, shape)| count(shape))
        .ok_or_else(|| Fault::key("the file", "holds no array of numbers", "one with samples"))?;
    let numbers = match ending.as_str() {
        "npz" => numpy::read_npz(open()?, &key)?,
        "mat" => hdf5::read_mat(open()?, &key)?,
        _ => hdf5::read_h5(open()?, &key)?,
    };
    Ok((Some(key), numbers))
}

/// Keys of `.npz` files with a scene or with the program's own maps.
const RESERVED_KEYS: [&str; 8] =
    [X_KEY, "ends", "format_version", "heard", "net_output", "polar_full", "polar_partial_mag_phase", "sub0"];

/// Whether an `.npz` holds samples: an array of two axes or more, and none of a scene or of maps.
pub(super) fn has_samples(path: &Path) -> bool {
    let all = open_file(path).ok().and_then(|file| numpy::shapes(BufReader::new(file)).ok()).unwrap_or_default();
    !holds_own(&all) && all.iter().any(|(_, shape)| shape.len() > 1)
}

fn holds_own(all: &[(String, Vec<usize>)]) -> bool {
    all.iter().any(|(key, _)| RESERVED_KEYS.contains(&key.as_str()))
}

/// Number of transmitters that send in turn along the axis of chirps by the `.cfg`; `None` where the axes don't fit that.
fn turn_transmitters(reading: &Reading, shape: &[usize], profile: Option<&RadarProfile>) -> Option<usize> {
    let profile = profile?;
    let (transmitters, chirps) = (profile.chirp_transmitters.len(), reading.len(AxisKind::Chirp, shape));
    let fits = transmitters > 1
        && !profile.both_transmitters
        && reading.kinds.contains(&AxisKind::Chirp)
        && reading.len(AxisKind::Element, shape) == profile.receivers
        && chirps == profile.loops * transmitters;
    fits.then_some(transmitters)
}

/// The elements: those of the `.cfg` where the numbers of its antennas fit the axes, or elements half a wavelength apart.
fn line_of(
    reading: &Reading,
    shape: &[usize],
    turn_transmitters: Option<usize>,
    profile: Option<&RadarProfile>,
    board: Option<&'static Board>,
) -> ElementLine {
    let receivers = reading.len(AxisKind::Element, shape) * reading.len(AxisKind::Receiver, shape);
    let chirps = turn_transmitters.unwrap_or(reading.len(AxisKind::Transmitter, shape));
    let loops = reading.len(AxisKind::Chirp, shape) / turn_transmitters.unwrap_or(1);
    let counts = Counts { samples: reading.len(AxisKind::Sample, shape), receivers, chirps, loops };
    let fits = |p: &&RadarProfile| receivers == p.receivers && chirps == p.chirp_transmitters.len();
    match profile {
        Some(profile) if !fits(&profile) => uniform(counts, profile.carrier_hz()),
        profile => element_line(counts, profile, board),
    }
}

#[cfg(test)]
mod tests {
    use crate::files::npz::write_npz;
    use crate::radar::SPEED_OF_LIGHT;
    use crate::recording::file::load;
    use crate::recording::raw::tests::{CFG, folder};
    use ndarray::{Array2, Array4, ArrayD};
    use ndarray_npy::WriteNpyExt;
    use num_complex::Complex64;
    use std::f64::consts::TAU;

    /// Four loops of two transmitters in turn, four receivers, 64 samples: an echo in range bin 11, at a cosine of 0.25.
    fn cube() -> Array4<Complex64> {
        Array4::from_shape_fn((1, 8, 4, 64), |(_, chirp, receiver, n)| {
            let element = (4 * (chirp % 2) + receiver) as f64;
            let noise = ((n * 7 + receiver * 13 + chirp * 5) % 23) as f64 / 10.0;
            Complex64::from_polar(900.0, TAU * (11.0 * n as f64 / 64.0 - 0.125 * element)) + noise
        })
    }

    fn npy(values: ArrayD<Complex64>) -> Vec<u8> {
        let mut bytes = Vec::new();
        values.write_npy(&mut bytes).unwrap();
        bytes
    }

    #[test]
    fn archives_of_this_program_are_no_samples() {
        let folder = folder(&[]);
        let path = folder.path().join("found.npz");
        write_npz(&path, |out| out.add("net_output", &Array2::<f32>::zeros((64, 8)))).unwrap();
        let told = super::super::import(&path, None, None).unwrap_err().to_string();
        assert!(told.contains("found.npz: the archive holds a scene or maps of this program"), "{told}");
    }

    #[test]
    fn the_cfg_tells_transmitters_in_turn_apart() {
        let folder = folder(&[("cube.npy", &npy(cube().into_dyn())), ("cube.cfg", CFG.as_bytes())]);
        let recording = load(&folder.path().join("cube.npy")).unwrap();
        assert_eq!(recording.radar.elements, 8);
        let samples = &recording.signal().unwrap().samples;
        // The phase of an echo falls by an eighth of a turn from element to element, or rises, all along the line.
        let steps: Vec<f64> = (1..8).map(|n| (samples[[n, 5]] / samples[[n - 1, 5]]).arg() / TAU).collect();
        assert!(steps.iter().all(|step| (step.abs() - 0.125).abs() < 0.01), "{steps:?}");
        let slope = SPEED_OF_LIGHT / (2.0 * 50e12 * 64.0 / 4e6);
        assert!((recording.radar.range_resolution_metres() / slope - 1.0).abs() < 1e-6);
    }

    #[test]
    fn axes_of_mat_files_are_in_matlabs_order() {
        let new = include_bytes!("../../../tests/data/hdf5/new.mat");
        let folder = folder(&[("new.mat", new), ("new.h5", new)]);
        for (name, shape) in [("new.mat", [4, 3, 2]), ("new.h5", [2, 3, 4])] {
            let (key, numbers) = super::largest(&folder.path().join(name)).unwrap();
            assert_eq!((key.as_deref(), numbers.shape()), (Some("radar.adcData"), &shape[..]));
        }
    }

    #[test]
    fn arrays_of_no_fitting_shape_are_refused() {
        let flat = ArrayD::from_elem(vec![64], Complex64::ONE);
        let row = npy(ArrayD::from_elem(vec![1, 86], Complex64::ONE));
        let folder = folder(&[
            ("flat.npy", &npy(flat)),
            ("new.h5", b"\x89HDF"),
            ("no.npz", b"PK"),
            ("row.npy", &row),
            ("row.toml", b"[recording]\nfile = \"row.npy\"\n"),
            ("bare.npy", &row),
            ("bare.toml", b"[recording]\nfile = \"row.npy\"\n"),
        ]);
        let told = |name: &str| load(&folder.path().join(name)).unwrap_err().to_string();
        assert!(told("flat.npy").contains("has shape [64]; expected 2 to 5 axes"), "{}", told("flat.npy"));
        assert!(told("new.h5").contains("not an HDF5 file"), "{}", told("new.h5"));
        assert!(told("no.npz").contains("no.npz"), "{}", told("no.npz"));
        let row = told("row.npy");
        assert!(row.contains("row.npy: the array is read as 1 element × 86 samples"), "{row}");
        assert!(
            row.contains("two elements or more, or ") && row.ends_with("row.toml, which describes this file"),
            "{row}"
        );
        let bare = told("bare.npy");
        assert!(bare.contains("bare.npy: the array") && bare.ends_with("expected two elements or more"), "{bare}");
    }
}
