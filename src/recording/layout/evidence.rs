//! Evidence for a layout: log-odds of several kinds, which add up.
//!
//! The level of a spectrum decides most: twice the negative logarithm of the likelihood of Gaussian samples with this
//! spectrum is the mean of its logarithm (Whittle, 1953), and every layout holds the same bytes.

use super::spectrum::Spectrum;
use super::{Counts, Layout, NumberEncoding, PartOrder, ReceiverOrder};
use crate::recording::RadarProfile;
use serde::Serialize;

/// A kind of evidence.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum EvidenceKind {
    /// Low mean logarithm of the spectrum: echoes in few bins over a low floor.
    Spectrum,
    /// Equal echoes at all receivers.
    Receivers,
    /// Rows that repeat after a loop.
    Rows,
    /// A whole number of frames in the file.
    Counts,
    /// An empty half of the range axis, which tells I before Q from Q before I.
    Half,
    /// Images of echoes, as of real samples.
    Images,
    /// Orders of samples by the `.cfg`.
    Config,
    /// Frequency of the layout among captures.
    Usual,
}

/// One piece of evidence.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Evidence {
    /// Kind.
    pub kind: EvidenceKind,
    /// Natural logarithm of the odds for the layout.
    pub log_odds: f64,
    /// The finding, as a part of a sentence; empty for none.
    pub sentence: String,
}

/// Log-odds of each neper by which the mean logarithm of the spectrum's power is lower.
pub(super) const LEVEL_LOG_ODDS: f64 = 300.0;
/// Log-odds of a correlation of 1 between the receivers' range profiles.
const CORRELATION_LOG_ODDS: f64 = 10.0;
/// Log-odds of each echo in the near half of the range axis (power counts as one), and most that count: a far scene's are in the far half.
const HALF_LOG_ODDS: f64 = 0.7;
const MAX_HALF_ECHOES: f64 = 8.0;
/// The same without a `.cfg`: five echoes at random ranges are in one half too often for certainty.
const HALF_LOG_ODDS_WITHOUT_CONFIG: f64 = 0.35;
/// Log-odds of each echo with an image against complex samples, and most such echoes that count.
const IMAGE_LOG_ODDS: f64 = 15.0;
const MAX_IMAGES: usize = 6;
/// Log-odds of the `.cfg` for its order of I and Q, its order of receivers, and real or complex samples.
const CONFIG_IQ_LOG_ODDS: f64 = 5.0;
const CONFIG_RECEIVERS_LOG_ODDS: f64 = 8.0;
const CONFIG_REAL_LOG_ODDS: f64 = 40.0;
/// Log-odds against receivers one after another on four lanes, where each lane carries one: at broadside both orders have equal spectra.
const FOUR_LANES_LOG_ODDS: f64 = 20.0;

/// The `.cfg` and the number of data bytes of the file.
#[derive(Debug, Clone, Copy)]
pub(super) struct FileFacts<'a> {
    pub profile: Option<&'a RadarProfile>,
    pub bytes: u64,
}

/// All evidence for `layout`, by which the file has this spectrum.
pub(super) fn evidence(layout: &Layout, counts: Counts, spectrum: &Spectrum, facts: FileFacts<'_>) -> Vec<Evidence> {
    let mut all = vec![spectrum_evidence(spectrum)];
    all.extend((counts.receivers > 1).then(|| receivers(spectrum)));
    all.push(filling(layout, counts, facts));
    if layout.part_order != PartOrder::Real {
        all.push(half(spectrum, facts));
        all.extend((spectrum.images > 0).then(|| images(spectrum)));
    }
    all.extend(facts.profile.map(|profile| config(layout, profile)));
    all.push(Evidence { kind: EvidenceKind::Usual, log_odds: usual(layout), sentence: String::new() });
    all
}

fn spectrum_evidence(spectrum: &Spectrum) -> Evidence {
    let echoes: usize = spectrum.echoes.iter().sum();
    let sentence = format!(
        "{} out, and between echoes the spectrum lies {:.1} dB below a flat one",
        if echoes == 1 { "one echo stands".to_owned() } else { format!("{echoes} echoes stand") },
        spectrum.flatness_db()
    );
    // The penalty for the number of fitted parameters, the bins of a spectrum (Schwarz, 1978).
    let rows = spectrum.rows.max(2) as f64;
    let log_odds = -LEVEL_LOG_ODDS * (spectrum.level + rows.ln() / (2.0 * rows));
    Evidence { kind: EvidenceKind::Spectrum, log_odds, sentence }
}

fn receivers(spectrum: &Spectrum) -> Evidence {
    let finding = if spectrum.correlation > 0.7 {
        "every receiver sees the same echoes"
    } else {
        "receivers see different echoes"
    };
    let sentence = format!("{finding} (correlation {:.2})", spectrum.correlation);
    Evidence { kind: EvidenceKind::Receivers, log_odds: CORRELATION_LOG_ODDS * spectrum.correlation, sentence }
}

/// Bytes of a frame with its headers, at least 1.
pub(super) fn frame_bytes(layout: &Layout, counts: Counts, profile: Option<&RadarProfile>) -> u64 {
    let numbers = counts.samples as u64 * counts.receivers as u64;
    let chirps = counts.chirps as u64 * counts.loops as u64;
    let all_numbers = profile.map_or(0, |p| p.frame_numbers as u64).max(numbers.saturating_mul(chirps));
    let headers = all_numbers.checked_div(numbers).unwrap_or(0).saturating_mul(layout.header_bytes as u64);
    all_numbers.saturating_mul(layout.part_order.bytes() as u64).saturating_add(headers).max(1)
}

