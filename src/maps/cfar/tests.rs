use super::*;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

fn noise(bins: usize, columns: usize, seed: u64) -> Array2<f64> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    Array2::from_shape_simple_fn((bins, columns), || -(1.0 - random.random::<f64>()).ln())
}

fn small(statistic: Statistic) -> Cfar {
    Cfar { statistic, guard: [1, 1], training: [2, 3], false_alarm: 0.02 }
}

#[test]
fn the_rate_of_false_alarms_on_noise_is_the_wanted_one() {
    for statistic in Statistic::ALL {
        let cfar = small(statistic);
        let mask = cfar.detect(noise(700, 900, 5).view()).unwrap();
        // Cells whose windows of 7 by 9 don't overlap are independent.
        let alone = || mask.cells.indexed_iter().filter(|((row, column), _)| row % 7 == 3 && column % 9 == 4);
        let (count, alarms) = (alone().count() as f64, alone().filter(|(_, c)| **c).count() as f64);
        let error = (cfar.false_alarm * (1.0 - cfar.false_alarm) / count).sqrt();
        let off = (alarms / count - cfar.false_alarm) / error;
        assert!(count == 10_000.0 && off.abs() < 3.5, "{statistic:?}: {alarms} of {count}, {off:.2} standard errors");
        // Over all cells, the edges with their smaller windows included; neighbours share training cells.
        let all = mask.count() as f64 / mask.cells.len() as f64;
        assert!((all / cfar.false_alarm - 1.0).abs() < 0.04, "{statistic:?}: {all}");
        let edges = mask.cells.slice(ndarray::s![..2, ..]).iter().filter(|c| **c).count() as f64 / 1800.0;
        assert!((edges / cfar.false_alarm - 1.0).abs() < 0.5, "{statistic:?}: {edges} at the edge");
    }
}

#[test]
fn detections_do_not_change_with_the_unit_of_power() {
    let map = noise(40, 48, 1);
    for statistic in Statistic::ALL {
        let detect = |scale: f64| small(statistic).detect(map.mapv(|v| v * scale).view()).unwrap();
        let mask = detect(1.0);
        assert!(mask.count() > 0);
        for exponent in [-600, 600] {
            assert_eq!(detect(2f64.powi(exponent)), mask, "{statistic:?}");
        }
    }
}

#[test]
fn every_cell_of_a_map_is_what_its_own_window_says() {
    // 300 dB between one echo and the noise: differences of large sums would lose the noise.
    let mut map = noise(24, 40, 2).mapv(|v| 1e-30 * v);
    map[[12, 20]] = 1.0;
    map[[3, 39]] = 1e-27;
    for statistic in Statistic::ALL {
        for (guard, training) in [([1, 1], [2, 3]), ([0, 0], [0, 2]), ([2, 0], [3, 0]), ([0, 3], [1, 0])] {
            let cfar = Cfar { statistic, guard, training, false_alarm: 0.05 };
            let mask = cfar.detect(map.view()).unwrap();
            for ((bin, column), detected) in mask.cells.indexed_iter() {
                let level = cfar.level(|cell| map[cell], [24, 40], [bin, column]).unwrap();
                assert_eq!(level.is_detected(), *detected, "{cfar} {bin} {column}: {level:?}");
                assert_eq!(level.training, cfar.training_cells(bin, 24));
            }
            assert!(mask.cells[[12, 20]] && mask.cells[[3, 39]], "{cfar}");
        }
    }
}

#[test]
fn windows_have_the_cells_that_counting_finds() {
    let cfar = small(Statistic::CellAveraging);
    // 7 x 9 cells without 3 x 3; at the edge 4 x 9 without 2 x 3.
    assert_eq!([cfar.training_cells(10, 40), cfar.training_cells(0, 40)], [54, 30]);
    let around: Vec<_> = window::Window::new(cfar.guard, cfar.training).around([0, 0], [40, 48]).collect();
    assert!(around.len() == 30 && around.contains(&[0, 46]) && around.contains(&[3, 4]), "columns wrap around");
    assert!(!around.contains(&[1, 47]) && !around.contains(&[39, 0]), "guard cells and the far end are left out");
}

#[test]
fn power_is_lambda_on_a_linear_scale() {
    let map = RangeAngleMap { lambda: ndarray::array![[1.0f32, 0.5, 0.0]] };
    let power = relative_power(&map, LambdaScale { floor: -3.0, peak: 1.0 });
    for (found, expected) in power.iter().zip([1.0, 1e-4, 1e-8]) {
        assert!((found / expected - 1.0).abs() < 1e-9, "{found} {expected}");
    }
}

#[test]
fn what_can_not_work_is_said_in_a_sentence() {
    let told = |cfar: Cfar, map: [usize; 2]| cfar.check_map(map).unwrap_err().to_string();
    let usual = Cfar { guard: [3, 3], training: [6, 12], ..Cfar::default() };
    for rate in [0.0, 1.0, -0.1, f64::NAN, f64::INFINITY] {
        let said = told(Cfar { false_alarm: rate, ..usual }, [512, 1024]);
        assert!(said.starts_with("the wanted false-alarm rate is"), "{said}");
    }
    let said = told(Cfar { training: [0, 0], ..usual }, [512, 1024]);
    assert!(said.starts_with("there are no training cells"), "{said}");
    let said = told(Cfar { guard: [600, 3], training: [4, 0], ..usual }, [512, 1024]);
    let expected = "the guard of 600 range bins a side leaves no training cell around range bin 0 of 512";
    assert!(said.starts_with(expected), "{said}");
    let said = told(usual, [512, 24]);
    assert!(said.starts_with("guard and training cells span 31 columns and the map has 24"), "{said}");
    assert!(told(Cfar { guard: [3, usize::MAX], ..usual }, [512, 24]).contains("at most 1000"));
}

#[test]
fn a_detector_is_read_as_it_was_shown() {
    let other = Cfar { statistic: Statistic::OrderedStatistics, guard: [0, 7], training: [9, 1], false_alarm: 1e-7 };
    for cfar in [Cfar::default(), other] {
        assert_eq!(cfar.to_string().parse(), Ok(cfar));
        let written = serde_json::to_string(&cfar).unwrap();
        assert_eq!(serde_json::from_str::<Cfar>(&written).unwrap(), cfar);
    }
    assert_eq!("ca".parse(), Ok(Cfar::default()));
    assert_eq!("os:rate=0.01".parse::<Cfar>().unwrap().false_alarm, 0.01);
    for text in ["", "go", "ca:guard=3", "ca:training=1x-1", "ca:rate=often", "ca:guard=1x1:1"] {
        assert!(matches!(text.parse::<Cfar>(), Err(CfarError::Text(_))), "{text}");
    }
    assert_eq!("ca:rate=2".parse::<Cfar>(), Err(CfarError::Rate(2.0)));
}
