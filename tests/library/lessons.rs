//! The numbers that lessons teach, computed again: each must stand in its lesson's text as it comes out here.

use apertura::lesson::question::Answer;
use apertura::lesson::{Lesson, shipped};
use apertura::maps::cfar::Cfar;
use apertura::maps::{LogMap, LogMaps, Mask, RangeAngleMap};
use apertura::radar::{Decibels, End, Polar, Radar, WindowFunction};
use apertura::scene::{Object, Point, Scene};
use apertura::signal::{BeatSignal, Floor, simulate};
use apertura::theory::{Consequences, Pattern, comb_teeth, fold_period_cos};

/// A lesson's file.
fn text(id: &str) -> &'static str {
    shipped::ALL.iter().find(|s| s.id == id).unwrap_or_else(|| panic!("no lesson {id}")).toml
}

fn lesson(id: &str) -> Lesson {
    Lesson::from_toml(text(id)).unwrap()
}

/// Holds a lesson to a number as its text has it.
fn taught(id: &str, number: &str) {
    assert!(text(id).contains(number), "{id} does not say \"{number}\"");
}

fn maps(radar: &Radar, scene: &Scene) -> LogMaps {
    LogMaps::of_signal(radar, &simulate(radar, scene, Floor::Exact, 0).unwrap())
}

/// The maps of a lesson's step, counted from 1.
fn maps_of_step(id: &str, step: usize) -> LogMaps {
    let lesson = lesson(id);
    maps(&lesson.steps[step - 1].radar, &lesson.steps[step - 1].scene())
}

/// Decibels of a cell below the map's peak.
fn below_peak(map: &LogMap, bin: usize, column: usize) -> f64 {
    20.0 * (map.decades()[[bin, column]] - map.max())
}

/// The largest of some cells, in decibels below the map's peak.
fn highest(map: &LogMap, bins: std::ops::Range<usize>, columns: std::ops::Range<usize>) -> f64 {
    let cells = bins.flat_map(|bin| columns.clone().map(move |column| (bin, column)));
    cells.map(|(bin, column)| below_peak(map, bin, column)).fold(f64::NEG_INFINITY, f64::max)
}

/// Columns of the peak's row that reach a level, from the first to the last.
fn columns_above(map: &LogMap, level_db: f64) -> usize {
    let (bin, _) = peak(map);
    let width = map.decades().ncols();
    let above: Vec<usize> = (0..width).filter(|column| below_peak(map, bin, *column) > level_db).collect();
    above.last().zip(above.first()).map_or(0, |(last, first)| last - first + 1)
}

fn peak(map: &LogMap) -> (usize, usize) {
    map.decades().indexed_iter().max_by(|a, b| a.1.total_cmp(b.1)).unwrap().0
}

/// Mean power of a map's cells.
fn mean_power(map: &LogMap) -> f64 {
    map.decades().iter().map(|d| 10f64.powf(2.0 * d)).sum::<f64>() / map.decades().len() as f64
}

/// Decibels of a ratio of powers.
fn db(ratio: f64) -> f64 {
    10.0 * ratio.log10()
}

#[test]
fn the_floor_teaches_the_right_processing_gain() {
    let radar = Radar::default();
    let scene = Scene::of_points([(0.0, 20.0)]);
    let signal = simulate(&radar, &scene, Floor::Exact, 0).unwrap();
    let noisy = simulate(&radar, &scene, Floor::Snr(Decibels(20.0)), 0).unwrap();
    let noise = BeatSignal { samples: &noisy.samples - &signal.samples };
    let power = |s: &BeatSignal| s.samples.iter().map(|v| v.norm_sqr()).sum::<f64>() / s.samples.len() as f64;
    let before = db(power(&signal) / power(&noise));
    assert!((before - 20.0).abs() < 0.1, "{before}");
    let (shown, hiss) = (LogMaps::of_signal(&radar, &signal), LogMaps::of_signal(&radar, &noise));
    let gain = |signal: &LogMap, noise: &LogMap| db(10f64.powf(2.0 * signal.max()) / mean_power(noise)) - before;
    let whole = gain(&shown.full, &hiss.full);
    assert!((whole - 42.6).abs() < 0.1, "{whole}");
    taught("the-floor", "42.6 dB");
    let end = gain(&shown.first, &hiss.first);
    assert!((end - 33.8).abs() < 0.2, "{end}");
    taught("the-floor", "34 dB");
    // A plane wave without windows, and what the windows cost in noise bandwidth.
    let samples = (radar.elements * radar.samples) as f64;
    taught("the-floor", &format!("gain {:.0} dB", db(samples)));
    let cost = |n: usize| {
        let weights = radar.window.weights(n);
        let sum: f64 = weights.iter().sum();
        db(n as f64 * weights.iter().map(|w| w * w).sum::<f64>() / (sum * sum))
    };
    let windows = cost(radar.elements) + cost(radar.samples);
    taught("the-floor", &format!("{windows:.1} for the windows"));
    let near_field = db(samples) - windows - whole;
    taught("the-floor", &format!("about {near_field:.0} because the near field"));
}

