//! Samples and receivers of a file that no text describes: the length of rows that makes the sharpest spectrum, and after how many rows
//! they repeat.

use super::marks::{HEADER_BYTES, Marks};
use super::spectrum::{Spectrum, correlation};
use super::stream::Stream;
use super::{Counts, Layout, Parts, ReceiverOrder, Words, decode};
use ndarray::{Array2, ArrayView1, s};
use num_complex::Complex64;
use std::io::{self, Read, Seek};

/// Numbers before it that each is predicted from.
const ORDER: usize = 12;
/// Samples of a chirp that are tried.
const SAMPLES: [usize; 50] = [
    32, 40, 48, 50, 60, 64, 80, 90, 96, 100, 112, 120, 125, 128, 144, 150, 160, 180, 192, 200, 224, 225, 240, 250, 256,
    280, 288, 300, 320, 360, 384, 400, 448, 480, 500, 512, 600, 640, 720, 768, 800, 896, 960, 1000, 1024, 1200, 1280,
    1536, 2048, 4096,
];
/// Receivers that may stand sample by sample, the most first.
const INTERLEAVED: [usize; 5] = [16, 8, 4, 3, 2];
/// Rows of receivers sample by sample repeat their spectrum so much alike, as a correlation of logarithms.
const COMB: f64 = 0.6;
/// Receivers that radars usually have.
const USUAL_RECEIVERS: usize = 4;
/// Samples by which parts and the length of rows are judged.
const JUDGED_NUMBERS: usize = 1 << 15;
/// Lengths of rows by which the parts are judged.
const LEVEL_LENGTHS: [usize; 3] = [64, 128, 256];
/// A shorter length divides a longer one where so much more of its other beginnings does not follow.
const DIVIDES: f64 = 1.4;
/// Rows after which rows may repeat.
const LONGEST_PERIOD: usize = 64;
/// Rows are the same again where they are so much alike, as a part of the most alike; and at least so much.
const REPEATS: f64 = 0.9;
const LEAST_ALIKE: f64 = 0.3;
/// Most loops that are taken for a frame where nothing says how many there are.
const MOST_LOOPS: usize = 64;

/// Counts that were found.
pub(super) struct Searched {
    pub counts: Vec<Counts>,
    pub note: Option<String>,
}

/// One way to cut the numbers into rows.
#[derive(Clone, Copy)]
struct Cut {
    layout: Layout,
    samples: usize,
    /// Receivers that stand sample by sample; 1 where they stand one after another.
    mixed: usize,
}

/// Searches the lengths of rows: the order of parts that makes the sharpest spectra, and then the length at whose multiples samples don't
/// follow from those before.
pub(super) fn search<R: Read + Seek>(stream: &mut Stream<R>, marks: Option<Marks>) -> io::Result<Searched> {
    let bytes = samples_of(stream, marks, 4 * JUDGED_NUMBERS)?;
    let marked = marks.filter(|m| m.apart > 0).map(|m| m.apart - HEADER_BYTES);
    let words = likely_words(&bytes);
    let numbers = |layout: &Layout| {
        let count = bytes.len() / layout.parts.bytes();
        decode::numbers(layout, &bytes, count.min(JUDGED_NUMBERS))
    };
    let levels = Parts::ALL.into_iter().filter_map(|parts| {
        let layout = layout(words, parts);
        Some((level(&numbers(&layout), parts == Parts::Real)?, layout))
    });
    let Some((_, layout)) = levels.min_by(|a, b| a.0.total_cmp(&b.0)) else {
        return Ok(Searched { counts: Vec::new(), note: None });
    };
    let numbers = numbers(&layout);
    let residual = residual(&numbers);
    let fits = |length: &usize| marked.is_none_or(|held| held.is_multiple_of(length * layout.parts.bytes()));
    let lengths: Vec<usize> = SAMPLES.into_iter().flat_map(|samples| [samples, 4 * samples]).filter(fits).collect();
    let broken = lengths.iter().map(|length| (broken(&residual, *length), *length));
    let longest = broken.max_by(|a, b| a.0.total_cmp(&b.0)).map_or(SAMPLES[0], |(_, length)| length);
    let length = divided(&residual, longest, &lengths);
    let mixed = interleaved(&numbers, length);
    let cut = Cut { layout, samples: length / mixed, mixed };
    let note = Some(
        "No .cfg says samples and receivers: they are those that make the sharpest spectrum and repeat. Carrier, slope and rate are not \
         known: a bin of range is shown as one metre, and directions are those of elements half a wavelength apart."
            .to_owned(),
    );
    Ok(Searched { counts: vec![counted(&cut, &numbers, stream.bytes(), marks, marked)], note })
}

/// How low the spectra of rows of a few lengths lie, all together; real numbers in rows of twice as many, which hold as much. `None` where
/// they are too few.
fn level(numbers: &[Complex64], is_real: bool) -> Option<f64> {
    let mut sum = 0.0;
    for length in LEVEL_LENGTHS {
        let length = if is_real { 2 * length } else { length };
        if numbers.len() < 2 * length {
            break;
        }
        let spectrum = Spectrum::of(&rows(numbers, length, 1), 1);
        sum += if is_real { spectrum.of_real().level } else { spectrum.level };
    }
    (numbers.len() >= 4 * LEVEL_LENGTHS[0]).then_some(sum)
}

