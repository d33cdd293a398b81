//! The thesis' baseline column, reproduced on fewer scenes than `apertura evaluate --method baseline --count 100`.
//!
//! Bounds are relative to the printed values, not to our own standard errors, which grow where a result is wrong.

use crate::prelude::*;
use apertura::evaluate::tables::PRINTED_BASELINE;

/// SE as a part of the printed one, P_D and P_FA in percentage points: ours less the printed.
fn differences(tally: &Tally, set: usize) -> [f64; 3] {
    let printed = PRINTED_BASELINE[set - 1];
    [
        tally.squared_error().mean / printed.squared_error - 1.0,
        100.0 * (tally.detection().mean - printed.detection),
        100.0 * (tally.false_alarm().mean - printed.false_alarm),
    ]
}

fn reproduces(found: [f64; 3], allowed: [f64; 3]) -> [bool; 3] {
    [0, 1, 2].map(|i| found[i].abs() <= allowed[i])
}

fn run(campaign: &Campaign, set: usize) -> Tally {
    let sets = [SceneSet::Generated(Kind::TEST_SETS[set - 1])];
    Tally::of(&campaign.run(&sets, &[&Baseline], &Task::default(), |_| ()).expect("test scenes are valid"))
}

/// On 40 scenes: SE scatters by 3 % and P_D of set 1 by 3 points from one draw of scenes to another.
const ON_FORTY: [f64; 3] = [0.08, 6.0, 0.06];

fn forty() -> Campaign {
    Campaign { count: 40, seed: 1, ..Campaign::default() }
}

#[test]
fn sets_of_points_reproduce_the_printed_baseline() {
    for set in [1, 2] {
        let found = differences(&run(&forty(), set), set);
        assert_eq!(reproduces(found, ON_FORTY), [true; 3], "set {set}: SE, P_D, P_FA off by {found:.3?}");
    }
}

/// Without the thesis' rounding floor the squared error is far from the printed one. With another window it is 9 % and P_FA 49 % below.
#[test]
fn other_floors_and_windows_do_not_reproduce_the_table() {
    let found = differences(&run(&Campaign { floor: Floor::Exact, ..forty() }, 1), 1);
    assert!(!reproduces(found, ON_FORTY)[0] && found[0] < -0.3, "SE, P_D, P_FA off by {found:.3?}");
    let radar = Radar { window: WindowFunction::Rectangular, ..Radar::default() };
    let found = differences(&run(&Campaign { radar, ..forty() }, 2), 2);
    let [squared_error, _, false_alarm] = reproduces(found, ON_FORTY);
    assert!(!squared_error && !false_alarm, "SE, P_D, P_FA off by {found:.3?}");
}

/// On the 100 scenes a set of README's table, whose greatest difference is that of set 3's SE. `cargo test --release -- --ignored baseline`
#[test]
#[ignore = "minutes: 300 scenes"]
fn all_nine_baseline_cells() {
    for (set, allowed) in [(1, [0.03, 4.0, 0.05]), (2, [0.05, 1.5, 0.05]), (3, [0.09, 4.0, 0.6])] {
        let found = differences(&run(&Campaign::default(), set), set);
        println!("set {set}: SE {:+.1} %, P_D {:+.2} points, P_FA {:+.3} points", 100.0 * found[0], found[1], found[2]);
        assert_eq!(reproduces(found, allowed), [true; 3], "set {set}: SE, P_D, P_FA off by {found:.3?}");
    }
}
