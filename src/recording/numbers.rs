//! Arrays of a file before their axes are named.

use super::Fault;
pub(super) use crate::files::Numbers;

/// Most numbers of an array of a recording: 512 MiB of complex ones.
pub const MAX_NUMBERS: usize = 1 << 25;

const MAX_INT16: f64 = i16::MAX as f64;

impl Numbers {
    /// Real numbers, or real and imaginary parts.
    fn parts(&mut self) -> Box<dyn Iterator<Item = &mut f64> + '_> {
        match self {
            Numbers::Real(values) => Box::new(values.iter_mut()),
            Numbers::Complex(values) => Box::new(values.iter_mut().flat_map(|v| [&mut v.re, &mut v.im])),
        }
    }

    /// Restores the sign of 16-bit integers stored as unsigned (whole numbers up to 65535, some above 32767). Returns a sentence on it, or `None`.
    pub(super) fn restore_signs(&mut self) -> Option<String> {
        let is_word = |v: f64| v.fract() == 0.0 && (0.0..=65535.0).contains(&v);
        let are_words = self.parts().all(|v| is_word(*v));
        if !are_words || self.parts().all(|v| *v <= MAX_INT16) {
            return None;
        }
        self.parts().filter(|v| **v > MAX_INT16).for_each(|v| *v -= 65536.0);
        Some("The array's integers have lost their sign: those beyond 32767 are taken less 65536, as int16 would have them.".to_owned())
    }

    pub(super) fn shape(&self) -> &[usize] {
        match self {
            Numbers::Real(values) => values.shape(),
            Numbers::Complex(values) => values.shape(),
        }
    }
}

/// Product of the lengths of `shape`; `None` above [`MAX_NUMBERS`].
pub(super) fn bounded_count(shape: &[usize]) -> Option<usize> {
    shape.iter().try_fold(1usize, |n, len| n.checked_mul(*len)).filter(|n| *n <= MAX_NUMBERS)
}

pub(super) fn too_large(what: &str, shape: &[usize]) -> Fault {
    Fault::Data(format!("{what} has shape {shape:?}; expected at most {MAX_NUMBERS} numbers"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use ndarray::array;
    use num_complex::Complex64;

    #[test]
    fn unsigned_integers_get_their_sign_back() {
        let mut complex =
            Numbers::Complex(array![Complex64::new(3.0, 65535.0), Complex64::new(40000.0, 0.0)].into_dyn());
        assert!(complex.restore_signs().unwrap().contains("lost their sign"));
        let expected = Numbers::Complex(array![Complex64::new(3.0, -1.0), Complex64::new(-25536.0, 0.0)].into_dyn());
        assert_eq!(complex, expected);
        for whole in [vec![-1.0, 40000.0], vec![0.5, 40000.0], vec![1.0, 32767.0], vec![1.0, 70000.0]] {
            let mut numbers = Numbers::Real(ndarray::Array1::from(whole).into_dyn());
            assert_eq!((numbers.clone(), None), (numbers.clone(), numbers.restore_signs()));
        }
    }
}
