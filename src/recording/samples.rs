//! Samples of a recording's data files, sorted by the array's elements.

use super::axes::{Join, arrange, frame_of, into_loops, split_turns};
use super::capture::join_strongest;
use super::chain::{Source, open_joined};
use super::numbers::Numbers;
use super::numpy::{read_npy, read_npz};
use super::recording_table::{CoveredElements, RecordingTable};
use super::recording_text::RecordingText;
use super::{AxisKind, Capture, ChirpChoice, Fault, Recorded, hdf5};
use crate::radar::Radar;
use crate::signal::BeatSignal;
use ndarray::{Array2, Array3, Axis, ShapeError, concatenate};
use num_complex::Complex64;
use std::collections::HashSet;

impl RecordingText<'_> {
    /// Reads as many samples as the radar has, with all corrections of the table. The second value has a sentence for each doubt about them.
    pub fn samples(&self) -> Result<(Recorded, Vec<String>), Fault> {
        let table = &self.table;
        let (mut rows, notes) = match &table.capture {
            Some(capture) => {
                check_capture(table)?;
                let (file, pair_turns) = (self.open_capture(capture)?, pair_turns(&self.radar));
                let (rows, notes) = capture.read(file, self.profile.as_ref(), &pair_turns, table.beat_rises())?;
                (pairs_to_rows(rows)?, notes)
            }
            None => self.read_arrays()?,
        };
        if let Some(((element, sample), _)) = rows.indexed_iter().find(|(_, v)| !v.is_finite()) {
            let message = format!("sample {sample} of element {element} is not finite; expected finite numbers only");
            return Err(Fault::Data(message));
        }
        table.calibration.divide_out(&mut rows)?;
        self.signs.apply(&mut rows);
        if table.reverse_elements && !table.counts_pairs() {
            rows.invert_axis(Axis(0));
        }
        Ok((self.place_rows(self.in_element_order(rows)?)?, notes))
    }

    /// Sorts rows of pairs by the places of their elements, from the left, with zeros at gaps. Other rows stay as they are.
    fn in_element_order(&self, rows: Array2<Complex64>) -> Result<Array2<Complex64>, Fault> {
        let antennas = self.radar.antennas.as_ref().filter(|_| self.table.counts_pairs());
        let Some(antennas) = antennas else { return Ok(rows) };
        let (transmitters, receivers) = (antennas.transmitter_x_metres().len(), antennas.receiver_x_metres().len());
        if rows.nrows() != transmitters * receivers {
            let expected = format!("{transmitters} by {receivers}, as many as radar says places of antennas");
            return Err(Fault::count(["pair of antennas", "pairs of antennas"], rows.nrows(), &expected, rows.dim()));
        }
        let mut ordered = Array2::zeros((self.radar.elements, rows.ncols()));
        for (mut element, pair) in ordered.outer_iter_mut().zip(antennas.pairs()) {
            if let Some([t, r]) = pair {
                element.assign(&rows.row(t * receivers + r));
            }
        }
        Ok(ordered)
    }

    /// Every loop of a frame, `[loops, elements, samples]`, with the signs of the maps' formula.
    pub fn read_loops(&self) -> Result<Array3<Complex64>, Fault> {
        let mut loops = match &self.table.capture {
            Some(capture) => {
                check_capture(&self.table)?;
                capture.loops(self.open_capture(capture)?, self.profile.as_ref())?
            }
            None => self.read_array_loops()?,
        };
        self.signs.apply(&mut loops);
        Ok(loops)
    }

    /// Every loop of an array's frame, `[loops, elements, samples]`. Elements are the pairs of the selected transmitters and receivers.
    fn read_array_loops(&self) -> Result<Array3<Complex64>, Fault> {
        let table = &self.table;
        let mut kinds = table.axes.clone().unwrap_or_default();
        if !kinds.contains(&AxisKind::Chirp) {
            let expected = "an axis \"chirp\": one chirp tells no velocity";
            return Err(Fault::key("recording.axes", "has no loops", expected));
        }
        let mut numbers = self.read_numbers(table.array.as_deref())?;
        numbers.restore_signs();
        let numbers = split_turns(frame_of(numbers, &mut kinds, table.frame)?, &mut kinds, table.transmitters_in_turn)?;
        let loops = into_loops(numbers, &kinds)?;
        let (count, transmitters, receivers, samples) = loops.dim();
        let pairs = transmitters * receivers;
        let rows = loops
            .into_shape_with_order((count, pairs, samples))
            .map_err(|e| Fault::key("recording.axes", e.to_string(), "others"))?;
        Ok(match taken_rows(table, pairs, [transmitters, receivers])? {
            Some(places) => rows.select(Axis(1), &places),
            None => rows,
        })
    }

    /// Number of frames in the array; 1 without an axis of frames.
    pub fn count_frames(&self) -> Result<u64, Fault> {
        let table = &self.table;
        let place = table.axes.iter().flatten().position(|kind| *kind == AxisKind::Frame);
        let Some(place) = place else { return Ok(1) };
        let numbers = self.read_numbers(table.array.as_deref().or(table.first.as_deref()))?;
        Ok(numbers.shape().get(place).map_or(1, |frames| *frames as u64))
    }

    /// Opens the files of a capture as one.
    pub fn open_capture(&self, capture: &Capture) -> Result<Box<dyn Source>, Fault> {
        let Capture { more_files, chips, .. } = capture;
        if !(more_files.is_empty() || chips.is_empty()) {
            return Err(Fault::key("recording.capture.chips", "stands beside more_files", "one of the two"));
        }
        Ok(open_joined(&self.table.file, more_files, chips, |name| (self.open)(name))?)
    }

    /// Reads the array, or the arrays of both ends, `[elements, samples]`, and sentences on the samples.
    fn read_arrays(&self) -> Result<(Array2<Complex64>, Vec<String>), Fault> {
        let RecordingTable { axes, array, first, last, .. } = &self.table;
        let Some(axes) = axes else {
            let kinds = "a list of \"element\", \"sample\", \"chirp\" and so on, one for each axis of the array";
            return Err(Fault::key("recording.axes", "is missing", kinds));
        };
        match (array, first, last) {
            (array, None, None) => self.array_of(array.as_deref(), axes.clone()),
            (None, Some(first), Some(last)) => {
                let (first, mut notes) = self.array_of(Some(first), axes.clone())?;
                let (last, last_notes) = self.array_of(Some(last), axes.clone())?;
                if first.dim() != last.dim() {
                    let expected = format!("as many as \"first\" has, {} by {}", first.nrows(), first.ncols());
                    let numbers = ["number in \"last\"", "numbers in \"last\""];
                    return Err(Fault::count(numbers, last.len(), &expected, last.dim()));
                }
                notes.extend(last_notes);
                notes.dedup();
                let rows = concatenate(Axis(0), &[first.view(), last.view()]);
                let mismatch = |e: ShapeError| {
                    Fault::key("recording.last", format!("does not join ({e})"), "the shape of \"first\"")
                };
                Ok((rows.map_err(mismatch)?, notes))
            }
            _ => {
                Err(Fault::key("recording.array", "stands beside half a pair", "either array, or both first and last"))
            }
        }
    }

    /// Reads the array called `key`, `[elements, samples]`, and sentences on its samples.
    fn array_of(&self, key: Option<&str>, mut kinds: Vec<AxisKind>) -> Result<(Array2<Complex64>, Vec<String>), Fault> {
        let table = &self.table;
        let mut numbers = self.read_numbers(key)?;
        let mut notes: Vec<String> = numbers.restore_signs().into_iter().collect();
        let numbers = frame_of(numbers, &mut kinds, table.frame)?;
        notes.extend(real_samples_note(&numbers, &kinds));
        let numbers = split_turns(numbers, &mut kinds, table.transmitters_in_turn)?;
        let len = |kind| kinds.iter().position(|k| *k == kind).map_or(1, |place| numbers.shape()[place]);
        let sizes = [len(AxisKind::Transmitter), len(AxisKind::Receiver)];
        let rows = if table.chirp == Some(ChirpChoice::Joined(Join::Strongest)) && kinds.contains(&AxisKind::Chirp) {
            let (rows, notes_on_loops) = self.join_loops(numbers, &kinds)?;
            notes.extend(notes_on_loops);
            rows
        } else {
            arrange(numbers, &kinds, table.chirp)?
        };
        let rows = match taken_rows(table, rows.nrows(), sizes)? {
            Some(places) => rows.select(Axis(0), &places),
            None => rows,
        };
        Ok((rows, notes))
    }

    /// Joins the loops of an array by the strongest Doppler cells, `[elements, samples]`, and returns sentences on it.
    fn join_loops(&self, numbers: Numbers, kinds: &[AxisKind]) -> Result<(Array2<Complex64>, Vec<String>), Fault> {
        let chirps = kinds.iter().position(|kind| *kind == AxisKind::Chirp).map_or(1, |place| numbers.shape()[place]);
        let loops = into_loops(numbers, kinds)?;
        let (read, transmitters, _, _) = loops.dim();
        let left_out = (read < chirps).then(|| {
            format!(
                "The first {read} of {chirps} chirps are joined; the others are left out, since the frame is too large."
            )
        });
        let all: Vec<usize> = (0..transmitters).collect();
        let chosen = self.table.transmitters_taken.as_deref().unwrap_or(&all);
        if chosen.iter().any(|t| *t >= transmitters) {
            return Err(no_such_index("recording.transmitters_taken", chosen, transmitters));
        }
        let (rows, note) = join_strongest(loops, chosen, &pair_turns(&self.radar));
        let notes: Vec<String> = note.into_iter().chain(left_out).collect();
        Ok((pairs_to_rows(rows)?, notes))
    }

    /// Reads the array called `key`; `None` for the one array of an `.npy` file.
    fn read_numbers(&self, key: Option<&str>) -> Result<Numbers, Fault> {
        let table = &self.table;
        let open = || (self.open)(&table.file);
        let extension = table.extension();
        let named = || key.ok_or_else(|| Fault::key("recording.array", "is missing", "the array's name in the file"));
        match extension.as_str() {
            "npz" => read_npz(open()?, named()?),
            "mat" => hdf5::read_mat(open()?, named()?),
            "h5" | "hdf5" => hdf5::read_h5(open()?, named()?),
            "npy" if key.is_some() => {
                Err(Fault::key("recording.array", "is there", "it not beside an .npy file, which holds one array"))
            }
            "npy" => read_npy(open()?),
            "bin" => Err(Fault::key("[recording.capture]", "is missing", "it beside a .bin file")),
            _ => Err(Fault::key(
                "recording.file",
                format!("is \"{}\"", table.file),
                "a name ending in .npz, .npy, .mat, .h5 or .bin",
            )),
        }
    }

    /// Places the rows of the file in the whole array, with zeros for missing elements.
    fn place_rows(&self, rows: Array2<Complex64>) -> Result<Recorded, Fault> {
        let RecordingText { table, radar, .. } = self;
        if rows.ncols() != radar.samples {
            let expected = format!("{} as radar.samples says", radar.samples);
            return Err(Fault::count(["sample", "samples"], rows.ncols(), &expected, rows.dim()));
        }
        let covered = table.covered_elements(radar);
        let missing: HashSet<usize> = table.missing.iter().copied().collect();
        let present: Vec<usize> = covered.iter().copied().filter(|n| !missing.contains(n)).collect();
        let places = [&covered, &present].into_iter().find(|places| places.len() == rows.nrows()).ok_or_else(|| {
            let fewer =
                (present.len() < covered.len()).then(|| format!(", or {} without the missing ones", present.len()));
            let source = if table.covers() == CoveredElements::All {
                "radar.elements says"
            } else {
                "radar.end_elements says for two ends"
            };
            let expected = format!("{} as {source}{}", covered.len(), fewer.unwrap_or_default());
            Fault::count(["element", "elements"], rows.nrows(), &expected, rows.dim())
        })?;
        let mut samples = Array2::zeros((radar.elements, radar.samples));
        for (element, row) in places.iter().zip(rows.outer_iter()).filter(|(element, _)| !missing.contains(element)) {
            samples.row_mut(*element).assign(&row);
        }
        let signal = BeatSignal { samples };
        Ok(match table.covers() {
            CoveredElements::All => Recorded::All(signal),
            CoveredElements::Ends => Recorded::Ends(signal.two_ends(radar)),
        })
    }
}

