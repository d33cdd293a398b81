//! Shipped scenes on which a method fails do so in the way that their notes explain.
#![cfg(feature = "network")]

use apertura::evaluate::failure::Fate;
use apertura::evaluate::trial::Trial;
use apertura::maps::Normalisation;
use apertura::methods;
use apertura::radar::Radar;
use apertura::reconstruct::Request;
use apertura::scene::presets::{self, Preset};
use apertura::signal::Floor;
use std::collections::BTreeSet;

/// Scene, method, and how many objects are missed, merged and on a wrong tooth, and how many ghosts there are.
const EXPLAINED: [(&str, &str, [usize; 4]); 10] = [
    ("failure-live-missed", "live", [1, 0, 0, 0]),
    ("failure-live-merged", "live", [0, 2, 0, 0]),
    ("failure-live-ghost", "live", [0, 0, 0, 1]),
    ("failure-wrong-tooth", "live", [0, 0, 1, 0]),
    ("failure-hybrid-merged", "hybrid", [0, 2, 0, 0]),
    ("failure-hybrid-missed", "hybrid", [1, 0, 0, 0]),
    ("failure-thesis-missed", "thesis", [1, 0, 0, 0]),
    ("failure-thesis-merged", "thesis", [3, 2, 0, 1]),
    ("failure-thesis-ghost", "thesis", [0, 0, 0, 1]),
    ("failure-thesis-wrong-tooth", "thesis", [0, 0, 1, 0]),
];

#[test]
fn every_failure_that_ships_is_explained() {
    let shipped: BTreeSet<&str> = presets::ALL.iter().filter(|p| p.is_failure()).map(|p| p.id).collect();
    assert_eq!(shipped, EXPLAINED.iter().map(|(id, ..)| *id).collect());
    for id in shipped {
        assert!(include_str!("../../docs/failures.md").contains(&format!("assets/scenes/{id}.toml")), "{id}");
    }
}

#[test]
fn methods_fail_on_shipped_scenes_as_their_notes_say() {
    for (id, name, expected) in EXPLAINED {
        let scene = Preset::by_id(id).unwrap().load().unwrap().scene;
        let trial = Trial::new(&Radar::default(), &scene, Floor::Thesis, Normalisation::MinMax).unwrap();
        let method = methods::by_name(name).unwrap();
        let answer = trial.ask(method.as_ref(), &Request::default()).unwrap();
        let failures = trial.failures(&answer);
        let merged = failures.count(|fate| matches!(fate, Fate::Merged { .. }));
        let wrong_tooth = failures.count(|fate| matches!(fate, Fate::WrongTooth { .. }));
        assert_eq!([failures.missed(), merged, wrong_tooth, failures.ghosts.len()], expected, "{id}, {name}");
    }
}
