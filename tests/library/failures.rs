//! Shipped scenes on which a method fails do so in the way that their notes explain.
#![cfg(feature = "network")]

use crate::prelude::*;
use Fault::{Ghost, Merged, Missed, WrongTooth};
use apertura::evaluate::verdict::ObjectVerdict;
use apertura::scene::presets::Preset;

#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Fault {
    Missed,
    Merged,
    WrongTooth,
    Ghost,
}

/// Scene, method, and the kinds of failure that the notes explain. None is more frequent than the first.
const EXPLAINED: [(&str, &str, &[Fault]); 9] = [
    ("failure-live-missed", "live", &[Missed]),
    ("failure-live-merged", "live", &[Merged]),
    ("failure-live-ghost", "live", &[Ghost]),
    ("failure-live-wrong-tooth", "live", &[WrongTooth]),
    ("failure-hybrid-merged", "hybrid", &[Merged]),
    ("failure-thesis-missed", "thesis", &[Missed]),
    ("failure-thesis-merged", "thesis", &[Missed, Merged, Ghost]),
    ("failure-thesis-ghost", "thesis", &[Ghost]),
    ("failure-thesis-wrong-tooth", "thesis", &[WrongTooth]),
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
        let preset = Preset::by_id(id).unwrap();
        assert_eq!(preset.failing_method(), Some(name), "{id} opens with its method");
        let scene = preset.load().unwrap().scene;
        let trial = Trial::new(&Radar::default(), &scene, Floor::Thesis, Normalisation::MinMax).unwrap();
        let method = methods::by_name(name).unwrap();
        let answer = trial.ask(method.as_ref(), &Request::default()).unwrap();
        let verdicts = trial.verdicts(&answer);
        let merged = verdicts.count(|verdict| matches!(verdict, ObjectVerdict::Merged { .. }));
        let wrong_tooth = verdicts.count(|verdict| matches!(verdict, ObjectVerdict::WrongTooth { .. }));
        let counts =
            [(Missed, verdicts.missed()), (Merged, merged), (WrongTooth, wrong_tooth), (Ghost, verdicts.ghosts.len())];
        let shown: BTreeSet<Fault> = counts.into_iter().filter(|(_, count)| *count > 0).map(|(kind, _)| kind).collect();
        assert_eq!(shown, expected.iter().copied().collect(), "{id}, {name}: {counts:?}");
        let most = counts.iter().map(|(_, count)| *count).max();
        let of_the_first = counts.iter().find(|(kind, _)| *kind == expected[0]).map(|(_, count)| *count);
        assert_eq!(of_the_first, most, "{id}: {counts:?}");
    }
}
