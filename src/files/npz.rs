//! NumPy archives (`.npz`): reading by key with errors that name key, shape and type, and writing in one step.

use super::entries::check_entries;
use super::npy::NpyHeader;
use super::{Numbers, write_atomically};
use crate::platform::fs::{self, Draft, File};
use ndarray::{Array, Array2, ArrayD, ArrayRef, Dimension, ShapeError};
use ndarray_npy::npy::header::{Header, Layout};
use ndarray_npy::{NpzWriter, WritableElement, WriteNpyError, WriteNpyExt, WriteNpzError};
use num_complex::{Complex64, ComplexFloat};
use std::cell::RefCell;
use std::fmt::Display;
use std::io::{self, BufReader, BufWriter, Read, Seek, Write};
use std::path::Path;
use zip::result::ZipError;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipArchive};

/// Most bytes that one array of an archive may have, unless [`Npz::at_most`] says otherwise: 1 GiB, the samples of the largest radar.
pub const MAX_ARRAY_BYTES: u64 = 1 << 30;

/// An error of reading or writing an archive. Messages don't name the file: its opener does.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs)] // The messages name every field.
pub enum NpzError {
    /// The system could not read or write.
    #[error("{0}")]
    Io(#[from] io::Error),
    #[error("not a whole .npz archive ({0}); expected one written by numpy.savez")]
    Archive(String),
    #[error("has no array \"{key}\"; expected it beside what is there: {found}")]
    Missing { key: String, found: String },
    #[error("array \"{key}\" holds {found}; expected {expected}")]
    Type { key: String, found: String, expected: &'static str },
    #[error("array \"{key}\" has shape {found}; expected {expected}")]
    Shape { key: String, found: String, expected: String },
    #[error("array \"{key}\" holds {value} at index {index:?}; expected finite numbers only")]
    NotFinite { key: String, index: Vec<usize>, value: String },
    #[error("array \"{key}\" is too large; at most {most} bytes are read")]
    TooLarge { key: String, most: u64 },
    #[error("array \"{key}\" can't be read: {reason}")]
    Damaged { key: String, reason: String },
}

/// An open archive.
pub struct Npz<R = BufReader<File>> {
    archive: ZipArchive<R>,
    keys: Vec<String>,
    most_bytes: u64,
}

impl Npz {
    /// Opens an archive and reads its list of keys.
    /// # Errors
    /// [`NpzError::Io`] or [`NpzError::Archive`].
    pub fn open(path: &Path) -> Result<Npz, NpzError> {
        if !fs::metadata(path)?.is_file() {
            let message = "is a folder, device or pipe; expected an .npz file";
            return Err(io::Error::new(io::ErrorKind::InvalidInput, message).into());
        }
        Npz::of(BufReader::new(File::open(path)?))
    }
}

impl<R: Read + Seek> Npz<R> {
    /// The archive that `file` holds, with its list of keys.
    /// # Errors
    /// [`NpzError::Archive`].
    pub fn of(mut file: R) -> Result<Npz<R>, NpzError> {
        let not_whole = |error: ZipError| NpzError::Archive(error.to_string());
        check_entries(&mut file).map_err(|e| NpzError::Archive(e.to_string()))?;
        let archive = ZipArchive::new(file).map_err(not_whole)?;
        // NumPy leaves the ending off its keys.
        let keys = archive.file_names().map(|name| name.strip_suffix(".npy").unwrap_or(name).to_owned()).collect();
        Ok(Npz { archive, keys, most_bytes: MAX_ARRAY_BYTES })
    }

    /// Refuses arrays of more than so many bytes.
    pub fn at_most(self, most_bytes: u64) -> Npz<R> {
        Npz { most_bytes, ..self }
    }

    /// The keys of the archive.
    pub fn keys(&self) -> &[String] {
        &self.keys
    }

    /// Whether the archive has an array under `key`.
    pub fn has(&self, key: &str) -> bool {
        self.keys.iter().any(|k| k == key)
    }

    /// Real numbers under `key`, from f64, f32, i64 or i32 arrays; all finite.
    /// # Errors
    /// [`NpzError`] names the key and what was expected of it.
    pub fn reals<D: Dimension>(&mut self, key: &str) -> Result<Array<f64, D>, NpzError> {
        let found = self.numbers(key, &["f8", "f4", "i8", "i4"], "real numbers (float64)", D::NDIM)?;
        let values = match found {
            Numbers::Real(values) => values,
            Numbers::Complex(values) => values.mapv(|v| v.re),
        };
        all_finite(key, values)
    }

    /// Complex numbers under `key`, from complex128 or complex64 arrays; all finite.
    /// # Errors
    /// [`NpzError`] names the key and what was expected of it.
    pub fn complexes<D: Dimension>(&mut self, key: &str) -> Result<Array<Complex64, D>, NpzError> {
        let found = self.numbers(key, &["c16", "c8"], "complex numbers (complex128)", D::NDIM)?;
        let values = match found {
            Numbers::Real(values) => values.mapv(Complex64::from),
            Numbers::Complex(values) => values,
        };
        all_finite(key, values)
    }

    /// The numbers under `key`, of one of the types `codes` and of so many dimensions.
    fn numbers(
        &mut self,
        key: &str,
        codes: &[&str],
        expected: &'static str,
        dimensions: Option<usize>,
    ) -> Result<Numbers, NpzError> {
        let most = self.most_bytes;
        let mut file = self.entry(key)?;
        let damaged = |error: io::Error| NpzError::Damaged { key: key.to_owned(), reason: error.to_string() };
        let header = NpyHeader::read(&mut file).map_err(damaged)?;
        if !codes.contains(&header.code()) {
            return Err(NpzError::Type { key: key.to_owned(), found: header.descriptor, expected });
        }
        if header.bytes().is_none_or(|bytes| bytes as u64 > most) {
            return Err(NpzError::TooLarge { key: key.to_owned(), most });
        }
        if let Some(asked) = dimensions.filter(|asked| *asked != header.shape.len()) {
            let (found, expected) = (format!("with {} dimensions", header.shape.len()), format!("{asked} dimensions"));
            return Err(NpzError::Shape { key: key.to_owned(), found, expected });
        }
        let unread = || damaged(io::Error::other("its type is not read"));
        header.numbers(file).ok_or_else(unread)?.map_err(damaged)
    }

    /// The bytes of the array under `key`, as `numpy.save` writes them.
    /// # Errors
    /// [`NpzError`] where there is no such key, or its bytes can't be read.
    pub fn entry(&mut self, key: &str) -> Result<impl Read + '_, NpzError> {
        let name = format!("{key}.npy");
        let index = self.archive.index_for_name(key).or_else(|| self.archive.index_for_name(&name));
        let Some(index) = index else {
            let found = if self.keys.is_empty() { "nothing".to_owned() } else { self.keys.join(", ") };
            return Err(NpzError::Missing { key: key.to_owned(), found });
        };
        self.archive.by_index(index).map_err(|e| NpzError::Damaged { key: key.to_owned(), reason: e.to_string() })
    }
}

fn all_finite<T: ComplexFloat + Display, D: Dimension>(key: &str, values: ArrayD<T>) -> Result<Array<T, D>, NpzError> {
    if let Some((index, value)) = values.indexed_iter().find(|(_, v)| !v.is_finite()) {
        let (index, value) = (Dimension::slice(&index).to_vec(), value.to_string());
        return Err(NpzError::NotFinite { key: key.to_owned(), index, value });
    }
    let damaged = |e: ShapeError| NpzError::Damaged { key: key.to_owned(), reason: e.to_string() };
    values.into_dimensionality().map_err(damaged)
}

/// An archive being written.
pub struct NpzOutput<'a> {
    writer: NpzWriter<&'a mut BufWriter<Draft>>,
}

