//! Raw captures on the command line: described, imported, and opened as they are.

use crate::cli::*;
use std::f64::consts::TAU;

const C: f64 = 299_792_458.0;
const SAMPLES: usize = 128;
const LOOPS: usize = 8;

/// Two transmitters and four receivers, 128 samples, eight loops.
const CFG: &str = "channelCfg 15 5 0\nadcCfg 2 1\nadcbufCfg -1 0 0 1 1\nprofileCfg 0 77 30 6 60 0 0 60 1 128 4000 0 0 30\n\
                   chirpCfg 0 0 0 0 0 0 0 1\nchirpCfg 1 1 0 0 0 0 0 4\nframeCfg 0 1 8 0 100 1 0\n";

/// An echo at x = 1.1 m, y = 2.3 m that goes away at 3 m/s, as I I Q Q.
fn capture() -> Vec<u8> {
    let frequency = |n: usize| 77e9 + 60e12 * (6e-6 + n as f64 / 4e6);
    let half_wave = C / frequency(SAMPLES / 2) / 2.0;
    let mut state = 5u32;
    let mut noise = move || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        8.0 * (f64::from(state >> 16) / 65536.0 - 0.5)
    };
    let mut sample = |chirp: usize, receiver: usize, n: usize| {
        let grown = 1.0 + 3.0 * 90e-6 * chirp as f64 / 1.1f64.hypot(2.3);
        let way = |place: f64| (1.1 * grown - (place - 1.75) * half_wave).hypot(2.3 * grown);
        let path = way(4.0 * (chirp % 2) as f64) + way(receiver as f64);
        Complex64::from_polar(400.0, TAU * frequency(n) * path / C) + Complex64::new(noise(), noise())
    };
    let all: Vec<Complex64> =
        (0..LOOPS * 2 * 4 * SAMPLES).map(|n| sample(n / (4 * SAMPLES), n / SAMPLES % 4, n % SAMPLES)).collect();
    let part = |v: f64| (v.round() as i16).to_le_bytes();
    all.chunks(2)
        .flat_map(|b| b.iter().map(|v| part(v.re)).chain(b.iter().map(|v| part(v.im))).collect::<Vec<_>>())
        .flatten()
        .collect()
}

fn with_capture() -> TempDir {
    let folder = folder();
    std::fs::write(folder.path().join("room.bin"), capture()).unwrap();
    std::fs::write(folder.path().join("room.cfg"), CFG).unwrap();
    folder
}

#[test]
fn an_import_says_what_it_found_with_why() {
    let folder = with_capture();
    let mut command = apertura(&folder);
    let told = contains("I I Q Q as two lanes send them, 4 receivers one after another, 128 samples a chirp")
        .and(contains("Every receiver sees the same echoes"))
        .and(contains("One whole frame fills the file"))
        .and(contains("the choice is sure"))
        .and(contains("xWR1843"))
        .and(contains("wrote room.toml"));
    command.args(["import", "room.bin", "-o", "room.toml"]).assert().success().stdout(told);
    call(&folder, "maps room.toml -o m.npz").assert().success();
    let output = call(&folder, "import room.bin --json").assert().success().get_output().stdout.clone();
    let found: serde_json::Value = serde_json::from_slice(&output).unwrap();
    assert_eq!((&found["certainty"], &found["layouts"][0]["parts"]), (&"sure".into(), &"two-lanes".into()));
    assert!(found["toml"].as_str().unwrap().contains("format = 3"));
}

#[test]
fn a_raw_capture_gives_the_place_of_its_echo() {
    let folder = with_capture();
    call(&folder, "reconstruct room.bin --method iaa -o out.npz").assert().success();
    let mut out = Npz::open(&folder.path().join("out.npz")).unwrap();
    let [range, cosine] =
        ["found_range_metres", "found_cos_theta"].map(|key| out.reals::<Ix1>(key).unwrap().first().copied().unwrap());
    let true_range = 1.1f64.hypot(2.3);
    assert!((range - true_range).abs() < 0.08 && (cosine - 1.1 / true_range).abs() < 0.03, "{range} m, {cosine}");
    call(&folder, "maps room.cfg -o m.png").assert().success();
    std::fs::rename(folder.path().join("room.cfg"), folder.path().join("other.txt")).unwrap();
    call(&folder, "maps room.bin --config other.txt -o n.npz").assert().success();
}

#[test]
fn a_raw_capture_has_a_range_doppler_map() {
    let folder = with_capture();
    call(&folder, "range-doppler room.bin --static-clutter-out -o d.npz")
        .assert()
        .success()
        .stdout(contains("of 8 velocities"));
    let mut map = Npz::open(&folder.path().join("d.npz")).unwrap();
    let power = map.reals::<Ix2>("power").unwrap();
    let velocity = map.reals::<Ix1>("velocity_metres_per_second").unwrap();
    let ((bin, column), _) = power.indexed_iter().max_by(|a, b| a.1.total_cmp(b.1)).unwrap();
    assert!((31..=34).contains(&bin), "{bin}");
    assert!((velocity[column] - 3.0).abs() <= velocity[1] - velocity[0], "{}", velocity[column]);
}

#[test]
fn what_does_not_belong_to_a_capture_is_told() {
    let folder = with_capture();
    let told = |arguments: &[&str], part: &'static str| {
        apertura(&folder).args(arguments).assert().failure().stderr(contains(part));
    };
    told(&["import", "room.bin", "--board", "abc"], "no such board is known; expected xWR1642");
    told(&["import", "room.bin", "-o", "room.txt"], "expected a name ending in .toml");
    told(&["import", "room.bin", "-o", "no/room.toml"], "beside the capture");
    told(&["range-doppler", "room.bin", "-o", "d.npz", "--time", "1"], "--time is a scene's");
    std::fs::write(folder.path().join("s.toml"), "").unwrap();
    std::fs::write(folder.path().join("wrong.bin"), [0; 5000]).unwrap();
    told(&["maps", "wrong.bin", "-o", "m.npz"], "wrong.bin");
    told(&["import", "no.bin"], "no.bin");
}
