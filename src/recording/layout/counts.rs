//! Numbers of samples, receivers and chirps of a file without a text that says them.
//!
//! A *number* is a complex or real sample in the file's order. A *row* is the samples of one chirp at one receiver, or of all receivers where these
//! are interleaved sample by sample. Linear prediction fails at the beginning of each row, which gives its length ([`Breaks`]). The spectrum of a row
//! of interleaved receivers repeats once for each receiver, which gives their number. The number of rows after which rows are the same again
//! ([`period`]) is that of receivers and chirps in a loop.

use super::breaks::Breaks;
use super::marks::{HEADER_BYTES, Marks};
use super::period::{Period, period};
use super::spectrum::{Spectrum, correlation};
use super::stream::CaptureStream;
use super::{Counts, Layout, NumberEncoding, PartOrder, ReceiverOrder};
use ndarray::Array2;
use num_complex::Complex64;
use std::io::{self, Read, Seek};

/// Usual numbers of samples of a chirp.
const USUAL_SAMPLES: [usize; 50] = [
    32, 40, 48, 50, 60, 64, 80, 90, 96, 100, 112, 120, 125, 128, 144, 150, 160, 180, 192, 200, 224, 225, 240, 250, 256,
    280, 288, 300, 320, 360, 384, 400, 448, 480, 500, 512, 600, 640, 720, 768, 800, 896, 960, 1000, 1024, 1200, 1280,
    1536, 2048, 4096,
];
/// Numbers of receivers that may be interleaved sample by sample, the largest first.
const INTERLEAVED_RECEIVERS: [usize; 5] = [16, 8, 4, 3, 2];
/// Least correlation of a row's logarithmic spectrum with itself, shifted circularly, for interleaved receivers.
const MIN_COMB_CORRELATION: f64 = 0.6;
/// Least height of a spectral line above the median over the strongest line's: of any line, of a strong line, and of one in a clipped file.
const MIN_LINE_PART: f64 = 0.3;
const MIN_STRONG_LINE_PART: f64 = 0.6;
const MIN_CLIPPED_LINE_PART: f64 = 0.75;
/// Least height of the strongest line above the median, nepers of power.
const MIN_PEAK_HEIGHT_NEPERS: f64 = 3.0;
/// Number of receivers of most radars.
const USUAL_RECEIVERS: usize = 4;
/// Number of the file's first numbers from which the order of parts and the length of rows are found.
const SEARCHED_NUMBERS: usize = 1 << 16;
/// Lengths of rows whose spectra decide on the order of parts, in complex numbers.
const LEVEL_ROW_LENGTHS: [usize; 3] = [64, 128, 256];
/// Distances between the numbers from which linear prediction computes the next one: receivers may be interleaved.
const PREDICTION_STRIDES: [usize; 4] = [1, 3, 4, 16];
/// Longest row that is tried, in numbers of all interleaved receivers together.
const MAX_ROW_LENGTH: usize = 16384;
/// Largest level of a likely order of parts above the lowest level, nepers, summed over [`LEVEL_ROW_LENGTHS`].
const MAX_LEVEL_ABOVE_LOWEST_NEPERS: f64 = 0.5;
/// Largest log-odds of the best length over those of another length that is still tried.
const MAX_LENGTH_LOG_ODDS_BELOW_BEST: f64 = 30.0;
/// Log-odds of another length over those of the `.cfg`'s above which the `.cfg` is doubted. Of 120 right lengths none had more than 40.
const MIN_DOUBT_LOG_ODDS: f64 = 50.0;
/// Log-odds of a length of which the file doesn't hold a whole number of rows, and of a usual length.
const UNFILLED_LOG_ODDS: f64 = -3.0;
const USUAL_LENGTH_LOG_ODDS: f64 = 2.0;
/// Log-odds of the second most likely period.
const SECOND_PERIOD_LOG_ODDS: f64 = -2.0;
/// Log-odds of fewer receivers with more transmitters in turn, for as many rows.
const FEWER_RECEIVERS_LOG_ODDS: f64 = -3.0;
/// Log-odds of a shorter row, or of fewer interleaved receivers.
const OTHER_CUT_LOG_ODDS: f64 = -2.0;
/// Most transmitters in turn where fewer receivers are tried.
const MAX_TRANSMITTERS: usize = 3;
/// Most loops of a frame where no text says their number.
const MAX_LOOPS: usize = 64;

