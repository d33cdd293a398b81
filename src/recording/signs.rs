//! The sign of a recording's phases, and the sample at which its carrier was measured: from the samples of a physical radar to those that the maps'
//! formula takes.
//!
//! A physical radar's sample `n` has the phase `s 2 pi f_n (R_t + R_r) / c`, where R_t and R_r are the distances from the transmitter
//! and from the receiver. The sign `s` is one for all samples, and `f_n` rises or falls by `B / N` from sample to sample. The program's
//! formula ([`crate::signal`]) at a distance R is
//!
//! * two-way: `+2 pi (f + B n / N) 2 R / c`. Conjugated, and put in the order of rising frequency, physical samples are exactly this
//!   where `R_t = R_r = R`.
//! * one-way: `-2 pi (f - 2 B n / N) R / c`. Conjugated, and put in the order of falling frequency, physical samples are
//!   `-2 pi (F - B n / N) (R_t + R_r) / c`. For plane waves over virtual elements at the sum of both positions the phase from element
//!   to element is the same in the middle of the chirp where `f - B = F - B / 2`. Beside the middle it is not: the program's changes
//!   twice as fast, so that it expects echoes to migrate through twice as many range bins along the array.

use super::Fault;
use super::said_recording::{BeatSign, CarrierAt, Sweep, Table};
use crate::radar::{Carrier, Radar};
use ndarray::{Array, Axis, Dimension};
use num_complex::Complex64;

/// The format of today's texts; texts that name none are of format 1.
pub const FORMAT: u32 = 3;

pub(super) fn oldest() -> u32 {
    1
}

/// Changes of the samples and of the carrier that bring a recording to the maps' formula.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Signs {
    pub conjugates: bool,
    pub reverses_samples: bool,
    /// The carrier of the maps' formula, hertz.
    pub carrier_hz: f64,
}

impl Signs {
    /// Changes samples, whose last axis counts them within a chirp.
    pub fn apply<D: Dimension>(self, samples: &mut Array<Complex64, D>) {
        if self.conjugates {
            samples.mapv_inplace(|v| v.conj());
        }
        if self.reverses_samples {
            samples.invert_axis(Axis(samples.ndim() - 1));
        }
    }
}

impl Table {
    /// The changes that signs and carrier ask of the samples of `radar`, whose carrier is as the text says it. The carrier of a `.cfg` is that in the
    /// middle of the samples.
    ///
    /// # Errors
    /// [`Fault::Key`] names the key that is missing, or that does not go with the others.
    pub fn signs(&self, format: u32, radar: &Radar, has_profile: bool) -> Result<Signs, Fault> {
        let Table { carrier_at, beat_sign, sweep, conjugate, .. } = *self;
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
                if let Some((name, _)) = named.into_iter().find(|(_, said)| *said) {
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
        Ok(physical(radar, at, beat, sweep.unwrap_or_default()))
    }
}

/// The changes of a physical radar's samples.
fn physical(radar: &Radar, at: CarrierAt, beat: BeatSign, sweep: Sweep) -> Signs {
    let rises = sweep == Sweep::Up;
    // The beat's phase is the carrier's less what it was at the first sample: both signs are one where the frequency rises.
    let phase_is_positive = (beat == BeatSign::Positive) == rises;
    let wants_positive = radar.carrier == Carrier::TwoWay;
    let conjugates = phase_is_positive != wants_positive;
    // The program's beat turns forwards: its frequency rises where phases are positive, and falls where they are negative.
    let reverses_samples = rises != wants_positive && radar.samples > 1;
    let per_sample = radar.bandwidth_hz / radar.samples as f64;
    let (last, way) = ((radar.samples - 1) as f64, if rises { 1.0 } else { -1.0 });
    let first_hz = match at {
        CarrierAt::FirstSample => radar.carrier_hz,
        CarrierAt::Middle => radar.carrier_hz - way * radar.bandwidth_hz / 2.0,
    };
    let first_taken_hz = if reverses_samples { first_hz + way * per_sample * last } else { first_hz };
    let carrier_hz = match radar.carrier {
        _ if radar.samples == 1 => radar.carrier_hz,
        Carrier::TwoWay => first_taken_hz,
        // Halfway the program has taken off twice what the radar has.
        Carrier::OneWay => first_taken_hz + per_sample * last / 2.0,
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

    fn table(keys: &str) -> Table {
        toml::from_str(&format!("file = \"a.npz\"\n{keys}")).unwrap()
    }

    const FIRST: &str = "carrier_at = \"first-sample\"\n";
    const PLUS: &str = "beat_sign = \"+\"\n";

    #[test]
    fn keys_that_do_not_go_together_are_told() {
        let all = &format!("{FIRST}{PLUS}");
        for (format, keys, part) in [
            (1, all.as_str(), "recording.carrier_at is there"),
            (4, all, "format is 4; expected 1, 2 or 3"),
            (2, &format!("{all}conjugate = true"), "beat_sign in its place"),
            (2, FIRST, "recording.beat_sign is missing"),
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
