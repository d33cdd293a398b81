//! The numbers that lessons teach, computed again: each must stand in its lesson's text as it comes out here.

use crate::prelude::*;
use crate::taught::{lesson, physical, taught};
use apertura::radar::Polar;
use apertura::theory::{Response, WindowPattern, comb_teeth};

fn maps(radar: &Radar, scene: &Scene) -> LogMaps {
    LogMaps::of_signal(radar, &simulate(radar, scene, Floor::Exact, 0).unwrap())
}

/// The maps of a lesson's step, counted from 1.
fn maps_of_step(id: &str, step: usize) -> LogMaps {
    let lesson = lesson(id);
    maps(&lesson.steps[step - 1].radar, &lesson.steps[step - 1].scene())
}

fn below_peak(map: &LogMap, bin: usize, column: usize) -> f64 {
    20.0 * (map.decades()[[bin, column]] - map.max())
}

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

fn mean_power(map: &LogMap) -> f64 {
    map.decades().iter().map(|d| 10f64.powf(2.0 * d)).sum::<f64>() / map.decades().len() as f64
}

fn db(ratio: f64) -> f64 {
    10.0 * ratio.log10()
}

#[test]
fn the_floor_teaches_the_right_processing_gain() {
    let radar = physical();
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
    assert!((whole - 45.5).abs() < 0.1, "{whole}");
    taught("the-floor", "45.5 dB");
    let end = gain(&shown.first, &hiss.first);
    assert!((end - 33.95).abs() < 0.2, "{end}");
    taught("the-floor", "34 dB");
    // A plane wave without windows, and the windows' cost in noise bandwidth.
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
    let radar = physical();
    let bins = [4f64.hypot(12.0), 4f64.hypot(12.0 + 74.0 * 0.1124221718)].map(|r| radar.bin_of_range(r) as usize);
    let wall = bins[0] - 12..bins[1] + 14;
    let peaks = wall.filter(|k| profile[*k] > profile[k - 1] && profile[*k] >= profile[k + 1]).count();
    taught("a-line", &format!("input 0 has {peaks} peaks"));
    let length = Consequences::of(&radar).range_width_metres.unwrap() / radar.range_resolution_metres();
    taught("a-line", &format!("{length:.2} bins long"));
    let (bin, column) = peak(&maps_of_step("a-line", 2).full);
    let (range, cos) = (radar.range_of_bin_metres(bin as f64), radar.cos_of_column(column as f64));
    taught("a-line", &format!("{range:.1} m, cos θ = {cos:.2}"));
}

#[test]
fn a_line_teaches_how_far_interference_weakens_a_wall() {
    let radar = physical();
    let wall = maps_of_step("a-line", 4).full.max();
    let alone = |i: usize| 10f64.powf(maps(&radar, &Scene::of_points([(0.0, 12.0 + 0.01 * i as f64)])).full.max());
    // The echoes hardly differ over the 75 cm: every fifteenth stands for its neighbours.
    let sum: f64 = (0..75).step_by(15).map(|i| 15.0 * alone(i + 7)).sum();
    taught("a-line", &format!("{:.0} dB below the sum", 20.0 * (sum.log10() - wall)));
    taught("a-line", &format!("{:.0} wavelengths long", radar.range_resolution_metres() / radar.wavelength_metres()));
}

#[test]
fn the_near_field_lesson_teaches_the_plateau_as_it_is() {
    let (radar, map) = (physical(), maps_of_step("near-field", 2).full);
    let half = radar.aperture_metres() / 2.0;
    let difference = 2.0 * half / half.hypot(5.0);
    taught("near-field", &format!("{difference:.2}"));
    let columns = difference * radar.elements as f64 / 2.0;
    taught("near-field", &format!("{columns:.0} columns"));
    assert_eq!((columns_above(&map, -20.0), columns_above(&map, -6.0)), (81, 51));
    for said in ["81 at -20 dB", "51 at -6 dB"] {
        taught("near-field", said);
    }
    taught("near-field", &format!("4 D² / λ with D = {:.2} m", radar.aperture_metres()));
    taught("near-field", &format!("about {:.0} km", radar.far_field_metres() / 1000.0));
}

/// cos(theta) of the whole array's brightest row, weighed by power.
fn cos_of_blob(id: &str, step: usize) -> f64 {
    let (radar, map) = (lesson(id).steps[step - 1].radar.clone(), maps_of_step(id, step).full);
    let (bin, _) = peak(&map);
    let row = map.decades().row(bin).mapv(|d| 10f64.powf(2.0 * (d - map.max())));
    row.iter().enumerate().map(|(k, power)| power * radar.cos_of_column(k as f64)).sum::<f64>() / row.sum()
}