/// Note on a file without a text that says samples and receivers.
pub(super) const NOTE: &str = "No .cfg says samples and receivers: they are those that make the sharpest spectrum and repeat, which is right \
    for four captures of five. Carrier, slope and rate are not known: a bin of range is shown as one metre, and directions \
    are those of elements half a wavelength apart.";

/// Note on a file whose rows have no period.
const NO_PERIOD_NOTE: &str =
    "No rows of samples are the same again: how many receivers and chirps of a loop there are is a guess.";

/// Note on a file whose rows are all the same.
const EQUAL_ROWS_NOTE: &str = "All rows of samples are alike, as of one receiver, or of echoes straight ahead of several: how many receivers and \
    chirps of a loop there are is a guess.";

/// Note on a file whose samples are clipped, which makes the search uncertain.
pub(super) const CLIPPED_NOTE: &str = "Many samples stand at the ends of their type, so echoes have harmonics that look like receivers and rows: \
    samples and receivers may be others.";

/// Counts that a file may have, with their log-odds.
pub(super) struct LikelyCounts {
    /// The order of parts for which they were found; `None` where they hold for every order.
    pub part_order: Option<PartOrder>,
    pub counts: Counts,
    /// The note where receivers and chirps are a guess.
    pub guessed: Option<&'static str>,
    /// Log-odds of the cut or the period, and of the number of receivers.
    pub odds: [f64; 2],
}

/// A division of the file's numbers into rows.
#[derive(Clone, Copy)]
struct Cut {
    layout: Layout,
    /// Samples of a chirp at one receiver.
    samples: usize,
    /// Number of receivers interleaved sample by sample; 1 where the receivers come one after another.
    interleaved: usize,
}

/// Searches the lengths of rows, for the orders of parts with the sharpest spectra: the lengths at whose multiples linear prediction fails, and of
/// which the file holds a whole number. Also returns whether the samples are clipped.
pub(super) fn search<R: Read + Seek>(
    stream: &mut CaptureStream<R>,
    marks: Option<Marks>,
) -> io::Result<(Vec<LikelyCounts>, bool)> {
    let bytes = sample_bytes(stream, marks, 4 * SEARCHED_NUMBERS)?;
    let chirp_bytes = marks.filter(|m| m.apart > 0).map(|m| m.apart - HEADER_BYTES);
    let encoding = NumberEncoding::likely(&bytes);
    let mut all = Vec::new();
    for part_order in PartOrder::ALL {
        let layout = layout_of(encoding, part_order);
        let count = bytes.len() / part_order.bytes();
        let numbers = layout.numbers(&bytes, count.min(SEARCHED_NUMBERS));
        if let Some(level) = spectrum_level(&numbers, part_order == PartOrder::Real) {
            all.push((level, layout, numbers));
        }
    }
    let sharpest = all.iter().map(|(level, ..)| *level).fold(f64::INFINITY, f64::min);
    let (mut ways, mut is_clipped) = (Vec::new(), false);
    for (_, layout, numbers) in all.into_iter().filter(|(level, ..)| *level < sharpest + MAX_LEVEL_ABOVE_LOWEST_NEPERS)
    {
        for (cut, others) in cuts(layout, &numbers, stream.bytes(), chirp_bytes) {
            is_clipped |= are_clipped(&numbers);
            ways.extend(likely_counts(&cut, &numbers, stream.bytes(), marks, chirp_bytes));
            for other in others {
                let likeliest = likely_counts(&other, &numbers, stream.bytes(), marks, chirp_bytes).into_iter().next();
                ways.extend(likeliest.map(|way| LikelyCounts { odds: [OTHER_CUT_LOG_ODDS, 0.0], ..way }));
            }
        }
    }
    Ok((ways, is_clipped))
}