/// The length of rows of which `longest` is several: where an echo goes on almost unbroken from receiver to receiver, most of what does not
/// follow stands at the beginnings of loops.
fn divided(residual: &[f64], longest: usize, lengths: &[usize]) -> usize {
    let mut length = longest;
    loop {
        let shorter = lengths.iter().copied().filter(|l| *l < length && length.is_multiple_of(*l));
        let within = shorter.map(|l| (broken_within(residual, l, length), l));
        match within.max_by(|a, b| a.0.total_cmp(&b.0)) {
            Some((ratio, shorter)) if ratio > DIVIDES => length = shorter,
            _ => return length,
        }
    }
}

/// How much of each number does not follow from the [`ORDER`] before it, as a power: linear prediction by least squares.
fn residual(numbers: &[Complex64]) -> Vec<f64> {
    let mean = numbers.iter().sum::<Complex64>() / numbers.len().max(1) as f64;
    let centred: Vec<Complex64> = numbers.iter().map(|v| v - mean).collect();
    let mut normal = [[Complex64::default(); ORDER + 1]; ORDER];
    for window in centred.windows(ORDER + 1) {
        for (row, a) in normal.iter_mut().zip(window) {
            row.iter_mut().zip(window).for_each(|(sum, b)| *sum += a.conj() * b);
        }
    }
    let ridge = 1e-6 * (0..ORDER).map(|n| normal[n][n].re).sum::<f64>() / ORDER as f64;
    (0..ORDER).for_each(|n| normal[n][n] += ridge.max(f64::MIN_POSITIVE));
    let weights = solved(normal);
    let predicted = |before: &[Complex64]| before.iter().zip(weights).map(|(v, w)| v * w).sum::<Complex64>();
    let errors = centred.windows(ORDER + 1).map(|window| (window[ORDER] - predicted(&window[..ORDER])).norm_sqr());
    std::iter::repeat_n(0.0, ORDER.min(centred.len())).chain(errors).collect()
}

/// The solution of a positive definite system whose right side stands in its last column.
fn solved(mut system: [[Complex64; ORDER + 1]; ORDER]) -> [Complex64; ORDER] {
    for pivot in 0..ORDER {
        let top = system[pivot];
        for (_, row) in system.iter_mut().enumerate().filter(|(n, _)| *n != pivot) {
            let factor = row[pivot] / top[pivot];
            row.iter_mut().zip(top).for_each(|(v, t)| *v -= factor * t);
        }
    }
    std::array::from_fn(|n| system[n][ORDER] / system[n][n])
}

/// How much less the first numbers of rows of this length follow from those before them than all others.
fn broken(residual: &[f64], length: usize) -> f64 {
    broken_at(residual, length, |_| true)
}

/// The same of those rows of this length that don't begin where longer ones do.
fn broken_within(residual: &[f64], length: usize, longer: usize) -> f64 {
    broken_at(residual, length, |row| !row.is_multiple_of(longer / length))
}

fn broken_at(residual: &[f64], length: usize, counts: impl Fn(usize) -> bool) -> f64 {
    if residual.len() < 3 * length || length <= 2 * ORDER {
        return 0.0;
    }
    let (mut first, mut other) = ((0.0, 0.0), (0.0, 0.0));
    for (n, row) in residual.chunks_exact(length).enumerate().skip(1) {
        if counts(n) {
            first = (first.0 + row[..ORDER].iter().sum::<f64>(), first.1 + ORDER as f64);
        }
        other = (other.0 + row[ORDER..].iter().sum::<f64>(), other.1 + (length - ORDER) as f64);
    }
    let mean = |(sum, count): (f64, f64)| sum / f64::max(count, 1.0);
    // Rounding alone leaves as much.
    mean(first) / (mean(other) + 0.2)
}

/// How many receivers stand sample by sample in rows of this length: their spectrum repeats as often.
fn interleaved(numbers: &[Complex64], length: usize) -> usize {
    let power = Spectrum::of(&rows(numbers, length, 1), 1).power;
    let logs: Vec<f64> = power.iter().map(|p| p.ln()).collect();
    let repeats = |receivers: &usize| {
        let shift = length / receivers;
        let turned = logs.iter().cycle().skip(shift).take(length).copied();
        length.is_multiple_of(*receivers) && shift >= SAMPLES[0] && correlation(logs.iter().copied(), turned) > COMB
    };
    INTERLEAVED.into_iter().find(repeats).unwrap_or(1)
}

fn layout(words: Words, parts: Parts) -> Layout {
    Layout { words, parts, q_first: false, receivers: ReceiverOrder::OneAfterAnother, header_bytes: 0, packets: false }
}

