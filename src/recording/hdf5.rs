//! Arrays of HDF5 files. A `.mat` of version 7.3 is one, with its axes in reverse order.

use super::numbers::{MAX_NUMBERS, Numbers};
use super::{Fault, matlab};
use crate::files::hdf5::Hdf5;
use std::io::{self, Read, Seek, SeekFrom};

/// The array called `key` of an HDF5 file; those in groups are `group.name`.
pub(super) fn read_h5(file: impl Read + Seek, key: &str) -> Result<Numbers, Fault> {
    Ok(Hdf5::open(file)?.values(key, MAX_NUMBERS)?)
}

/// Names and shapes of its arrays of numbers.
pub(super) fn h5_shapes(file: impl Read + Seek) -> Result<Vec<(String, Vec<usize>)>, Fault> {
    Ok(Hdf5::open(file)?.shapes()?)
}

/// [`matlab::read_mat`], also for version 7.3.
pub(super) fn read_mat(mut file: impl Read + Seek, key: &str) -> Result<Numbers, Fault> {
    if !is_hdf5(&mut file)? {
        return matlab::read_mat(file, key);
    }
    Ok(match read_h5(file, key)? {
        Numbers::Real(values) => Numbers::Real(values.reversed_axes()),
        Numbers::Complex(values) => Numbers::Complex(values.reversed_axes()),
    })
}

/// [`matlab::shapes`], also for version 7.3.
pub(super) fn mat_shapes(mut file: impl Read + Seek) -> Result<Vec<(String, Vec<usize>)>, Fault> {
    if !is_hdf5(&mut file)? {
        return matlab::shapes(file);
    }
    Ok(h5_shapes(file)?.into_iter().map(|(key, shape)| (key, shape.into_iter().rev().collect())).collect())
}

/// Whether a `.mat` is of version 7.3.
fn is_hdf5(file: &mut (impl Read + Seek)) -> io::Result<bool> {
    let mut start = Vec::new();
    file.by_ref().take(10).read_to_end(&mut start)?;
    file.seek(SeekFrom::Start(0))?;
    Ok(start == b"MATLAB 7.3" || start.starts_with(b"\x89HDF"))
}
