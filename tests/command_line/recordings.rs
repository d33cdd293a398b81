//! Recordings on the command line: maps, pictures, reconstructions, and refusals.

use crate::cli::*;

const CASCADE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/recordings/cascade-86.toml");
pub const CHIP: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/recordings/chip-8.toml");

#[test]
fn a_recording_gives_its_maps_without_positions() {
    let folder = folder();
    apertura(&folder).args(["maps", CHIP, "-o", "m.npz"]).assert().success();
    let mut found = Npz::open(&folder.path().join("m.npz")).unwrap();
    assert!(!found.has("all_point_x"));
    assert_eq!(found.complexes::<Ix2>("sub0").unwrap().dim(), (128, 3));
    assert_eq!(found.reals::<Ix3>("polar_partial_mag_phase").unwrap().dim(), (4, 128, 8));
    let full = found.reals::<Ix3>("polar_full").unwrap();
    let reference: Array2<f64> =
        ndarray_npy::read_npy(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/chip-8-map.npy")).unwrap();
    let worst = full.index_axis(Axis(0), 0).iter().zip(&reference).fold(0.0f64, |m, (a, b)| m.max((a - b).abs()));
    assert!(worst < 1e-9, "NumPy's map of the same file: {worst}");
}

#[test]
fn recordings_are_drawn() {
    let folder = folder();
    let drawn = |more: &[&str]| {
        apertura(&folder).args(["maps", CHIP, "-o", "chip.svg", "--method", "omp"]).args(more).assert().success();
        std::fs::read_to_string(folder.path().join("chip.svg")).unwrap()
    };
    let svg = drawn(&[]);
    assert!(svg.contains("A room, 8 elements") && svg.contains("Found by omp") && !svg.contains("CFAR"));
    assert!(drawn(&["--cfar", "os"]).contains("Output: OS-CFAR"));
    apertura(&folder).arg(CHIP).assert().success().stdout(contains("apertura.png"));
}

#[test]
fn what_reflectors_leave_unexplained_is_a_map() {
    let folder = folder();
    let near = "[[object]]\nkind = \"point\"\nx_metres = 0\ny_metres = 2\n";
    std::fs::write(folder.path().join("near.toml"), near).unwrap();
    let explained = apertura(&folder).args(["maps", CHIP, "--explain", "near.toml", "-o", "left.npz"]).assert();
    explained.success().stdout(contains("near.toml explains"));
    call(&folder, "maps near.toml --explain near.toml -o x.npz").assert().failure();
}

fn lists(path: &Path) -> (Vec<f64>, Vec<f64>, Vec<f64>) {
    let mut npz = Npz::open(path).unwrap();
    let mut list = |key: &str| npz.reals::<Ix1>(key).unwrap().to_vec();
    (list("found_cos_theta"), list("found_range_metres"), list("found_db"))
}

#[test]
fn samples_of_another_radar_are_told() {
    let folder = folder();
    let end = Array2::<Complex64>::ones((64, 12));
    let path = folder.path().join("in.npz");
    write_npz(&path, |out| ["sub0", "sub1"].into_iter().try_for_each(|key| out.add(key, &end))).unwrap();
    let run = |radar: &str| {
        std::fs::write(folder.path().join("radar.toml"), radar).unwrap();
        call(&folder, "reconstruct in.npz --radar radar.toml -o o.npz --method bartlett").assert()
    };
    let shapes = contains("\"sub0\" has shape [64, 12]; expected [128, 12]").and(contains("--radar says"));
    run("[radar]\nsamples = 128\n").failure().stderr(shapes);
    run("[radar]\nsamples = 0\n").failure().stderr(contains("radar.toml: line 2, column 11: radar.samples is 0"));
    run("name = \"no radar\"\n").failure().stderr(contains("has no table [radar]"));
    run("[radar]\nsamples = \"many\"\n").failure().stderr(contains("radar.toml: line 2"));
    assert!(!folder.path().join("o.npz").exists());
}

#[test]
fn shipped_recordings_are_reconstructed_without_a_radar() {
    let folder = folder();
    let run = |input: &str, more: &[&str]| {
        apertura(&folder).arg("reconstruct").arg(input).args(["-o", "o.npz"]).args(more).assert()
    };
    run(CASCADE, &[]).success().stdout(contains("iaa"));
    let (cos, range, db) = lists(&folder.path().join("o.npz"));
    let degrees: Vec<f64> = cos.iter().take(2).map(|c| c.asin().to_degrees()).collect();
    assert!(degrees.iter().all(|d| (d - 6.96).abs() < 0.1 || d.abs() < 0.1), "{degrees:?}");
    let is_of_two =
        db[0] == 0.0 && db[1] > -8.0 && db[2..].iter().all(|db| *db < -8.0) && db.is_sorted_by(|a, b| a >= b);
    assert!(range.iter().all(|r| *r == 15.0) && is_of_two, "{range:?} {db:?}");
    run(CASCADE, &["--radar", CASCADE]).failure().stderr(contains("leave --radar out"));
    run(CHIP, &["--method", "capon"]).failure().stderr(contains("transmitters stand apart from"));
    run(CHIP, &["--method", "omp"]).success();
    assert!(!lists(&folder.path().join("o.npz")).0.is_empty());
    // Its data file alone is opened by what its axes count, and the rest is said to be taken for granted.
    let granted = contains("No .cfg says the carrier").and(contains("8 receivers half a wavelength apart"));
    run(&CHIP.replace(".toml", ".npz"), &[]).success().stderr(granted);
    let single = contains("cascade-86.mat: the array is read as 1 element").and(contains("cascade-86.toml, which"));
    run(&CASCADE.replace(".toml", ".mat"), &[]).failure().stderr(single);
    // The ends of a snapshot of unknown range.
    apertura(&folder).args(["maps", CASCADE, "-o", "maps.npz"]).assert().success();
    std::fs::write(folder.path().join("r.toml"), "[radar]\nelements = 86\nsamples = 1\n").unwrap();
    run("maps.npz", &["--radar", "r.toml"]).failure().stderr(contains("--radar names another"));
    run("maps.npz", &["--method", "sbl"]).success();
    let mut npz = NpzReader::new(File::open(folder.path().join("o.npz")).unwrap()).unwrap();
    let range: Array1<f64> = npz.by_name("found_range_metres").unwrap();
    assert!(!range.is_empty() && range.iter().all(|r| r.is_nan()), "{range}");
}