/// The likely cuts of the numbers into rows, each with others almost as likely. `chirp_bytes` are those of all receivers in a file with headers.
fn cuts(layout: Layout, numbers: &[Complex64], file_bytes: u64, chirp_bytes: Option<usize>) -> Vec<(Cut, Vec<Cut>)> {
    let fits =
        |length: &usize| chirp_bytes.is_none_or(|bytes| bytes.is_multiple_of(length * layout.part_order.bytes()));
    let lengths: Vec<usize> = (USUAL_SAMPLES[0]..=MAX_ROW_LENGTH).filter(fits).collect();
    let likeliest = |stride: usize| {
        let breaks = Breaks::of(numbers, stride);
        let score = |length: &usize| (breaks.gain(*length) + length_log_odds(&layout, *length, file_bytes), *length);
        let best = lengths.iter().map(score).max_by(|a, b| a.0.total_cmp(&b.0));
        best.map(|(score, length)| (score, breaks, length))
    };
    let all: Vec<(f64, Breaks, usize)> = PREDICTION_STRIDES.into_iter().filter_map(likeliest).collect();
    let best = all.iter().map(|(score, ..)| *score).fold(f64::NEG_INFINITY, f64::max);
    let mut cuts: Vec<(Cut, Vec<Cut>)> = Vec::new();
    for (_, breaks, longest) in all.iter().filter(|(score, ..)| *score > best - MAX_LENGTH_LOG_ODDS_BELOW_BEST) {
        let whole = breaks.whole(*longest, &lengths);
        let interleaved = interleaved_receivers(numbers, whole);
        let lengths: Vec<usize> = lengths.iter().copied().filter(|length| length.is_multiple_of(interleaved)).collect();
        let length = if are_clipped(numbers) { whole } else { breaks.divided(whole, &lengths) };
        let cut = Cut { layout, samples: length / interleaved, interleaved };
        if cuts.iter().any(|(c, _)| (c.samples, c.interleaved) == (cut.samples, cut.interleaved)) {
            continue;
        }
        let shorter =
            breaks.almost_divided(length, &lengths).map(|length| Cut { samples: length / interleaved, ..cut });
        let fewer = (interleaved > 1 && !is_comb(numbers, &cut)).then(|| {
            let by = if interleaved.is_multiple_of(2) { 2 } else { interleaved };
            Cut { samples: cut.samples * by, interleaved: interleaved / by, ..cut }
        });
        cuts.push((cut, shorter.into_iter().chain(fewer).collect()));
    }
    cuts
}

/// Log-odds of a row's length, without regard to the numbers: some lengths are usual, and the file holds a whole number of rows of the right length.
/// A length whose largest odd divisor is `n` fits by chance in one file of `n`.
fn length_log_odds(layout: &Layout, length: usize, file_bytes: u64) -> f64 {
    let odd = (length >> length.trailing_zeros()) as f64;
    let row_bytes = (length * layout.part_order.bytes()) as u64;
    let fills = if file_bytes.is_multiple_of(row_bytes) { odd.ln() } else { UNFILLED_LOG_ODDS };
    let is_usual = USUAL_SAMPLES.contains(&length)
        || INTERLEAVED_RECEIVERS.iter().any(|r| length.is_multiple_of(*r) && USUAL_SAMPLES.contains(&(length / r)));
    fills + if is_usual { USUAL_LENGTH_LOG_ODDS } else { 0.0 }
}

