//! Evidence for a layout: log-odds of several kinds, which add up.
//!
//! The level of a spectrum decides most: twice the negative logarithm of the likelihood of Gaussian samples with this
//! spectrum is the mean of its logarithm (Whittle, 1953), and every layout holds the same bytes.

use super::spectrum::Spectrum;
use super::{Counts, Layout, Parts, ReceiverOrder, Words};
use crate::recording::RadarProfile;
use serde::Serialize;

/// A kind of evidence.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// Echoes stand in few bins over a low floor, without images.
    #[serde(rename = "spectrum")]
    Sharp,
    /// Receivers see the same echoes.
    Receivers,
    /// Rows are the same again after a loop.
    Rows,
    /// Whole frames fill the file.
    Counts,
    /// One half of the range axis is empty: I before Q, or Q before I.
    Half,
    /// Echoes have images, as of real samples.
    Images,
    /// Orders of samples that the `.cfg` says.
    Config,
    /// Frequency of the layout among captures.
    Usual,
}

/// One piece of evidence.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Evidence {
    /// Its kind.
    pub kind: Kind,
    /// Natural logarithm of the odds that it gives the layout.
    pub log_odds: f64,
    /// The finding, as a part of a sentence.
    pub sentence: String,
}

/// Log-odds of a nat of the spectrum's level.
pub(super) const OF_LEVEL: f64 = 300.0;
/// Log-odds of receivers whose profiles are alike.
const OF_ALIKE: f64 = 10.0;
/// Log-odds of each echo in the near half, with the power in both halves worth one echo; and most of them all: echoes of a far scene stand in the far
/// half together.
const OF_HALF: f64 = 0.7;
const MOST_OF_HALF: f64 = 8.0;
/// `OF_HALF` where no `.cfg` gives the order: five echoes at random places stand in one half too often to be sure.
const OF_HALF_ALONE: f64 = 0.35;
/// Log-odds against complex samples of an echo that has an image, and most such echoes that count.
const OF_IMAGE: f64 = 15.0;
const MOST_IMAGES: usize = 6;
/// Log-odds of the `.cfg`: for the order of I and Q, for the receivers' order, and for real samples.
const OF_ORDER: f64 = 5.0;
const OF_RECEIVERS: f64 = 8.0;
const OF_REAL: f64 = 40.0;
/// Log-odds against receivers one after another on four lanes, of which each carries a receiver: at broadside both orders have one spectrum.
const OF_LANES: f64 = 20.0;

#[derive(Debug, Clone, Copy)]
pub(super) struct Known<'a> {
    pub profile: Option<&'a RadarProfile>,
    pub bytes: u64,
}

/// All evidence for `layout`, whose bytes have this spectrum.
pub(super) fn evidence(layout: &Layout, counts: Counts, spectrum: &Spectrum, known: Known<'_>) -> Vec<Evidence> {
    let mut all = vec![sharp(spectrum)];
    all.extend((counts.receivers > 1).then(|| receivers(spectrum)));
    all.push(filling(layout, counts, known));
    if layout.parts != Parts::Real {
        all.push(half(spectrum, known));
        all.extend((spectrum.images > 0).then(|| images(spectrum)));
    }
    all.extend(known.profile.map(|profile| config(layout, profile)));
    all.push(Evidence { kind: Kind::Usual, log_odds: usual(layout), sentence: String::new() });
    all
}

fn sharp(spectrum: &Spectrum) -> Evidence {
    let echoes: usize = spectrum.echoes.iter().sum();
    let sentence = format!(
        "{} out, and between echoes the spectrum lies {:.1} dB below a flat one",
        if echoes == 1 { "one echo stands".to_owned() } else { format!("{echoes} echoes stand") },
        spectrum.flatness_db()
    );
    // Longer rows have more bins to fit a spectrum by, and fewer powers in each (Schwarz, 1978).
    let rows = spectrum.rows.max(2) as f64;
    Evidence { kind: Kind::Sharp, log_odds: -OF_LEVEL * (spectrum.level + rows.ln() / (2.0 * rows)), sentence }
}

fn receivers(spectrum: &Spectrum) -> Evidence {
    let said =
        if spectrum.alike > 0.7 { "every receiver sees the same echoes" } else { "receivers see different echoes" };
    let sentence = format!("{said} (correlation {:.2})", spectrum.alike);
    Evidence { kind: Kind::Receivers, log_odds: OF_ALIKE * spectrum.alike, sentence }
}

pub(super) fn frame_bytes(layout: &Layout, counts: Counts, profile: Option<&RadarProfile>) -> u64 {
    let numbers = counts.samples as u64 * counts.receivers as u64;
    let chirps = counts.chirps as u64 * counts.loops as u64;
    let all_numbers = profile.map_or(0, |p| p.frame_numbers as u64).max(numbers.saturating_mul(chirps));
    let headers = all_numbers.checked_div(numbers).unwrap_or(0).saturating_mul(layout.header_bytes as u64);
    all_numbers.saturating_mul(layout.parts.bytes() as u64).saturating_add(headers).max(1)
}