#[test]
fn the_squint_is_as_lessons_say() {
    let said = |id: &str, step: usize, cos: f64, percent: &str| {
        let radar = lesson(id).steps[step - 1].radar.clone();
        assert_eq!(format!("{:.1} %", 100.0 * (radar.squint() - 1.0).abs()), percent);
        taught(id, percent);
        assert!((cos_of_blob(id, step) - cos * radar.squint()).abs() < 0.002, "{id}: {}", cos_of_blob(id, step));
        taught(id, &format!("At {:.2}", cos * radar.squint()));
    };
    said("near-field", 4, -0.832, "1.3 %");
    said("which-radar-is-the-thesis-radar", 4, 0.832, "2.6 %");
    taught("which-radar-is-the-thesis-radar", &format!("shows the point at {:.3}", 0.832 * physical().squint()));
}

#[test]
fn the_lesson_names_the_thesis_radar_as_it_is() {
    let (id, radar) = ("which-radar-is-the-thesis-radar", Radar::default());
    let begins_gigahertz = radar.carrier_hz * radar.carrier.turns_per_wavelength().abs() / 2.0 / 1e9;
    taught(id, &format!("f/2 = {begins_gigahertz} GHz"));
    taught(id, &format!("from {begins_gigahertz} to {} GHz", begins_gigahertz - radar.bandwidth_hz / 1e9));
    taught(id, &format!("{:.3} mm apart", 1e3 * radar.element_spacing_metres));
    taught(id, &format!("wavelength of {:.2} mm", 4e3 * radar.element_spacing_metres));
}

#[test]
fn beams_are_as_wide_as_lessons_say() {
    let radar = physical();
    let found = columns_above(&maps_of_step("angle-and-aperture", 2).first, -3.01);
    let beam = Consequences::of(&radar).end_beam.columns;
    assert!((beam - found as f64).abs() <= 1.0, "{beam}, {found}");
    for id in ["angle-and-aperture", "two-ends-and-the-comb", "a-line"] {
        taught(id, &format!("{found} columns"));
    }
    let bare = (radar.wavelength_metres() / (2.0 * radar.aperture_metres())).to_degrees();
    taught("angle-and-aperture", &format!("λ / 2L wide, {bare:.2}°"));
    let hann = Consequences::of(&radar).full_beam.radians.to_degrees();
    taught("angle-and-aperture", &format!("makes that {hann:.2}°"));
}

#[test]
fn the_comb_has_as_many_teeth_in_a_beam_as_the_lesson_says() {
    let radar = physical();
    let teeth = comb_teeth(&radar, Polar { range_metres: 20.0, cos_theta: 0.0 }, 1);
    let column = (radar.cos_of_column(1.0) - radar.cos_of_column(0.0)).abs();
    let spacing = (teeth[1] - teeth[0]) / 2.0 * radar.squint() / column;
    // Directions of the map: the teeth stand where the map shows them.
    let beam = Consequences::of(&radar).end_beam.columns / spacing;
    assert!((125.0..135.0).contains(&beam), "{beam} teeth every {spacing} columns");
    taught("two-ends-and-the-comb", &format!("every {spacing:.2} columns"));
    taught("two-ends-and-the-comb", "About 130");
}

#[test]
fn the_ends_disagree_about_a_range_as_lessons_say() {
    let radar = physical();
    let bins = |x: f64, y: f64| {
        let [a, b] = End::BOTH.map(|end| (x - radar.end_centre_metres(end)).hypot(y));
        radar.bin_of_range(a - b)
    };
    taught("near-field", &format!("bins of 7.5 cm: {:.0}.", bins(18.0, 8.717798)));
    taught("two-ends-and-the-comb", &format!("bins of 7.5 cm: {:.1}.", bins(10.0, 17.320508)));
    let [first, last] = End::BOTH.map(|end| radar.end_centre_metres(end));
    for id in ["near-field", "two-ends-and-the-comb", "what-one-end-sees"] {
        taught(id, &format!("{:.2} m", last - first));
    }
}

