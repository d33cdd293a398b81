//! The candidate layouts, and the choice of the best.

use super::counts::{self, LikelyCounts};
use super::evidence::{Evidence, Kind, Known, evidence};
use super::marks::{HEADER_BYTES, Marks, marks};
use super::spectrum::Spectrum;
use super::stream::Stream;
use super::{Counts, Layout, Parts, ReceiverOrder, Words};
use crate::recording::{Fault, RadarProfile};
use ndarray::Array2;
use num_complex::Complex64;
use std::io::{self, Read, Seek};

/// Most chirps of complex samples that a candidate is judged by.
const CHIRPS: usize = 16;
/// Most bytes that a candidate is judged by.
const MOST_BYTES: usize = 1 << 20;
/// Number of zero bytes in a row that no radar sends: their chirp is left out.
const ZERO_RUN: usize = 128;
/// Largest level below a flat spectrum that counts as without an echo, decibels; fewer profiles scatter more.
const FLAT_DB: f64 = 0.35;

/// A layout with the evidence for it.
#[derive(Debug, Clone, PartialEq)]
pub struct Candidate {
    /// The layout.
    pub layout: Layout,
    /// Samples, receivers, chirps and loops.
    pub counts: Counts,
    /// Evidence for and against the layout.
    pub evidence: Vec<Evidence>,
    /// Mean power of each range bin, in the square of the file's unit.
    pub power: Vec<f64>,
    /// Mean level below a flat spectrum, decibels.
    pub flatness_db: f64,
}

impl Candidate {
    /// Natural logarithm of its odds, up to a constant that all candidates share.
    pub fn log_odds(&self) -> f64 {
        self.evidence.iter().map(|e| e.log_odds).sum()
    }

    /// The log-odds of one kind.
    pub fn of_kind(&self, kind: Kind) -> f64 {
        self.evidence.iter().filter(|e| e.kind == kind).map(|e| e.log_odds).sum()
    }
}

/// The layouts that were found for a file.
#[derive(Debug, Clone, PartialEq)]
pub struct Found {
    /// The candidates, the best first; there is one at least.
    pub candidates: Vec<Candidate>,
    /// Sentences on headers, packets and counts.
    pub notes: Vec<String>,
    /// Whether samples and receivers were searched where much of the file is saturated, or no rows are the same again.
    pub hides_counts: bool,
}

/// Finds the layout of a capture, with the help of the `.cfg` in `profile`.
///
/// # Errors
/// [`Fault`] where the file is too short, or no layout makes echoes of it.
pub fn find<R: Read + Seek>(stream: &mut Stream<R>, profile: Option<&RadarProfile>) -> Result<Found, Fault> {
    let marks = marks(stream)?;
    let mut notes = Vec::new();
    let (ways, mut hides_counts) = match profile {
        Some(p) => {
            let RadarProfile { samples, receivers, loops, .. } = *p;
            let counts = Counts { samples, receivers, chirps: p.chirp_transmitters.len(), loops };
            (vec![LikelyCounts { parts: None, counts, guessed: None, odds: [0.0; 2] }], false)
        }
        None => {
            notes.push(counts::NOTE.to_owned());
            counts::search(stream, marks)?
        }
    };
    notes.extend(hides_counts.then(|| counts::CLIPPED_NOTE.to_owned()));
    let header_bytes = headers(marks, ways.first().map(|way| way.counts), profile, &mut notes);
    let known = Known { profile, bytes: stream.bytes() };
    let mut candidates = Vec::new();
    judge(stream, &ways, header_bytes, known, &mut candidates)?;
    candidates.sort_by(|a, b| b.log_odds().total_cmp(&a.log_odds()));
    let Some(best) = candidates.first() else {
        return Err(match stream.bytes() {
            bytes @ ..1024 => short(bytes, 1024, ""),
            _ => zeros(),
        });
    };
    if best.power.iter().all(|p| *p < 0.5) {
        return Err(zeros());
    }
    if best.flatness_db < FLAT_DB {
        return Err(Fault::Data(format!(
            "is no capture of a kind that is known: in every layout its spectrum is flat, as of random bytes ({} were tried); expected 16-bit \
             samples, with the .cfg that set the radar up beside them where there is one",
            candidates.len()
        )));
    }
    if let Some(why) = ways.iter().find(|way| way.counts == best.counts).and_then(|way| way.guessed) {
        hides_counts = true;
        notes.push(why.to_owned());
    }
    if profile.is_some() {
        let Candidate { layout, counts, .. } = best;
        let job = Job { counts: *counts, only: None, header_bytes, known };
        let numbers = counts.samples * counts.receivers;
        let chirps = job.chirps(stream, layout.chirp_bytes(counts.samples, counts.receivers), numbers)?;
        notes.extend(counts::doubted(layout, *counts, &chirps.concat(), known.bytes));
    }
    notes.extend(stream.has_packets().then(|| told_of_packets(stream.lost_packets())));
    Ok(Found { candidates, notes, hides_counts })
}

