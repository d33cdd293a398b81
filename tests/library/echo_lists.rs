//! Lists of echoes on small arrays: the first echo that any method lists is the true one.

use crate::prelude::*;

/// A physical radar of 77 GHz whose two ends are all of its elements, or of 86 the outer ones; of three the middle one is in both.
fn radar(elements: usize) -> Radar {
    let radar = Radar { elements, samples: 64, bandwidth_hz: 1e9, ..Radar::default() };
    Radar { end_elements: radar.most_end_elements().min(12), ..radar }.in_convention(Convention::Physical)
}

#[test]
fn every_list_of_echoes_begins_with_the_true_one() {
    let (mut wrong, mut listed) = (Vec::new(), 0);
    for elements in [8, 12, 16, 86] {
        let radar = radar(elements);
        // Half of a beam of the array in cos(theta), at least 0.03.
        let within = (1.0 / elements as f64).max(0.03);
        for cosine in [0.1, -0.43] {
            let ends = heard(&radar, cosine);
            let request = Request { noise: NoisePrior::UNKNOWN, ..Request::default() };
            for method in methods::all().iter().filter(|m| m.check_array(&radar).is_ok()) {
                let Ok((_, found)) = reconstruct_and_find(method.as_ref(), &radar, &ends, &request) else { continue };
                let Some(first) = found.first() else { continue };
                listed += 1;
                // A lobe of the Hann window is four range bins wide.
                let is_there = (first.cos_theta - cosine).abs() < within
                    && (first.range_metres - RANGE_METRES).abs() < 1.5 * radar.range_resolution_metres();
                if !is_there {
                    wrong.push(format!("{} on {elements}: {first:?} for {cosine}", method.name()));
                }
            }
        }
    }
    assert!(wrong.is_empty() && listed > 40, "{listed} lists, of which\n{}", wrong.join("\n"));
}

const RANGE_METRES: f64 = 4.0;

fn heard(radar: &Radar, cosine: f64) -> TwoEnds {
    let scene = Scene::of_points([(RANGE_METRES * cosine, RANGE_METRES * (1.0 - cosine * cosine).sqrt())]);
    simulate(radar, &scene, Floor::Snr(Decibels(30.0)), 3).unwrap().two_ends(radar)
}

#[test]
fn two_to_five_elements_are_answered_or_refused() {
    for elements in 2..=5 {
        let radar = radar(elements);
        let ends = heard(&radar, 0.1);
        let mut answers = 0;
        for method in methods::all() {
            match method.reconstruct(&radar, &ends, &Request::default()) {
                Ok(answer) => {
                    answers += 1;
                    assert_eq!(answer.lambda.lambda.dim(), (64, elements), "{}", method.name());
                    assert!(answer.lambda.lambda.iter().all(|v| (0.0..=1.0).contains(v)), "{}", method.name());
                }
                Err(error) => {
                    let needed = format!("it needs {} elements of each end", method.fewest_end_elements());
                    assert!(error.to_string().contains(&needed), "{}: {error}", method.name());
                }
            }
        }
        // Methods that take both ends as one aperture answer; baseline and powers need two elements of an end.
        assert_eq!(answers, if elements == 2 { 3 } else { 5 }, "{elements} elements");
    }
}

#[test]
fn one_echo_before_two_or_three_elements_has_its_place() {
    for elements in [2, 3, 4] {
        let radar = radar(elements);
        for cosine in [0.3, -0.6, 0.05] {
            let ends = heard(&radar, cosine);
            let found = found_by("iaa", &radar, &ends);
            let first = found.first().expect("an echo");
            assert!((first.cos_theta - cosine).abs() < 0.03, "{elements}: {} for {cosine}", first.cos_theta);
            let off = (first.range_metres - RANGE_METRES).abs();
            assert!(off < radar.range_resolution_metres(), "{elements}: {off} m");
        }
    }
}

#[test]
fn three_elements_have_ends_that_share_the_middle_one() {
    assert_eq!(radar(3).end_elements, 2);
    assert!(radar(3).validate().is_ok() && Radar { end_elements: 3, ..radar(5) }.validate().is_err());
}