/// Mean logarithm of the spectrum's power, nepers, summed over [`LEVEL_ROW_LENGTHS`] (twice as long for real numbers); `None` for too few.
fn spectrum_level(numbers: &[Complex64], is_real: bool) -> Option<f64> {
    let mut sum = 0.0;
    for length in LEVEL_ROW_LENGTHS {
        let length = if is_real { 2 * length } else { length };
        if numbers.len() < 2 * length {
            break;
        }
        let spectrum = Spectrum::of(&rows(numbers, length, 1), 1);
        sum += if is_real { spectrum.of_real().level } else { spectrum.level };
    }
    (numbers.len() >= 4 * LEVEL_ROW_LENGTHS[0]).then_some(sum)
}

/// Natural logarithm of the mean power spectrum of rows of `length` numbers.
fn log_spectrum(numbers: &[Complex64], length: usize) -> Vec<f64> {
    Spectrum::of(&rows(numbers, length, 1), 1).power.iter().map(|p| p.ln()).collect()
}

/// The median of a logarithmic spectrum, and the height of the strongest line above it, nepers.
fn median_and_height(logs: &[f64]) -> (f64, f64) {
    let mut sorted = logs.to_vec();
    sorted.sort_by(f64::total_cmp);
    let median = sorted[logs.len() / 2];
    (median, sorted[logs.len() - 1] - median)
}

/// Number of receivers that are interleaved in rows of `length` numbers: the spectrum repeats as many times.
fn interleaved_receivers(numbers: &[Complex64], length: usize) -> usize {
    let logs = log_spectrum(numbers, length);
    let is_clipped = are_clipped(numbers);
    let repeats = |receivers: &usize| {
        let shift = length / receivers;
        length.is_multiple_of(*receivers)
            && shift >= USUAL_SAMPLES[0]
            && match is_clipped {
                // Harmonics of a clipped echo are equally spaced too, but all are lower than the echo.
                true => peaks_repeat(&logs, shift, MIN_CLIPPED_LINE_PART),
                false => {
                    shifted_correlation(&logs, shift) > MIN_COMB_CORRELATION
                        || peaks_repeat(&logs, shift, MIN_LINE_PART)
                }
            }
    };
    INTERLEAVED_RECEIVERS.into_iter().find(repeats).unwrap_or(1)
}

/// Whether receivers are interleaved beyond doubt: all strong echoes, two or more, repeat once for each receiver. One may repeat by chance.
fn is_comb(numbers: &[Complex64], cut: &Cut) -> bool {
    let logs = log_spectrum(numbers, cut.samples * cut.interleaved);
    let (bins, places) = (logs.len(), cut.interleaved - 1);
    let (median, height) = median_and_height(&logs);
    let around = |bin: usize| (bin + bins - 1..=bin + bins + 1).map(|n| logs[n % bins]).fold(f64::MIN, f64::max);
    let tops = (0..bins).filter(|n| logs[*n] - median > MIN_STRONG_LINE_PART * height && logs[*n] >= around(*n));
    let repeats = |bin: &usize| {
        let stands = |n: &usize| around(bin + n * cut.samples) - median > MIN_LINE_PART * height;
        (1..=places).filter(stands).count() * 5 >= places * 4
    };
    let (combs, alone): (Vec<usize>, Vec<usize>) = tops.partition(repeats);
    let mut residues: Vec<usize> = combs.into_iter().map(|bin| bin % cut.samples).collect();
    residues.sort_unstable();
    alone.is_empty() && residues.windows(2).any(|pair| pair[1] - pair[0] > 2)
}

/// Whether more than one number in 100 has a real or imaginary part at the limits of 16 bits.
fn are_clipped(numbers: &[Complex64]) -> bool {
    let end = f64::from(i16::MAX);
    let at_end = numbers.iter().filter(|v| v.re.abs() >= end || v.im.abs() >= end).count();
    at_end * 100 > numbers.len()
}

