use super::*;
use crate::files::npz::write_npz;
use crate::recording::Recorded;
use crate::signal::TwoEnds;
use ndarray::{Array2, Array3, ArrayD, Axis, array, concatenate};
use num_complex::Complex64;
use std::fs;
use tempfile::TempDir;

const RADAR: &str = "[radar]
carrier_hz = 77e9
bandwidth_hz = 1e9
element_spacing_metres = 0.0019
elements = 8
end_elements = 3
samples = 4
";

fn code(element: usize, sample: usize) -> Complex64 {
    Complex64::new(element as f64 + 1.0, sample as f64)
}

fn all() -> Array2<Complex64> {
    Array2::from_shape_fn((8, 4), |(n, s)| code(n, s))
}

fn folder_with(name: &str, arrays: &[(&str, ArrayD<Complex64>)]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    write_npz(&folder.path().join(name), |out| arrays.iter().try_for_each(|(key, a)| out.add(key, a))).unwrap();
    folder
}

fn read(folder: &TempDir, recording: &str) -> Result<Recording, RecordingError> {
    let path = folder.path().join("r.toml");
    fs::write(&path, format!("name = \"R\"\n{RADAR}{recording}")).unwrap();
    load(&path)
}

fn usual(more: &str) -> String {
    format!("[recording]\nfile = \"d.npz\"\narray = \"a\"\naxes = [\"element\", \"sample\"]\n{more}")
}

#[test]
fn a_whole_array_is_read_as_it_is() {
    let folder = folder_with("d.npz", &[("a", all().into_dyn())]);
    let recording = read(&folder, &usual("")).unwrap();
    assert_eq!(recording.signal().unwrap().samples, all());
    assert_eq!(recording.two_ends().last, all().slice(ndarray::s![5.., ..]));
    assert_eq!((recording.name.as_str(), recording.radar.elements, recording.is_snapshot()), ("R", 8, false));
}

#[test]
fn a_long_list_of_missing_elements_takes_no_time() {
    let folder = folder_with("d.npz", &[("a", all().into_dyn())]);
    let missing: Vec<usize> = (0..65_000).rev().collect();
    let radar = RADAR.replace("elements = 8", "elements = 65536");
    let text = format!("{radar}{}", usual(&format!("missing = {missing:?}\n")));
    fs::write(folder.path().join("r.toml"), text).unwrap();
    let began = crate::platform::Instant::now();
    let error = load(&folder.path().join("r.toml")).unwrap_err().to_string();
    assert!(error.contains("8 elements") && error.contains("65536") && error.contains("or 536"), "{error}");
    assert!(began.elapsed().as_secs_f32() < 1.0, "{:?}", began.elapsed());
}

#[test]
fn missing_elements_are_zeros_with_or_without_rows() {
    let without: Vec<usize> = (0..8).filter(|n| ![2, 6].contains(n)).collect();
    let fewer = all().select(Axis(0), &without);
    for rows in [all(), fewer] {
        let folder = folder_with("d.npz", &[("a", rows.into_dyn())]);
        let recording = read(&folder, &usual("missing = [6, 2]")).unwrap();
        let samples = &recording.signal().unwrap().samples;
        assert!(samples.row(2).iter().chain(samples.row(6)).all(|v| v.norm() == 0.0));
        assert_eq!((samples[[1, 3]], samples[[7, 1]]), (code(1, 3), code(7, 1)));
        assert_eq!(recording.missing, [2, 6]);
    }
}

#[test]
fn two_ends_stand_in_one_array_or_in_two() {
    let (first, last) = (all().slice(ndarray::s![..3, ..]).to_owned(), all().slice(ndarray::s![5.., ..]).to_owned());
    let both = concatenate(Axis(0), &[first.view(), last.view()]).unwrap();
    let folder = folder_with(
        "d.npz",
        &[("a", both.into_dyn()), ("sub0", first.clone().into_dyn()), ("sub1", last.clone().into_dyn())],
    );
    let pair = "[recording]\nfile = \"d.npz\"\nfirst = \"sub0\"\nlast = \"sub1\"\naxes = [\"element\", \"sample\"]\n";
    for text in [usual("elements = \"ends\""), pair.to_owned()] {
        let recording = read(&folder, &text).unwrap();
        assert_eq!(recording.samples, Recorded::Ends(TwoEnds { first: first.clone(), last: last.clone() }));
        assert_eq!(recording.signal(), None);
    }
}