#[test]
fn a_line_teaches_how_many_peaks_input_0_has() {
    let maps = maps_of_step("a-line", 3);
    let profile: Vec<f64> =
        maps.first.decades().rows().into_iter().map(|r| r.fold(f64::NEG_INFINITY, |m, v| m.max(*v))).collect();
    let radar = Radar::default();
    let bins = [4f64.hypot(12.0), 4f64.hypot(12.0 + 74.0 * 0.1124221718)].map(|r| radar.bin_of_range(r) as usize);
    let wall = bins[0] - 12..bins[1] + 14;
    let peaks = wall.filter(|k| profile[*k] > profile[k - 1] && profile[*k] >= profile[k + 1]).count();
    taught("a-line", &format!("input 0 has {peaks} peaks"));
    let length = Consequences::of(&radar).range_width_metres.unwrap() / radar.range_resolution_metres();
    taught("a-line", &format!("{length:.2} bins long"));
}

#[test]
fn a_line_teaches_how_far_interference_weakens_a_wall() {
    let radar = Radar::default();
    let wall = maps_of_step("a-line", 4).full.max();
    let alone = |i: usize| 10f64.powf(maps(&radar, &Scene::of_points([(0.0, 12.0 + 0.01 * i as f64)])).full.max());
    // The echoes hardly differ over the 75 cm: every fifteenth stands for its neighbours.
    let sum: f64 = (0..75).step_by(15).map(|i| 15.0 * alone(i + 7)).sum();
    taught("a-line", &format!("{:.0} dB below the sum", 20.0 * (sum.log10() - wall)));
    taught("a-line", &format!("{:.0} wavelengths long", radar.range_resolution_metres() / radar.wavelength_metres()));
}

#[test]
fn the_near_field_lesson_teaches_the_plateau_as_it_is() {
    let (radar, map) = (Radar::default(), maps_of_step("near-field", 2).full);
    let half = radar.aperture_metres() / 2.0;
    let difference = 2.0 * half / half.hypot(5.0);
    taught("near-field", &format!("{difference:.2}"));
    let columns = difference * radar.elements as f64 / 2.0;
    taught("near-field", &format!("{columns:.0} columns"));
    assert_eq!((columns_above(&map, -20.0), columns_above(&map, -6.0)), (153, 101));
    for said in ["153 at -20 dB", "101 at -6 dB"] {
        taught("near-field", said);
    }
    taught("near-field", &format!("{:.0} km", radar.far_field_metres() / 1000.0));
}

#[test]
fn the_near_field_lesson_teaches_the_squint_of_the_thesis_convention() {
    let radar = Radar::default();
    taught("near-field", &format!("{:.1} % too small", 100.0 * (1.0 - radar.squint())));
    taught("near-field", &format!("At {:.2}", -0.832 * radar.squint()));
    let (_, column) = peak(&maps_of_step("near-field", 4).full);
    // A streak of some tens of columns: its middle is meant.
    assert!((radar.cos_of_column(column as f64) + 0.81).abs() < 0.03, "{column}");
}

#[test]
fn an_ends_beam_is_as_wide_as_lessons_say() {
    let radar = Radar::default();
    let found = columns_above(&maps_of_step("angle-and-aperture", 2).first, -3.01);
    let beam = Consequences::of(&radar).end_beam.columns;
    assert!((beam - found as f64).abs() <= 1.0, "{beam}, {found}");
    for id in ["angle-and-aperture", "two-ends-and-the-comb", "a-line"] {
        taught(id, &format!("{found} columns"));
    }
}

