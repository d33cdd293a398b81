use super::*;
use AxisKind::{Element, Iq, Receiver, Sample, Transmitter};
use ndarray::array;

/// `shape` numbered from 0 in C order, as complex numbers.
fn numbered(shape: &[usize]) -> Numbers {
    let count: usize = shape.iter().product();
    let values = (0..count).map(|v| Complex64::from(v as f64)).collect();
    Numbers::Complex(ArrayD::from_shape_vec(IxDyn(shape), values).unwrap())
}

fn reals(values: Array2<Complex64>) -> Array2<f64> {
    values.mapv(|v| v.re)
}

#[test]
fn axes_are_put_in_order() {
    let straight = arrange(numbered(&[2, 3]), &[Element, Sample], None).unwrap();
    assert_eq!(reals(straight), array![[0.0, 1.0, 2.0], [3.0, 4.0, 5.0]]);
    let turned = arrange(numbered(&[2, 3]), &[Sample, Element], None).unwrap();
    assert_eq!(reals(turned), array![[0.0, 3.0], [1.0, 4.0], [2.0, 5.0]]);
    let snapshot = arrange(numbered(&[3]), &[Element], None).unwrap();
    assert_eq!(reals(snapshot), array![[0.0], [1.0], [2.0]]);
}

#[test]
fn chirps_are_picked_or_joined_but_never_guessed() {
    let of = |chirp| arrange(numbered(&[2, 2, 1]), &[AxisKind::Chirp, Element, Sample], chirp);
    assert_eq!(reals(of(Some(ChirpChoice::Number(1))).unwrap()), array![[2.0], [3.0]]);
    assert_eq!(reals(of(Some(ChirpChoice::Joined(Join::Mean))).unwrap()), array![[1.0], [2.0]]);
    assert!(of(None).unwrap_err().to_string().contains("recording.chirp = 0 to 1, \"mean\""));
    assert!(of(Some(ChirpChoice::Number(2))).unwrap_err().to_string().contains("expected 0 to 1"));
    let needless = arrange(numbered(&[2, 1]), &[Element, Sample], Some(ChirpChoice::Number(0)));
    assert!(needless.unwrap_err().to_string().contains("no axis is \"chirp\""));
}

#[test]
fn iq_may_have_its_own_axis() {
    let parts = array![[[1.0, 2.0]], [[3.0, 4.0]]].into_dyn();
    let found = arrange(Numbers::Real(parts.clone()), &[Element, Sample, Iq], None).unwrap();
    assert_eq!(found, array![[Complex64::new(1.0, 2.0)], [Complex64::new(3.0, 4.0)]]);
    let without = arrange(Numbers::Real(array![1.0, 2.0].into_dyn()), &[Element], None).unwrap_err();
    assert!(without.to_string().contains("axis \"iq\""), "{without}");
    let told = |numbers, kinds: &[AxisKind]| arrange(numbers, kinds, None).unwrap_err().to_string();
    assert!(told(Numbers::Real(parts), &[Element, Iq, Sample]).contains("\"iq\" has length 1"));
    assert!(told(numbered(&[1, 2]), &[Element, Iq]).contains("expected no axis \"iq\""));
}

#[test]
fn one_frame_is_selected() {
    let of = |frame| {
        let mut kinds = vec![AxisKind::Frame, Element, Sample];
        let numbers = frame_of(numbered(&[2, 2, 1]), &mut kinds, frame)?;
        arrange(numbers, &kinds, None).map(reals)
    };
    assert_eq!((of(None).unwrap(), of(Some(1)).unwrap()), (array![[0.0], [1.0]], array![[2.0], [3.0]]));
    assert!(of(Some(2)).unwrap_err().to_string().contains("recording.frame is 2; expected 0 to 1"));
    let needless = frame_of(numbered(&[2, 1]), &mut vec![Element, Sample], Some(0));
    assert!(needless.unwrap_err().to_string().contains("no axis is \"frame\""));
}

#[test]
fn real_samples_become_the_positive_half_of_their_spectrum() {
    let turn = |n: usize| std::f64::consts::TAU * 3.0 * n as f64 / 16.0;
    let waves = Array2::from_shape_fn((1, 16), |(_, n)| turn(n).cos());
    let found = arrange(Numbers::Real(waves.into_dyn()), &[Element, Sample], None).unwrap();
    for (n, v) in found.iter().enumerate() {
        assert!((v - Complex64::from_polar(1.0, turn(n))).norm() < 1e-12, "{n}: {v}");
    }
}

#[test]
fn wrong_axes_are_told() {
    for (kinds, part) in [
        (vec![Element], "shape [2, 3]"),
        (vec![Element, Element], "\"element\" stands twice"),
        (vec![Sample, Iq], "expected either"),
        (vec![Transmitter, Sample], "both \"transmitter\" and \"receiver\""),
        (vec![Transmitter, Element], "expected either"),
    ] {
        let message = arrange(numbered(&[2, 3]), &kinds, None).unwrap_err().to_string();
        assert!(message.contains(part), "{message}");
    }
    assert_eq!(arrange(numbered(&[0, 3]), &[Element, Sample], None).unwrap().dim(), (0, 3));
    assert_eq!(arrange(numbered(&[3, 0]), &[Element, Sample], None).unwrap().dim(), (0, 0));
}

#[test]
fn transmitters_in_turn_have_an_axis_of_their_own() {
    let mut kinds = vec![AxisKind::Chirp, Element, Sample];
    let numbers = split_turns(numbered(&[4, 1, 1]), &mut kinds, Some(2)).unwrap();
    let told = ([2, 2, 1, 1].as_slice(), [AxisKind::Chirp, Transmitter, Receiver, Sample].as_slice());
    assert_eq!((numbers.shape(), kinds.as_slice()), told);
    let joined = into_loops(numbers.clone(), &kinds).unwrap();
    assert_eq!((joined.dim(), joined[[1, 0, 0, 0]].re), ((2, 2, 1, 1), 2.0));
    assert_eq!(reals(arrange(numbers, &kinds, Some(ChirpChoice::Joined(Join::Mean))).unwrap()), array![[1.0], [2.0]]);
    let odd = split_turns(numbered(&[3, 1, 1]), &mut vec![AxisKind::Chirp, Element, Sample], Some(2));
    assert!(odd.unwrap_err().to_string().contains("3 chirps are no multiple of 2"));
}
