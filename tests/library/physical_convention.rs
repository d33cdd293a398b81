//! The physical convention, compared with formulas of its own: phases, blobs, and places within the Cramer-Rao bound.

use crate::prelude::*;

const C: f64 = 299_792_458.0;
const FIRST_HZ: f64 = 77e9;
const BANDWIDTH_HZ: f64 = 1e9;
const SAMPLES: usize = 128;
const ELEMENTS: usize = 64;
const END: usize = 16;

fn radar() -> Radar {
    let usual = Radar {
        carrier_hz: FIRST_HZ,
        bandwidth_hz: BANDWIDTH_HZ,
        samples: SAMPLES,
        elements: ELEMENTS,
        end_elements: END,
        ..Radar::default()
    };
    usual.in_convention(Convention::Physical)
}

/// Place of element `n`, metres: a quarter of the wavelength in the middle of the chirp from the next.
fn element_x(n: usize) -> f64 {
    (n as f64 - (ELEMENTS as f64 - 1.0) / 2.0) * C / (FIRST_HZ + BANDWIDTH_HZ / 2.0) / 4.0
}

/// Sample `n` at an antenna at `antenna` of a point of reflectivity 1, for each watt.
fn sample(antenna: f64, [x, y]: [f64; 2], n: usize) -> Complex64 {
    let hz = FIRST_HZ + BANDWIDTH_HZ * n as f64 / SAMPLES as f64;
    let range = (x - antenna).hypot(y);
    Complex64::from_polar(1.0 / (range * range), TAU * (hz * 2.0 * range / C).fract())
}

/// Reflectivity with which a point has an amplitude of 1 at the array's middle, for each watt.
fn reflectivity([x, y]: [f64; 2]) -> f64 {
    x * x + y * y
}

#[test]
fn a_sample_has_the_phase_of_its_frequency_over_the_whole_path() {
    let radar = radar();
    let place = [2.0, 5.0];
    let signal = simulate(&radar, &Scene::of_points([(2.0, 5.0)]), Floor::Exact, 0).unwrap();
    for element in [0, 17, 63] {
        for n in [0, 1, 64, 127] {
            let expected = sample(element_x(element), place, n) * radar.transmit_power_watts;
            let found = signal.samples[[element, n]];
            // The formula of this file reaches some 1e-12 in f64: the phase is 2500 turns.
            assert!((found - expected).norm() < 1e-10 * expected.norm(), "[{element}, {n}]: {found}, {expected}");
        }
    }
}

/// A capture of `points` in noise, in an `.npz` with the TOML beside it; the noise's standard deviation is `sigma`.
fn captured(points: &[[f64; 2]], sigma: f64, rng: &mut ChaCha8Rng) -> Recording {
    let folder = tempfile::tempdir().unwrap();
    let noise = |rng: &mut ChaCha8Rng| rng.sample::<f64, _>(StandardNormal) * sigma / 2f64.sqrt();
    let samples = Array2::from_shape_fn((ELEMENTS, SAMPLES), |(element, n)| {
        let echoes: Complex64 =
            points.iter().map(|place| sample(element_x(element), *place, n) * reflectivity(*place)).sum();
        // A mixer of the other sign: every phase falls.
        echoes.conj() + Complex64::new(noise(rng), noise(rng))
    });
    write_npz(&folder.path().join("c.npz"), |out| out.add("cube", &samples)).unwrap();
    let text = format!(
        "format = 2\n[radar]\nconvention = \"physical\"\ncarrier_hz = {FIRST_HZ:?}\nbandwidth_hz = {BANDWIDTH_HZ:?}\n\
         element_spacing_metres = {:?}\nelements = {ELEMENTS}\nend_elements = {END}\nsamples = {SAMPLES}\n\
         transmit_power_watts = 1.0\n[recording]\nfile = \"c.npz\"\narray = \"cube\"\n\
         axes = [\"element\", \"sample\"]\ncarrier_at = \"first-sample\"\nbeat_sign = \"-\"\n",
        element_x(1) - element_x(0),
    );
    std::fs::write(folder.path().join("c.toml"), text).unwrap();
    file::load(&folder.path().join("c.toml")).unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn points_of_physical_captures_are_placed_within_the_bound() {
    let method = methods::by_name("nomp").unwrap_or_else(|e| panic!("{e}"));
    let request = Request { noise: NoisePrior::UNKNOWN, ..Request::default() };
    let mut rng = ChaCha8Rng::seed_from_u64(7);
    let (sigma, captures) = (0.1, 40);
    let (mut ranges, mut cosines, mut placed) = (0.0, 0.0, 0);
    for capture in 0..captures {
        let (range, cos): (f64, f64) = (3.0 + 11.0 * rng.random::<f64>(), 1.4 * (rng.random::<f64>() - 0.5));
        let point = [range * cos, range * (1.0 - cos * cos).sqrt()];
        let recording = captured(&[point], sigma, &mut rng);
        let radar = &recording.radar;
        let found = method.reconstruct(radar, &recording.two_ends(), &request).unwrap().detections(radar);
        let reflector = Reflector { x_metres: point[0], y_metres: point[1], reflectivity: reflectivity(point) };
        let bound = cramer_rao(radar, &Layout::two_ends(radar), &[reflector], sigma * sigma).unwrap()[0];
        // A point that is taken for two has no single place. The count of such points is bounded below.
        let [first] = &found[..] else { continue };
        let range_off = (first.range_metres - range) / bound.range_metres;
        let cos_off = (first.cos_theta - cos) / bound.cos_theta;
        assert!(range_off.abs() < 5.0 && cos_off.abs() < 5.0, "capture {capture}: {range_off}, {cos_off} bounds off");
        ranges += range_off * range_off;
        cosines += cos_off * cos_off;
        placed += 1;
    }
    println!("{placed} of {captures} were taken for one point");
    // One in five points is taken for two: the search adds points to noise.
    assert!(f64::from(placed) >= 0.75 * f64::from(captures), "{placed} of {captures} were taken for one point");
    // Of 32 draws a root mean square is known to 13 %.
    for (what, squares) in [("range", ranges), ("cos(theta)", cosines)] {
        let ratio = f64::sqrt(squares / f64::from(placed));
        println!("{what}: error / bound = {ratio:.3}");
        assert!((0.65..1.35).contains(&ratio), "{what}: error / bound is {ratio}");
    }
}
