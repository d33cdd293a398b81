//! Verdicts on the objects of a scene: each is found, missed, merged with a neighbour, on the wrong tooth of the comb, or hidden. A *ghost* is a blob
//! of the output at a place where the scene has no object.
//!
//! An object's *footprint* is the set of cells where the whole array's map of the object alone, without noise, exceeds the target's threshold. The
//! footprint of a body also contains the cells of its ends, corners and glints that are 10 dB above their surroundings in the target: the end of a
//! wall is 30 to 60 dB weaker than its glint, but belongs to the wall. All verdicts compare footprints with the output above the method's threshold,
//! so that they hold for methods with and without reflectors. What lies at the *place* of an object, a reflector, end, corner or glint of it, is no
//! ghost, however weak the object is in the target.

use super::TARGET_ETA;
use super::blobs::Blobs;
use super::echoes::of_bodies;
use crate::maps::focus::map_of;
use crate::maps::{
    Aperture, LambdaScale, Mask, RangeAngleMap, RangeProfiles, angle_transform, range_transform_in_place,
};
use crate::radar::{BuiltArray, Radar};
use crate::scattering::{EchoSources, ObjectWithOccluders};
use crate::scene::{Object, Reflector, Scene};
use crate::signal::plan::amplitude_bound;
use crate::signal::{SynthesisPlan, beat_signal};
use ndarray::{Array2, Axis};
use num_complex::Complex64;
use rayon::prelude::*;

/// Least part of a footprint, 0 to 1, that must be detected for the object to count as found.
const MIN_FOUND_PART: f64 = 0.5;
/// Error of a footprint's simulation, relative to the object's amplitudes.
const SIMULATION_TOLERANCE: f64 = 1e-6;
/// Largest shift of a wrong tooth to either side, columns. The ambiguity function of the two ends has a peak about every column.
const MAX_TOOTH_COLUMNS: i32 = 8;
/// Largest squared error of the output against the shifted target, over that against the target, for which an object is on another tooth.
const MAX_TOOTH_ERROR_RATIO: f64 = 0.5;
/// Largest distance of a blob from a footprint or a place at which it is no ghost, rows and columns: side lobes and smeared edges.
const GHOST_MARGIN_CELLS: usize = 3;
/// Least number of cells of a ghost.
const MIN_GHOST_CELLS: usize = 8;
/// Objects whose footprints are computed at the same time: each holds the samples of the whole array.
const MAX_OBJECTS_AT_ONCE: usize = 4;

/// A cell of a map: range bin and column.
pub type CellIndex = [usize; 2];

/// Verdict on an object.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ObjectVerdict {
    /// Half of its footprint or more is detected. Of a body, its strongest echo or half of its echoes that stand out. Of an object that the target
    /// does not show, one of its places, in a blob of nothing else. No other verdict applies.
    Found,
    /// Less of its footprint, or of its echoes, is detected.
    Missed,
    /// One blob of the output covers this object and another one, which are two blobs of the target.
    Merged {
        /// Index of the other object in the scene.
        with: usize,
    },
    /// The output shows the object shifted along the columns, on another peak of the two ends' ambiguity function.
    WrongTooth {
        /// The shift, columns; positive to the right.
        columns: i32,
    },
    /// The object is too weak beside the others: no cell of the target exceeds the threshold for it, and the output doesn't show it either.
    Hidden,
}

impl ObjectVerdict {
    /// Name of the verdict in tables.
    pub fn name(self) -> &'static str {
        match self {
            ObjectVerdict::Found => "found",
            ObjectVerdict::Missed => "missed",
            ObjectVerdict::Merged { .. } => "merged",
            ObjectVerdict::WrongTooth { .. } => "wrong tooth",
            ObjectVerdict::Hidden => "hidden",
        }
    }

    /// Whether the object is found, or too weak to be missed.
    pub fn is_right(self) -> bool {
        matches!(self, ObjectVerdict::Found | ObjectVerdict::Hidden)
    }
}

/// A blob of the output where the scene has nothing.
#[derive(Debug, Clone, PartialEq)]
pub struct Ghost {
    /// Cells of the blob, (range bin, column).
    pub cells: Vec<CellIndex>,
}

/// Verdicts on all objects of a scene, and the ghosts of an output.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct OutputVerdicts {
    /// The verdict on every object, in the scene's order.
    pub objects: Vec<ObjectVerdict>,
    /// Detected part of each object's footprint, 0 to 1, without a shift. For a body, the detected part of its echoes that stand out. For an object
    /// without a footprint that is found, the detected part of its places; else 0.
    pub covered: Vec<f64>,
    /// Blobs far from every object and from every blob of the target.
    pub ghosts: Vec<Ghost>,
}

