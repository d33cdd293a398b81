//! Arrays of a file before their axes are named.

use super::Fault;
pub(super) use crate::files::Numbers;

/// Most numbers that an array of a recording may hold: half a gigabyte of complex ones.
pub const MAX_NUMBERS: usize = 1 << 25;

/// The largest number of 16 bits that has a sign.
const MOST_SIGNED: f64 = i16::MAX as f64;

impl Numbers {
    fn parts(&mut self) -> Box<dyn Iterator<Item = &mut f64> + '_> {
        match self {
            Numbers::Real(values) => Box::new(values.iter_mut()),
            Numbers::Complex(values) => Box::new(values.iter_mut().flat_map(|v| [&mut v.re, &mut v.im])),
        }
    }

    /// Gives 16-bit integers that lost their sign their sign again: 65535 is -1. Such numbers are whole, from 0 to 65535, and some lie beyond 32767.
    /// Returns a sentence where it was done.
    pub(super) fn mend_signs(&mut self) -> Option<String> {
        let is_word = |v: f64| v.fract() == 0.0 && (0.0..=65535.0).contains(&v);
        let are_words = self.parts().all(|v| is_word(*v));
        if !are_words || self.parts().all(|v| *v <= MOST_SIGNED) {
            return None;
        }
        self.parts().filter(|v| **v > MOST_SIGNED).for_each(|v| *v -= 65536.0);
        Some("The array's integers have lost their sign: those beyond 32767 are taken less 65536, as int16 would have them.".to_owned())
    }

    pub(super) fn shape(&self) -> &[usize] {
        match self {
            Numbers::Real(values) => values.shape(),
            Numbers::Complex(values) => values.shape(),
        }
    }
}

/// Number of numbers in an array of `shape`; `None` above [`MAX_NUMBERS`].
pub(super) fn bounded_count(shape: &[usize]) -> Option<usize> {
    shape.iter().try_fold(1usize, |n, len| n.checked_mul(*len)).filter(|n| *n <= MAX_NUMBERS)
}

/// The error of an array of more than [`MAX_NUMBERS`].
pub(super) fn too_large(what: &str, shape: &[usize]) -> Fault {
    Fault::Data(format!("{what} has shape {shape:?}; expected at most {MAX_NUMBERS} numbers"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use ndarray::array;
    use num_complex::Complex64;

    #[test]
    fn integers_that_lost_their_sign_get_it_back() {
        let mut complex =
            Numbers::Complex(array![Complex64::new(3.0, 65535.0), Complex64::new(40000.0, 0.0)].into_dyn());
        assert!(complex.mend_signs().unwrap().contains("lost their sign"));
        let expected = Numbers::Complex(array![Complex64::new(3.0, -1.0), Complex64::new(-25536.0, 0.0)].into_dyn());
        assert_eq!(complex, expected);
        for whole in [vec![-1.0, 40000.0], vec![0.5, 40000.0], vec![1.0, 32767.0], vec![1.0, 70000.0]] {
            let mut numbers = Numbers::Real(ndarray::Array1::from(whole).into_dyn());
            assert_eq!((numbers.clone(), None), (numbers.clone(), numbers.mend_signs()));
        }
    }
}