fn filling(layout: &Layout, counts: Counts, known: Known<'_>) -> Evidence {
    let frame = frame_bytes(layout, counts, known.profile);
    let (frames, rest) = (known.bytes / frame, known.bytes % frame);
    let said = known.profile.map_or(0, |p| p.frames as u64);
    let whole = if frames == 1 { "one whole frame".to_owned() } else { format!("{frames} whole frames") };
    let fill = if frames == 1 { "fills" } else { "fill" };
    let (log_odds, sentence) = match (frames, rest) {
        (0, _) => (-3.0, format!("the file is smaller than one frame ({} of {frame} bytes)", known.bytes)),
        (_, 0) if said == 0 || said == frames => (3.0, format!("{whole} {fill} the file")),
        (_, 0) => (1.5, format!("{whole} {fill} the file, not the {said} that were asked for")),
        _ => (0.0, format!("{whole} and a part of one fill the file")),
    };
    Evidence { kind: Kind::Counts, log_odds, sentence }
}

/// Echoes stand at positive frequencies where the chirp rises.
fn half(spectrum: &Spectrum, known: Known<'_>) -> Evidence {
    let sign = if known.profile.is_none_or(RadarProfile::rises) { 1.0 } else { -1.0 };
    let near = sign * spectrum.near;
    let part = 100.0 * (1.0 + near.abs()) / 2.0;
    let which = if near >= 0.0 { "near" } else { "far" };
    let sentence = format!("{part:.0} % of the power stands in the {which} half of the range axis");
    let [in_near, in_far] = spectrum.echoes.map(|echoes| echoes as f64);
    let odds = (near + sign * (in_near - in_far)).clamp(-MOST_OF_HALF, MOST_OF_HALF);
    let weight = if known.profile.is_some() { OF_HALF } else { OF_HALF_ALONE };
    Evidence { kind: Kind::Half, log_odds: weight * odds, sentence }
}

/// Complex samples have echoes in one half alone.
fn images(spectrum: &Spectrum) -> Evidence {
    let images = spectrum.images;
    let log_odds = -OF_IMAGE * images.min(MOST_IMAGES) as f64;
    Evidence {
        kind: Kind::Images,
        log_odds,
        sentence: format!("{images} of the echoes have an image, as of real samples"),
    }
}

fn config(layout: &Layout, profile: &RadarProfile) -> Evidence {
    let all = said(layout, profile);
    let agrees: Vec<&str> = all.iter().filter(|s| s.said == s.is).map(|s| s.is).collect();
    let sentence = if agrees.is_empty() {
        "the .cfg says otherwise".to_owned()
    } else {
        format!("the .cfg says {}", agrees.join(", "))
    };
    let log_odds = all.iter().map(|s| if s.said == s.is { s.log_odds } else { -s.log_odds }).sum();
    Evidence { kind: Kind::Config, log_odds, sentence }
}

/// A property of the order of samples, in words: by the `.cfg`, and by a layout.
pub(in crate::recording) struct Said {
    /// The `.cfg`'s.
    pub said: &'static str,
    /// The layout's.
    pub is: &'static str,
    log_odds: f64,
}

/// The orders that the `.cfg` says, beside those of `layout`.
pub(in crate::recording) fn said(layout: &Layout, profile: &RadarProfile) -> Vec<Said> {
    let real = (Some(profile.real), layout.parts == Parts::Real, OF_REAL, ["complex samples", "real samples"]);
    let order = (profile.q_first, layout.q_first, OF_ORDER, ["I first", "Q first"]);
    let mixed = layout.receivers == ReceiverOrder::Interleaved;
    let words = ["receivers one after another", "receivers sample by sample"];
    let receivers = (profile.interleaved.filter(|_| profile.receivers > 1), mixed, OF_RECEIVERS, words);
    let of = |(said, is, log_odds, words): (Option<bool>, bool, f64, [&'static str; 2])| {
        Some(Said { said: words[usize::from(said?)], is: words[usize::from(is)], log_odds })
    };
    let is_told = |n: &usize| *n != 1 || layout.parts != Parts::Real;
    [real, order, receivers].into_iter().enumerate().filter(|(n, _)| is_told(n)).filter_map(|(_, s)| of(s)).collect()
}

/// Log-odds of a layout by its frequency among captures.
pub(super) fn usual(layout: &Layout) -> f64 {
    let words = match layout.words {
        Words::Int16 => 0.0,
        Words::OffsetBinary | Words::TwelveBits => -1.0,
        Words::BigEndian => -2.0,
    };
    let parts = match layout.parts {
        Parts::Pairs | Parts::TwoLanes => 0.0,
        Parts::FourLanes => -0.5,
        Parts::Real => -2.0,
    };
    let order = if layout.q_first { -0.5 } else { 0.0 };
    let is_one_lane_each = layout.parts != Parts::FourLanes || layout.receivers == ReceiverOrder::Interleaved;
    words + parts + order - if is_one_lane_each { 0.0 } else { OF_LANES }
}
