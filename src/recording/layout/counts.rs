//! Samples and receivers of a file that no text describes, from the lengths of rows at whose beginnings samples don't follow from those before, from
//! the repeats of a row's spectrum, and from the number of rows after which rows are the same again.

use super::breaks::Breaks;
use super::marks::{HEADER_BYTES, Marks};
use super::period::{Period, period};
use super::spectrum::{Spectrum, correlation};
use super::stream::Stream;
use super::{Counts, Layout, Parts, ReceiverOrder, Words};
use ndarray::Array2;
use num_complex::Complex64;
use std::io::{self, Read, Seek};

/// Samples of a chirp that are tried.
const SAMPLES: [usize; 50] = [
    32, 40, 48, 50, 60, 64, 80, 90, 96, 100, 112, 120, 125, 128, 144, 150, 160, 180, 192, 200, 224, 225, 240, 250, 256,
    280, 288, 300, 320, 360, 384, 400, 448, 480, 500, 512, 600, 640, 720, 768, 800, 896, 960, 1000, 1024, 1200, 1280,
    1536, 2048, 4096,
];
/// Receivers that may stand sample by sample, the most first.
const INTERLEAVED: [usize; 5] = [16, 8, 4, 3, 2];
/// Least correlation of a row's logarithmic spectrum with itself turned, for receivers sample by sample.
const COMB: f64 = 0.6;
/// Least logarithm of a line over the middle of the spectrum, as a part of the strongest line's: in general, for strong lines and for clipped ones;
/// and least height of the strongest line over the middle, nepers of power.
const LINE: f64 = 0.3;
const STRONG_LINE: f64 = 0.6;
const CLIPPED_LINE: f64 = 0.75;
const STANDS_OUT: f64 = 3.0;
/// Receivers that radars usually have.
const USUAL_RECEIVERS: usize = 4;
/// Ratio of words at the ends of their type to words next to them above which a file is saturated.
const SATURATED: usize = 8;
/// Samples by which parts and the length of rows are judged.
const JUDGED_NUMBERS: usize = 1 << 16;
/// Lengths of rows by which the parts are judged.
const LEVEL_LENGTHS: [usize; 3] = [64, 128, 256];
/// Distances of the numbers that each is predicted from: receivers may stand sample by sample.
const STRIDES: [usize; 4] = [1, 3, 4, 16];
/// Longest row that is tried, in samples of all interleaved receivers together.
const LONGEST_ROW: usize = 16384;
/// Largest level of a likely order of parts above the lowest level, nepers in all of [`LEVEL_LENGTHS`].
const PLAUSIBLE: f64 = 0.5;
/// Log-odds below the best length from which a length is not looked at.
const LIKELY_LENGTH: f64 = 30.0;
/// Gain of another length over that of the `.cfg`'s above which the `.cfg` is doubted: of 120 right lengths none had more than 40.
const DOUBTED: f64 = 50.0;
/// Log-odds of a length that doesn't fill the file, and of a usual length.
const UNFILLED: f64 = -3.0;
const USUAL_LENGTH: f64 = 2.0;
/// Log-odds of the period that is almost as likely, and of fewer receivers with more transmitters in turn for as many rows.
const LESS_STEADY: f64 = -2.0;
const LESS_USUAL: f64 = -3.0;
/// Log-odds of a shorter row, or of fewer receivers sample by sample.
const LESS_BROKEN: f64 = -2.0;
const MOST_TRANSMITTERS: usize = 3;
/// Most loops that are taken for a frame where nothing says how many there are.
const MOST_LOOPS: usize = 64;

/// Note where no text says counts.
pub(super) const NOTE: &str = "No .cfg says samples and receivers: they are those that make the sharpest spectrum and repeat, which is right \
    for four captures of five. Carrier, slope and rate are not known: a bin of range is shown as one metre, and directions \
    are those of elements half a wavelength apart.";

/// Note where rows don't repeat.
const GUESSED_NOTE: &str =
    "No rows of samples are the same again: how many receivers and chirps of a loop there are is a guess.";

/// Note where all rows are the same.
const ALIKE_NOTE: &str = "All rows of samples are alike, as of one receiver, or of echoes straight ahead of several: how many receivers and \
    chirps of a loop there are is a guess.";

