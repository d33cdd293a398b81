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

#[test]
fn a_repair_without_success_says_so_in_a_sentence() {
    let folder = folder();
    call(&folder, "scenes --set 2 --seed 3 --index 1 -o s.toml").assert().success();
    let repair = "worsen s.toml --method baseline --repair --within 0.001 --tries 1 -o w.toml";
    let told = contains("no scene on which the method is right within 0.001 m in 1 try; try a larger --within");
    call(&folder, repair).assert().failure().stderr(told);
    assert!(!folder.path().join("w.toml").exists());
}
