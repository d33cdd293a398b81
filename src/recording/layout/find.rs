//! The candidate layouts, and the choice of the best.

use super::counts::{self, LikelyCounts};
use super::evidence::{Evidence, EvidenceKind, FileFacts, evidence};
use super::marks::{HEADER_BYTES, Marks, marks};
use super::spectrum::Spectrum;
use super::stream::CaptureStream;
use super::{Counts, Layout, NumberEncoding, PartOrder, ReceiverOrder};
use crate::radar::counted;
use crate::recording::{Fault, RadarProfile};
use ndarray::Array2;
use num_complex::Complex64;
use std::io::{self, Read, Seek};

/// Most chirps of complex samples that the evidence for a candidate is computed from.
const MAX_CHIRPS: usize = 16;
/// Most bytes that it is computed from.
const MAX_BYTES: usize = 1 << 20;
/// Least number of zero bytes in a row that count as a lost packet; their chirp is left out.
const MIN_ZERO_RUN_BYTES: usize = 128;
/// Largest mean level below a flat spectrum of a file without echoes, decibels.
const MAX_FLATNESS_DB: f64 = 0.35;

/// Least length of a file without a `.cfg` whose layout can be sure: 16 chirps of 64 complex samples.
const MIN_SURE_BYTES: u64 = 4096;

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
    /// Natural logarithm of its odds, up to a constant that is the same for all candidates.
    pub fn log_odds(&self) -> f64 {
        self.evidence.iter().map(|e| e.log_odds).sum()
    }

    /// The sum of the log-odds of one kind.
    pub fn of_kind(&self, kind: EvidenceKind) -> f64 {
        self.evidence.iter().filter(|e| e.kind == kind).map(|e| e.log_odds).sum()
    }
}

/// The layouts that were found for a file.
#[derive(Debug, Clone, PartialEq)]
pub struct Found {
    /// The candidates, the best first; at least one.
    pub candidates: Vec<Candidate>,
    /// Sentences on headers, packets and counts.
    pub notes: Vec<String>,
    /// Whether the counts were searched although the file is short, much of it is saturated, or no rows repeat.
    pub hides_counts: bool,
}

/// Finds the layout of a capture; `profile` is its `.cfg`, where there is one.
/// # Errors
/// [`Fault`] where the file can't be read or is too short, or by no layout has echoes.
pub fn find<R: Read + Seek>(stream: &mut CaptureStream<R>, profile: Option<&RadarProfile>) -> Result<Found, Fault> {
    let marks = marks(stream)?;
    let mut notes = Vec::new();
    let (all_counts, mut hides_counts) = match profile {
        Some(p) => {
            let RadarProfile { samples, receivers, loops, .. } = *p;
            let counts = Counts { samples, receivers, chirps: p.chirp_transmitters.len(), loops };
            (vec![LikelyCounts { part_order: None, counts, guessed: None, odds: [0.0; 2] }], false)
        }
        None => {
            notes.push(counts::NOTE.to_owned());
            counts::search(stream, marks)?
        }
    };
    notes.extend(hides_counts.then(|| counts::CLIPPED_NOTE.to_owned()));
    let header_bytes = header_bytes(marks, all_counts.first().map(|likely| likely.counts), profile, &mut notes);
    let facts = FileFacts { profile, bytes: stream.bytes() };
    let mut candidates = Vec::new();
    add_candidates(stream, &all_counts, header_bytes, facts, &mut candidates)?;
    candidates.sort_by(|a, b| b.log_odds().total_cmp(&a.log_odds()));
    let Some(best) = candidates.first() else {
        return Err(match stream.bytes() {
            bytes @ ..1024 => too_short(bytes, 1024, ""),
            _ => all_zeros(),
        });
    };
    if best.power.iter().all(|p| *p < 0.5) {
        return Err(all_zeros());
    }
    if best.flatness_db < MAX_FLATNESS_DB {
        return Err(Fault::Data(format!(
            "is no capture of a kind that is known: in every layout its spectrum is flat, as of random bytes ({} were tried); expected 16-bit \
             samples, with the .cfg that set the radar up beside them where there is one",
            candidates.len()
        )));
    }
    if let Some(note) = all_counts.iter().find(|likely| likely.counts == best.counts).and_then(|likely| likely.guessed)
    {
        hides_counts = true;
        notes.push(note.to_owned());
    }
    if profile.is_none() && facts.bytes < MIN_SURE_BYTES {
        hides_counts = true;
        notes.push(format!("The file has {} bytes, too few for a sure choice.", facts.bytes));
    }
    if profile.is_some() {
        let Candidate { layout, counts, .. } = best;
        let with_counts = Candidates { counts: *counts, only_order: None, header_bytes, facts };
        let numbers = counts.samples * counts.receivers;
        let chirps = with_counts.chirps(stream, layout.chirp_bytes(counts.samples, counts.receivers), numbers)?;
        notes.extend(counts::doubted(layout, *counts, &chirps.concat(), facts.bytes));
    }
    notes.extend(stream.has_packets().then(|| packets_note(stream.lost_packets())));
    Ok(Found { candidates, notes, hides_counts })
}

