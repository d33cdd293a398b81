//! Numbers of an array: in one piece or in chunks, with filters.

use super::object::{ChunkFilter, Hdf5Object, Storage};
use super::source::{Hdf5Bytes, Hdf5Error, HeaderBytes};
use flate2::read::ZlibDecoder;
use std::io::{Read, Seek};

impl<R: Read + Seek> Hdf5Bytes<R> {
    /// The bytes of all `count` numbers; a chunk has at most `most` numbers.
    pub(super) fn bytes_of(&mut self, object: &Hdf5Object, count: usize, most: usize) -> Result<Vec<u8>, Hdf5Error> {
        let size = object.number.as_ref().map_or(0, |number| number.bytes);
        let all = count * size;
        match &object.place {
            Some(Storage::Here(bytes)) if bytes.len() >= all => Ok(bytes[..all].to_vec()),
            Some(Storage::Whole(Some(address))) => self.at(*address, all as u64),
            // Numbers that were never written are zero.
            Some(Storage::Whole(None) | Storage::Chunks { tree: None, .. }) => Ok(vec![0; all]),
            Some(Storage::Chunks { tree: Some(tree), shape }) => {
                let count = shape.iter().try_fold(1usize, |n, len| n.checked_mul(*len));
                let fits = shape.len() == object.shape.len() && shape.iter().all(|len| *len > 0);
                if !fits || count.is_none_or(|n| n > most) {
                    return Err(Hdf5Error::Damaged("the chunks of an array don't fit it"));
                }
                self.of_chunks(object, *tree, shape, size)
            }
            Some(Storage::Unread(what)) => Err(Hdf5Error::Unread(what)),
            Some(Storage::Here(_)) | None => Err(Hdf5Error::Damaged("an array has no numbers")),
        }
    }

    fn of_chunks(
        &mut self,
        object: &Hdf5Object,
        tree: u64,
        shape: &[usize],
        size: usize,
    ) -> Result<Vec<u8>, Hdf5Error> {
        if object.filters.contains(&ChunkFilter::Unread) {
            return Err(Hdf5Error::Unread("an array compressed by another filter than deflate"));
        }
        // The key of a chunk: its size, a mask of filters left out, and its offset along each axis and within a number.
        let key_bytes = 8 + 8 * (shape.len() + 1);
        let mut chunks = Vec::new();
        self.walk(tree, 1, key_bytes, &mut |key, address| chunks.push((key.to_vec(), address)))?;
        let mut out = vec![0; object.shape.iter().product::<usize>() * size];
        let whole = shape.iter().product::<usize>() * size;
        for (key, address) in chunks {
            let mut key = HeaderBytes::new(&key);
            let (stored, left_out) = (key.number(4)?, key.word()?);
            let begins: Vec<usize> =
                shape.iter().map(|_| Ok(key.number(8)? as usize)).collect::<Result<_, Hdf5Error>>()?;
            let mut bytes = self.at(address, stored)?;
            for (n, filter) in object.filters.iter().enumerate().rev().filter(|(n, _)| left_out >> n & 1 == 0) {
                bytes = match *filter {
                    ChunkFilter::Deflate => inflated(&bytes, n, whole)?,
                    ChunkFilter::Shuffle => unshuffled(&bytes, size),
                    ChunkFilter::Sum => bytes[..bytes.len().saturating_sub(4)].to_vec(),
                    ChunkFilter::Unread => bytes,
                };
            }
            if bytes.len() < whole {
                return Err(Hdf5Error::Damaged("a chunk of an array is too short"));
            }
            place(&mut out, &object.shape, &bytes, shape, &begins, size);
        }
        Ok(out)
    }
}

/// The inflated bytes of a chunk: at most those of a `whole` chunk and of the sums that filters before number `n` have put behind it.
fn inflated(bytes: &[u8], n: usize, whole: usize) -> Result<Vec<u8>, Hdf5Error> {
    let mut out = Vec::new();
    ZlibDecoder::new(bytes)
        .take((whole + 4 * n) as u64)
        .read_to_end(&mut out)
        .map_err(|_| Hdf5Error::Damaged("a chunk can't be inflated"))?;
    Ok(out)
}

fn unshuffled(bytes: &[u8], size: usize) -> Vec<u8> {
    let count = bytes.len() / size.max(1);
    let mut out = bytes.to_vec();
    for (at, byte) in out.iter_mut().enumerate().take(count * size) {
        *byte = bytes[at % size * count + at / size];
    }
    out
}

/// Puts the rows of a chunk in their places; cells beyond the array are left out.
fn place(out: &mut [u8], of: &[usize], bytes: &[u8], chunk: &[usize], begins: &[usize], size: usize) {
    let Some((last, outer)) = chunk.split_last() else { return };
    let begin = begins[outer.len()];
    let kept = last.min(&of[outer.len()].saturating_sub(begin)) * size;
    for row in 0..outer.iter().product::<usize>() {
        let (mut rest, mut at, mut step, mut is_inside) = (row, begin, of[outer.len()], kept > 0);
        for (axis, len) in outer.iter().enumerate().rev() {
            let place = begins[axis].saturating_add(rest % len);
            rest /= len;
            is_inside &= place < of[axis];
            at = at.wrapping_add(place.wrapping_mul(step));
            step *= of[axis];
        }
        if is_inside {
            let from = row * last * size;
            out[at * size..at * size + kept].copy_from_slice(&bytes[from..from + kept]);
        }
    }
}