impl OutputVerdicts {
    /// Number of objects that are [`ObjectVerdict::Missed`].
    pub fn missed(&self) -> usize {
        self.count(|verdict| verdict == ObjectVerdict::Missed)
    }

    /// Number of objects whose verdict satisfies `is`.
    pub fn count(&self, is: impl Fn(ObjectVerdict) -> bool) -> usize {
        self.objects.iter().filter(|verdict| is(**verdict)).count()
    }

    /// One line for the user: the numbers of objects found, of objects that the target or the output shows, and of ghosts.
    pub fn headline(&self) -> String {
        let shown = self.objects.len() - self.count(|verdict| verdict == ObjectVerdict::Hidden);
        format!(
            "{} of {shown} found, {} false",
            self.count(|verdict| verdict == ObjectVerdict::Found),
            self.ghosts.len()
        )
    }
}

/// The footprints of all objects of a scene.
#[derive(Debug, Clone)]
pub struct Footprints {
    /// The footprint of each object.
    objects: Vec<Vec<CellIndex>>,
    /// The cells of each object's reflectors, or of its ends, corners and glints.
    places: Vec<Vec<CellIndex>>,
    /// For each object, the cells of each of its echoes that stand out, the strongest first. Empty for an object that is no body.
    echoes: Vec<Vec<Vec<CellIndex>>>,
    target: Blobs,
}

impl Footprints {
    /// The footprints in `scene`, whose target is `target`, Lambda as `[range bins, columns]`. `scale` converts decades to its Lambda.
    /// `scene` must have passed [`Scene::validate`].
    pub fn new(radar: &Radar, scene: &Scene, target: &RangeAngleMap, scale: LambdaScale) -> Footprints {
        let level = 10f64.powf(scale.floor + f64::from(TARGET_ETA) * (scale.peak - scale.floor));
        let echoes = of_bodies(radar, scene, target, &scale);
        let mut objects: Vec<Vec<CellIndex>> = Vec::with_capacity(scene.objects.len());
        for seen in ObjectWithOccluders::all(radar, scene).chunks(MAX_OBJECTS_AT_ONCE) {
            objects.par_extend(seen.par_iter().map(|seen| footprint(radar, seen, level)));
        }
        for (cells, echoes) in objects.iter_mut().zip(&echoes).filter(|(_, echoes)| !echoes.is_empty()) {
            cells.extend(echoes.iter().flatten());
            cells.sort_unstable();
            cells.dedup();
        }
        let shown = target.above(if scene.is_silent() { 1.0 } else { TARGET_ETA });
        let places = scene.objects.iter().map(|object| places(radar, object)).collect();
        Footprints { objects, places, echoes, target: Blobs::of(&shown) }
    }

    /// The footprint of every object, in the scene's order; empty for one that the target doesn't show.
    pub fn cells(&self) -> &[Vec<CellIndex>] {
        &self.objects
    }

    /// Verdicts on `output`, with the threshold `eta` on Lambda, against `target`; both are `[range bins, columns]`.
    pub fn judge(&self, target: &RangeAngleMap, output: &RangeAngleMap, eta: f32) -> OutputVerdicts {
        self.judge_cells(target, output, &output.above(eta))
    }

