//! Damages valid files at random, the same way for the same seed.

use crate::prelude::*;
use rand::seq::{IndexedRandom, IteratorRandom};

/// Text that readers are likely to stumble over, written over its content: a token between any two blanks.
const TOKENS: &[u8] =
    b"-1 0 1e308 -0.0 nan inf 4294967296 9223372036854775807 18446744073709551616 99999999999999999999999 \
                        [[ ]] { } ((((((( \" ' \n = , \0 \xff\xff\xff\xff";

const MAX_LENGTH: usize = 1 << 17;

pub fn damaged(files: &[Vec<u8>], number: u64) -> Vec<u8> {
    let mut rng = ChaCha8Rng::seed_from_u64(number);
    let mut bytes = files.choose(&mut rng).cloned().unwrap_or_default();
    for _ in 0..rng.random_range(1..=8) {
        damage(&mut bytes, files, &mut rng);
    }
    bytes.truncate(MAX_LENGTH);
    bytes
}

fn damage(bytes: &mut Vec<u8>, files: &[Vec<u8>], rng: &mut ChaCha8Rng) {
    let length = bytes.len();
    // Headers are where it matters: half of all damage is done to the first or the last 300 bytes.
    let at = match rng.random_range(0..4) {
        0 => rng.random_range(0..=length.min(300)),
        1 => length - rng.random_range(0..=length.min(300)),
        _ => rng.random_range(0..=length),
    };
    let end = (at + rng.random_range(0..=40)).min(length);
    match rng.random_range(0..8) {
        0 if at < length => bytes[at] ^= 1 << rng.random_range(0..8),
        1 if at < length => bytes[at] = rng.random(),
        2 => drop(bytes.drain(at..end)),
        3 => {
            let copy = bytes[at..end].to_vec();
            for _ in 0..rng.random_range(1..=30) {
                bytes.splice(at..at, copy.iter().copied());
            }
        }
        4 => bytes.truncate(at),
        5 => {
            let token = TOKENS.split(|byte| *byte == b' ').choose(rng).unwrap_or_default();
            let over = (at + token.len()).min(length);
            bytes.splice(at..over, token.iter().copied());
        }
        6 => {
            let number: u64 = [0, 1, 0x7f, 0xff, 0xffff, 0x7fff_ffff, 0xffff_ffff, u64::MAX][rng.random_range(0..8)];
            let width = [1, 2, 4, 8][rng.random_range(0..4)];
            for (byte, value) in bytes[at..].iter_mut().zip(number.to_le_bytes()).take(width) {
                *byte = value;
            }
        }
        _ => {
            let other = files.choose(rng).map_or(&[][..], Vec::as_slice);
            let from = rng.random_range(0..=other.len());
            let part = other[from..(from + 60).min(other.len())].to_vec();
            bytes.splice(at..end, part);
        }
    }
}
