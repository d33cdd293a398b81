//! Captures of physical radars, written by formulas of their own, read as docs/recordings.md says: the directions found are the true ones.

use crate::prelude::*;

const C: f64 = 299_792_458.0;
/// Frequencies of the ramp at the first sample and their width, hertz.
const FIRST_HZ: f64 = 77e9;
const BANDWIDTH_HZ: f64 = 1e9;
const SAMPLES: usize = 128;
const ELEMENTS: usize = 64;
const TRANSMITTERS: usize = 4;
/// Range in metres and cos(theta) of the reflectors.
const PLACES: [(f64, f64); 3] = [(6.0, -0.4), (9.0, 0.1), (12.0, 0.7)];
/// Largest error of a direction that iaa finds in a monostatic capture, degrees.
const DEGREES: f64 = 0.1;
/// `DEGREES` where transmitter and receiver of an element stand apart. No reading knows that the path to a pair `a` apart is longer by `a² sin²θ /
/// 4R`; it differs from pair to pair, and at 6 m it turns the two ends against each other.
const DEGREES_OF_PAIRS: f64 = 0.6;
/// Largest error of the map's peak between two columns, columns.
const COLUMNS: f64 = 0.25;

#[derive(Debug, Clone, Copy)]
struct Made {
    /// 1 or -1: all phases.
    sign: f64,
    /// 1 or -1: the ramp goes up or down.
    sweep: f64,
    in_middle: bool,
}

const UPWARDS: [Made; 4] = [
    Made { sign: 1.0, sweep: 1.0, in_middle: false },
    Made { sign: 1.0, sweep: 1.0, in_middle: true },
    Made { sign: -1.0, sweep: 1.0, in_middle: false },
    Made { sign: -1.0, sweep: 1.0, in_middle: true },
];
const DOWNWARDS: Made = Made { sign: 1.0, sweep: -1.0, in_middle: true };

impl Made {
    /// Sample `n` of antennas at `transmitter` and `receiver`, metres along the array; each point has an amplitude of 1 at its middle.
    fn sample(self, transmitter: f64, receiver: f64, n: usize, places: &[(f64, f64)]) -> Complex64 {
        let hz = FIRST_HZ + self.sweep * BANDWIDTH_HZ * n as f64 / SAMPLES as f64;
        let echo = |&(range, cos): &(f64, f64)| {
            let (x, y) = (range * cos, range * (1.0 - cos * cos).sqrt());
            let [there, back] = [transmitter, receiver].map(|antenna| (x - antenna).hypot(y));
            let phase = self.sign * TAU * (hz * (there + back) / C).fract();
            Complex64::from_polar(range * range / (there * back), phase)
        };
        places.iter().map(echo).sum()
    }

    fn keys(self) -> String {
        let beat = if self.sign * self.sweep > 0.0 { "+" } else { "-" };
        let at = if self.in_middle { "middle" } else { "first-sample" };
        let sweep = if self.sweep > 0.0 { "" } else { "sweep = \"down\"\n" };
        format!("carrier_at = \"{at}\"\nbeat_sign = \"{beat}\"\n{sweep}")
    }

    fn carrier_hz(self) -> f64 {
        if self.in_middle { FIRST_HZ + self.sweep * BANDWIDTH_HZ / 2.0 } else { FIRST_HZ }
    }
}

fn wavelength() -> f64 {
    C / (FIRST_HZ + BANDWIDTH_HZ / 2.0)
}

/// Place of element `n`, metres: a quarter of the wavelength from the next.
fn element_x(n: usize) -> f64 {
    (n as f64 - (ELEMENTS as f64 - 1.0) / 2.0) * wavelength() / 4.0
}

/// Every element sends and hears by itself.
fn monostatic(made: Made, folder: &Path) -> Recording {
    let sample = |(n, s)| made.sample(element_x(n), element_x(n), s, &PLACES);
    let samples = Array2::from_shape_fn((ELEMENTS, SAMPLES), sample);
    write_npz(&folder.join("c.npz"), |out| out.add("cube", &samples)).unwrap();
    read(made, folder, "two-way", wavelength() / 4.0, "\"element\"")
}

/// Four transmitters far apart and sixteen receivers close together; the sums of their positions are half a wavelength apart.
fn pairs(made: Made, folder: &Path, carrier: &str, spacing: f64) -> Recording {
    let virtual_spacing = wavelength() / 2.0;
    let receivers = ELEMENTS / TRANSMITTERS;
    let centred = |n: usize, count: usize| n as f64 - (count as f64 - 1.0) / 2.0;
    let transmitter = |t: usize| centred(t, TRANSMITTERS) * receivers as f64 * virtual_spacing;
    let receiver = |r: usize| centred(r, receivers) * virtual_spacing;
    let shape = (TRANSMITTERS, receivers, SAMPLES);
    let samples = Array3::from_shape_fn(shape, |(t, r, s)| made.sample(transmitter(t), receiver(r), s, &PLACES));
    write_npz(&folder.join("c.npz"), |out| out.add("cube", &samples)).unwrap();
    read(made, folder, carrier, spacing, "\"transmitter\", \"receiver\"")
}

fn read(made: Made, folder: &Path, carrier: &str, spacing: f64, elements: &str) -> Recording {
    let text = format!(
        "format = 2\n[radar]\ncarrier = \"{carrier}\"\ncarrier_hz = {:?}\nbandwidth_hz = {BANDWIDTH_HZ:?}\n\
         element_spacing_metres = {spacing:?}\nelements = {ELEMENTS}\nend_elements = 16\nsamples = {SAMPLES}\n\
         transmit_power_watts = 1.0\n[recording]\nfile = \"c.npz\"\narray = \"cube\"\naxes = [{elements}, \"sample\"]\n{}",
        made.carrier_hz(),
        made.keys()
    );
    std::fs::write(folder.join("c.toml"), text).unwrap();
    file::load(&folder.join("c.toml")).unwrap_or_else(|e| panic!("{e}"))
}