/// The samples of pairs, `[transmitters, receivers, samples]`, as `[elements, samples]`.
fn pairs_to_rows(rows: Array3<Complex64>) -> Result<Array2<Complex64>, Fault> {
    let kinds = [AxisKind::Transmitter, AxisKind::Receiver, AxisKind::Sample];
    arrange(Numbers::Complex(rows.into_dyn()), &kinds, None)
}

/// Phase of each pair for an echo at a cosine of 1, in turns, transmitter by transmitter.
fn pair_turns(radar: &Radar) -> Vec<f64> {
    let Some(antennas) = &radar.antennas else {
        return (0..radar.elements).map(|n| 2.0 * radar.element_x_metres(n) / radar.wavelength_metres()).collect();
    };
    let sums = |t: &f64| antennas.receiver_x_metres().iter().map(move |r| t + r).collect::<Vec<f64>>();
    antennas.transmitter_x_metres().iter().flat_map(sums).map(|sum| sum / radar.wavelength_metres()).collect()
}

/// Refuses keys and files of arrays beside a table `[recording.capture]`.
fn check_capture(table: &RecordingTable) -> Result<(), Fault> {
    if ["npz", "npy", "mat", "h5", "hdf5"].contains(&table.extension().as_str()) {
        return Err(Fault::key("[recording.capture]", "is there", "it only beside a raw capture, such as a .bin file"));
    }
    let arrays = [("array", table.array.is_some()), ("first", table.first.is_some()), ("last", table.last.is_some())];
    let others = [("axes", table.axes.is_some()), ("chirp", table.chirp.is_some()), ("frame", table.frame.is_some())];
    if let Some((key, _)) = arrays.iter().chain(&others).find(|(_, is_present)| *is_present) {
        return Err(Fault::key(
            &format!("recording.{key}"),
            "is there",
            "it not beside a .bin file: [recording.capture] says it all",
        ));
    }
    Ok(())
}