/// The error of a file of less than a chirp; `source` is a clause with the source of the expected number, or empty.
fn too_short(bytes: u64, expected: u64, source: &str) -> Fault {
    let found = counted(bytes, "byte", "bytes");
    Fault::Data(format!("has {found}; expected at least one chirp, {expected} bytes{source}"))
}

fn all_zeros() -> Fault {
    Fault::Data("begins with nothing but zeros or one constant: no echo to find a layout by".to_owned())
}

fn add_candidates<R: Read + Seek>(
    stream: &mut CaptureStream<R>,
    all_counts: &[LikelyCounts],
    header_bytes: usize,
    facts: FileFacts<'_>,
    candidates: &mut Vec<Candidate>,
) -> Result<(), Fault> {
    let mut none = None;
    // Log-odds of the likeliest counts, which those of other counts are relative to.
    let mut likeliest = 0.0;
    for likely in all_counts {
        match (Candidates { counts: likely.counts, only_order: likely.part_order, header_bytes, facts })
            .evaluate(stream)
        {
            Ok(found) if likely.odds == [0.0; 2] => {
                likeliest = found[0].log_odds();
                candidates.extend(found);
            }
            // Spectra of rows of other lengths are not comparable: the log-odds of repeats and breaks of the rows decide.
            Ok(found) => candidates.extend(found.into_iter().take(1).map(|mut other| {
                let [rows, usual] = likely.odds;
                let log_odds = likeliest + rows - other.log_odds();
                other.evidence.push(Evidence { kind: EvidenceKind::Rows, log_odds, sentence: String::new() });
                other.evidence.push(Evidence { kind: EvidenceKind::Usual, log_odds: usual, sentence: String::new() });
                other
            })),
            Err(error @ Fault::Io(_)) => return Err(error),
            Err(error) => none = Some(error),
        }
    }
    none.filter(|_| candidates.is_empty()).map_or(Ok(()), Err)
}

fn packets_note(lost: u64) -> String {
    let lost = match lost {
        0 => "none is lost".to_owned(),
        1 => "one is lost and read as zeros".to_owned(),
        lost => format!("{lost} are lost and read as zeros"),
    };
    format!("The file holds network packets with headers of 10 bytes: {lost}.")
}

/// Bytes of the header before each chirp, 0 without one. Adds notes on them.
fn header_bytes(
    marks: Option<Marks>,
    counts: Option<Counts>,
    profile: Option<&RadarProfile>,
    notes: &mut Vec<String>,
) -> usize {
    let Some(Marks { found, apart }) = marks else {
        if profile.is_some_and(|p| p.has_headers) {
            notes.push("The .cfg asks for a header before each chirp, but none stands there.".to_owned());
        }
        return 0;
    };
    let fits = |c: &Counts| PartOrder::ALL.iter().any(|p| c.samples * c.receivers * p.bytes() + HEADER_BYTES == apart);
    if !counts.as_ref().is_some_and(fits) && found > 1 {
        let samples = (apart - HEADER_BYTES) / 4;
        notes.push(format!(
            "Headers stand {apart} bytes apart, so a chirp holds {samples} complex samples of all receivers: the .cfg says otherwise."
        ));
    }
    notes.push(format!("Each chirp begins with a header of {HEADER_BYTES} bytes: {found} were found."));
    HEADER_BYTES
}

/// The candidates with these counts.
struct Candidates<'a> {
    counts: Counts,
    /// The only order of parts of the candidates; `None` for every order.
    only_order: Option<PartOrder>,
    header_bytes: usize,
    facts: FileFacts<'a>,
}