#[test]
fn the_comb_has_as_many_teeth_in_a_beam_as_the_lesson_says() {
    let radar = Radar::default();
    let teeth = comb_teeth(&radar, Polar { range_metres: 20.0, cos_theta: 0.0 }, 1);
    let column = 2.0 / radar.elements as f64;
    let spacing = (teeth[1] - teeth[0]) / 2.0 * radar.squint() / column;
    // Directions of the map: the teeth stand where the map shows them.
    let beam = Consequences::of(&radar).end_beam.columns / spacing;
    assert!((125.0..135.0).contains(&beam), "{beam} teeth every {spacing} columns");
    taught("two-ends-and-the-comb", &format!("every {spacing:.2} columns"));
    taught("two-ends-and-the-comb", "About 130");
}

#[test]
fn the_ends_disagree_about_a_range_as_lessons_say() {
    let radar = Radar::default();
    let bins = |x: f64, y: f64| {
        let [a, b] = End::BOTH.map(|end| (x - radar.end_centre_metres(end)).hypot(y));
        radar.bin_of_range(a - b)
    };
    taught("near-field", &format!("{:.0} bins", bins(18.0, 8.717798)));
    taught("two-ends-and-the-comb", &format!("{:.0} bins", bins(10.0, 17.320508)));
    // With a common transmitter only the way back differs, and a range is half of the whole way.
    let common = |x: f64, y: f64| bins(x, y) / 2.0;
    assert!((common(18.0, 8.717798) - 12.0).abs() < 0.5);
}

#[test]
fn a_grating_lobe_is_as_far_away_as_the_lesson_says() {
    let lesson = lesson("grating-lobes");
    for (step, said) in [(1, "2.05"), (2, "1.03")] {
        assert_eq!(format!("{:.2}", fold_period_cos(&lesson.steps[step - 1].radar)), said);
        taught("grating-lobes", said);
    }
    let radar = &lesson.steps[2].radar;
    let shown = 0.6 * radar.squint();
    taught("grating-lobes", &format!("0.6 at {shown:.2}, and {shown:.2} - 1 = {:.2}", shown - 1.0));
    let (_, column) = peak(&maps_of_step("grating-lobes", 3).full);
    assert!((radar.cos_of_column(column as f64) + 0.42).abs() < 0.02, "{column}");
}

/// Bins per column along the bright cells of a map.
fn lean(map: &LogMap) -> f64 {
    let strong = map.decades().indexed_iter().filter(|(_, d)| **d > map.max() - 1.0);
    let cells: Vec<[f64; 3]> = strong.map(|((b, c), d)| [b as f64, c as f64, 10f64.powf(2.0 * d)]).collect();
    let total: f64 = cells.iter().map(|c| c[2]).sum();
    let mean = |i: usize| cells.iter().map(|c| c[i] * c[2]).sum::<f64>() / total;
    let (bin, column) = (mean(0), mean(1));
    let sum = |f: &dyn Fn(&[f64; 3]) -> f64| cells.iter().map(|c| f(c) * c[2]).sum::<f64>();
    sum(&|c| (c[0] - bin) * (c[1] - column)) / sum(&|c| (c[1] - column).powi(2))
}

#[test]
fn a_near_grating_lobe_leans_the_other_way_than_a_reflector_there() {
    let lesson = lesson("grating-lobes");
    let radar = &lesson.steps[3].radar;
    let lobe = lean(&maps(radar, &lesson.steps[3].scene()).full);
    let cos = (0.6 * radar.squint() - 1.0) / radar.squint();
    let reflector = lean(&maps(radar, &Scene::of_points([(20.0 * cos, 20.0 * (1.0 - cos * cos).sqrt())])).full);
    assert!(lobe > 0.1 && reflector < -0.1, "{lobe}, {reflector}");
    taught("grating-lobes", "would lean the other way");
}

#[test]
fn windows_fall_as_the_lesson_says() {
    let level = |window: WindowFunction, bins: f64| {
        let pattern = Pattern::new(window, 512);
        let near = (-32..=32).map(|i| (pattern.at(bins + f64::from(i) / 64.0) / pattern.at(0.0)).abs());
        20.0 * near.fold(0.0, f64::max).log10()
    };
    for (window, first, slope, far) in
        [(WindowFunction::Hann, -31.0, 18.0, -118.0), (WindowFunction::Hamming, -43.0, 6.0, -62.0)]
    {
        let lobes = (2..40).map(|k| level(window, f64::from(k) + 0.5)).fold(f64::NEG_INFINITY, f64::max);
        assert!((lobes - first).abs() < 1.0, "{window:?}: {lobes}");
        let fall = level(window, 32.5) - level(window, 64.5);
        assert!((fall - slope).abs() < 0.5, "{window:?}: {fall}");
        assert!((level(window, 64.5) - far).abs() < 1.0, "{window:?}: {}", level(window, 64.5));
        for said in [first, far].map(|db: f64| format!("{db} dB")) {
            taught("windows-and-side-lobes", &said);
        }
    }
}