/// The error of a file of less than a chirp; `whose` is a clause with the source of the count, or nothing.
fn short(bytes: u64, expected: u64, whose: &str) -> Fault {
    Fault::Data(format!("has {bytes} bytes; expected at least one chirp, {expected} bytes{whose}"))
}

fn zeros() -> Fault {
    Fault::Data("begins with nothing but zeros or one constant: no echo to find a layout by".to_owned())
}

/// Judges every layout of each of the counts.
fn judge<R: Read + Seek>(
    stream: &mut Stream<R>,
    ways: &[LikelyCounts],
    header_bytes: usize,
    known: Known<'_>,
    candidates: &mut Vec<Candidate>,
) -> Result<(), Fault> {
    let mut none = None;
    // Log-odds of the likeliest counts. Other counts are judged beside them.
    let mut likeliest = 0.0;
    for way in ways {
        match (Job { counts: way.counts, only: way.parts, header_bytes, known }).candidates(stream) {
            Ok(of_way) if way.odds == [0.0; 2] => {
                likeliest = of_way[0].log_odds();
                candidates.extend(of_way);
            }
            // Spectra of as many numbers in other rows don't tell layouts apart: the repeats and the breaks of the rows do.
            Ok(of_way) => candidates.extend(of_way.into_iter().take(1).map(|mut other| {
                let [rows, usual] = way.odds;
                let log_odds = likeliest + rows - other.log_odds();
                other.evidence.push(Evidence { kind: Kind::Rows, log_odds, sentence: String::new() });
                other.evidence.push(Evidence { kind: Kind::Usual, log_odds: usual, sentence: String::new() });
                other
            })),
            Err(error @ Fault::Io(_)) => return Err(error),
            Err(error) => none = Some(error),
        }
    }
    none.filter(|_| candidates.is_empty()).map_or(Ok(()), Err)
}

fn told_of_packets(lost: u64) -> String {
    let lost = match lost {
        0 => "none is lost".to_owned(),
        1 => "one is lost and read as zeros".to_owned(),
        lost => format!("{lost} are lost and read as zeros"),
    };
    format!("The file holds network packets with headers of 10 bytes: {lost}.")
}

/// Bytes of the headers before chirps.
fn headers(
    marks: Option<Marks>,
    counts: Option<Counts>,
    profile: Option<&RadarProfile>,
    notes: &mut Vec<String>,
) -> usize {
    let Some(Marks { found, apart }) = marks else {
        if profile.is_some_and(|p| p.headers) {
            notes.push("The .cfg asks for a header before each chirp, but none stands there.".to_owned());
        }
        return 0;
    };
    let fits = |c: &Counts| Parts::ALL.iter().any(|p| c.samples * c.receivers * p.bytes() + HEADER_BYTES == apart);
    if !counts.as_ref().is_some_and(fits) && found > 1 {
        let held = (apart - HEADER_BYTES) / 4;
        notes.push(format!(
            "Headers stand {apart} bytes apart, so a chirp holds {held} complex samples of all receivers: the .cfg says otherwise."
        ));
    }
    notes.push(format!("Each chirp begins with a header of {HEADER_BYTES} bytes: {found} were found."));
    HEADER_BYTES
}

/// One set of counts to judge every layout by.
struct Job<'a> {
    counts: Counts,
    /// The order of parts that alone is judged, where one is.
    only: Option<Parts>,
    header_bytes: usize,
    known: Known<'a>,
}