impl Candidates<'_> {
    /// All of them, the likeliest first; at least one.
    fn evaluate<R: Read + Seek>(&self, stream: &mut CaptureStream<R>) -> Result<Vec<Candidate>, Fault> {
        let Counts { samples, receivers, .. } = self.counts;
        let mut all = Vec::new();
        for part_order in PartOrder::ALL
            .into_iter()
            .filter(|part_order| self.only_order.is_none_or(|only_order| only_order == *part_order))
        {
            let numbers = samples.saturating_mul(receivers);
            if numbers == 0 || !numbers.is_multiple_of(part_order.group()) {
                continue;
            }
            let size = numbers.saturating_mul(part_order.bytes()).saturating_add(self.header_bytes);
            let chirps = self.chirps(stream, size, numbers)?;
            if chirps.is_empty() {
                continue;
            }
            let has_twelve_bits = are_twelve_bits(&chirps);
            for encoding in
                NumberEncoding::ALL.into_iter().filter(|w| *w != NumberEncoding::TwelveBits || has_twelve_bits)
            {
                for order in [ReceiverOrder::OneAfterAnother, ReceiverOrder::Interleaved] {
                    if order == ReceiverOrder::OneAfterAnother || receivers > 1 {
                        let (header_bytes, packets) = (self.header_bytes, stream.has_packets());
                        let layout =
                            Layout { encoding, part_order, q_first: false, receivers: order, header_bytes, packets };
                        self.add_layout(layout, &chirps, &mut all);
                    }
                }
            }
        }
        if all.is_empty() {
            let expected = (samples * receivers * 4 + self.header_bytes) as u64;
            let source = if self.facts.profile.is_some() { " as the .cfg says" } else { "" };
            return Err(too_short(self.facts.bytes, expected, source));
        }
        all.sort_by(|a: &Candidate, b| b.log_odds().total_cmp(&a.log_odds()));
        Ok(all)
    }

    /// The first chirps without their headers. Those with runs of zeros are left out, unless all have such.
    fn chirps<R: Read + Seek>(
        &self,
        stream: &mut CaptureStream<R>,
        size: usize,
        numbers: usize,
    ) -> io::Result<Vec<Vec<u8>>> {
        let before = self.facts.profile.map_or(0, |p| p.numbers_before) / numbers * size;
        // As many bytes for every layout: real samples have half the bytes of complex ones.
        let bytes = MAX_CHIRPS
            .saturating_mul(numbers.saturating_mul(PartOrder::Pairs.bytes()).saturating_add(self.header_bytes));
        let max_chirps = (MAX_BYTES.min(bytes) / size).max(1);
        let file_chirps = stream.bytes().saturating_sub(before as u64) / size as u64;
        let mut chirps = Vec::new();
        for n in 0..file_chirps.min(max_chirps as u64) {
            let mut bytes = vec![0; size - self.header_bytes];
            stream.read_at(before as u64 + n * size as u64 + self.header_bytes as u64, &mut bytes)?;
            chirps.push(bytes);
        }
        let has_no_zero_run =
            |bytes: &Vec<u8>| bytes.chunks(MIN_ZERO_RUN_BYTES).all(|part| part.iter().any(|b| *b != 0));
        if chirps.iter().any(has_no_zero_run) {
            chirps.retain(has_no_zero_run);
        }
        Ok(chirps)
    }

    /// Adds the candidates of a layout, complex ones with both orders of I and Q.
    fn add_layout(&self, layout: Layout, chirps: &[Vec<u8>], all: &mut Vec<Candidate>) {
        let Counts { samples, receivers, .. } = self.counts;
        let mut rows = Array2::<Complex64>::zeros((chirps.len() * receivers, samples));
        for (n, bytes) in chirps.iter().enumerate() {
            let chirp = layout.decode(bytes, samples, receivers);
            rows.slice_mut(ndarray::s![n * receivers..(n + 1) * receivers, ..]).assign(&chirp);
        }
        let spectrum = Spectrum::of(&rows, receivers);
        if layout.part_order == PartOrder::Real {
            all.push(self.candidate(layout, spectrum.of_real()));
        } else {
            all.push(self.candidate(Layout { q_first: true, ..layout }, spectrum.mirrored()));
            all.push(self.candidate(layout, spectrum));
        }
    }

    fn candidate(&self, layout: Layout, spectrum: Spectrum) -> Candidate {
        let evidence = evidence(&layout, self.counts, &spectrum, self.facts);
        let flatness_db = spectrum.flatness_db();
        Candidate { layout, counts: self.counts, evidence, power: spectrum.power, flatness_db }
    }
}

/// Whether all words have 12 bits without sign extension, and some are negative.
fn are_twelve_bits(chirps: &[Vec<u8>]) -> bool {
    let words = || chirps.iter().flat_map(|bytes| bytes.chunks_exact(2)).map(|b| u16::from_le_bytes([b[0], b[1]]));
    words().all(|word| word < 0x1000) && words().any(|word| word >= 0x0800)
}
