//! The thesis' baseline column, reproduced on fewer scenes than `apertura evaluate --method baseline --count 100`.
//!
//! A cell passes when the printed value, rounding included, lies within 3.5 standard errors of the mean over our scenes. The printed
//! values come from finitely many scenes themselves, so this is strict, and the control shows that it can fail.

use apertura::evaluate::campaign::Campaign;
use apertura::evaluate::sets::SceneSet;
use apertura::evaluate::tables::{PRINTED_BASELINE, Tally};
use apertura::reconstruct::Baseline;
use apertura::scene::generate::Kind;
use apertura::signal::Floor;
use apertura::task::Task;

/// Standard errors between ours and the printed SE, P_D and P_FA.
fn deviations(tally: &Tally, set: usize) -> [f64; 3] {
    let printed = PRINTED_BASELINE[set - 1];
    let rounding = printed.rate_rounding();
    [
        tally.squared_error().deviation_from(printed.squared_error, 0.005),
        tally.detection().deviation_from(printed.detection, rounding),
        tally.false_alarm().deviation_from(printed.false_alarm, rounding),
    ]
}

fn tally(campaign: &Campaign, set: usize) -> Tally {
    let sets = [SceneSet::Generated(Kind::TEST_SETS[set - 1])];
    Tally::of(&campaign.run(&sets, &[&Baseline], &Task::default(), |_| ()).expect("test scenes are valid"))
}

fn run(floor: Floor, set: usize, count: u32) -> Tally {
    let campaign = Campaign { floor, count, seed: 1, ..Campaign::default() };
    tally(&campaign, set)
}

#[test]
fn sets_1_and_2_reproduce_the_printed_baseline() {
    for set in [1, 2] {
        let found = deviations(&run(Floor::Thesis, set, 30), set);
        assert!(found.iter().all(|d| d.abs() < 3.5), "set {set}: SE, P_D, P_FA off by {found:.2?} standard errors");
    }
}

/// Without the thesis' rounding floor the squared error is far from the printed one.
#[test]
fn the_exact_floor_does_not_reproduce_them() {
    let [squared_error, ..] = deviations(&run(Floor::Exact, 1, 30), 1);
    assert!(squared_error < -10.0, "off by {squared_error:.2} standard errors");
}

/// All nine cells within 2.5 standard errors on 100 scenes a set; minutes long. `cargo test --release -- --ignored baseline`
#[test]
#[ignore = "simulates 300 scenes with the plain formula"]
fn all_nine_baseline_cells() {
    for set in [1, 2, 3] {
        let found = deviations(&tally(&Campaign::default(), set), set);
        assert!(found.iter().all(|d| d.abs() < 2.5), "set {set}: SE, P_D, P_FA off by {found:.2?} standard errors");
    }
}