/// The first bytes that are samples: headers are left out.
fn samples_of<R: Read + Seek>(stream: &mut Stream<R>, marks: Option<Marks>, most: usize) -> io::Result<Vec<u8>> {
    let mut bytes = vec![0; stream.bytes().min(most as u64 + (most / 8) as u64) as usize];
    stream.read_at(0, &mut bytes)?;
    if let Some(Marks { apart, .. }) = marks.filter(|m| m.apart > HEADER_BYTES) {
        bytes = bytes.chunks(apart).filter_map(|chirp| chirp.get(HEADER_BYTES..)).flatten().copied().collect();
    } else if marks.is_some() {
        bytes.drain(..HEADER_BYTES.min(bytes.len()));
    }
    bytes.truncate(most);
    Ok(bytes)
}

/// The words that change least from one to the next of the same kind: wrong ones jump.
fn likely_words(bytes: &[u8]) -> Words {
    let words = || bytes.chunks_exact(2).map(|b| u16::from_le_bytes([b[0], b[1]]));
    if words().all(|w| w < 0x1000) && words().any(|w| w >= 0x0800) {
        return Words::TwelveBits;
    }
    let power = |of: Words| {
        let numbers = || bytes.chunks_exact(2).map(move |b| f64::from(of.number([b[0], b[1]])));
        let count = numbers().count().max(1) as f64;
        let mean = numbers().sum::<f64>() / count;
        numbers().map(|v| (v - mean).powi(2)).sum::<f64>() / count
    };
    let [plain, offset, swapped] = [Words::Int16, Words::OffsetBinary, Words::BigEndian].map(power);
    if offset < 0.5 * plain && offset <= swapped {
        Words::OffsetBinary
    } else if swapped < 0.5 * plain {
        Words::BigEndian
    } else {
        Words::Int16
    }
}

/// The numbers as rows of `samples`, of `mixed` receivers sample by sample.
fn rows(numbers: &[Complex64], samples: usize, mixed: usize) -> Array2<Complex64> {
    let block = samples * mixed;
    let count = numbers.len() / block * mixed;
    Array2::from_shape_fn((count, samples), |(row, s)| numbers[row / mixed * block + s * mixed + row % mixed])
}

/// The counts that follow from a cut: after how many rows they repeat, and how many fill the file.
fn counted(cut: &Cut, numbers: &[Complex64], bytes: u64, marks: Option<Marks>, marked: Option<usize>) -> Counts {
    let rows = rows(numbers, cut.samples, cut.mixed);
    let row_bytes = cut.samples * cut.layout.parts.bytes();
    let period = period(&rows);
    let receivers = match (marked, cut.mixed) {
        (Some(held), _) => (held / row_bytes).max(1),
        (None, 1) if period.is_multiple_of(USUAL_RECEIVERS) => USUAL_RECEIVERS,
        (None, 1) if period > 4 && period.is_multiple_of(2) => 2,
        (None, 1) => period,
        (None, mixed) => mixed,
    };
    let chirps = (period / receivers).max(1);
    let header = if marks.is_some() { HEADER_BYTES as u64 } else { 0 };
    let loop_bytes = chirps as u64 * ((receivers * row_bytes) as u64 + header);
    let all = (bytes / loop_bytes.max(1)).max(1);
    let loops = (1..=MOST_LOOPS as u64).rev().find(|loops| all.is_multiple_of(*loops)).unwrap_or(1);
    // A count with few divisors is no reason to look at fewer loops.
    let loops = if loops < all.min(8) { all.min(MOST_LOOPS as u64) } else { loops };
    Counts { samples: cut.samples, receivers, chirps, loops: loops as usize }
}

/// After how many rows they are the same again; that of the usual receivers where all are alike or none is.
fn period(rows: &Array2<Complex64>) -> usize {
    let mut centred = rows.slice(s![..rows.nrows().min(4 * LONGEST_PERIOD), ..]).to_owned();
    for mut row in centred.outer_iter_mut() {
        let mean = row.sum() / row.len().max(1) as f64;
        row.mapv_inplace(|v| v - mean);
    }
    let most = LONGEST_PERIOD.min(centred.nrows() / 2);
    let product = |a: ArrayView1<'_, Complex64>, b: ArrayView1<'_, Complex64>| -> f64 {
        a.iter().zip(b).map(|(a, b)| (a * b.conj()).re).sum()
    };
    let alike = |lag: usize| {
        let pairs = || (0..centred.nrows() - lag).map(|n| (centred.row(n), centred.row(n + lag)));
        let all: f64 = pairs().map(|(a, b)| (product(a, a) * product(b, b)).sqrt()).sum();
        if all > 0.0 { pairs().map(|(a, b)| product(a, b)).sum::<f64>() / all } else { 0.0 }
    };
    let alike: Vec<f64> = (1..=most).map(alike).collect();
    let best = alike.iter().copied().fold(0.0, f64::max);
    let first = alike.iter().position(|v| *v >= REPEATS * best).map(|n| n + 1);
    first.filter(|lag| best >= LEAST_ALIKE && *lag > 1).unwrap_or(USUAL_RECEIVERS.min(rows.nrows().max(1)))
}
