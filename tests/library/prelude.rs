//! Names that most tests of the library use.

pub use apertura::bounds::cramer_rao;
pub use apertura::engine::{Engine, MapRequest};
pub use apertura::evaluate::campaign::Campaign;
pub use apertura::evaluate::rows::{Row, read_rows};
pub use apertura::evaluate::sets::SceneSet;
pub use apertura::evaluate::tables::Tally;
pub use apertura::evaluate::trial::Trial;
pub use apertura::files::npz::{Npz, write_npz};
pub use apertura::lesson::question::Answer;
pub use apertura::lesson::{Lesson, shipped};
pub use apertura::maps::archive::write_maps;
pub use apertura::maps::{Aperture, LogMap, LogMaps, Normalisation, RangeAngleMap, angle_transform, range_transform};
pub use apertura::radar::presets::RadarPreset;
pub use apertura::radar::{
    Antennas, Carrier, Convention, Decibels, End, Layout, Radar, SPEED_OF_LIGHT, WindowFunction,
};
pub use apertura::reconstruct::found::reconstruct_and_find;
pub use apertura::reconstruct::{Baseline, Detection, NoisePrior, ReconstructError, Reconstructor, Request};
pub use apertura::recording::{Recording, file};
pub use apertura::scene::file::SceneFile;
pub use apertura::scene::generate::{Generator, Kind, Purpose, Reading};
pub use apertura::scene::{Block, GaussianCluster, Line, Object, Point, Post, Reflector, Scene, Wall, presets};
pub use apertura::signal::chirps::{chirp_elements, simulate_chirps_for};
pub use apertura::signal::{BeatSignal, Floor, TwoEnds, judge, simulate};
pub use apertura::task::Task;
pub use apertura::theory::Consequences;
pub use apertura::{methods, recording};
pub use ndarray::{Array1, Array2, Array3, Ix1};
pub use num_complex::Complex64;
pub use rand::{RngExt, SeedableRng};
pub use rand_chacha::ChaCha8Rng;
pub use rand_distr::StandardNormal;
pub use std::collections::{BTreeMap, BTreeSet};
pub use std::f64::consts::TAU;
pub use std::fs;
pub use std::path::{Path, PathBuf};
pub use std::process::Command;
pub use std::time::{Duration, Instant};

/// Echoes that a method finds where nothing tells it how loud the noise is.
pub fn found_by(method: &str, radar: &Radar, ends: &TwoEnds) -> Vec<Detection> {
    let method = methods::by_name(method).unwrap_or_else(|e| panic!("{e}"));
    let request = Request { noise: NoisePrior::UNKNOWN, ..Request::default() };
    reconstruct_and_find(method.as_ref(), radar, ends, &request).unwrap_or_else(|e| panic!("{e}")).1
}