#[test]
fn side_lobes_hide_the_weak_point_without_a_window() {
    let lesson = lesson("occlusion");
    let (step, scene) = (&lesson.steps[2], lesson.steps[2].scene());
    let [x, y] = scene.objects[1].centre_metres();
    let over_side_lobes = |window| {
        let radar = Radar { window, ..step.radar.clone() };
        let shown = maps(&radar, &scene);
        [(&shown.first, radar.end_centre_metres(End::First)), (&shown.full, 0.0)].map(|(map, centre)| {
            let blob = radar.blob_of(centre, x, y);
            let (bin, column) =
                (radar.bin_of_range(blob.range_metres).round() as usize, radar.column_of_cos(blob.cos_theta) as usize);
            let columns = column - 20..column + 20;
            let around =
                highest(map, bin - 12..bin - 5, columns.clone()).max(highest(map, bin + 6..bin + 13, columns.clone()));
            highest(map, bin - 1..bin + 2, columns) - around
        })
    };
    let without = over_side_lobes(WindowFunction::Rectangular);
    assert!(without.iter().all(|db| *db < 1.0), "{without:?}");
    let [end, whole] = over_side_lobes(WindowFunction::Hann);
    assert!(whole > 50.0, "{whole}");
    taught("occlusion", &format!("{end:.0} dB below it in input 0"));
    let ratio = (x.hypot(y) / 3f64.hypot(10.0)).powi(2);
    taught("occlusion", &format!("about {ratio:.1}."));
}

/// The scene's note and the guide say by how much the side lobes stay below the point of figure 5-7.
#[test]
fn a_point_behind_a_line_stays_visible_under_the_hann_window() {
    let scene = lesson("occlusion").steps[0].scene();
    let Object::Point(Point { x_metres: x, y_metres: y, .. }) = scene.objects[1] else { panic!("a point") };
    for (window, least, most) in [(WindowFunction::Hann, 70.0, 120.0), (WindowFunction::Rectangular, 15.0, 28.0)] {
        let radar = Radar { window, ..Radar::default() };
        let map = maps(&radar, &scene).first;
        let blob = radar.blob_of(radar.end_centre_metres(End::First), x, y);
        let (bin, column) =
            (radar.bin_of_range(blob.range_metres).round() as usize, radar.column_of_cos(blob.cos_theta) as usize);
        let columns = column - 60..column + 60;
        let clear = highest(&map, bin - 1..bin + 2, columns.clone()) - highest(&map, bin + 16..bin + 24, columns);
        assert!((least..most).contains(&clear), "{window:?}: {clear}");
    }
}

#[test]
fn thresholds_are_asked_for_as_they_are_graded() {
    for file in shipped::ALL {
        for step in file.load().unwrap().steps {
            let Some(question) = step.predict else { continue };
            if let Answer::Threshold { false_alarm_at_most, .. } = question.answer {
                let said = format!("at most {} %", 100.0 * false_alarm_at_most);
                assert!(question.ask.contains(&said), "{}: \"{}\" does not say \"{said}\"", file.id, question.ask);
            }
        }
    }
}

#[test]
fn every_text_that_teaches_the_squint_says_whose_convention_it_is() {
    let texts = [
        ("near-field", text("near-field")),
        ("grating-lobes", text("grating-lobes")),
        ("guide", include_str!("../../assets/guide.md")),
        ("README", include_str!("../../README.md")),
        ("figures", include_str!("../../docs/figures.md")),
    ];
    for (name, text) in texts {
        assert!(text.contains("thesis' convention"), "{name}");
        assert!(!text.contains("whole scene twice") && !text.contains("whole scene appears twice"), "{name}");
    }
}

