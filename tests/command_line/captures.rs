//! Raw captures on the command line: described, imported, and opened as they are.

use super::rows::json;
use crate::cli::*;
use crate::made_captures::{Echo, RISING, STILL, cfg, samples, two_lanes};

fn with_capture() -> TempDir {
    let folder = folder();
    let loops = samples(&RISING, Echo { speed: 3.0, ..STILL }, 2, 8);
    std::fs::write(folder.path().join("room.bin"), two_lanes(loops.into_iter().flatten())).unwrap();
    let cfg = cfg(&RISING, &[1, 4], 8, "adcbufCfg -1 0 0 1 1\n");
    std::fs::write(folder.path().join("room.cfg"), cfg).unwrap();
    folder
}

#[test]
fn an_import_says_what_it_found_with_why() {
    let folder = with_capture();
    let told = contains("I I Q Q as two lanes send them, 4 receivers one after another, 128 samples a chirp")
        .and(contains("Every receiver sees the same echoes"))
        .and(contains("One whole frame fills the file"))
        .and(contains("the choice is sure"))
        .and(contains("xWR1843"))
        .and(contains("wrote room.toml"));
    call(&folder, "import room.bin -o room.toml").assert().success().stdout(told);
    call(&folder, "maps room.toml -o m.npz").assert().success();
    let found = json(&folder, "import room.bin --json");
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
    let made = call(&folder, "range-doppler room.bin --static-clutter-out -o d.npz").assert().success();
    made.stdout(contains("of 8 velocities"));
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
    std::fs::write(folder.path().join("wrong.bin"), [0; 5000]).unwrap();
    for (arguments, part) in [
        ("import room.bin --board abc", "no such board is known; expected xWR1642"),
        ("import room.bin -o room.txt", "expected a name ending in .toml"),
        ("import room.bin -o no/room.toml", "beside the capture"),
        ("import no.bin", "no.bin"),
        ("range-doppler room.bin -o d.npz --time 1", "--time is a scene's"),
        ("range-doppler room.bin -o d.npz --seed 1", "--seed is a scene's"),
        ("maps room.bin -o m.npz --floor snr=20", "--floor is a scene's"),
        ("maps wrong.bin -o m.npz", "wrong.bin"),
        ("reconstruct room.bin -o o.npz --floor exact", "--floor is a scene's"),
    ] {
        call(&folder, arguments).assert().failure().stderr(contains(part));
    }
}