/// Correlation of a logarithmic spectrum with itself, shifted circularly by `shift` bins, -1 to 1.
fn shifted_correlation(logs: &[f64], shift: usize) -> f64 {
    correlation(logs.iter().copied(), logs.iter().cycle().skip(shift).take(logs.len()).copied())
}

/// Whether the strongest line repeats, with the part `least` of its height above the median, at four in five multiples of `shift` bins or more.
fn peaks_repeat(logs: &[f64], shift: usize, least: f64) -> bool {
    let (median, height) = median_and_height(logs);
    let strongest = (0..logs.len()).max_by(|a, b| logs[*a].total_cmp(&logs[*b])).unwrap_or(0);
    let places = logs.len() / shift - 1;
    let stands = |n: &usize| logs[(strongest + n * shift) % logs.len()] - median > least * height;
    height > MIN_PEAK_HEIGHT_NEPERS && (1..=places).filter(stands).count() * 5 >= places * 4
}

/// The layout of these encodings without headers, receivers one after another.
fn layout_of(encoding: NumberEncoding, part_order: PartOrder) -> Layout {
    Layout {
        encoding,
        part_order,
        q_first: false,
        receivers: ReceiverOrder::OneAfterAnother,
        header_bytes: 0,
        packets: false,
    }
}

/// The first `most` bytes of the samples, without headers.
fn sample_bytes<R: Read + Seek>(
    stream: &mut CaptureStream<R>,
    marks: Option<Marks>,
    most: usize,
) -> io::Result<Vec<u8>> {
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

/// A sentence of doubt about the counts of a `.cfg`, `None` where they are right: the rows of `bytes` have another length by linear prediction, or
/// another period. `bytes` are whole chirps of a file of `file_bytes` bytes.
pub(super) fn doubted(layout: &Layout, counts: Counts, bytes: &[u8], file_bytes: u64) -> Option<String> {
    let stride = if layout.receivers == ReceiverOrder::Interleaved { counts.receivers } else { 1 };
    let cfg_length = counts.samples * stride;
    let most = (SEARCHED_NUMBERS / 2).max(4 * cfg_length);
    let numbers = layout.numbers(bytes, (bytes.len() / layout.part_order.bytes()).min(most));
    let longest = numbers.len() / 3;
    let breaks = Breaks::of(&numbers, stride);
    let gain = |length: &usize| breaks.gain(*length);
    let best = (USUAL_SAMPLES[0]..=longest).max_by(|a, b| gain(a).total_cmp(&gain(b)))?;
    let is_other = cfg_length <= longest && gain(&best) > gain(&cfg_length) + MIN_DOUBT_LOG_ODDS;
    // An echo may continue from receiver to receiver, almost without a break.
    let is_multiple = best.is_multiple_of(cfg_length) && breaks.whole(cfg_length, &[best]) == cfg_length;
    if is_other && !is_multiple {
        return Some(format!(
            "By the .cfg the samples of a chirp begin anew every {cfg_length} numbers, but they do so every {best}: it may be the .cfg of another \
             capture."
        ));
    }
    let cut = Cut { layout: *layout, samples: counts.samples, interleaved: 1 };
    let cfg_rows = counts.receivers * counts.chirps;
    let row_bytes = (counts.samples * layout.part_order.bytes()) as u64;
    let fills = |rows: usize| file_bytes.is_multiple_of(rows as u64 * row_bytes);
    let can_check_rows = stride == 1 && layout.header_bytes == 0 && !fills(cfg_rows);
    let found = can_check_rows.then(|| period_of(&cut, &numbers)).flatten()?.rows;
    (found != cfg_rows && fills(found)).then(|| {
        format!(
            "By the .cfg a loop has {cfg_rows} rows of samples, which don't fill the file, but rows are the same again after {found}, which do: it \
             may be the .cfg of another capture."
        )
    })
}

/// The numbers as rows, `[rows, samples]`, of `interleaved` receivers sample by sample.
fn rows(numbers: &[Complex64], samples: usize, interleaved: usize) -> Array2<Complex64> {
    let block = samples * interleaved;
    let count = numbers.len() / block * interleaved;
    Array2::from_shape_fn((count, samples), |(row, s)| {
        numbers[row / interleaved * block + s * interleaved + row % interleaved]
    })
}

fn period_of(cut: &Cut, numbers: &[Complex64]) -> Option<Period> {
    let is_real = cut.layout.part_order == PartOrder::Real || numbers.iter().all(|v| v.im == 0.0);
    period(&rows(numbers, cut.samples, cut.interleaved), cut.interleaved, is_real)
}

/// Counts of receivers, chirps and loops for a cut, the likeliest first, by its rows' period and the file's length; `chirp_bytes` as in [`cuts`].
fn likely_counts(
    cut: &Cut,
    numbers: &[Complex64],
    file_bytes: u64,
    marks: Option<Marks>,
    chirp_bytes: Option<usize>,
) -> Vec<LikelyCounts> {
    let row_bytes = cut.samples * cut.layout.part_order.bytes();
    let found = period_of(cut, numbers);
    let rows = found.as_ref().map_or(USUAL_RECEIVERS.min((numbers.len() / cut.samples).max(1)), |found| found.rows);
    let guessed = match found {
        None => Some(NO_PERIOD_NOTE),
        Some(Period { next: Some(1), .. }) => Some(EQUAL_ROWS_NOTE),
        Some(_) => None,
    };
    let usual_receivers = |rows: usize| match (chirp_bytes, cut.interleaved) {
        (Some(bytes), _) => (bytes / row_bytes).max(1),
        (None, 1) => [4, 3, 2].into_iter().find(|receivers| rows.is_multiple_of(*receivers)).unwrap_or(rows),
        (None, interleaved) => interleaved,
    };
    let counts_for = |rows: usize, receivers: usize, odds: [f64; 2]| {
        // A chirp has a whole number of groups of parts.
        let group = cut.layout.part_order.group();
        let fits = |more: &usize| (cut.samples * receivers * more).is_multiple_of(group);
        let receivers = receivers * [1, 2, 4].into_iter().find(fits).unwrap_or(1);
        let chirps = (rows / receivers).max(1);
        let header = if marks.is_some() { HEADER_BYTES as u64 } else { 0 };
        let loop_bytes = chirps as u64 * ((receivers * row_bytes) as u64 + header);
        let file_loops = (file_bytes / loop_bytes.max(1)).max(1);
        let loops = (1..=MAX_LOOPS as u64).rev().find(|loops| file_loops.is_multiple_of(*loops)).unwrap_or(1);
        // A number with few divisors is no reason for few loops.
        let loops = if loops < file_loops.min(8) { file_loops.min(MAX_LOOPS as u64) } else { loops };
        let counts = Counts { samples: cut.samples, receivers, chirps, loops: loops as usize };
        LikelyCounts { part_order: Some(cut.layout.part_order), counts, guessed, odds }
    };
    let mut all = vec![counts_for(rows, usual_receivers(rows), [0.0; 2])];
    let is_open = chirp_bytes.is_none() && cut.interleaved == 1 && guessed.is_none();
    let others = [3, 2, 1].into_iter().filter(|n| is_open && rows.is_multiple_of(*n) && *n < usual_receivers(rows));
    let others = others.filter(|n| rows / n <= MAX_TRANSMITTERS);
    all.extend(others.map(|receivers| counts_for(rows, receivers, [0.0, FEWER_RECEIVERS_LOG_ODDS])));
    let next = found.and_then(|found| found.next).filter(|next| *next > 1);
    all.extend(next.map(|next| counts_for(next, usual_receivers(next), [SECOND_PERIOD_LOG_ODDS, 0.0])));
    all
}