impl Job<'_> {
    /// The layouts of these counts, the likeliest first; there is one at least.
    fn candidates<R: Read + Seek>(&self, stream: &mut Stream<R>) -> Result<Vec<Candidate>, Fault> {
        let Counts { samples, receivers, .. } = self.counts;
        let mut all = Vec::new();
        for parts in Parts::ALL.into_iter().filter(|parts| self.only.is_none_or(|only| only == *parts)) {
            let numbers = samples.saturating_mul(receivers);
            if numbers == 0 || !numbers.is_multiple_of(parts.group()) {
                continue;
            }
            let size = numbers.saturating_mul(parts.bytes()).saturating_add(self.header_bytes);
            let chirps = self.chirps(stream, size, numbers)?;
            if chirps.is_empty() {
                continue;
            }
            let short = fits_twelve(&chirps);
            for words in Words::ALL.into_iter().filter(|w| *w != Words::TwelveBits || short) {
                for order in [ReceiverOrder::OneAfterAnother, ReceiverOrder::Interleaved] {
                    if order == ReceiverOrder::OneAfterAnother || receivers > 1 {
                        let (header_bytes, packets) = (self.header_bytes, stream.has_packets());
                        let layout = Layout { words, parts, q_first: false, receivers: order, header_bytes, packets };
                        self.judge(layout, &chirps, &mut all);
                    }
                }
            }
        }
        if all.is_empty() {
            let expected = (samples * receivers * 4 + self.header_bytes) as u64;
            let whose = if self.known.profile.is_some() { " as the .cfg says" } else { "" };
            return Err(short(self.known.bytes, expected, whose));
        }
        all.sort_by(|a: &Candidate, b| b.log_odds().total_cmp(&a.log_odds()));
        Ok(all)
    }

    /// The first chirps without their headers; those with runs of zeros are left out where others are left.
    fn chirps<R: Read + Seek>(&self, stream: &mut Stream<R>, size: usize, numbers: usize) -> io::Result<Vec<Vec<u8>>> {
        let before = self.known.profile.map_or(0, |p| p.numbers_before) / numbers * size;
        // Real samples are half as long: every layout is judged by the same bytes.
        let bytes =
            CHIRPS.saturating_mul(numbers.saturating_mul(Parts::Pairs.bytes()).saturating_add(self.header_bytes));
        let most = (MOST_BYTES.min(bytes) / size).max(1);
        let there = stream.bytes().saturating_sub(before as u64) / size as u64;
        let mut chirps = Vec::new();
        for n in 0..there.min(most as u64) {
            let mut bytes = vec![0; size - self.header_bytes];
            stream.read_at(before as u64 + n * size as u64 + self.header_bytes as u64, &mut bytes)?;
            chirps.push(bytes);
        }
        let whole = |bytes: &Vec<u8>| bytes.chunks(ZERO_RUN).all(|part| part.iter().any(|b| *b != 0));
        if chirps.iter().any(whole) {
            chirps.retain(whole);
        }
        Ok(chirps)
    }

    fn judge(&self, layout: Layout, chirps: &[Vec<u8>], all: &mut Vec<Candidate>) {
        let Counts { samples, receivers, .. } = self.counts;
        let mut rows = Array2::<Complex64>::zeros((chirps.len() * receivers, samples));
        for (n, bytes) in chirps.iter().enumerate() {
            let chirp = layout.decode(bytes, samples, receivers);
            rows.slice_mut(ndarray::s![n * receivers..(n + 1) * receivers, ..]).assign(&chirp);
        }
        let spectrum = Spectrum::of(&rows, receivers);
        if layout.parts == Parts::Real {
            all.push(self.candidate(layout, spectrum.of_real()));
        } else {
            all.push(self.candidate(Layout { q_first: true, ..layout }, spectrum.mirrored()));
            all.push(self.candidate(layout, spectrum));
        }
    }

    fn candidate(&self, layout: Layout, spectrum: Spectrum) -> Candidate {
        let evidence = evidence(&layout, self.counts, &spectrum, self.known);
        let flatness_db = spectrum.flatness_db();
        Candidate { layout, counts: self.counts, evidence, power: spectrum.power, flatness_db }
    }
}

/// Whether every word is one of 12 bits whose sign was not carried into the upper four.
fn fits_twelve(chirps: &[Vec<u8>]) -> bool {
    let words = || chirps.iter().flat_map(|bytes| bytes.chunks_exact(2)).map(|b| u16::from_le_bytes([b[0], b[1]]));
    words().all(|word| word < 0x1000) && words().any(|word| word >= 0x0800)
}
