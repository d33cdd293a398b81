//! `apertura reconstruct` and `apertura train` as a user runs them.

use crate::cli::*;
use ndarray::Ix0;

/// A folder with in.npz: samples of one far reflector at broadside, as NumPy would store them.
fn with_samples(gain: f64) -> TempDir {
    let folder = folder();
    let end = Array2::from_shape_fn((512, 12), |(n, _)| Complex64::from_polar(gain, 0.9 * n as f64));
    let path = folder.path().join("in.npz");
    write_npz(&path, |out| ["sub0", "sub1"].into_iter().try_for_each(|key| out.add(key, &end))).unwrap();
    folder
}

fn output(folder: &TempDir) -> NpzReader<File> {
    NpzReader::new(File::open(folder.path().join("out.npz")).unwrap()).unwrap()
}

#[test]
fn live_writes_what_it_promises() {
    let folder = with_samples(3.0);
    call(&folder, "reconstruct in.npz -o out.npz").assert().success().stdout(contains("live"));
    let mut npz = output(&folder);
    let map: Array2<f32> = npz.by_name("net_output").unwrap();
    assert_eq!(map.dim(), (512, 1024));
    assert!(map.iter().all(|v| (0.0..=1.0).contains(v)));
    let eta: ndarray::Array<f64, Ix0> = npz.by_name("eta").unwrap();
    assert!((0.5..1.0).contains(&eta.into_scalar()));
    let time: ndarray::Array<f64, Ix0> = npz.by_name("milliseconds").unwrap();
    assert!(time.into_scalar() > 0.0);
}

#[test]
fn an_archive_of_version_0_1_is_read_with_its_radar() {
    let folder = folder();
    let archive = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/program-0.1.0/maps.npz");
    apertura(&folder).args(["reconstruct", archive, "--method", "iaa", "-o", "out.npz"]).assert().success();
    let mut written = NpzReader::new(File::open(archive).unwrap()).unwrap();
    let mut found = output(&folder);
    let cosines: [Array1<f64>; 2] = [written.by_name("cos_theta").unwrap(), found.by_name("cos_theta").unwrap()];
    assert_eq!(cosines[0], cosines[1]);
    let map: Array2<f32> = found.by_name("net_output").unwrap();
    let full: Array3<f64> = written.by_name("polar_full").unwrap();
    assert_eq!([map.nrows(), map.ncols()], full.shape()[1..]);
}

#[test]
fn unsuitable_input_is_told() {
    let folder = with_samples(f64::NAN);
    let reconstruct = "reconstruct in.npz -o out.npz --method";
    let run = |method: &str| call(&folder, &format!("{reconstruct} {method}")).assert().failure();
    run("live").stderr(contains("finite numbers only"));
    run("magic").stderr(contains("unknown method \"magic\""));
    let map = Array3::<f64>::zeros((4, 8, 8));
    write_npz(&folder.path().join("in.npz"), |out| out.add("polar_partial_mag_phase", &map)).unwrap();
    run("live").stderr(contains("needs sub0 and sub1"));
    assert!(!folder.path().join("out.npz").exists());
}

#[test]
fn weights_from_a_file_are_used_or_refused() {
    let folder = folder();
    let ramp = Array3::from_shape_fn((4, 512, 1024), |(c, i, j)| ((c + i + j) % 16) as f64 / 16.0);
    write_npz(&folder.path().join("in.npz"), |out| out.add("polar_partial_mag_phase", &ramp)).unwrap();
    // The weights' path begins at the project's folder, or is whole.
    let run = |method: &str, weights: &str| {
        let weights = Path::new(env!("CARGO_MANIFEST_DIR")).join(weights);
        call(&folder, &format!("reconstruct in.npz -o out.npz --method {method} --weights")).arg(weights).assert()
    };
    // A small network of the author's layout, as PyTorch's own checkpoint and as safetensors: the same map.
    let maps = ["pt", "safetensors"].map(|kind| {
        run("thesis", &format!("tests/data/thesis_reference_weights.{kind}")).success();
        output(&folder).by_name::<ndarray::OwnedRepr<f32>, Ix2>("net_output").unwrap()
    });
    assert_eq!(maps[0], maps[1]);
    assert!(maps[0].iter().any(|v| (v - maps[0][[0, 0]]).abs() > 0.05), "the same value everywhere");
    run("thesis", "training/checkpoints/thesis-1.pt").success();
    run("live", "tests/data/thesis_reference_weights.pt").failure().stderr(contains("add --method thesis"));
    let missing = folder.path().join("missing.pt");
    let missing = missing.to_str().unwrap();
    run("thesis", missing).failure().stderr(contains("missing.pt"));
    std::fs::write(missing, b"PK\x03\x04 cut short").unwrap();
    run("thesis", missing).failure().stderr(contains("is not a PyTorch checkpoint"));
}

#[test]
fn unknown_recipes_are_refused() {
    let folder = folder();
    call(&folder, "train --list").assert().success().stdout(contains("experiment-2-small"));
    call(&folder, "train no-such").assert().failure().stderr(contains("neither a file nor a shipped recipe"));
    std::fs::write(folder.path().join("long.toml"), vec![b'#'; (1 << 20) + 1]).unwrap();
    call(&folder, "train long.toml").assert().failure().stderr(contains("long.toml: has 1048577 bytes"));
}