/// Note where saturation makes the search unsure.
pub(super) const CLIPPED_NOTE: &str = "Many samples stand at the ends of their type, so echoes have harmonics that look like receivers and rows: \
    samples and receivers may be others.";

pub(super) struct LikelyCounts {
    /// The order of parts that they are counts of; `None` where any may be.
    pub parts: Option<Parts>,
    pub counts: Counts,
    /// Note on the reason where receivers and chirps are a guess.
    pub guessed: Option<&'static str>,
    /// Log-odds of the rows that repeat, and of the number of receivers.
    pub odds: [f64; 2],
}

/// One way to cut the numbers into rows.
#[derive(Clone, Copy)]
struct Cut {
    layout: Layout,
    samples: usize,
    /// Receivers that stand sample by sample; 1 where they stand one after another.
    mixed: usize,
}

/// Searches the lengths of rows: of the orders of parts that make the sharpest spectra, the lengths at whose multiples samples don't follow
/// from those before, and which fill the file. Also whether the samples are clipped.
pub(super) fn search<R: Read + Seek>(
    stream: &mut Stream<R>,
    marks: Option<Marks>,
) -> io::Result<(Vec<LikelyCounts>, bool)> {
    let bytes = samples_of(stream, marks, 4 * JUDGED_NUMBERS)?;
    let marked = marks.filter(|m| m.apart > 0).map(|m| m.apart - HEADER_BYTES);
    let words = likely_words(&bytes);
    let mut all = Vec::new();
    for parts in Parts::ALL {
        let layout = layout(words, parts);
        let count = bytes.len() / parts.bytes();
        let numbers = layout.numbers(&bytes, count.min(JUDGED_NUMBERS));
        if let Some(level) = level(&numbers, parts == Parts::Real) {
            all.push((level, layout, numbers));
        }
    }
    let sharpest = all.iter().map(|(level, ..)| *level).fold(f64::INFINITY, f64::min);
    let (mut ways, mut is_clipped) = (Vec::new(), false);
    for (_, layout, numbers) in all.into_iter().filter(|(level, ..)| *level < sharpest + PLAUSIBLE) {
        for (cut, others) in cuts(layout, &numbers, stream.bytes(), marked) {
            is_clipped |= clipped(&numbers);
            ways.extend(counted(&cut, &numbers, stream.bytes(), marks, marked));
            for other in others {
                let likeliest = counted(&other, &numbers, stream.bytes(), marks, marked).into_iter().next();
                ways.extend(likeliest.map(|way| LikelyCounts { odds: [LESS_BROKEN, 0.0], ..way }));
            }
        }
    }
    Ok((ways, is_clipped))
}

/// The likely ways to cut numbers into rows, each with others that are almost as likely.
fn cuts(layout: Layout, numbers: &[Complex64], bytes: u64, marked: Option<usize>) -> Vec<(Cut, Vec<Cut>)> {
    let fits = |length: &usize| marked.is_none_or(|held| held.is_multiple_of(length * layout.parts.bytes()));
    let lengths: Vec<usize> = (SAMPLES[0]..=LONGEST_ROW).filter(fits).collect();
    let likeliest = |stride: usize| {
        let breaks = Breaks::of(numbers, stride);
        let score = |length: &usize| (breaks.gain(*length) + prior(&layout, *length, bytes), *length);
        let best = lengths.iter().map(score).max_by(|a, b| a.0.total_cmp(&b.0));
        best.map(|(score, length)| (score, breaks, length))
    };
    let all: Vec<(f64, Breaks, usize)> = STRIDES.into_iter().filter_map(likeliest).collect();
    let best = all.iter().map(|(score, ..)| *score).fold(f64::NEG_INFINITY, f64::max);
    let mut cuts: Vec<(Cut, Vec<Cut>)> = Vec::new();
    for (_, breaks, longest) in all.iter().filter(|(score, ..)| *score > best - LIKELY_LENGTH) {
        let whole = breaks.whole(*longest, &lengths);
        let mixed = interleaved(numbers, whole);
        let lengths: Vec<usize> = lengths.iter().copied().filter(|length| length.is_multiple_of(mixed)).collect();
        let length = if clipped(numbers) { whole } else { breaks.divided(whole, &lengths) };
        let cut = Cut { layout, samples: length / mixed, mixed };
        if cuts.iter().any(|(c, _)| (c.samples, c.mixed) == (cut.samples, cut.mixed)) {
            continue;
        }
        let shorter = breaks.almost_divided(length, &lengths).map(|length| Cut { samples: length / mixed, ..cut });
        let fewer = (mixed > 1 && !is_comb(numbers, &cut)).then(|| {
            let by = if mixed.is_multiple_of(2) { 2 } else { mixed };
            Cut { samples: cut.samples * by, mixed: mixed / by, ..cut }
        });
        cuts.push((cut, shorter.into_iter().chain(fewer).collect()));
    }
    cuts
}

