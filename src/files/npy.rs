//! NumPy's single arrays (`.npy`): the header is checked before memory is reserved by its sizes.
//!
//! `ndarray_npy` trusts the header's number of elements, and its own length. A damaged header may give any.

use ndarray_npy::npy::header::Header;
use std::io::{self, Read};

const MAX_HEADER_BYTES: usize = 4096;

/// Most brackets in a header.
const MAX_BRACKETS: usize = 16;

/// Most brackets within each other: a dictionary of a list of tuples with shapes. The parser takes several times the memory for one more.
const MAX_DEPTH: usize = 4;

/// Magic number, version and dictionary, so long and so nested as NumPy would write them.
/// # Errors
/// [`io::ErrorKind::InvalidData`] for anything else, [`io::ErrorKind::UnexpectedEof`] where the file ends before.
pub fn header_bytes(file: &mut impl Read) -> io::Result<Vec<u8>> {
    let invalid = |message: &str| io::Error::new(io::ErrorKind::InvalidData, message.to_owned());
    let mut bytes = vec![0; 8];
    file.read_exact(&mut bytes)?;
    if !bytes.starts_with(b"\x93NUMPY") {
        return Err(invalid("it does not begin with NumPy's magic number"));
    }
    let width = if bytes[6] == 1 { 2 } else { 4 };
    let mut length = [0; 4];
    file.read_exact(&mut length[..width])?;
    bytes.extend_from_slice(&length[..width]);
    let length = u32::from_le_bytes(length) as usize;
    if length > MAX_HEADER_BYTES {
        return Err(invalid("its header is longer than 4096 bytes"));
    }
    let start = bytes.len();
    bytes.resize(start + length, 0);
    file.read_exact(&mut bytes[start..])?;
    let (mut brackets, mut depth) = (0, 0usize);
    for byte in &bytes[start..] {
        match byte {
            b'(' | b'[' | b'{' => (brackets, depth) = (brackets + 1, depth + 1),
            b')' | b']' | b'}' => depth = depth.saturating_sub(1),
            _ => {}
        }
        if brackets > MAX_BRACKETS || depth > MAX_DEPTH {
            return Err(invalid("its header is nested too deep"));
        }
    }
    Ok(bytes)
}

/// Checks that an array's file (`.npy`: header, numbers) is as long as its header says, so that reading it allocates no more.
/// # Errors
/// The fault of the file.
pub fn check(file: &[u8]) -> Result<(), String> {
    let mut numbers = file;
    let header = header_bytes(&mut numbers).map_err(|e| e.to_string())?;
    let header = Header::from_reader(&mut header.as_slice()).map_err(|e| e.to_string())?;
    let size = element_bytes(&header.type_descriptor.to_string());
    let promised = header.shape.iter().try_fold(size, |product, n| product.checked_mul(*n));
    if promised == Some(numbers.len()) {
        return Ok(());
    }
    Err(format!("it holds {} bytes of numbers, which is not what its shape {:?} promises", numbers.len(), header.shape))
}

/// Bytes of one element: the number at the end of a type such as `'<f8'`. Types without one are refused later, by name; 1 till then.
fn element_bytes(descriptor: &str) -> usize {
    descriptor.trim_matches(|c: char| !c.is_ascii_digit()).parse().unwrap_or(1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use ndarray::{Array1, Array2, arr0};
    use ndarray_npy::WriteNpyExt;
    use num_complex::Complex64;

    fn file(version: u8, header: &str, numbers: usize) -> Vec<u8> {
        let mut file = b"\x93NUMPY".to_vec();
        file.extend([version, 0]);
        match version {
            1 => file.extend((header.len() as u16).to_le_bytes()),
            _ => file.extend((header.len() as u32).to_le_bytes()),
        }
        file.extend(header.as_bytes());
        file.resize(file.len() + numbers, 0);
        file
    }

    #[test]
    fn whole_files_pass() {
        let written = |array: &dyn Fn(&mut Vec<u8>)| {
            let mut bytes = Vec::new();
            array(&mut bytes);
            bytes
        };
        for bytes in [
            written(&|b| Array1::<f64>::zeros(3).write_npy(b).unwrap()),
            written(&|b| Array2::<Complex64>::zeros((4, 5)).write_npy(b).unwrap()),
            written(&|b| Array2::<f32>::zeros((0, 5)).write_npy(b).unwrap()),
            written(&|b| arr0(1i32).write_npy(b).unwrap()),
        ] {
            assert_eq!(check(&bytes), Ok(()));
        }
    }

    #[test]
    fn promises_that_are_not_kept_are_told() {
        let shape = |shape: &str| format!("{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}, }}\n");
        for (bytes, part) in [
            (b"PK is no array".to_vec(), "magic number"),
            (file(1, &shape("(3,)"), 23), "23 bytes"),
            (file(1, &shape("(1000000000000,)"), 24), "promises"),
            (file(1, &shape("(4294967296, 4294967296, 2)"), 24), "promises"),
            (file(1, &shape("(-1,)"), 24), "shape"),
            (file(1, &shape(&"(".repeat(100)), 24), "nested"),
            (file(1, &"{'descr': '<f8', 'fortran_order': Fa".repeat(6), 24), "nested"),
            (file(2, &" ".repeat(5000), 24), "longer than"),
            (file(1, "{}\n", 0)[..11].to_vec(), "fill whole buffer"),
        ] {
            let message = check(&bytes).unwrap_err();
            assert!(message.contains(part), "{message}");
        }
    }
}