    /// Verdicts on `output` with the detections `detected`, against `target`; all are `[range bins, columns]`.
    pub fn judge_cells(&self, target: &RangeAngleMap, output: &RangeAngleMap, detected: &Mask) -> OutputVerdicts {
        let found = Blobs::of(detected);
        let verdicts = self.objects.iter().zip(&self.echoes).map(|(cells, echoes)| {
            let (verdict, part) = verdict_on_footprint(cells, target, output, &found);
            if echoes.is_empty() || matches!(verdict, ObjectVerdict::WrongTooth { .. }) {
                (verdict, part)
            } else {
                verdict_on_body(echoes, &found)
            }
        });
        let (mut objects, mut covered): (Vec<ObjectVerdict>, Vec<f64>) = verdicts.unzip();
        let blobs_of =
            |blobs: &Blobs| -> Vec<Option<u32>> { self.objects.iter().map(|cells| blobs.most_of(cells)).collect() };
        let (shown, seen) = (blobs_of(&self.target), blobs_of(&found));
        for i in 0..objects.len() {
            if objects[i] == ObjectVerdict::Found
                && let Some(with) = merged_with(i, &objects, &shown, &seen)
            {
                objects[i] = ObjectVerdict::Merged { with };
            }
        }
        let mut explained = self.explained(&found, &objects);
        let hidden: Vec<usize> = (0..objects.len()).filter(|&i| objects[i] == ObjectVerdict::Hidden).collect();
        for &i in &hidden {
            let is_at = |is: &dyn Fn(usize) -> bool| {
                let seen = self.places[i].iter().filter(|place| near(&found, **place, 0).any(is)).count();
                seen as f64 / self.places[i].len().max(1) as f64
            };
            if is_at(&|label| !explained[label]) > 0.0 {
                (objects[i], covered[i]) = (ObjectVerdict::Found, is_at(&|label| label != 0));
            }
        }
        let of_hidden = hidden.iter().flat_map(|&i| &self.places[i]);
        of_hidden.flat_map(|&place| near(&found, place, 0)).for_each(|label| explained[label] = true);
        let blobs = found.cells.iter().zip(&explained[1..]);
        let ghosts = blobs.filter(|(cells, explained)| !**explained && cells.len() >= MIN_GHOST_CELLS);
        OutputVerdicts { objects, covered, ghosts: ghosts.map(|(cells, _)| Ghost { cells: cells.clone() }).collect() }
    }

    /// For each label of `found`, whether its blob is near an object that the target shows, or near a blob of the target; true for the ground.
    fn explained(&self, found: &Blobs, verdicts: &[ObjectVerdict]) -> Vec<bool> {
        let mut explained = vec![false; found.cells.len() + 1];
        explained[0] = true;
        let mut explain =
            |cell: CellIndex, shift: i32| near(found, cell, shift).for_each(|label| explained[label] = true);
        // Blobs of the target away from the objects, of side lobes and noise, explain blobs of the output too.
        self.target.cells.iter().flatten().for_each(|&cell| explain(cell, 0));
        for ((cells, places), verdict) in self.objects.iter().zip(&self.places).zip(verdicts) {
            let shift = if let ObjectVerdict::WrongTooth { columns } = verdict { *columns } else { 0 };
            if *verdict != ObjectVerdict::Hidden {
                cells.iter().chain(places).for_each(|&cell| explain(cell, shift));
            }
        }
        explained
    }
}

/// Index of an object that the output shows in one blob with object `i`, but the target doesn't. `shown` is the blob of each object in the target,
/// `seen` that in the output.
fn merged_with(i: usize, verdicts: &[ObjectVerdict], shown: &[Option<u32>], seen: &[Option<u32>]) -> Option<usize> {
    let (own_shown, own_seen) = (shown[i]?, seen[i]?);
    (0..verdicts.len())
        .filter(|&o| o != i && matches!(verdicts[o], ObjectVerdict::Found | ObjectVerdict::Merged { .. }))
        .find(|&o| seen[o] == Some(own_seen) && shown[o].is_some_and(|other| other != own_shown))
}

/// Labels of the cells near a cell that is moved by `shift` columns; 0 is the ground.
fn near(found: &Blobs, [row, column]: CellIndex, shift: i32) -> impl Iterator<Item = usize> {
    let ((rows, columns), margin) = (found.labels.dim(), GHOST_MARGIN_CELLS as i32);
    let rows = row.saturating_sub(GHOST_MARGIN_CELLS)..(row + GHOST_MARGIN_CELLS + 1).min(rows);
    let across = (-margin..=margin).map(move |c| shifted_column(column, c + shift, columns));
    rows.flat_map(move |row| across.clone().map(move |column| found.labels[[row, column]] as usize))
}

/// The cells of an object's reflectors, or of a body's echoes at the array's middle; a range beyond the maximum wraps.
fn places(radar: &Radar, object: &Object) -> Vec<CellIndex> {
    let cell = |reflector: &Reflector| {
        let blob = radar.blob_of(0.0, reflector.x_metres, reflector.y_metres);
        let bin = radar.bin_of_range(blob.range_metres).round().rem_euclid(radar.samples as f64);
        [bin as usize, radar.column_of_cos(blob.cos_theta).round() as usize % radar.elements]
    };
    object.marks().iter().map(cell).collect()
}

