use super::*;
use crate::reconstruct::{About, BARTLETT, Baseline, ReconstructError, Reconstruction};
use crate::scene::generate::Kind;
use crate::signal::TwoEnds;

/// Rows without their times.
fn figures(rows: &[Row]) -> Vec<Row> {
    rows.iter().map(|r| Row { milliseconds: 0.0, ..r.clone() }).collect()
}

#[test]
fn the_shards_of_a_campaign_add_up_to_it() {
    let sets = [SceneSet::Generated(Kind::Set1), SceneSet::Generated(Kind::Set2)];
    let run = |shard: &str| {
        let campaign = Campaign { count: 3, seed: 3, shard: shard.parse().unwrap(), ..Campaign::default() };
        let mut seen = 0;
        let rows = campaign.run(&sets, &[&Baseline, &BARTLETT], &Task::default(), |_| seen += 1).unwrap();
        assert_eq!(rows.len(), seen);
        figures(&rows)
    };
    let whole = run("0/1");
    assert_eq!(
        whole.iter().map(|r| (&*r.set, r.index)).collect::<Vec<_>>()[2..6],
        [("1", 1), ("1", 1), ("1", 2), ("1", 2)]
    );
    assert_eq!(whole.len(), 12);
    assert_ne!(whole[0].squared_error, whole[2].squared_error);
    let shards = vec![("a".into(), run("1/2")), ("b".into(), run("0/2"))];
    let merged = super::super::rows::merge(shards).unwrap();
    let figures = |rows: &[Row]| rows.iter().map(|r| Row { shard: None, ..r.clone() }).collect::<Vec<_>>();
    assert_eq!(figures(&merged), figures(&whole));
    assert_eq!(super::super::rows::lacks(&merged), []);
}

#[test]
fn the_rest_of_a_campaign_is_what_lacked() {
    let sets = [SceneSet::Generated(Kind::Set1)];
    let methods: [&dyn Reconstructor; 2] = [&Baseline, &BARTLETT];
    let campaign = Campaign { count: 3, ..Campaign::default() };
    let whole = campaign.run(&sets, &methods, &Task::default(), |_| ()).unwrap();
    let is_done = |_: &str, index: u32, method: &str| index == 0 || (index, method) == (1, "baseline");
    let empty = campaign.empty_rows(&sets, &methods).unwrap();
    let rest = campaign.run_rest(&sets, &methods, &empty, &is_done, &Task::default(), |_, _, _| ()).unwrap();
    assert_eq!(figures(&rest), figures(&whole[3..]));
}

#[test]
fn rows_tell_what_the_detector_makes_of_every_output() {
    let sets = [SceneSet::Generated(Kind::Set1)];
    let run = |cfar: Option<Cfar>| {
        Campaign { count: 1, cfar, ..Campaign::default() }.run(&sets, &[&Baseline], &Task::default(), |_| ())
    };
    let [without, with] = [None, Some(Cfar::default())].map(|cfar| figures(&run(cfar).unwrap()));
    let (detection, false_alarm) = (with[0].cfar_detection, with[0].cfar_false_alarm);
    assert!(detection > Some(0.0) && with[0].cfar == Cfar::default().to_string().as_str());
    let added = |row: &Row| Row {
        cfar: with[0].cfar.clone(),
        cfar_detection: detection,
        cfar_false_alarm: false_alarm,
        ..row.clone()
    };
    assert!(without[0].cfar.is_empty() && without[0].cfar_false_alarm.is_none());
    assert_eq!(added(&without[0]), with[0]);
    let few = run(Some(Cfar { false_alarm: 1e-12, ..Cfar::default() })).unwrap();
    assert!(few[0].cfar_false_alarm < false_alarm, "{few:?}");
    let wide = run(Some(Cfar { guard: [3, 600], ..Cfar::default() })).unwrap_err().to_string();
    assert!(wide.starts_with("the detector on scene 0 of set 1: guard and training cells span"), "{wide}");
}

#[test]
fn scenes_of_noise_alone_have_no_detection_rate() {
    let campaign = Campaign { count: 2, ..Campaign::default() };
    let sets = [SceneSet::Generated(Kind::Noise)];
    let rows = campaign.run(&sets, &[&Baseline, &BARTLETT], &Task::default(), |_| ()).unwrap();
    assert_eq!(rows.len(), 4);
    for row in rows {
        assert_eq!((&*row.set, row.objects, row.detection, row.detection_at_printed), ("noise", 0, None, None));
        assert_eq!((row.false_alarm, row.ghosts), (0.0, 0), "{}", row.method);
        assert!(row.squared_error > 1.0, "the target is noise");
    }
}

/// Refuses every radar.
struct Refuses;

impl Reconstructor for Refuses {
    fn about(&self) -> About {
        About { name: "refuses", ..Baseline.about() }
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
    let [Unfit { method: "refuses", set, scenes: 2, reason }] = &unfit[..] else { panic!("{unfit:?}") };
    assert!(set == "set 1" && reason.contains("made for no radar"), "{reason}");
}

#[test]
fn a_campaign_can_be_cancelled() {
    let task = Task::default();
    task.cancel();
    let sets = [SceneSet::Generated(Kind::Set1)];
    let stopped = Campaign::default().run(&sets, &[&Baseline], &task, |_| ()).unwrap_err();
    assert!(stopped.is_cancelled() && stopped.to_string().contains("scene 0 of set 1"), "{stopped}");
}
