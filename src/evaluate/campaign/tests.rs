use super::*;
use crate::reconstruct::{Baseline, MethodInfo, ReconstructError, Reconstruction};
use crate::scene::generate::Kind;
use crate::signal::TwoEnds;

#[test]
fn rows_tell_what_the_detector_makes_of_every_output() {
    let sets = [SceneSet::Generated(Kind::Set1)];
    let run = |cfar: Option<Cfar>| {
        Campaign { count: 1, cfar, ..Campaign::default() }.run(&sets, &[&Baseline], &Task::default(), |_| ())
    };
    let row = |cfar| Row { milliseconds: 0.0, ..run(cfar).unwrap()[0].clone() };
    let [without, with] = [None, Some(Cfar::default())].map(row);
    let Row { cfar, cfar_detection, cfar_false_alarm, .. } = with.clone();
    assert!(cfar_detection > Some(0.0) && cfar == Cfar::default().to_string().as_str());
    assert!(without.cfar.is_empty() && without.cfar_false_alarm.is_none());
    assert_eq!(Row { cfar, cfar_detection, cfar_false_alarm, ..without }, with);
    let few = run(Some(Cfar { false_alarm: 1e-12, ..Cfar::default() })).unwrap();
    assert!(few[0].cfar_false_alarm < cfar_false_alarm, "{few:?}");
    let wide = run(Some(Cfar { guard: [3, 600], ..Cfar::default() })).unwrap_err().to_string();
    assert!(wide.starts_with("the detector on scene 0 of set 1: guard and training cells span"), "{wide}");
}

struct Refuses;

impl Reconstructor for Refuses {
    fn info(&self) -> MethodInfo {
        MethodInfo { name: "refuses", ..Baseline.info() }
    }

    fn estimate(&self, _: &Radar, _: &TwoEnds, _: &Request) -> Result<Reconstruction, ReconstructError> {
        Err(ReconstructError::Unusable { method: "refuses", reason: "made for no radar".to_owned() })
    }
}

#[test]
fn a_campaign_goes_on_without_a_method_that_refuses_its_scenes() {
    let campaign = Campaign { count: 2, ..Campaign::default() };
    let sets = [SceneSet::Generated(Kind::Set1)];
    let methods: [&dyn Reconstructor; 2] = [&Refuses, &Baseline];
    assert!(campaign.run(&sets, &methods, &Task::default(), |_| ()).is_err());
    let (rows, unfit) = campaign.run_fit(&sets, &methods, &Task::default(), |_, _, _| ()).unwrap();
    assert_eq!(rows.iter().map(|row| &*row.method).collect::<Vec<_>>(), ["baseline"; 2]);
    let [MethodFailure { method: "refuses", set, scenes: 2, reason }] = &unfit[..] else { panic!("{unfit:?}") };
    assert!(set == "set 1" && reason.contains("made for no radar"), "{reason}");
}