/// Verdict on an object by its footprint `cells`, without regard to the other objects, and the detected part of the footprint.
fn verdict_on_footprint(
    cells: &[CellIndex],
    target: &RangeAngleMap,
    output: &RangeAngleMap,
    found: &Blobs,
) -> (ObjectVerdict, f64) {
    if cells.is_empty() {
        return (ObjectVerdict::Hidden, 0.0);
    }
    let columns = target.lambda.ncols();
    let at = |[row, column]: CellIndex, shift: i32| [row, shifted_column(column, shift, columns)];
    let covered = |shift: i32| {
        let hits = cells.iter().filter(|&&cell| found.labels[at(cell, shift)] != 0).count();
        hits as f64 / cells.len() as f64
    };
    let error = |shift: i32| -> f64 {
        let edges =
            cells.iter().flat_map(|&cell| [-MAX_TOOTH_COLUMNS, 0, MAX_TOOTH_COLUMNS].map(|edge| at(cell, edge)));
        edges.map(|cell| f64::from(output.lambda[at(cell, shift)] - target.lambda[cell]).powi(2)).sum()
    };
    let (here, part) = (error(0), covered(0));
    let best = (-MAX_TOOTH_COLUMNS..=MAX_TOOTH_COLUMNS)
        .map(|shift| (shift, error(shift)))
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .filter(|(shift, error)| {
            *shift != 0 && *error <= MAX_TOOTH_ERROR_RATIO * here && covered(*shift) >= MIN_FOUND_PART
        });
    let verdict = match best {
        Some((columns, _)) => ObjectVerdict::WrongTooth { columns },
        None if part >= MIN_FOUND_PART => ObjectVerdict::Found,
        None => ObjectVerdict::Missed,
    };
    (verdict, part)
}

/// Verdict on a body by the cells of its echoes, and the detected part of the echoes.
fn verdict_on_body(echoes: &[Vec<CellIndex>], found: &Blobs) -> (ObjectVerdict, f64) {
    let is_seen = |cells: &Vec<CellIndex>| cells.iter().any(|cell| found.labels[*cell] != 0);
    let part = echoes.iter().filter(|cells| is_seen(cells)).count() as f64 / echoes.len() as f64;
    (if part >= MIN_FOUND_PART || is_seen(&echoes[0]) { ObjectVerdict::Found } else { ObjectVerdict::Missed }, part)
}

/// The column `by` columns to the right; columns wrap.
fn shifted_column(column: usize, by: i32, columns: usize) -> usize {
    (column as i64 + i64::from(by)).rem_euclid(columns as i64) as usize
}

/// The cells where the noiseless map of an object alone exceeds the magnitude `level`, without parts that other bodies hide.
fn footprint(radar: &Radar, seen: &ObjectWithOccluders, level: f64) -> Vec<CellIndex> {
    let echoing = EchoSources::of_objects(radar, std::slice::from_ref(seen));
    let amplitude = amplitude_bound(radar, &echoing);
    let plan = SynthesisPlan::cheapest(echoing.len(), amplitude, SIMULATION_TOLERANCE);
    let signal = beat_signal(radar, &echoing, &plan);
    if radar.focus_off_line && !radar.is_on_line() {
        let map = map_of(radar, &BuiltArray::default(), &signal, Aperture::Full).cells;
        return map.indexed_iter().filter(|(_, v)| v.norm() > level).map(|((bin, column), _)| [bin, column]).collect();
    }
    let profiles = range_transform_in_place(radar, signal).profiles;
    let bins = loud_bins(radar, &profiles, level);
    let rows = RangeProfiles { profiles: profiles.select(Axis(1), &bins) };
    let map = angle_transform(radar, &rows, Aperture::Full);
    map.cells.indexed_iter().filter(|(_, v)| v.norm() > level).map(|((row, column), _)| [bins[row], column]).collect()
}

/// The range bins of `profiles` in which a cell may exceed the magnitude `level`. A cell is at most the sum of its bin's weighted magnitudes, and a
/// magnitude is at most the sum of both parts' absolute values, which takes no root.
fn loud_bins(radar: &Radar, profiles: &Array2<Complex64>, level: f64) -> Vec<usize> {
    let mut bounds = vec![0.0; radar.samples];
    for (profile, weight) in profiles.outer_iter().zip(radar.window.weights(radar.elements)) {
        bounds.iter_mut().zip(profile).for_each(|(bound, p)| *bound += (p.re.abs() + p.im.abs()) * weight.abs());
    }
    let scale = (radar.elements as f64).sqrt().recip();
    (0..radar.samples).filter(|&bin| bounds[bin] * scale > level).collect()
}

#[cfg(test)]
mod tests;
