use super::*;
use proptest::prelude::*;
use std::io::Cursor;

/// Written by `tests/data/hdf5/write.py`.
const ARRAYS: &[u8] = include_bytes!("../../../tests/data/hdf5/arrays.h5");
const MATLAB: &[u8] = include_bytes!("../../../tests/data/hdf5/new.mat");
const LATEST: &[u8] = include_bytes!("../../../tests/data/hdf5/latest.h5");

fn values(bytes: &[u8], key: &str) -> Result<Numbers, Hdf5Error> {
    Hdf5::open(Cursor::new(bytes))?.values(key, 1000)
}

fn reals(bytes: &[u8], key: &str) -> ArrayD<f64> {
    match values(bytes, key).unwrap() {
        Numbers::Real(values) => values,
        Numbers::Complex(values) => panic!("{key} is complex: {values}"),
    }
}

fn complex(bytes: &[u8], key: &str) -> ArrayD<Complex64> {
    match values(bytes, key).unwrap() {
        Numbers::Complex(values) => values,
        Numbers::Real(values) => panic!("{key} is real: {values}"),
    }
}

#[test]
fn every_way_of_storing_gives_the_numbers() {
    let cube = complex(ARRAYS, "cube");
    assert_eq!(cube.shape(), [3, 5, 4]);
    assert!(cube.iter().enumerate().all(|(n, v)| *v == Complex64::new(n as f64, -2.0 * n as f64)), "{cube}");
    let summed = reals(ARRAYS, "summed");
    assert!(summed.shape() == [3, 5, 4] && summed.iter().enumerate().all(|(n, v)| *v == n as f64), "{summed}");
    let nested = reals(ARRAYS, "radar.raw.adcData");
    assert!(nested.shape() == [2, 6] && nested.iter().enumerate().all(|(n, v)| *v == n as f64 - 6.0), "{nested}");
    let half = reals(ARRAYS, "half");
    let near = |v: f64, expected: f64| (v - expected).abs() <= 1e-3 * expected.abs();
    let expected = [0.0, -1.5, 6.1e-5, 2f64.powi(-24), 65504.0];
    assert!(half.iter().zip(expected).all(|(v, e)| near(*v, e)), "{half}");
    assert!(reals(ARRAYS, "unwritten") == ArrayD::<f64>::zeros(vec![3, 2]));
}

#[test]
fn a_file_of_matlab_has_its_variables_with_members() {
    let z = complex(MATLAB, "z");
    assert_eq!((z.shape(), z[[2, 3]]), (&[3, 4][..], Complex64::new(11.0, -31.0)));
    let shapes = Hdf5::open(Cursor::new(MATLAB)).unwrap().shapes().unwrap();
    assert_eq!(shapes, [("radar.adcData".to_owned(), vec![2, 3, 4]), ("z".to_owned(), vec![3, 4])]);
}

#[test]
fn what_is_not_read_is_told() {
    let told = |bytes: &[u8], key: &str, part: &str| {
        let message = values(bytes, key).unwrap_err().to_string();
        assert!(message.contains(part), "{message}");
    };
    assert_eq!(reals(LATEST, "whole").sum(), 1770.0);
    told(LATEST, "chunks", "in chunks of HDF5's version 1.10");
    told(ARRAYS, "text", "has no array \"text\"; expected it beside what is there: cube, half");
    told(b"x", "a", "not an HDF5 file");
    told(&ARRAYS[..1000], "cube", "damaged");
    let few = Hdf5::open(Cursor::new(ARRAYS)).unwrap().values("cube", 59).unwrap_err().to_string();
    assert!(few.contains("[3, 5, 4]") && few.contains("at most 59 numbers"), "{few}");
}

proptest! {
    #[test]
    fn damaged_files_are_read_or_refused(at in 0usize..ARRAYS.len(), byte: u8, second in 0usize..2000, cut in 0usize..ARRAYS.len()) {
        let mut bytes = ARRAYS.to_vec();
        bytes[at] = byte;
        bytes[second] = byte.wrapping_mul(31);
        for bytes in [&bytes[..], &bytes[..cut]] {
            for key in ["cube", "summed", "radar.raw.adcData"] {
                if let Ok(Numbers::Real(values)) = values(bytes, key) {
                    prop_assert!(values.len() <= 1000);
                }
            }
        }
    }
}