fn filling(layout: &Layout, counts: Counts, facts: FileFacts<'_>) -> Evidence {
    let frame = frame_bytes(layout, counts, facts.profile);
    let (frames, rest) = (facts.bytes / frame, facts.bytes % frame);
    let config_frames = facts.profile.map_or(0, |p| p.frames as u64);
    let whole = if frames == 1 { "one whole frame".to_owned() } else { format!("{frames} whole frames") };
    let fill = if frames == 1 { "fills" } else { "fill" };
    let (log_odds, sentence) = match (frames, rest) {
        (0, _) => (-3.0, format!("the file is smaller than one frame ({} of {frame} bytes)", facts.bytes)),
        (_, 0) if config_frames == 0 || config_frames == frames => (3.0, format!("{whole} {fill} the file")),
        (_, 0) => (1.5, format!("{whole} {fill} the file, not the {config_frames} that were asked for")),
        _ => (0.0, format!("{whole} and a part of one fill the file")),
    };
    Evidence { kind: EvidenceKind::Counts, log_odds, sentence }
}

/// Evidence by the halves of the range axis: echoes have positive beat frequencies where the chirp's frequency rises.
fn half(spectrum: &Spectrum, facts: FileFacts<'_>) -> Evidence {
    let sign = if facts.profile.is_none_or(RadarProfile::rises) { 1.0 } else { -1.0 };
    let near = sign * spectrum.near;
    let part = 100.0 * (1.0 + near.abs()) / 2.0;
    let which = if near >= 0.0 { "near" } else { "far" };
    let sentence = format!("{part:.0} % of the power stands in the {which} half of the range axis");
    let [in_near, in_far] = spectrum.echoes.map(|echoes| echoes as f64);
    let odds = (near + sign * (in_near - in_far)).clamp(-MAX_HALF_ECHOES, MAX_HALF_ECHOES);
    let weight = if facts.profile.is_some() { HALF_LOG_ODDS } else { HALF_LOG_ODDS_WITHOUT_CONFIG };
    Evidence { kind: EvidenceKind::Half, log_odds: weight * odds, sentence }
}

/// Evidence by images in the other half of the range axis, which complex samples have not.
fn images(spectrum: &Spectrum) -> Evidence {
    let images = spectrum.images;
    let log_odds = -IMAGE_LOG_ODDS * images.min(MAX_IMAGES) as f64;
    Evidence {
        kind: EvidenceKind::Images,
        log_odds,
        sentence: format!("{images} of the echoes have an image, as of real samples"),
    }
}

fn config(layout: &Layout, profile: &RadarProfile) -> Evidence {
    let all = config_claims(layout, profile);
    let agrees: Vec<&str> = all.iter().filter(|s| s.config == s.layout).map(|s| s.layout).collect();
    let sentence = if agrees.is_empty() {
        "the .cfg says otherwise".to_owned()
    } else {
        format!("the .cfg says {}", agrees.join(", "))
    };
    let log_odds = all.iter().map(|s| if s.config == s.layout { s.log_odds } else { -s.log_odds }).sum();
    Evidence { kind: EvidenceKind::Config, log_odds, sentence }
}

/// A property of the samples in words, by the `.cfg` and by a layout.
pub(in crate::recording) struct ConfigClaim {
    pub config: &'static str,
    pub layout: &'static str,
    log_odds: f64,
}

/// The properties of the samples that the `.cfg` has, beside those of `layout`.
pub(in crate::recording) fn config_claims(layout: &Layout, profile: &RadarProfile) -> Vec<ConfigClaim> {
    let real = (
        Some(profile.real),
        layout.part_order == PartOrder::Real,
        CONFIG_REAL_LOG_ODDS,
        ["complex samples", "real samples"],
    );
    let order = (profile.q_first, layout.q_first, CONFIG_IQ_LOG_ODDS, ["I first", "Q first"]);
    let mixed = layout.receivers == ReceiverOrder::Interleaved;
    let words = ["receivers one after another", "receivers sample by sample"];
    let receivers = (profile.interleaved.filter(|_| profile.receivers > 1), mixed, CONFIG_RECEIVERS_LOG_ODDS, words);
    let claim = |(config, layout, log_odds, words): (Option<bool>, bool, f64, [&'static str; 2])| {
        Some(ConfigClaim { config: words[usize::from(config?)], layout: words[usize::from(layout)], log_odds })
    };
    // Real samples have no order of I and Q.
    let applies = |n: &usize| *n != 1 || layout.part_order != PartOrder::Real;
    [real, order, receivers].into_iter().enumerate().filter(|(n, _)| applies(n)).filter_map(|(_, s)| claim(s)).collect()
}

/// Log-odds of a layout by its frequency among captures.
pub(super) fn usual(layout: &Layout) -> f64 {
    let encoding = match layout.encoding {
        NumberEncoding::Int16 => 0.0,
        NumberEncoding::OffsetBinary | NumberEncoding::TwelveBits => -1.0,
        NumberEncoding::BigEndian => -2.0,
    };
    let part_order = match layout.part_order {
        PartOrder::Pairs | PartOrder::TwoLanes => 0.0,
        PartOrder::FourLanes => -0.5,
        PartOrder::Real => -2.0,
    };
    let order = if layout.q_first { -0.5 } else { 0.0 };
    let is_one_lane_each = layout.part_order != PartOrder::FourLanes || layout.receivers == ReceiverOrder::Interleaved;
    encoding + part_order + order - if is_one_lane_each { 0.0 } else { FOUR_LANES_LOG_ODDS }
}