/// cos(theta) of the map's peak at `range_metres`, between its columns by a parabola through the logarithms of three.
fn peak_cos(recording: &Recording, range_metres: f64) -> f64 {
    let radar = &recording.radar;
    let map = angle_transform(radar, &range_transform(radar, recording.signal().unwrap()), Aperture::Full).cells;
    let row = map.row(radar.bin_of_range(range_metres).round() as usize);
    let level = |i: usize| row[i % ELEMENTS].norm().ln();
    let top = (0..ELEMENTS).max_by(|a, b| level(*a).total_cmp(&level(*b))).unwrap();
    let (before, here, after) = (level(top + ELEMENTS - 1), level(top), level(top + 1));
    let off = 0.5 * (before - after) / (before - 2.0 * here + after);
    radar.cos_of_blob(radar.cos_of_column(top as f64 + off))
}

fn errors(recording: &Recording) -> (f64, f64) {
    let radar = &recording.radar;
    let found = found_by("iaa", radar, &recording.two_ends());
    let (mut columns, mut degrees) = (0.0f64, 0.0f64);
    for (range, cos) in PLACES {
        columns = columns.max((peak_cos(recording, range) - cos).abs() / (2.0 / ELEMENTS as f64));
        let bin = radar.range_resolution_metres();
        let near = found.iter().filter(|f| (f.range_metres - range).abs() < bin && f.relative_power.0 > -15.0);
        let strongest = near.max_by(|a, b| a.relative_power.0.total_cmp(&b.relative_power.0));
        let strongest = strongest.unwrap_or_else(|| panic!("nothing at {range} m in {found:?}"));
        degrees = degrees.max((strongest.cos_theta.acos() - cos.acos()).abs().to_degrees());
    }
    (columns, degrees)
}

fn assert_true(what: &str, made: Made, recording: &Recording, most_degrees: f64) {
    let (columns, degrees) = errors(recording);
    println!("{what}, {made:?}: {columns:.3} columns, {degrees:.4} degrees");
    assert!(columns < COLUMNS && degrees < most_degrees, "{what}, {made:?}: {columns} columns, {degrees} degrees");
    assert!(recording.doubts.is_empty(), "{:?}", recording.doubts);
}

#[test]
fn a_monostatic_capture_gives_its_true_directions() {
    let folder = tempfile::tempdir().unwrap();
    for made in UPWARDS.into_iter().chain([DOWNWARDS]) {
        assert_true("monostatic", made, &monostatic(made, folder.path()), DEGREES);
    }
}

#[test]
fn pairs_give_their_true_directions_in_either_reading() {
    let folder = tempfile::tempdir().unwrap();
    let one_way = UPWARDS.into_iter().chain([DOWNWARDS]).map(|made| ("one-way", 2.0, made));
    for (carrier, parts, made) in one_way.chain(UPWARDS.map(|made| ("two-way", 4.0, made))) {
        let recording = pairs(made, folder.path(), carrier, wavelength() / parts);
        assert_true(carrier, made, &recording, DEGREES_OF_PAIRS);
    }
}

/// One echo at 3 m, whose text says the wrong sign.
#[test]
fn the_wrong_beat_sign_is_doubted() {
    let folder = tempfile::tempdir().unwrap();
    let turn = |n: usize| Complex64::from_polar(1.0, TAU * 20.0 * n as f64 / SAMPLES as f64);
    let samples = Array2::from_shape_fn((ELEMENTS, SAMPLES), |(_, n)| turn(n));
    write_npz(&folder.path().join("c.npz"), |out| out.add("cube", &samples)).unwrap();
    for (made, wrong) in [(UPWARDS[0], false), (UPWARDS[2], true)] {
        let doubts = read(made, folder.path(), "two-way", wavelength() / 4.0, "\"element\"").doubts;
        assert_eq!(doubts.iter().any(|d| d.contains("recording.beat_sign is the other one")), wrong, "{doubts:?}");
    }
}

#[test]
fn a_spacing_that_folds_directions_is_doubted() {
    let folder = tempfile::tempdir().unwrap();
    let _quarter = monostatic(UPWARDS[0], folder.path());
    let half = read(UPWARDS[0], folder.path(), "two-way", wavelength() / 2.0, "\"element\"");
    assert!(half.doubts.iter().any(|d| d.contains("fold to the other side")), "{:?}", half.doubts);
}

#[test]
fn a_sample_has_the_phase_of_its_frequency_over_the_whole_path() {
    let (samples, elements, end_elements) = (SAMPLES, ELEMENTS, 16);
    let usual = Radar { samples, elements, end_elements, bandwidth_hz: BANDWIDTH_HZ, ..Radar::default() };
    let (radar, range) = (usual.in_convention(Convention::Physical), 29f64.sqrt());
    let signal = simulate(&radar, &Scene::of_points([(2.0, 5.0)]), Floor::Exact, 0).unwrap();
    for (element, n) in [0, 17, 63].into_iter().flat_map(|element| [0, 1, 64, 127].map(|n| (element, n))) {
        let x = element_x(element);
        let expected = UPWARDS[0].sample(x, x, n, &[(range, 2.0 / range)]) * radar.transmit_power_watts / 29.0;
        let found = signal.samples[[element, n]];
        // The formula of this file reaches some 1e-12 in f64: the phase is 2500 turns.
        assert!((found - expected).norm() < 1e-10 * expected.norm(), "[{element}, {n}]: {found}, {expected}");
    }
}
