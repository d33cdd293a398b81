//! `apertura worsen`: a worse scene near one that is given.

use super::rows::error_by_hand;
use crate::cli::*;

#[test]
fn worsen_writes_a_scene_as_bad_as_it_says() {
    let folder = folder();
    call(&folder, "scenes --set 2 --seed 3 --index 1 -o s.toml").assert().success();
    let worsen = "worsen s.toml --method baseline --tries 24 --within 1.5 --seed 5 -o";
    let output = call(&folder, &format!("{worsen} w.toml")).assert().success();
    let text = String::from_utf8(output.get_output().stdout.clone()).unwrap();
    call(&folder, &format!("{worsen} again.toml")).assert().success();
    let [found, again] = ["w.toml", "again.toml"].map(|name| file::load(&folder.path().join(name)).unwrap().scene);
    assert_eq!(found, again);
    let start = file::load(&folder.path().join("s.toml")).unwrap().scene;
    for (a, b) in start.objects.iter().zip(&found.objects) {
        let ([ax, ay], [bx, by]) = (a.centre_metres(), b.centre_metres());
        assert!((bx - ax).hypot(by - ay) <= 1.5 + 1e-9);
    }
    call(&folder, "maps w.toml -o maps.npz").assert().success();
    call(&folder, "reconstruct maps.npz --method baseline -o out.npz").assert().success();
    let after = text.lines().find(|l| l.starts_with("after")).unwrap();
    assert!(after.contains(&format!("SE {:.1},", error_by_hand(folder.path()))), "{text}");
}

/// Within 2 m and a minute, five times the squared error for four of five starts of set 1.
#[test]
#[ignore = "minutes; prints what the search finds for the live network"]
#[cfg(feature = "network")]
fn worsen_finds_trouble_for_the_live_network() {
    let folder = folder();
    let mut factors: Vec<f64> = (0..5)
        .map(|index| {
            call(&folder, &format!("scenes --set 1 --seed 11 --index {index} -o s.toml")).assert().success();
            let start = std::time::Instant::now();
            let arguments = "worsen s.toml --method live --within 2 --minutes 1 -o w.toml";
            let output = call(&folder, arguments).assert().success();
            let text = String::from_utf8(output.get_output().stdout.clone()).unwrap();
            let error = |line: &str| {
                let line = text.lines().find(|l| l.starts_with(line)).unwrap();
                line.split("SE ").nth(1).unwrap().split(',').next().unwrap().parse::<f64>().unwrap()
            };
            println!("{:.0} s\n{text}", start.elapsed().as_secs_f64());
            error("after") / error("before")
        })
        .collect();
    factors.sort_by(f64::total_cmp);
    println!("{factors:.1?}");
    assert!(factors[1] >= 5.0);
}