/// Log-odds of a length before its numbers are looked at: some lengths are usual, and the right one fills the file. A length with an odd part fills
/// it by chance once in that part.
fn prior(layout: &Layout, length: usize, bytes: u64) -> f64 {
    let odd = (length >> length.trailing_zeros()) as f64;
    let fills = if bytes.is_multiple_of((length * layout.parts.bytes()) as u64) { odd.ln() } else { UNFILLED };
    let is_usual = SAMPLES.contains(&length)
        || INTERLEAVED.iter().any(|r| length.is_multiple_of(*r) && SAMPLES.contains(&(length / r)));
    fills + if is_usual { USUAL_LENGTH } else { 0.0 }
}

/// Sum of the levels of the spectra of rows of a few lengths. Rows of real numbers are twice as long and hold as much. `None` where there are too few
/// numbers.
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

/// Logarithmic spectrum of rows of one length.
fn logs(numbers: &[Complex64], length: usize) -> Vec<f64> {
    Spectrum::of(&rows(numbers, length, 1), 1).power.iter().map(|p| p.ln()).collect()
}

/// The middle line of a logarithmic spectrum, and the height of the strongest above it.
fn middle_and_height(logs: &[f64]) -> (f64, f64) {
    let mut sorted = logs.to_vec();
    sorted.sort_by(f64::total_cmp);
    let middle = sorted[logs.len() / 2];
    (middle, sorted[logs.len() - 1] - middle)
}

/// Number of receivers that stand sample by sample in rows of this length: the spectrum repeats as often.
fn interleaved(numbers: &[Complex64], length: usize) -> usize {
    let logs = logs(numbers, length);
    let is_clipped = clipped(numbers);
    let repeats = |receivers: &usize| {
        let shift = length / receivers;
        length.is_multiple_of(*receivers)
            && shift >= SAMPLES[0]
            && match is_clipped {
                // Harmonics of a clipped echo stand at even distances too, but none as high as the echo.
                true => peaks_repeat(&logs, shift, CLIPPED_LINE),
                false => repeats_alike(&logs, shift) > COMB || peaks_repeat(&logs, shift, LINE),
            }
    };
    INTERLEAVED.into_iter().find(repeats).unwrap_or(1)
}

/// Whether receivers surely stand sample by sample: the spectrum has two echoes or more that repeat at the distances of the receivers. A single
/// echo may repeat by chance.
fn is_comb(numbers: &[Complex64], cut: &Cut) -> bool {
    let logs = logs(numbers, cut.samples * cut.mixed);
    let (bins, places) = (logs.len(), cut.mixed - 1);
    let (middle, height) = middle_and_height(&logs);
    let around = |bin: usize| (bin + bins - 1..=bin + bins + 1).map(|n| logs[n % bins]).fold(f64::MIN, f64::max);
    let tops = (0..bins).filter(|n| logs[*n] - middle > STRONG_LINE * height && logs[*n] >= around(*n));
    let repeats = |bin: &usize| {
        let stands = |n: &usize| around(bin + n * cut.samples) - middle > LINE * height;
        (1..=places).filter(stands).count() * 5 >= places * 4
    };
    let (combs, alone): (Vec<usize>, Vec<usize>) = tops.partition(repeats);
    let mut residues: Vec<usize> = combs.into_iter().map(|bin| bin % cut.samples).collect();
    residues.sort_unstable();
    alone.is_empty() && residues.windows(2).any(|pair| pair[1] - pair[0] > 2)
}

