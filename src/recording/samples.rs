//! Samples in the data files of a recording, brought into the order of the array's elements.

use super::axes::{Join, arrange, in_turn, loops, one_frame};
use super::capture::strongest_of;
use super::chain::{Source, opened};
use super::described::Described;
use super::numbers::Numbers;
use super::numpy::{read_npy, read_npz};
use super::said_recording::{Covers, Table};
use super::{AxisKind, Capture, Chirp, Fault, Recorded, hdf5};
use crate::radar::Radar;
use crate::signal::BeatSignal;
use ndarray::{Array2, Array3, Axis, ShapeError, concatenate};
use num_complex::Complex64;
use std::collections::HashSet;

impl Described<'_> {
    /// Reads the samples that the table names, with all its corrections, and sentences on doubts about them. The radar gives the numbers of elements
    /// and samples expected.
    ///
    /// # Errors
    /// [`Fault`] names the key or the array, and what was expected of it.
    pub fn samples(&self) -> Result<(Recorded, Vec<String>), Fault> {
        let table = &self.table;
        let (mut rows, notes) = match &table.capture {
            Some(capture) => {
                check_capture(table)?;
                let (file, turns) = (self.open_capture(capture)?, turns(&self.radar));
                let (rows, notes) = capture.read(file, self.profile.as_ref(), &turns, table.beat_rises())?;
                (of_pairs(rows)?, notes)
            }
            None => self.arrays()?,
        };
        if let Some(((element, sample), _)) = rows.indexed_iter().find(|(_, v)| !v.is_finite()) {
            let message = format!("sample {sample} of element {element} is not finite; expected finite numbers only");
            return Err(Fault::Data(message));
        }
        table.calibration.take_off(&mut rows)?;
        self.signs.apply(&mut rows);
        if table.reverse_elements && !table.counts_pairs() {
            rows.invert_axis(Axis(0));
        }
        Ok((self.sorted(self.in_element_order(rows)?)?, notes))
    }

    /// `rows` in the order of elements from the left, where the file counts transmitters and receivers and the text gives their places; zeros at
    /// gaps.
    fn in_element_order(&self, rows: Array2<Complex64>) -> Result<Array2<Complex64>, Fault> {
        let antennas = self.radar.antennas.as_ref().filter(|_| self.table.counts_pairs());
        let Some(antennas) = antennas else { return Ok(rows) };
        let (transmitters, receivers) = (antennas.transmitter_x_metres().len(), antennas.receiver_x_metres().len());
        if rows.nrows() != transmitters * receivers {
            let expected = format!("{transmitters} by {receivers}, as many as radar says places of antennas");
            return Err(Fault::count("pairs of antennas", rows.nrows(), &expected, rows.dim()));
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
    ///
    /// # Errors
    /// [`Fault`] names the key.
    pub fn every_loop(&self) -> Result<Array3<Complex64>, Fault> {
        let mut loops = match &self.table.capture {
            Some(capture) => {
                check_capture(&self.table)?;
                capture.loops(self.open_capture(capture)?, self.profile.as_ref())?
            }
            None => self.array_loops()?,
        };
        self.signs.apply(&mut loops);
        Ok(loops)
    }

    /// Every loop of an array's frame, `[loops, elements, samples]`: elements are the pairs of the transmitters and receivers taken.
    fn array_loops(&self) -> Result<Array3<Complex64>, Fault> {
        let table = &self.table;
        let mut kinds = table.axes.clone().unwrap_or_default();
        if !kinds.contains(&AxisKind::Chirp) {
            let expected = "an axis \"chirp\": one chirp tells no velocity";
            return Err(Fault::key("recording.axes", "has no loops", expected));
        }
        let mut numbers = self.numbers(table.array.as_deref())?;
        numbers.mend_signs();
        let numbers = in_turn(one_frame(numbers, &mut kinds, table.frame)?, &mut kinds, table.transmitters_in_turn)?;
        let loops = loops(numbers, &kinds)?;
        let (count, transmitters, receivers, samples) = loops.dim();
        let pairs = transmitters * receivers;
        // The same numbers in the same order: the shape can't fail to fit.
        let rows = loops
            .into_shape_with_order((count, pairs, samples))
            .map_err(|e| Fault::key("recording.axes", e.to_string(), "others"))?;
        Ok(match taken(table, pairs, [transmitters, receivers])? {
            Some(places) => rows.select(Axis(1), &places),
            None => rows,
        })
    }

    /// Number of frames in the arrays.
    pub fn count_frames(&self) -> Result<u64, Fault> {
        let table = &self.table;
        let place = table.axes.iter().flatten().position(|kind| *kind == AxisKind::Frame);
        let Some(place) = place else { return Ok(1) };
        let numbers = self.numbers(table.array.as_deref().or(table.first.as_deref()))?;
        Ok(numbers.shape().get(place).map_or(1, |frames| *frames as u64))
    }

    /// The file of a capture, with those that go on from it.
    pub fn open_capture(&self, capture: &Capture) -> Result<Box<dyn Source>, Fault> {
        let Capture { more_files, chips, .. } = capture;
        if !(more_files.is_empty() || chips.is_empty()) {
            return Err(Fault::key("recording.capture.chips", "stands beside more_files", "one of the two"));
        }
        Ok(opened(&self.table.file, more_files, chips, |name| (self.open)(name))?)
    }

    fn arrays(&self) -> Result<(Array2<Complex64>, Vec<String>), Fault> {
        let Table { axes, array, first, last, .. } = &self.table;
        let Some(axes) = axes else {
            let kinds = "a list of \"element\", \"sample\", \"chirp\" and so on, one for each axis of the array";
            return Err(Fault::key("recording.axes", "is missing", kinds));
        };
        match (array, first, last) {
            (array, None, None) => self.array(array.as_deref(), axes.clone()),
            (None, Some(first), Some(last)) => {
                let (first, mut notes) = self.array(Some(first), axes.clone())?;
                let (last, of_last) = self.array(Some(last), axes.clone())?;
                if first.dim() != last.dim() {
                    let expected = format!("as many as \"first\" has, {} by {}", first.nrows(), first.ncols());
                    return Err(Fault::count("numbers in \"last\"", last.len(), &expected, last.dim()));
                }
                notes.extend(of_last);
                notes.dedup();
                // Equal shapes join.
                let rows = concatenate(Axis(0), &[first.view(), last.view()]);
                let unlike = |e: ShapeError| {
                    Fault::key("recording.last", format!("does not join ({e})"), "the shape of \"first\"")
                };
                Ok((rows.map_err(unlike)?, notes))
            }
            _ => {
                Err(Fault::key("recording.array", "stands beside half a pair", "either array, or both first and last"))
            }
        }
    }

    /// The array called `key`, `[elements, samples]`, and sentences on its samples.
    fn array(&self, key: Option<&str>, mut kinds: Vec<AxisKind>) -> Result<(Array2<Complex64>, Vec<String>), Fault> {
        let table = &self.table;
        let mut numbers = self.numbers(key)?;
        let mut notes: Vec<String> = numbers.mend_signs().into_iter().collect();
        let numbers = one_frame(numbers, &mut kinds, table.frame)?;
        notes.extend(told_of_real(&numbers, &kinds));
        let numbers = in_turn(numbers, &mut kinds, table.transmitters_in_turn)?;
        let len = |kind| kinds.iter().position(|k| *k == kind).map_or(1, |place| numbers.shape()[place]);
        let sizes = [len(AxisKind::Transmitter), len(AxisKind::Receiver)];
        let rows = if table.chirp == Some(Chirp::Joined(Join::Strongest)) && kinds.contains(&AxisKind::Chirp) {
            let (rows, told) = self.joined(numbers, &kinds)?;
            notes.extend(told);
            rows
        } else {
            arrange(numbers, &kinds, table.chirp)?
        };
        let rows = match taken(table, rows.nrows(), sizes)? {
            Some(places) => rows.select(Axis(0), &places),
            None => rows,
        };
        Ok((rows, notes))
    }

    /// The strongest Doppler cell of each range bin, `[elements, samples]`, and sentences on it.
    fn joined(&self, numbers: Numbers, kinds: &[AxisKind]) -> Result<(Array2<Complex64>, Vec<String>), Fault> {
        let chirps = kinds.iter().position(|kind| *kind == AxisKind::Chirp).map_or(1, |place| numbers.shape()[place]);
        let loops = loops(numbers, kinds)?;
        let (taken, transmitters, _, _) = loops.dim();
        let left_out = (taken < chirps).then(|| {
            format!(
                "The first {taken} of {chirps} chirps are joined; the others are left out, since the frame is too large."
            )
        });
        let all: Vec<usize> = (0..transmitters).collect();
        let chosen = self.table.transmitters_taken.as_deref().unwrap_or(&all);
        if chosen.iter().any(|t| *t >= transmitters) {
            return Err(no_such("recording.transmitters_taken", chosen, transmitters));
        }
        let (rows, note) = strongest_of(loops, chosen, &turns(&self.radar));
        let notes: Vec<String> = note.into_iter().chain(left_out).collect();
        Ok((of_pairs(rows)?, notes))
    }

    fn numbers(&self, key: Option<&str>) -> Result<Numbers, Fault> {
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

    /// The rows of the file in their places of the array.
    fn sorted(&self, rows: Array2<Complex64>) -> Result<Recorded, Fault> {
        let Described { table, radar, .. } = self;
        if rows.ncols() != radar.samples {
            let expected = format!("{} as radar.samples says", radar.samples);
            return Err(Fault::count("samples", rows.ncols(), &expected, rows.dim()));
        }
        let covered = table.covered(radar);
        let missing: HashSet<usize> = table.missing.iter().copied().collect();
        let present: Vec<usize> = covered.iter().copied().filter(|n| !missing.contains(n)).collect();
        let places = [&covered, &present].into_iter().find(|places| places.len() == rows.nrows()).ok_or_else(|| {
            let fewer =
                (present.len() < covered.len()).then(|| format!(", or {} without the missing ones", present.len()));
            let whose = if table.covers() == Covers::All {
                "radar.elements says"
            } else {
                "radar.end_elements says for two ends"
            };
            let expected = format!("{} as {whose}{}", covered.len(), fewer.unwrap_or_default());
            Fault::count("elements", rows.nrows(), &expected, rows.dim())
        })?;
        let mut samples = Array2::zeros((radar.elements, radar.samples));
        for (element, row) in places.iter().zip(rows.outer_iter()).filter(|(element, _)| !missing.contains(element)) {
            samples.row_mut(*element).assign(&row);
        }
        let signal = BeatSignal { samples };
        Ok(match table.covers() {
            Covers::All => Recorded::All(signal),
            Covers::Ends => Recorded::Ends(signal.two_ends(radar)),
        })
    }
}

/// The samples of pairs, `[transmitters, receivers, samples]`, as `[elements, samples]`.
fn of_pairs(rows: Array3<Complex64>) -> Result<Array2<Complex64>, Fault> {
    let kinds = [AxisKind::Transmitter, AxisKind::Receiver, AxisKind::Sample];
    arrange(Numbers::Complex(rows.into_dyn()), &kinds, None)
}

/// Turns of phase across the array of each pair at a cosine of 1, transmitter by transmitter.
fn turns(radar: &Radar) -> Vec<f64> {
    let Some(antennas) = &radar.antennas else {
        return (0..radar.elements).map(|n| 2.0 * radar.element_x_metres(n) / radar.wavelength_metres()).collect();
    };
    let of = |t: &f64| antennas.receiver_x_metres().iter().map(move |r| t + r).collect::<Vec<f64>>();
    antennas.transmitter_x_metres().iter().flat_map(of).map(|sum| sum / radar.wavelength_metres()).collect()
}

fn check_capture(table: &Table) -> Result<(), Fault> {
    if ["npz", "npy", "mat", "h5", "hdf5"].contains(&table.extension().as_str()) {
        return Err(Fault::key("[recording.capture]", "is there", "it only beside a raw capture, such as a .bin file"));
    }
    let arrays = [("array", table.array.is_some()), ("first", table.first.is_some()), ("last", table.last.is_some())];
    let others = [("axes", table.axes.is_some()), ("chirp", table.chirp.is_some()), ("frame", table.frame.is_some())];
    if let Some((key, _)) = arrays.iter().chain(&others).find(|(_, said)| *said) {
        return Err(Fault::key(
            &format!("recording.{key}"),
            "is there",
            "it not beside a .bin file: [recording.capture] says it all",
        ));
    }
    Ok(())
}

/// Places in `rows` of the transmitters and receivers that form the line, of those that the array counts; `None` for all.
fn taken(table: &Table, rows: usize, [transmitters, receivers]: [usize; 2]) -> Result<Option<Vec<usize>>, Fault> {
    let Table { transmitters_taken, receivers_taken, .. } = table;
    if transmitters_taken.is_none() && receivers_taken.is_none() {
        return Ok(None);
    }
    let of = |key: &str, taken: &Option<Vec<usize>>, count: usize| match taken {
        None => Ok((0..count).collect::<Vec<_>>()),
        Some(taken) if taken.iter().all(|n| *n < count) => Ok(taken.clone()),
        Some(taken) => Err(no_such(key, taken, count)),
    };
    let receivers_taken = of("recording.receivers_taken", receivers_taken, receivers)?;
    let of_one = |t: &usize| receivers_taken.iter().map(|r| t * receivers + r).collect::<Vec<usize>>();
    let transmitters = of("recording.transmitters_taken", transmitters_taken, transmitters)?;
    let places: Vec<usize> = transmitters.iter().flat_map(of_one).collect();
    if places.iter().any(|place| *place >= rows) {
        let expected = "it only where axes count transmitters and receivers";
        return Err(Fault::key("recording.transmitters_taken", "is there", expected));
    }
    Ok(Some(places))
}

fn no_such(key: &str, taken: &[usize], count: usize) -> Fault {
    Fault::key(key, format!("is {taken:?}"), format!("numbers from 0 to {}, each once", count.saturating_sub(1)))
}

/// A note on real samples, or on complex ones whose imaginary parts are zero.
fn told_of_real(numbers: &Numbers, kinds: &[AxisKind]) -> Option<String> {
    let told = match numbers {
        Numbers::Real(_) if kinds.contains(&AxisKind::Iq) => return None,
        Numbers::Real(_) => "Samples are real: the positive half of their spectrum is taken (the analytic signal).",
        Numbers::Complex(values) if values.iter().all(|v| v.im == 0.0) && values.iter().any(|v| v.re != 0.0) => {
            "Every imaginary part is zero: these are real samples, stored as complex ones. Each echo has a mirror image in the far half of the \
             range axis."
        }
        Numbers::Complex(_) => return None,
    };
    Some(told.to_owned())
}
