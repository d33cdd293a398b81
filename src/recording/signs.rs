//! The signs and the carrier by which the samples of a physical radar become those of the maps' formula.
//!
//! A physical radar's sample `n` has the phase `s 2 pi f_n (R_t + R_r) / c`, where R_t and R_r are the distances from the transmitter
//! and from the receiver. The sign `s` is one for all samples, and `f_n` rises or falls by `B / N` from sample to sample. The program's
//! formula ([`crate::signal`]) at a distance R is
//!
//! * two-way: `+2 pi (f + B n / N) 2 R / c`. Conjugated, and put in the order of rising frequency, physical samples are exactly this
//!   where `R_t = R_r = R`.
//! * one-way: `-2 pi (f - 2 B n / N) R / c`. Conjugated, and put in the order of falling frequency, physical samples are
//!   `-2 pi (F - B n / N) (R_t + R_r) / c`. For plane waves over virtual elements at the sum of both positions the phase from element
//!   to element is the same in the middle of the chirp where `f - B = F - B / 2`. Elsewhere the program's changes twice as fast from sample to
//!   sample: its formula has echoes migrate through twice as many range bins along the array.

use super::Fault;
use super::recording_table::{BeatSign, CarrierAt, RecordingTable, Sweep};
use crate::radar::{Carrier, Radar};
use ndarray::{Array, Axis, Dimension};
use num_complex::Complex64;

/// The newest format of a recording's TOML. A text without the key is of format 1.
pub const FORMAT: u32 = 3;

pub(super) fn first_format() -> u32 {
    1
}

/// Changes of samples and carrier by which a recording fits the maps' formula.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Signs {
    pub conjugates: bool,
    pub reverses_samples: bool,
    /// The carrier of the maps' formula, hertz.
    pub carrier_hz: f64,
}

impl Signs {
    /// Applies the changes to samples, whose last axis is that within a chirp.
    pub fn apply<D: Dimension>(self, samples: &mut Array<Complex64, D>) {
        if self.conjugates {
            samples.mapv_inplace(|v| v.conj());
        }
        if self.reverses_samples {
            samples.invert_axis(Axis(samples.ndim() - 1));
        }
    }
}

impl RecordingTable {
    /// The changes by the keys of the table. `radar` has the carrier of the text, or that of the `.cfg` in the middle of the samples.
    pub fn signs(&self, format: u32, radar: &Radar, has_profile: bool) -> Result<Signs, Fault> {
        let RecordingTable { carrier_at, beat_sign, sweep, conjugate, .. } = *self;
        let key = |name: &str| format!("recording.{name}");
        let is_there = |name: &str, expected: &str| Err(Fault::key(&key(name), "is there", expected));
        if has_profile && carrier_at == Some(CarrierAt::FirstSample) {
            let expected = "\"middle\", as the .cfg says, or no such key";
            return Err(Fault::key(&key("carrier_at"), "is \"first-sample\"", expected));
        }
        match format {
            1 => {
                let named = [
                    ("carrier_at", carrier_at.is_some()),
                    ("beat_sign", beat_sign.is_some()),
                    ("sweep", sweep.is_some()),
                ];
                if let Some((name, _)) = named.into_iter().find(|(_, is_present)| *is_present) {
                    return is_there(name, "it only below format = 2, a line above [radar]");
                }
                let conjugates = conjugate.unwrap_or(false);
                return Ok(Signs { conjugates, reverses_samples: false, carrier_hz: radar.carrier_hz });
            }
            2 | FORMAT => {}
            other => return Err(Fault::key("format", format!("is {other}"), "1, 2 or 3")),
        }
        if conjugate.is_some() {
            return is_there("conjugate", "beat_sign in its place: below format = 2 signs follow from it");
        }
        let Some(beat) = beat_sign else {
            let expected = "\"+\" where echoes stand at positive frequencies of the beat, or \"-\"";
            return Err(Fault::key(&key("beat_sign"), "is missing", expected));
        };
        let at = match carrier_at {
            None if radar.samples == 1 => CarrierAt::FirstSample,
            Some(_) if radar.samples == 1 => return is_there("carrier_at", "it only where radar.samples is above 1"),
            Some(at) => at,
            None if has_profile => CarrierAt::Middle,
            None => {
                let expected = "\"first-sample\" or \"middle\": where on the chirp radar.carrier_hz lies";
                return Err(Fault::key(&key("carrier_at"), "is missing", expected));
            }
        };
        Ok(physical_signs(radar, at, beat, sweep.unwrap_or_default()))
    }
}

