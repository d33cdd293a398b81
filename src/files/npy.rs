//! NumPy's single arrays (`.npy`). The header is checked, and no memory is reserved by its sizes: a damaged one may give any.

use super::{NumberKind, Numbers};
use ndarray::{ArrayD, IxDyn, ShapeBuilder};
use ndarray_npy::npy::header::{Header, Layout};
use num_complex::Complex64;
use std::fmt::Display;
use std::io::{self, BufReader, Read};

const MAX_HEADER_BYTES: usize = 4096;

/// Most brackets in a header.
const MAX_BRACKETS: usize = 16;

/// Most brackets within each other: a dictionary of a list of tuples with shapes. The parser takes several times the memory for one more.
const MAX_DEPTH: usize = 4;

/// The header of an array.
#[derive(Debug)]
pub struct NpyHeader {
    /// NumPy's name of the type, as the header has it: `'<f8'` with quotes, or the list of a structure.
    pub descriptor: String,
    /// Lengths of the axes.
    pub shape: Vec<usize>,
    in_columns: bool,
}

fn invalid(message: impl Display) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, message.to_string())
}

impl NpyHeader {
    /// Reads magic number, version and dictionary, so long and so nested as NumPy would write them.
    /// # Errors
    /// [`io::ErrorKind::InvalidData`] for anything else, [`io::ErrorKind::UnexpectedEof`] where the file ends before.
    pub fn read(file: &mut impl Read) -> io::Result<NpyHeader> {
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
        let Header { type_descriptor, layout, shape } = Header::from_reader(&mut bytes.as_slice()).map_err(invalid)?;
        Ok(NpyHeader { descriptor: type_descriptor.to_string(), shape, in_columns: matches!(layout, Layout::Fortran) })
    }

    /// The type without the order of its bytes: `f8`.
    pub fn code(&self) -> &str {
        self.descriptor.trim_matches(['\'', '"']).trim_start_matches(['<', '>', '|', '='])
    }

    /// The type of the numbers, and their count in an element: two of complex ones. `None` for types that are not read.
    fn kind(&self) -> Option<(NumberKind, usize)> {
        let is_big = self.descriptor.contains('>');
        let float = |bytes| NumberKind { bytes, is_float: true, is_signed: true, is_big };
        let integer = |bytes, is_signed| NumberKind { bytes, is_float: false, is_signed, is_big };
        Some(match self.code() {
            "c16" => (float(8), 2),
            "c8" => (float(4), 2),
            "f8" => (float(8), 1),
            "f4" => (float(4), 1),
            "f2" => (float(2), 1),
            "i8" => (integer(8, true), 1),
            "i4" => (integer(4, true), 1),
            "i2" => (integer(2, true), 1),
            "i1" => (integer(1, true), 1),
            "u2" => (integer(2, false), 1),
            _ if self.is_pair() => (integer(2, true), 2),
            _ => return None,
        })
    }

    /// Whether a structure of two 16-bit integers, low byte first, is meant: real and imaginary part.
    fn is_pair(&self) -> bool {
        let found = &self.descriptor;
        found.starts_with('[') && found.matches("'<i2'").count() == 2 && found.matches('\'').count() == 8
    }

    /// Bytes of the numbers; `None` where there are too many to count, or for types that are not read.
    pub fn bytes(&self) -> Option<usize> {
        let (kind, parts) = self.kind()?;
        self.shape.iter().try_fold(parts * kind.bytes, |product, n| product.checked_mul(*n))
    }

    /// The numbers, to the end of `file` behind the header; `None` but for float16 to float64, complex64/128, int8 to int64, uint16 and pairs of int16.
    pub fn numbers(&self, file: impl Read) -> Option<io::Result<Numbers>> {
        self.kind().map(|(kind, parts)| self.numbers_of(file, kind, parts))
    }

    fn numbers_of(&self, file: impl Read, kind: NumberKind, parts: usize) -> io::Result<Numbers> {
        let promised = |what: &str| invalid(format!("{what} its shape {:?} promises", self.shape));
        let all = self.bytes().ok_or_else(|| promised("nothing holds as many numbers as"))?;
        let count = all / (parts * kind.bytes);
        let mut file = BufReader::new(file);
        let mut bytes = vec![0; kind.bytes];
        let mut next = || match file.read_exact(&mut bytes) {
            Ok(()) => Ok(kind.value(&bytes)),
            Err(e) if e.kind() == io::ErrorKind::UnexpectedEof => {
                Err(promised("it ends too early for the numbers that"))
            }
            Err(e) => Err(e),
        };
        let shape = IxDyn(&self.shape).set_f(self.in_columns);
        let numbers = if parts == 1 {
            let values = (0..count).map(|_| next()).collect::<io::Result<_>>()?;
            Numbers::Real(ArrayD::from_shape_vec(shape, values).map_err(invalid)?)
        } else {
            let values =
                (0..count).map(|_| Ok::<_, io::Error>(Complex64::new(next()?, next()?))).collect::<io::Result<_>>()?;
            Numbers::Complex(ArrayD::from_shape_vec(shape, values).map_err(invalid)?)
        };
        // An archive's sum is compared at the end of the entry.
        if file.read(&mut [0])? > 0 { Err(promised("it holds more than")) } else { Ok(numbers) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ndarray::{Array1, Array2, arr0};
    use ndarray_npy::WriteNpyExt;

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

    fn read(mut bytes: &[u8]) -> Result<Numbers, String> {
        let header = NpyHeader::read(&mut bytes).map_err(|e| e.to_string())?;
        header.numbers(bytes).unwrap().map_err(|e| e.to_string())
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
            assert!(read(&bytes).is_ok());
        }
    }

    #[test]
    fn promises_that_are_not_kept_are_told() {
        let shape = |shape: &str| format!("{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}, }}\n");
        for (bytes, part) in [
            (b"PK is no array".to_vec(), "magic number"),
            (file(1, &shape("(3,)"), 23), "ends too early"),
            (file(1, &shape("(3,)"), 32), "more than its shape [3] promises"),
            (file(1, &shape("(1000000000000,)"), 24), "promises"),
            (file(1, &shape("(4294967296, 4294967296, 2)"), 24), "promises"),
            (file(1, &shape("(-1,)"), 24), "shape"),
            (file(1, &shape(&"(".repeat(100)), 24), "nested"),
            (file(1, &"{'descr': '<f8', 'fortran_order': Fa".repeat(6), 24), "nested"),
            (file(2, &" ".repeat(5000), 24), "longer than"),
            (file(1, "{}\n", 0)[..11].to_vec(), "fill whole buffer"),
        ] {
            let message = read(&bytes).unwrap_err();
            assert!(message.contains(part), "{message}");
        }
    }
}