#[test]
fn a_grating_lobe_is_as_far_away_as_the_lesson_says() {
    let lesson = lesson("grating-lobes");
    for (step, said) in [(1, 2.0), (2, 1.0)] {
        let radar = &lesson.steps[step - 1].radar;
        let wavelength = SPEED_OF_LIGHT / (radar.carrier_hz + radar.bandwidth_hz / 2.0);
        assert!((wavelength / (2.0 * radar.element_spacing_metres) - said).abs() < 0.001);
        assert!((radar.fold_period_cos() - said).abs() < 0.001);
        taught("grating-lobes", &format!("λ / 2d = {said}"));
    }
    let radar = &lesson.steps[2].radar;
    let (_, column) = peak(&maps_of_step("grating-lobes", 3).full);
    assert!((radar.cos_of_column(column as f64) + 0.4).abs() < 0.02, "{column}");
    taught("grating-lobes", "0.6 − 1 = −0.4");
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
fn a_near_grating_lobe_leans_against_a_reflectors_lean() {
    let lesson = lesson("grating-lobes");
    let radar = &lesson.steps[3].radar;
    let lobe = lean(&maps(radar, &lesson.steps[3].scene()).full);
    let cos = 0.6 - radar.fold_period_cos();
    let reflector = lean(&maps(radar, &Scene::of_points([(20.0 * cos, 20.0 * (1.0 - cos * cos).sqrt())])).full);
    assert!(lobe * reflector < 0.0 && lobe.abs() > 0.1 && reflector.abs() > 0.1, "{lobe}, {reflector}");
    taught("grating-lobes", "would lean the other way");
}

#[test]
fn twelve_arrows_close_as_far_out_as_the_lesson_says() {
    let step = &lesson("phasors").steps[3];
    let radar = &step.radar;
    // Columns from the peak of a point's row to its first null.
    let null = |aperture| {
        let [x_metres, y_metres] = step.scene().objects[0].centre_metres();
        let response = Response::new(radar, &Reflector { x_metres, y_metres, reflectivity: 1.0 }, aperture);
        let row = response.row(radar.bin_of_range(y_metres).round());
        let level: Vec<f64> =
            (0..4000).map(|i| row.magnitude(radar.elements as f64 / 2.0 + f64::from(i) / 100.0)).collect();
        let top = (0..100).max_by(|a, b| level[*a].total_cmp(&level[*b])).unwrap();
        let first = (top + 1..level.len() - 1).find(|i| level[*i] < level[i - 1] && level[*i] <= level[i + 1]);
        (first.unwrap() - top) as f64 / 100.0
    };
    let (end, whole) = (null(Aperture::End(End::Last)), null(Aperture::Full));
    assert!((end / whole - 95.0 / 11.0).abs() < 0.2, "{end} {whole}");
    taught("phasors", &format!("95 / 11 is {:.1}", 95.0 / 11.0));
}

#[test]
fn windows_fall_as_the_lesson_says() {
    let level = |window: WindowFunction, bins: f64| {
        let pattern = WindowPattern::new(window, 512);
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
fn side_lobes_of_the_wall_are_as_high_as_the_lesson_says() {
    let lesson = lesson("occlusion");
    let (step, scene) = (&lesson.steps[2], lesson.steps[2].scene());
    let [x, y] = scene.objects[1].centre_metres();
    let [wall, point] = [0, 1].map(|i| Scene { objects: vec![scene.objects[i].clone()], ..Scene::default() });
    // Decibels of the point's blob over the wall's highest cell around it, in input 0 and in the map of all elements.
    let over_the_wall = |window| {
        let radar = Radar { window, ..step.radar.clone() };
        let ([wall, point], centre) = ([&wall, &point].map(|s| maps(&radar, s)), radar.end_centre_metres(End::First));
        [(&wall.first, &point.first, centre), (&wall.full, &point.full, 0.0)].map(|(wall, point, centre)| {
            let blob = radar.blob_of(centre, x, y);
            let (bin, column) =
                (radar.bin_of_range(blob.range_metres).round() as usize, radar.column_of_cos(blob.cos_theta) as usize);
            let level = |map: &LogMap| 20.0 * map.max() + highest(map, bin - 12..bin + 13, column - 20..column + 20);
            level(point) - level(wall)
        })
    };
    let [end, _] = over_the_wall(WindowFunction::Hann);
    taught("occlusion", &format!("lie {end:.0} dB below it in input 0"));
    let [end, whole] = over_the_wall(WindowFunction::Rectangular);
    taught("occlusion", &format!("Without a window the highest is {:.0} dB above it", -end));
    taught("occlusion", &format!("the highest within 20 columns is {:.0} dB above it", -whole));
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
fn the_link_budget_is_as_its_lesson_says() {
    let [at_15, car, _] = [1, 2, 3].map(|step| lesson("the-link-budget").steps[step - 1].clone());
    let snr = |dbsm, range| at_15.radar.link(dbsm, range, 1.0);
    assert!((snr(0.0, 15.0).array.0 - snr(0.0, 30.0).array.0 - 12.04).abs() < 0.01, "12 dB");
    taught("the-link-budget", "12 dB");
    for (number, decibels) in [
        ("41.4 dB", snr(0.0, 20.0).array.0),
        ("-12.2 dB", snr(0.0, 20.0).sample.0),
        ("44.9 dB", snr(0.0, 20.0).sample.0 + db((512 * 1024) as f64)),
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