/// The changes of a physical radar's samples (formats 2 and 3).
fn physical_signs(radar: &Radar, at: CarrierAt, beat: BeatSign, sweep: Sweep) -> Signs {
    let rises = sweep == Sweep::Up;
    // The phase of a sample is that of the carrier plus that of the beat. Both have the same sign where the frequency rises.
    let phase_is_positive = (beat == BeatSign::Positive) == rises;
    let wants_positive = radar.carrier == Carrier::TwoWay;
    let conjugates = phase_is_positive != wants_positive;
    // In the maps' formula the beat frequency is positive. So the chirp's frequency rises where phases are positive, and falls elsewhere.
    let reverses_samples = rises != wants_positive && radar.samples > 1;
    let per_sample = radar.bandwidth_hz / radar.samples as f64;
    let (last, direction) = ((radar.samples - 1) as f64, if rises { 1.0 } else { -1.0 });
    let first_hz = match at {
        CarrierAt::FirstSample => radar.carrier_hz,
        CarrierAt::Middle => radar.carrier_hz - direction * radar.bandwidth_hz / 2.0,
    };
    let new_first_hz = if reverses_samples { first_hz + direction * per_sample * last } else { first_hz };
    let carrier_hz = match radar.carrier {
        _ if radar.samples == 1 => radar.carrier_hz,
        Carrier::TwoWay => new_first_hz,
        // By the middle of the chirp the formula's frequency has fallen by twice as much as the radar's.
        Carrier::OneWay => new_first_hz + per_sample * last / 2.0,
    };
    Signs { conjugates, reverses_samples, carrier_hz }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn radar(carrier: Carrier) -> Radar {
        Radar { carrier, samples: 101, bandwidth_hz: 1.01e9, ..Radar::default() }
    }

    /// The changes by a text of format 2 with these keys.
    fn signs(radar: &Radar, keys: &str) -> Signs {
        table(keys).signs(2, radar, false).unwrap()
    }

    fn table(keys: &str) -> RecordingTable {
        toml::from_str(&format!("file = \"a.npz\"\n{keys}")).unwrap()
    }

    const FIRST_SAMPLE: &str = "carrier_at = \"first-sample\"\n";
    const PLUS: &str = "beat_sign = \"+\"\n";

    #[test]
    fn contradicting_keys_are_refused() {
        let all = &format!("{FIRST_SAMPLE}{PLUS}");
        for (format, keys, part) in [
            (1, all.as_str(), "recording.carrier_at is there"),
            (4, all, "format is 4; expected 1, 2 or 3"),
            (2, &format!("{all}conjugate = true"), "beat_sign in its place"),
            (2, FIRST_SAMPLE, "recording.beat_sign is missing"),
            (2, PLUS, "recording.carrier_at is missing"),
        ] {
            let message = table(keys).signs(format, &radar(Carrier::OneWay), false).unwrap_err().to_string();
            assert!(message.contains(part), "{message}");
        }
        let snapshot = Radar { samples: 1, ..Radar::default() };
        let told = table(all).signs(2, &snapshot, false).unwrap_err().to_string();
        assert!(told.contains("only where radar.samples is above 1"), "{told}");
        let signs = signs(&snapshot, PLUS);
        assert_eq!((signs.carrier_hz, signs.reverses_samples), (77e9, false));
    }
}