impl NpzOutput<'_> {
    /// Adds an array under `key`.
    /// # Errors
    /// [`NpzError::Io`] when the disk is full.
    pub fn add<T: WritableElement, D: Dimension>(&mut self, key: &str, array: &ArrayRef<T, D>) -> Result<(), NpzError> {
        self.writer.add_array(key, array).map_err(write_error)
    }

    /// Adds arrays `[rows, columns]` as one of `shape` `[count, rows, columns]` under `key`. `next` makes them in order; one is held at a time.
    /// # Errors
    /// The error of `next`, an array of another shape, or [`NpzError::Io`] when the disk is full.
    pub fn add_stack<T: WritableElement + Clone>(
        &mut self,
        key: &str,
        shape: [usize; 3],
        next: impl FnMut(usize) -> Result<Array2<T>, NpzError>,
    ) -> Result<(), NpzError> {
        let options = SimpleFileOptions::default().compression_method(CompressionMethod::Stored).large_file(true);
        let stack = Stack { shape, next: RefCell::new(next) };
        self.writer.add_array_with_options(key, &stack, options).map_err(write_error)
    }
}

/// Arrays of one shape, made one after another, as the one array that has them along its first axis.
struct Stack<F> {
    shape: [usize; 3],
    next: RefCell<F>,
}