/// Cells that a detector finds in the target of a step, counted from 1, and the target's Lambda.
fn detected(step: usize, cfar: Option<&str>) -> (Mask, RangeAngleMap) {
    let step = &lesson("a-threshold-that-follows-the-noise").steps[step - 1];
    let cfar = cfar.map_or_else(|| step.view.cfar.unwrap(), |text| text.parse().unwrap());
    let signal = simulate(&step.radar, &step.scene(), step.view.floor, step.view.seed).unwrap();
    let full = LogMaps::of_signal(&step.radar, &signal).full;
    let lambda = full.normalise(step.view.normalisation);
    (cfar.detect_lambda(&lambda, full.scale(step.view.normalisation)).unwrap(), lambda)
}

/// Where a step's map has a point.
fn cell_of(step: usize, point: usize) -> (usize, usize) {
    let step = &lesson("a-threshold-that-follows-the-noise").steps[step - 1];
    let [x, y] = step.scene().objects[point].centre_metres();
    let blob = step.radar.blob_of(0.0, x, y);
    let bin = step.radar.bin_of_range(blob.range_metres).round() as usize;
    (bin, step.radar.column_of_cos(blob.cos_theta).round() as usize)
}

/// Whether one of the cells next to a point's is detected.
fn finds(mask: &Mask, (bin, column): (usize, usize)) -> bool {
    mask.cells.slice(ndarray::s![bin - 1..bin + 2, column - 1..column + 2]).iter().any(|cell| *cell)
}

#[test]
fn the_link_budget_is_as_its_lesson_says() {
    let [at_15, car, _] = [1, 2, 3].map(|step| lesson("the-link-budget").steps[step - 1].clone());
    let snr = |dbsm, range| at_15.radar.link(dbsm, range, 1.0);
    assert!((snr(0.0, 15.0).array.0 - snr(0.0, 30.0).array.0 - 12.04).abs() < 0.01, "12 dB");
    taught("the-link-budget", "12 dB");
    for (number, decibels) in [
        ("41.4 dB", snr(0.0, 20.0).array.0),
        ("-12.2 dB", snr(0.0, 20.0).sample.0),
        ("51.4 dB", snr(10.0, 20.0).array.0),
    ] {
        assert_eq!(format!("{decibels:.1} dB"), number);
        taught("the-link-budget", number);
    }
    // The echo over the noise of the samples, as they are simulated.
    let power = |scene: &Scene, floor| {
        simulate(&car.radar, scene, floor, 0).unwrap().samples.mapv(|v| v.norm_sqr()).mean().unwrap()
    };
    let simulated = power(&car.scene(), Floor::Exact) / power(&Scene::default(), Floor::Thermal);
    assert!((10.0 * simulated.log10() - snr(10.0, 20.0).sample.0).abs() < 0.05, "{simulated}");
}

#[test]
fn the_detector_keeps_its_rate_as_its_lesson_says() {
    let [quiet, loud] = [1, 2].map(|step| detected(step, None).0.count());
    assert!((350..700).contains(&quiet) && (350..700).contains(&loud), "{quiet} {loud}");
    taught("a-threshold-that-follows-the-noise", "some 500 false alarms");
    assert_eq!("ca:guard=3x3:training=6x12".parse::<Cfar>().unwrap().training_cells(100, 512), 540);
}

#[test]
fn the_detector_finds_a_far_point_as_its_lesson_says() {
    let (mask, lambda) = detected(3, None);
    let [near, far] = [0, 1].map(|point| cell_of(3, point));
    let above = lambda.above(0.9);
    assert!(finds(&above, near) && !finds(&above, far), "the threshold finds the near point alone");
    assert!(finds(&mask, near) && finds(&mask, far), "the detector finds both");
}

#[test]
fn ordered_statistics_find_a_weak_point_as_their_lesson_says() {
    let weak = cell_of(4, 1);
    let [mean, rank] = ["ca", "os"].map(|cfar| finds(&detected(4, Some(cfar)).0, weak));
    assert!(!mean && rank, "{mean} {rank}");
}

#[test]
fn a_window_along_range_finds_a_streak_as_its_lesson_says() {
    let middle = cell_of(5, 0);
    let [along_the_streak, across] = ["ca:guard=0x3:training=0x12", "ca:guard=8x0:training=20x0"]
        .map(|cfar| detected(5, Some(cfar)).0.cells[middle]);
    assert!(!along_the_streak && across, "{along_the_streak} {across}");
}