#[test]
fn elements_are_corrected_as_the_text_says() {
    let folder = folder_with("d.npz", &[("a", all().into_dyn())]);
    let gains = "[recording.calibration]\ngain_db = [20, 0, 0, 0, 0, 0, 0, 0]";
    let recording = read(&folder, &usual(&format!("conjugate = true\nreverse_elements = true\n{gains}"))).unwrap();
    let samples = &recording.signal().unwrap().samples;
    assert_eq!(samples[[0, 3]], code(7, 3).conj());
    assert!((samples[[7, 2]] - code(0, 2).conj() / 10.0).norm() < 1e-12);
}

#[test]
fn a_snapshot_needs_its_range() {
    let folder = folder_with("d.npz", &[("a", array![1, 2, 3, 4, 5, 6, 7, 8].mapv(|v| code(v, 0)).into_dyn())]);
    let path = folder.path().join("s.toml");
    let radar = RADAR.replace("samples = 4", "samples = 1").replace("bandwidth_hz = 1e9\n", "");
    let text =
        |more: &str| format!("{radar}[recording]\nfile = \"d.npz\"\narray = \"a\"\naxes = [\"element\"]\n{more}");
    fs::write(&path, text("range_metres = 15")).unwrap();
    let recording = load(&path).unwrap();
    assert!(recording.is_snapshot() && recording.range_metres == Some(15.0));
    assert_eq!(recording.signal().unwrap().samples.dim(), (8, 1));
    for (more, part) in [("", "range_metres is missing"), ("range_metres = -1", "range_metres is -1")] {
        fs::write(&path, text(more)).unwrap();
        let message = load(&path).unwrap_err().to_string();
        assert!(message.contains(part) && message.contains("s.toml"), "{message}");
    }
}

#[test]
fn a_raw_capture_takes_its_radar_from_the_cfg() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("p.cfg"), super::super::profile::tests::CFG).unwrap();
    // Two chirps of four receivers and eight samples, twice: as many int16 as there are parts.
    let bytes: Vec<u8> = (0..2 * 2 * 4 * 8 * 2i16).flat_map(i16::to_le_bytes).collect();
    fs::write(folder.path().join("d.bin"), bytes).unwrap();
    let path = folder.path().join("c.toml");
    let radar = "[radar]\nelement_spacing_metres = 0.0019\nelements = 8\nend_elements = 3\n";
    let capture =
        "[recording.capture]\nconfig = \"p.cfg\"\nlanes = 2\nreceivers = \"one-after-another\"\nchirps = [0, 1]\n";
    let write = |radar: &str, key: &str, more: &str| {
        fs::write(&path, format!("{radar}[recording]\nfile = \"d.bin\"\n{key}{capture}{more}")).unwrap();
        load(&path)
    };
    let recording = write(radar, "", "loop = 1").unwrap();
    assert_eq!((recording.radar.samples, recording.radar.elements), (8, 8));
    assert!((recording.radar.bandwidth_hz - 107.5e6).abs() < 1e5 && recording.radar.carrier_hz > 77.5e9);
    let samples = &recording.signal().unwrap().samples;
    // The second chirp's first receiver, of the second loop, begins after three chirps of 64 numbers: I I Q Q.
    assert_eq!((samples[[4, 0]], samples[[4, 1]]), (Complex64::new(192.0, 194.0), Complex64::new(193.0, 195.0)));
    for (radar, key, more, parts) in [
        (format!("{radar}samples = 9\n"), "", "", ["c.toml", "radar.samples is 9; expected 8, as the .cfg says"]),
        (format!("{radar}carrier_hz = 60e9\n"), "", "", ["radar.carrier_hz", "as the .cfg says"]),
        (radar.replace("elements = 8", "elements = 9"), "", "", ["d.bin", "8 elements; expected 9"]),
        (radar.to_owned(), "axes = [\"element\"]\n", "", ["recording.axes", "beside a .bin"]),
        (radar.to_owned(), "", "loop = 2", ["d.bin", "loop is 2"]),
    ] {
        let message = write(&radar, key, more).unwrap_err().to_string();
        assert!(parts.iter().all(|p| message.contains(p)), "{message}");
    }
    fs::write(folder.path().join("p.cfg"), "chirpCfg x").unwrap();
    let message = write(radar, "", "").unwrap_err().to_string();
    assert!(message.contains("p.cfg: line 1"), "{message}");
}

