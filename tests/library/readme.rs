//! README's example in Rust: it compiles, runs, and is what README shows.

use apertura::maps::{LogMaps, Normalisation};
use apertura::radar::Radar;
use apertura::scene::Scene;
use apertura::signal::{Floor, simulate};

#[test]
fn the_example_of_the_readme_draws_the_target() -> Result<(), Box<dyn std::error::Error>> {
    let radar = Radar::default();
    let scene = Scene::of_points([(-4.0, 12.5), (3.0, 20.0)]); // (x, y) in metres, y ahead
    let signal = simulate(&radar, &scene, Floor::Thesis, 0)?; // [elements, samples], complex
    let target = LogMaps::of_signal(&radar, &signal).full.normalise(Normalisation::MinMax);

    assert_eq!(target.lambda.dim(), (512, 1024));
    Ok(())
}

#[test]
fn every_line_of_the_readmes_example_is_in_this_file() {
    let [readme, this] = [include_str!("../../README.md"), include_str!("readme.rs")];
    let [_, rest] = readme.split("```rust\n").collect::<Vec<_>>()[..] else { panic!("README has one block in Rust") };
    let single = |line: &str| line.split_whitespace().collect::<Vec<_>>().join(" ");
    let lines: Vec<String> = this.lines().map(single).collect();
    let mut after = 0;
    for line in rest.split("```").next().unwrap().lines().map(single).filter(|line| !line.is_empty()) {
        let at = lines[after..].iter().position(|found| *found == line);
        after += at.unwrap_or_else(|| panic!("{line} is missing, or stands elsewhere")) + 1;
    }
}
