//! NumPy's `.npy` and `.npz` files. The header's sizes are checked before memory is allocated.

use super::Fault;
use super::numbers::{Numbers, bounded_count, too_large};
use crate::files::npy::NpyHeader;
use crate::files::npz::Npz;
use std::io::{self, Read, Seek};

pub(super) fn read_npz(file: impl Read + Seek, key: &str) -> Result<Numbers, Fault> {
    read_array(Npz::of(file)?.entry(key)?, &format!("array \"{key}\""))
}

/// Names and shapes of the arrays of an archive, without their numbers; those that can't be read are left out.
pub(super) fn shapes(file: impl Read + Seek) -> Result<Vec<(String, Vec<usize>)>, Fault> {
    let mut archive = Npz::of(file)?;
    let keys = archive.keys().to_vec();
    let shape = |key: String| Some((key.clone(), NpyHeader::read(&mut archive.entry(&key).ok()?).ok()?.shape));
    Ok(keys.into_iter().filter_map(shape).collect())
}

pub(super) fn read_npy(file: impl Read) -> Result<Numbers, Fault> {
    read_array(file, "the array")
}

fn read_array(mut file: impl Read, what: &str) -> Result<Numbers, Fault> {
    let damaged = |e: io::Error| Fault::Data(format!("{what} can't be read: {e}; expected what numpy.save writes"));
    let header = NpyHeader::read(&mut file).map_err(damaged)?;
    bounded_count(&header.shape).ok_or_else(|| too_large(what, &header.shape))?;
    let unsupported = || {
        let expected = "complex or real numbers, integers of 16 or more bits or int8, or pairs of int16";
        Fault::Data(format!("{what} holds {}; expected {expected}", header.descriptor))
    };
    header.numbers(file).ok_or_else(unsupported)?.map_err(damaged)
}

#[cfg(test)]
mod tests {
    use super::*;
    use ndarray::{Array, Dimension, array};
    use ndarray_npy::{NpzWriter, WritableElement, WriteNpyExt};
    use num_complex::{Complex32, Complex64};
    use std::io::Cursor;

    fn npy<T: WritableElement, D: Dimension>(values: &Array<T, D>) -> Vec<u8> {
        let mut bytes = Vec::new();
        values.write_npy(&mut bytes).unwrap();
        bytes
    }

    fn npz() -> Vec<u8> {
        let mut bytes = Cursor::new(Vec::new());
        let mut writer = NpzWriter::new_compressed(&mut bytes);
        writer.add_array("a", &array![[Complex32::new(1.0, -2.0)]]).unwrap();
        writer.add_array("text", &array![1u8]).unwrap();
        writer.finish().unwrap();
        bytes.into_inner()
    }

    #[test]
    fn every_width_is_read() {
        let complex = Numbers::Complex(array![[Complex64::new(1.0, -2.0)]].into_dyn());
        assert_eq!(read_npz(Cursor::new(npz()), "a").unwrap(), complex);
        assert_eq!(read_npy(npy(&array![[Complex64::new(1.0, -2.0)]]).as_slice()).unwrap(), complex);
        let real = Numbers::Real(array![1.0, -2.0].into_dyn());
        for bytes in [
            npy(&array![1i16, -2]),
            npy(&array![1i32, -2]),
            npy(&array![1i64, -2]),
            npy(&array![1f32, -2.0]),
            npy(&array![1f64, -2.0]),
        ] {
            assert_eq!(read_npy(bytes.as_slice()).unwrap(), real);
        }
        assert_eq!(read_npy(npy(&array![1i8, -2]).as_slice()).unwrap(), real);
        let unsigned = Numbers::Real(array![1.0, 65534.0].into_dyn());
        assert_eq!(read_npy(npy(&array![1u16, 65534]).as_slice()).unwrap(), unsigned);
        let turned = array![[1.0, 2.0], [3.0, 4.0]].reversed_axes();
        assert_eq!(read_npy(npy(&turned).as_slice()).unwrap(), Numbers::Real(turned.into_dyn()), "Fortran order");
    }

    #[test]
    fn halves_with_pairs_of_integers_are_read() {
        let file = |kind: &str, order: &str, shape: &str, words: &[u16]| {
            let mut bytes = with_header(&format!("{{'descr': {kind}, 'fortran_order': {order}, 'shape': {shape}, }}"));
            bytes.extend(words.iter().flat_map(|w| w.to_le_bytes()));
            read_npy(bytes.as_slice())
        };
        // 1, -2, the smallest above 0, and 65504.
        let halves = file("'<f2'", "False", "(4,)", &[0x3c00, 0xc000, 0x0001, 0x7bff]).unwrap();
        assert_eq!(halves, Numbers::Real(array![1.0, -2.0, 2f64.powi(-24), 65504.0].into_dyn()));
        let pairs = "[('re', '<i2'), ('im', '<i2')]";
        let complex = |re: i16, im: i16| Complex64::new(re.into(), im.into());
        let found = file(pairs, "False", "(1, 2)", &[1, 2, 0xffff, 4]).unwrap();
        assert_eq!(found, Numbers::Complex(array![[complex(1, 2), complex(-1, 4)]].into_dyn()));
        let found = file("'<f2'", "True", "(2, 2)", &[0x3c00, 0xc000, 0, 0]).unwrap();
        assert_eq!(found, Numbers::Real(array![[1.0, 0.0], [-2.0, 0.0]].into_dyn()), "Fortran order");
        assert!(file(pairs, "False", "(2,)", &[1, 2, 3]).unwrap_err().to_string().contains("ends too early"));
    }

    #[test]
    fn faults_name_the_key_with_the_expectation() {
        let error = |key: &str| read_npz(Cursor::new(npz()), key).unwrap_err().to_string();
        assert!(error("b").contains("\"b\"") && error("b").contains("a, text"), "{}", error("b"));
        assert!(error("text").contains("|u1") && error("text").contains("complex"), "{}", error("text"));
        let message = read_npz(Cursor::new(b"PK no".to_vec()), "a").unwrap_err().to_string();
        assert!(message.contains("numpy.savez"), "{message}");
        let message = read_npy(&b"no array at all"[..]).unwrap_err().to_string();
        assert!(message.contains("magic number") && message.contains("numpy.save"), "{message}");
    }

    fn with_header(dictionary: &str) -> Vec<u8> {
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        bytes.extend_from_slice(&(dictionary.len() as u16 + 1).to_le_bytes());
        bytes.extend_from_slice(dictionary.as_bytes());
        bytes.push(b'\n');
        bytes
    }

    #[test]
    fn a_header_of_a_huge_array_is_refused() {
        let huge = with_header("{'descr': '<c16', 'fortran_order': False, 'shape': (1000000, 1000000), }");
        let message = read_npy(huge.as_slice()).unwrap_err().to_string();
        assert!(message.contains("[1000000, 1000000]") && message.contains("at most"), "{message}");
    }
}