#[test]
fn faults_name_file_key_shape_expectation() {
    let folder = folder_with("d.npz", &[("a", all().into_dyn()), ("cube", Array3::zeros((2, 8, 4)).into_dyn())]);
    fs::write(folder.path().join("real.npy"), b"no array at all").unwrap();
    let mut nan = all();
    nan[[5, 2]].re = f64::NAN;
    write_npz(&folder.path().join("nan.npz"), |out| out.add("a", &nan)).unwrap();
    let turned = "holds 8 samples; expected 4 as radar.samples says (it is read as 4 elements by 8 samples)";
    for (text, parts) in [
        ("[recording]\nfile = 3".to_owned(), ["r.toml: line 10", "string"]),
        ("[recording]\naxis = 3".to_owned(), ["r.toml: line 10", "axes"]),
        (usual("").replace("d.npz", "no.npz"), ["no.npz", "No such file"]),
        (usual("").replace("d.npz", "."), ["recording.file", ".npz, .npy, .mat, .h5 or .bin"]),
        ("[recording]\nfile = \"d.npz\"\narray = \"a\"".to_owned(), ["r.toml", "recording.axes is missing"]),
        (usual("").replace("\"a\"", "\"b\""), ["d.npz", "\"b\"; expected it beside what is there: a, cube"]),
        (usual("").replace("array = \"a\"\n", ""), ["r.toml", "recording.array is missing"]),
        (usual("").replace("\"a\"", "\"cube\""), ["recording.axes names 2 axes", "shape [2, 8, 4]"]),
        (usual("").replace("\"element\", \"sample\"", "\"sample\", \"element\""), ["d.npz", turned]),
        (usual("").replace("\"element\"", "\"antenna\""), ["line 12", "antenna"]),
        (usual("chirp = \"median\""), ["line 13", "a number from 0, \"mean\""]),
        (usual("elements = \"ends\""), ["d.npz", "holds 8 elements; expected 6 as radar.end_elements"]),
        (usual("missing = [1, 1]"), ["recording.missing", "each once"]),
        (usual("missing = [8]"), ["recording.missing names element 8", "below 8"]),
        (usual("range_metres = 3"), ["recording.range_metres", "only where radar.samples is 1"]),
        (usual("first = \"a\""), ["recording.array", "both first and last"]),
        (usual("[recording.calibration]\ngain_db = [1]"), ["gain_db has 1", "expected 8"]),
        (usual("").replace("d.npz", "nan.npz"), ["nan.npz", "sample 2 of element 5 is not finite"]),
        (usual("").replace("d.npz", "real.npy"), ["r.toml", "recording.array is there"]),
        (usual("").replace("d.npz", "real.npy").replace("array = \"a\"\n", ""), ["real.npy", "magic number"]),
        (usual("").replace("d.npz", "r.bin"), ["r.toml", "[recording.capture] is missing"]),
    ] {
        let message = read(&folder, &text).unwrap_err().to_string();
        assert!(parts.iter().all(|p| message.contains(p)), "{text}\n{message}");
    }
}

#[test]
fn the_text_must_have_the_radar() {
    let folder = folder_with("d.npz", &[("a", all().into_dyn())]);
    let path = folder.path().join("r.toml");
    let told = |radar: &str, part: &str| {
        fs::write(&path, format!("{radar}{}", usual(""))).unwrap();
        let message = load(&path).unwrap_err().to_string();
        assert!(message.contains(part), "{message}");
    };
    told(&RADAR.replace("bandwidth_hz = 1e9\n", ""), "radar.bandwidth_hz is missing");
    told(&RADAR.replace("elements = 8\nend_elements = 3\n", "end_elements = 3\n"), "radar.elements is missing");
    told(&RADAR.replace("elements = 8\n", "elements = \"many\"\n"), "[radar]");
    told(&RADAR.replace("bandwidth_hz = 1e9", "bandwidth_hz = -1.0"), "radar.bandwidth_hz is -1");
    told(&format!("{RADAR}colour = 3\n"), "colour");
    told("", "radar");
}