/// Indices among the `rows` of the pairs of the selected transmitters and receivers; `None` where all are used.
fn taken_rows(
    table: &RecordingTable,
    rows: usize,
    [transmitters, receivers]: [usize; 2],
) -> Result<Option<Vec<usize>>, Fault> {
    let RecordingTable { transmitters_taken, receivers_taken, .. } = table;
    if transmitters_taken.is_none() && receivers_taken.is_none() {
        return Ok(None);
    }
    let selected = |key: &str, indices: &Option<Vec<usize>>, count: usize| match indices {
        None => Ok((0..count).collect::<Vec<_>>()),
        Some(indices) if indices.iter().all(|n| *n < count) => Ok(indices.clone()),
        Some(indices) => Err(no_such_index(key, indices, count)),
    };
    let receivers_taken = selected("recording.receivers_taken", receivers_taken, receivers)?;
    let pairs_of = |t: &usize| receivers_taken.iter().map(|r| t * receivers + r).collect::<Vec<usize>>();
    let transmitters = selected("recording.transmitters_taken", transmitters_taken, transmitters)?;
    let places: Vec<usize> = transmitters.iter().flat_map(pairs_of).collect();
    if places.iter().any(|place| *place >= rows) {
        let expected = "it only where axes count transmitters and receivers";
        return Err(Fault::key("recording.transmitters_taken", "is there", expected));
    }
    Ok(Some(places))
}

fn no_such_index(key: &str, indices: &[usize], count: usize) -> Fault {
    Fault::key(key, format!("is {indices:?}"), format!("numbers from 0 to {}, each once", count.saturating_sub(1)))
}

/// A note on real samples, or on complex ones whose imaginary parts are zero.
fn real_samples_note(numbers: &Numbers, kinds: &[AxisKind]) -> Option<String> {
    let note = match numbers {
        Numbers::Real(_) if kinds.contains(&AxisKind::Iq) => return None,
        Numbers::Real(_) => "Samples are real: the positive half of their spectrum is taken (the analytic signal).",
        Numbers::Complex(values) if values.iter().all(|v| v.im == 0.0) && values.iter().any(|v| v.re != 0.0) => {
            "Every imaginary part is zero: these are real samples, stored as complex ones. Each echo has a mirror image in the far half of the \
             range axis."
        }
        Numbers::Complex(_) => return None,
    };
    Some(note.to_owned())
}