/// Whether many parts stand at the ends of the numbers' type.
fn clipped(numbers: &[Complex64]) -> bool {
    let end = f64::from(i16::MAX);
    let at_end = numbers.iter().filter(|v| v.re.abs() >= end || v.im.abs() >= end).count();
    at_end * 100 > numbers.len()
}

/// Correlation of a spectrum with itself, turned.
fn repeats_alike(logs: &[f64], shift: usize) -> f64 {
    correlation(logs.iter().copied(), logs.iter().cycle().skip(shift).take(logs.len()).copied())
}

/// Whether the strongest echo stands at every shift too, over a floor that fills the rest.
fn peaks_repeat(logs: &[f64], shift: usize, least: f64) -> bool {
    let (middle, height) = middle_and_height(logs);
    let strongest = (0..logs.len()).max_by(|a, b| logs[*a].total_cmp(&logs[*b])).unwrap_or(0);
    let places = logs.len() / shift - 1;
    let stands = |n: &usize| logs[(strongest + n * shift) % logs.len()] - middle > least * height;
    height > STANDS_OUT && (1..=places).filter(stands).count() * 5 >= places * 4
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

/// The words that change least from one to the next of the same kind: those of a wrong encoding jump.
fn likely_words(bytes: &[u8]) -> Words {
    let words = || bytes.chunks_exact(2).map(|b| u16::from_le_bytes([b[0], b[1]]));
    // With bit 15 flipped, saturated samples would be the smallest; the samples next to them tell them from small ones.
    let count = |of: [u16; 2]| words().filter(|w| of.contains(w)).count();
    let is_saturated = count([0x7fff, 0x8000]) > SATURATED * count([0x7ffe, 0x8001]).max(1);
    let power = |of: Words| {
        let counts = move |b: &&[u8]| !is_saturated || ![[0xff, 0x7f], [0x00, 0x80]].contains(&[b[0], b[1]]);
        let numbers = || bytes.chunks_exact(2).filter(counts).map(move |b| f64::from(of.number([b[0], b[1]])));
        let count = numbers().count().max(1) as f64;
        let mean = numbers().sum::<f64>() / count;
        numbers().map(|v| (v - mean).powi(2)).sum::<f64>() / count
    };
    let [plain, offset, swapped, twelve] =
        [Words::Int16, Words::OffsetBinary, Words::BigEndian, Words::TwelveBits].map(power);
    if words().all(|w| w < 0x1000) && twelve < 0.5 * plain {
        Words::TwelveBits
    } else if offset < 0.5 * plain && offset <= swapped {
        Words::OffsetBinary
    } else if swapped < 0.5 * plain {
        Words::BigEndian
    } else {
        Words::Int16
    }
}

/// A doubt about the counts of a `.cfg`, where the samples of `bytes` begin anew at other distances or their rows repeat after another number.
/// `bytes` are whole chirps of a file of `of_file` bytes.
pub(super) fn doubted(layout: &Layout, counts: Counts, bytes: &[u8], of_file: u64) -> Option<String> {
    let stride = if layout.receivers == ReceiverOrder::Interleaved { counts.receivers } else { 1 };
    let said = counts.samples * stride;
    let most = (JUDGED_NUMBERS / 2).max(4 * said);
    let numbers = layout.numbers(bytes, (bytes.len() / layout.parts.bytes()).min(most));
    let longest = numbers.len() / 3;
    let breaks = Breaks::of(&numbers, stride);
    let gain = |length: &usize| breaks.gain(*length);
    let best = (SAMPLES[0]..=longest).max_by(|a, b| gain(a).total_cmp(&gain(b)))?;
    let is_other = said <= longest && gain(&best) > gain(&said) + DOUBTED;
    // An echo may go on almost unbroken from receiver to receiver.
    let is_part = best.is_multiple_of(said) && breaks.whole(said, &[best]) == said;
    if is_other && !is_part {
        return Some(format!(
            "By the .cfg the samples of a chirp begin anew every {said} numbers, but they do so every {best}: it may be the .cfg of another \
             capture."
        ));
    }
    let cut = Cut { layout: *layout, samples: counts.samples, mixed: 1 };
    let said = counts.receivers * counts.chirps;
    let row_bytes = (counts.samples * layout.parts.bytes()) as u64;
    let fills = |rows: usize| of_file.is_multiple_of(rows as u64 * row_bytes);
    let judged = stride == 1 && layout.header_bytes == 0 && !fills(said);
    let found = judged.then(|| period_of(&cut, &numbers)).flatten()?.rows;
    (found != said && fills(found)).then(|| {
        format!(
            "By the .cfg a loop has {said} rows of samples, which don't fill the file, but rows are the same again after {found}, which do: it \
             may be the .cfg of another capture."
        )
    })
}

/// The numbers as rows of `samples`, of `mixed` receivers sample by sample.
fn rows(numbers: &[Complex64], samples: usize, mixed: usize) -> Array2<Complex64> {
    let block = samples * mixed;
    let count = numbers.len() / block * mixed;
    Array2::from_shape_fn((count, samples), |(row, s)| numbers[row / mixed * block + s * mixed + row % mixed])
}

fn period_of(cut: &Cut, numbers: &[Complex64]) -> Option<Period> {
    let is_real = cut.layout.parts == Parts::Real || numbers.iter().all(|v| v.im == 0.0);
    period(&rows(numbers, cut.samples, cut.mixed), cut.mixed, is_real)
}

/// Counts of receivers, chirps and loops for a cut, the likeliest first. They follow from the period of its rows and from the length of the file.
fn counted(
    cut: &Cut,
    numbers: &[Complex64],
    bytes: u64,
    marks: Option<Marks>,
    marked: Option<usize>,
) -> Vec<LikelyCounts> {
    let row_bytes = cut.samples * cut.layout.parts.bytes();
    let found = period_of(cut, numbers);
    let rows = found.as_ref().map_or(USUAL_RECEIVERS.min((numbers.len() / cut.samples).max(1)), |found| found.rows);
    let guessed = match found {
        None => Some(GUESSED_NOTE),
        Some(Period { next: Some(1), .. }) => Some(ALIKE_NOTE),
        Some(_) => None,
    };
    let usual = |rows: usize| match (marked, cut.mixed) {
        (Some(held), _) => (held / row_bytes).max(1),
        (None, 1) => [4, 3, 2].into_iter().find(|receivers| rows.is_multiple_of(*receivers)).unwrap_or(rows),
        (None, mixed) => mixed,
    };
    let of = |rows: usize, receivers: usize, odds: [f64; 2]| {
        // Lanes carry whole groups of parts.
        let group = cut.layout.parts.group();
        let fits = |more: &usize| (cut.samples * receivers * more).is_multiple_of(group);
        let receivers = receivers * [1, 2, 4].into_iter().find(fits).unwrap_or(1);
        let chirps = (rows / receivers).max(1);
        let header = if marks.is_some() { HEADER_BYTES as u64 } else { 0 };
        let loop_bytes = chirps as u64 * ((receivers * row_bytes) as u64 + header);
        let all = (bytes / loop_bytes.max(1)).max(1);
        let loops = (1..=MOST_LOOPS as u64).rev().find(|loops| all.is_multiple_of(*loops)).unwrap_or(1);
        // A count with few divisors is no reason to look at fewer loops.
        let loops = if loops < all.min(8) { all.min(MOST_LOOPS as u64) } else { loops };
        let counts = Counts { samples: cut.samples, receivers, chirps, loops: loops as usize };
        LikelyCounts { parts: Some(cut.layout.parts), counts, guessed, odds }
    };
    let mut all = vec![of(rows, usual(rows), [0.0; 2])];
    let is_open = marked.is_none() && cut.mixed == 1 && guessed.is_none();
    let others = [3, 2, 1].into_iter().filter(|n| is_open && rows.is_multiple_of(*n) && *n < usual(rows));
    let others = others.filter(|n| rows / n <= MOST_TRANSMITTERS);
    all.extend(others.map(|receivers| of(rows, receivers, [0.0, LESS_USUAL])));
    let next = found.and_then(|found| found.next).filter(|next| *next > 1);
    all.extend(next.map(|next| of(next, usual(next), [LESS_STEADY, 0.0])));
    all
}