impl<T: WritableElement + Clone, F: FnMut(usize) -> Result<Array2<T>, NpzError>> WriteNpyExt for Stack<F> {
    fn write_npy<W: Write>(&self, mut writer: W) -> Result<(), WriteNpyError> {
        let [count, rows, columns] = self.shape;
        let type_descriptor = T::type_descriptor();
        Header { type_descriptor, layout: Layout::Standard, shape: self.shape.to_vec() }.write(&mut writer)?;
        for n in 0..count {
            let array = (self.next.borrow_mut())(n).map_err(io::Error::other)?;
            let array = array.as_standard_layout();
            match array.as_slice() {
                Some(numbers) if array.dim() == (rows, columns) => T::write_slice(numbers, &mut writer)?,
                _ => {
                    let message = format!("array {n} has shape {:?}; expected [{rows}, {columns}]", array.shape());
                    return Err(io::Error::other(message).into());
                }
            }
        }
        Ok(())
    }
}

fn write_error(error: WriteNpzError) -> NpzError {
    NpzError::Io(io::Error::other(error))
}

/// Writes an archive in one step, uncompressed as `numpy.savez` does: `fill` adds the arrays.
/// # Errors
/// The error of `fill`, or [`NpzError::Io`].
pub fn write_npz(path: &Path, fill: impl FnOnce(&mut NpzOutput) -> Result<(), NpzError>) -> Result<(), NpzError> {
    write_atomically(path, |out| {
        let mut output = NpzOutput { writer: NpzWriter::new(out) };
        fill(&mut output)?;
        output.writer.finish().map_err(write_error)?;
        Ok(())
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use ndarray::{Ix1, Ix2, array};

    #[test]
    fn a_stack_is_one_array_of_three_axes() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.npz");
        let next = |n: usize| Ok(array![[n as f64, 1.0, 2.0]]);
        write_npz(&path, |out| out.add_stack("maps", [4, 1, 3], next)).unwrap();
        let maps = Npz::open(&path).unwrap().reals::<ndarray::Ix3>("maps").unwrap();
        assert_eq!((maps.dim(), maps[[3, 0, 0]], maps[[2, 0, 2]]), ((4, 1, 3), 3.0, 2.0));
        let error = write_npz(&path, |out| out.add_stack("maps", [4, 2, 3], next)).unwrap_err().to_string();
        assert!(error.contains("array 0 has shape [1, 3]"), "{error}");
    }

    fn archive() -> (tempfile::TempDir, std::path::PathBuf) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.npz");
        write_npz(&path, |out| {
            out.add("f32", &array![1.5f32, -2.0])?;
            out.add("ints", &array![3i64, 4])?;
            out.add("nan", &array![0.0, f64::NAN])?;
            out.add("complex", &array![[Complex64::new(1.0, -2.0)]])
        })
        .unwrap();
        (folder, path)
    }

    #[test]
    fn numbers_of_every_width_are_read() {
        let (_folder, path) = archive();
        let mut npz = Npz::open(&path).unwrap();
        assert_eq!(npz.reals::<Ix1>("f32").unwrap(), array![1.5, -2.0]);
        assert_eq!(npz.reals::<Ix1>("ints").unwrap(), array![3.0, 4.0]);
        assert_eq!(npz.complexes::<Ix2>("complex").unwrap(), array![[Complex64::new(1.0, -2.0)]]);
    }

    #[test]
    fn every_fault_names_its_key() {
        let (_folder, path) = archive();
        let mut npz = Npz::open(&path).unwrap();
        for (message, parts) in [
            (npz.reals::<Ix1>("sub0").unwrap_err().to_string(), ["\"sub0\"", "f32, ints, nan, complex"]),
            (npz.reals::<Ix1>("nan").unwrap_err().to_string(), ["\"nan\"", "[1]"]),
            (npz.reals::<Ix2>("f32").unwrap_err().to_string(), ["1 dimensions", "2 dimensions"]),
            (npz.reals::<Ix2>("complex").unwrap_err().to_string(), ["<c16", "float64"]),
        ] {
            assert!(parts.iter().all(|p| message.contains(p)), "{message}");
        }
    }

    #[test]
    fn a_truncated_archive_is_no_archive() {
        let (_folder, path) = archive();
        let whole = std::fs::read(&path).unwrap();
        for length in [0, 10, whole.len() / 2, whole.len() - 1] {
            std::fs::write(&path, &whole[..length]).unwrap();
            assert!(matches!(Npz::open(&path), Err(NpzError::Archive(_))), "{length} bytes");
        }
    }
}
