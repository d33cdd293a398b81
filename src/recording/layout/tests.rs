use super::stream::CaptureStream;
use super::*;
use crate::recording::RadarProfile;
use crate::recording::card::tests::sent;
use num_complex::Complex64;
use proptest::prelude::*;
use std::f64::consts::TAU;
use std::io::Cursor;

const SAMPLES: usize = 96;

/// 96 samples, three receivers, one transmitter, eight loops.
const CFG: &str = "channelCfg 7 1 0\nprofileCfg 0 77 10 6 60 0 0 50 1 96 4000 0 0 30\nchirpCfg 0 0 0 0 0 0 0 1\nframeCfg 0 0 8 0 100 1 0\n";

fn profile(more: &str) -> RadarProfile {
    RadarProfile::parse(&format!("{CFG}{more}")).unwrap()
}

/// Numbers up to half of `size` either way, the same ones for the same seed.
fn noise(mut seed: u32, size: f64) -> impl FnMut() -> f64 {
    move || {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        size * (f64::from(seed >> 16) / 65536.0 - 0.5)
    }
}

fn chirps() -> Vec<Vec<Complex64>> {
    seen(300.0)
}

/// Eight chirps of three receivers, with this amplitude of the second echo.
fn seen(second: f64) -> Vec<Vec<Complex64>> {
    rows(8, 3 * SAMPLES, noise(7, 8.0), |n| {
        let (receiver, n) = ((n / SAMPLES) as f64, (n % SAMPLES) as f64);
        let turns = |bin: f64, phase: f64| TAU * (bin * n / SAMPLES as f64 + phase * receiver);
        900.0 * Complex64::cis(turns(13.3, 0.21)) + second * Complex64::cis(turns(29.7, -0.13))
    })
}

/// Rows of `length` samples: echoes, and noise beside them.
fn rows(
    count: usize,
    length: usize,
    mut noise: impl FnMut() -> f64,
    echoes: impl Fn(usize) -> Complex64,
) -> Vec<Vec<Complex64>> {
    let mut sample = |n| echoes(n) + Complex64::new(noise(), noise());
    (0..count).map(|_| (0..length).map(&mut sample).collect()).collect()
}

fn written(layout: &Layout, chirps: &[Vec<Complex64>]) -> Vec<u8> {
    let mut out = Vec::new();
    let word = |v: f64| match layout.encoding {
        NumberEncoding::Int16 => (v.round() as i16).to_le_bytes(),
        NumberEncoding::OffsetBinary => ((v.round() as i16) as u16 ^ 0x8000).to_le_bytes(),
        NumberEncoding::BigEndian => (v.round() as i16).to_be_bytes(),
        NumberEncoding::TwelveBits => ((v.round() as i16) as u16 & 0x0fff).to_le_bytes(),
    };
    for chirp in chirps {
        out.extend(marks::MAGIC.iter().chain(&[0; 56]).take(layout.header_bytes));
        let sorted: Vec<Complex64> = match layout.receivers {
            ReceiverOrder::OneAfterAnother => chirp.clone(),
            ReceiverOrder::Interleaved => (0..chirp.len()).map(|n| chirp[n % 3 * SAMPLES + n / 3]).collect(),
        };
        for block in sorted.chunks(layout.part_order.group()) {
            let (first, second): (Vec<f64>, Vec<f64>) =
                block.iter().map(|v| if layout.q_first { (v.im, v.re) } else { (v.re, v.im) }).unzip();
            out.extend(first.iter().flat_map(|v| word(*v)));
            if layout.part_order != PartOrder::Real {
                out.extend(second.iter().flat_map(|v| word(*v)));
            }
        }
    }
    out
}

fn layout(encoding: NumberEncoding, part_order: PartOrder, q_first: bool, receivers: ReceiverOrder) -> Layout {
    Layout { encoding, part_order, q_first, receivers, header_bytes: 0, packets: false }
}

fn in_order(part_order: PartOrder) -> Layout {
    layout(NumberEncoding::Int16, part_order, false, ReceiverOrder::OneAfterAnother)
}

fn found(bytes: Vec<u8>, profile: Option<&RadarProfile>) -> Found {
    find(&mut CaptureStream::new(Cursor::new(bytes)).unwrap(), profile).unwrap()
}

#[test]
fn every_layout_is_found_by_the_spectrum_alone() {
    for encoding in NumberEncoding::ALL {
        for part_order in [PartOrder::Pairs, PartOrder::TwoLanes, PartOrder::FourLanes] {
            for q_first in [false, true] {
                for receivers in [ReceiverOrder::OneAfterAnother, ReceiverOrder::Interleaved] {
                    let right = layout(encoding, part_order, q_first, receivers);
                    let found = found(written(&right, &chirps()), Some(&profile("")));
                    assert_eq!(found.best().layout, right, "{:#?}", found.sentences());
                    assert_ne!(found.certainty(), Certainty::Open, "{:#?}", found.sentences());
                }
            }
        }
    }
}

#[test]
fn complex_and_real_samples_are_judged_by_the_same_bytes() {
    let right = in_order(PartOrder::TwoLanes);
    let mut all = vec![chirps(); 4].concat();
    // Where the second half is louder, real samples, which are half as long, must not be judged by the first half alone.
    let mut turns = noise(1, 1.0);
    all[8..].iter_mut().flatten().for_each(|sample| *sample += Complex64::from_polar(120.0, TAU * turns()));
    let found = found(written(&right, &all), Some(&profile("")));
    assert_eq!(found.best().layout, right, "{:#?}", found.sentences());
}

#[test]
fn four_lanes_carry_a_receiver_each() {
    let order = |receivers| evidence::usual(&layout(NumberEncoding::Int16, PartOrder::FourLanes, false, receivers));
    let told = order(ReceiverOrder::Interleaved) - order(ReceiverOrder::OneAfterAnother);
    assert!(told > 16.0, "more than a .cfg's word for the other order: {told}");
}

#[test]
fn the_deciding_evidence_is_named() {
    let right = in_order(PartOrder::TwoLanes);
    let plain = found(written(&right, &chirps()), Some(&profile("")));
    assert_eq!(plain.decided_by(), EvidenceKind::Half, "I and Q alone are near: {:#?}", plain.sentences());
    assert!(plain.sentences().iter().any(|s| s.starts_with("Every receiver sees the same echoes")));
    // Two echoes in the far half have less weight than the .cfg.
    let swapped = profile("adcbufCfg -1 0 1 1 1\n");
    let one = found(written(&right, &seen(0.0)), Some(&swapped));
    assert!(one.best().layout.q_first && one.best().of_kind(EvidenceKind::Half) < 0.0, "{:#?}", one.sentences());
    assert_eq!(one.decided_by(), EvidenceKind::Config);
    let several = found(written(&right, &chirps()), Some(&swapped));
    assert!(several.best().layout.q_first, "{:#?}", several.sentences());
    assert_ne!(several.certainty(), Certainty::Open, "{:#?}", several.sentences());
}

#[test]
fn headers_before_chirps_are_found() {
    let right = Layout { header_bytes: 64, ..in_order(PartOrder::Pairs) };
    let found = found(written(&right, &chirps()), Some(&profile("lvdsStreamCfg -1 1 1 1\n")));
    assert_eq!(found.best().layout, right);
    assert!(found.notes.iter().any(|n| n.contains("header of 64 bytes: 8 were found")), "{:?}", found.notes);
}

fn packets(bytes: &[u8], lost: &[usize]) -> Vec<u8> {
    let kept = sent(bytes).into_iter().enumerate().filter(|(n, _)| !lost.contains(n));
    kept.flat_map(|(_, packet)| packet).collect()
}

#[test]
fn packets_are_read_with_zeros_for_those_lost() {
    let bytes: Vec<u8> = (0..20_000u32).map(|n| (n % 251) as u8).collect();
    let mut stream = CaptureStream::new(Cursor::new(packets(&bytes, &[]))).unwrap();
    let mut read = vec![0; 5000];
    stream.read_at(1000, &mut read).unwrap();
    assert!(stream.has_packets() && read == bytes[1000..6000] && stream.lost_packets() == 0);
    let mut stream = CaptureStream::new(Cursor::new(packets(&bytes, &[2, 5, 6]))).unwrap();
    assert_eq!((stream.bytes(), stream.lost_packets()), (20_000, 3));
    let mut all = vec![1; bytes.len()];
    stream.read_at(0, &mut all).unwrap();
    for (n, part) in all.chunks(1456).enumerate() {
        let expected =
            if [2, 5, 6].contains(&n) { vec![0; part.len()] } else { bytes[n * 1456..n * 1456 + part.len()].to_vec() };
        assert_eq!(part, expected, "packet {n}");
    }
    assert!(!CaptureStream::new(Cursor::new(bytes)).unwrap().has_packets());
}

#[test]
fn samples_with_receivers_are_found_without_a_cfg() {
    let three: Vec<Vec<Complex64>> = (0..5).flat_map(|_| chirps()).collect();
    for receivers in [ReceiverOrder::OneAfterAnother, ReceiverOrder::Interleaved] {
        let right = layout(NumberEncoding::Int16, PartOrder::TwoLanes, false, receivers);
        let found = found(written(&right, &three), None);
        let Candidate { layout, counts, .. } = found.best();
        let read = (layout, counts.samples, counts.receivers, counts.chirps);
        assert_eq!(read, (&right, SAMPLES, 3, 1), "{:#?}", found.sentences());
        if receivers == ReceiverOrder::OneAfterAnother {
            let of_three_transmitters = |c: &&Candidate| (c.counts.receivers, c.counts.chirps) == (1, 3);
            assert!(found.rivals().iter().any(of_three_transmitters), "{:#?}", found.sentences());
            assert_ne!(found.certainty(), Certainty::Sure, "{:#?}", found.sentences());
        }
    }
}

#[test]
fn a_short_file_without_a_cfg_is_never_sure() {
    let bytes = written(&in_order(PartOrder::Pairs), &chirps());
    for length in [1000, 2000, 4000] {
        let found = found(bytes[..length].to_vec(), None);
        assert_ne!(found.certainty(), Certainty::Sure, "{length} bytes: {:#?}", found.sentences());
    }
}

#[test]
fn a_cfg_of_another_capture_is_doubted() {
    let right = in_order(PartOrder::TwoLanes);
    let bytes = written(&right, &(0..5).flat_map(|_| chirps()).collect::<Vec<_>>());
    for (samples, is_doubted) in [(96, false), (48, true), (128, true), (250, true)] {
        let more = format!("profileCfg 0 77 10 6 60 0 0 50 1 {samples} 4000 0 0 30\n");
        let notes = found(bytes.clone(), Some(&profile(&more))).notes;
        assert_eq!(notes.iter().any(|n| n.contains("but they do so every 96")), is_doubted, "{samples}: {notes:?}");
    }
    let notes = found(bytes, Some(&profile("channelCfg 127 1 0\n"))).notes;
    assert!(notes.iter().any(|n| n.contains("a loop has 7 rows") && n.contains("again after 3")), "{notes:?}");
}

#[test]
fn two_echoes_at_mirrored_places_are_no_image() {
    let all = rows(8, 3 * SAMPLES, noise(3, 8.0), |n| {
        let (receiver, n) = ((n / SAMPLES) as f64, (n % SAMPLES) as f64 / SAMPLES as f64);
        let far = Complex64::from_polar(900.0, TAU * (66.0 * n + 0.13 * receiver));
        far + Complex64::from_polar(500.0, TAU * (30.0 * n + 0.21 * receiver))
    });
    let right = in_order(PartOrder::Pairs);
    let found = found(written(&right, &all), Some(&profile("adcbufCfg -1 0 0 1 1\n")));
    let best = found.best();
    assert_eq!((best.layout, best.of_kind(EvidenceKind::Images)), (right, 0.0), "{:#?}", found.sentences());
}

#[test]
fn a_constant_part_or_saturation_does_not_change_the_words() {
    let right = in_order(PartOrder::TwoLanes);
    let changed = |change: fn(Complex64) -> Complex64| -> Vec<Vec<Complex64>> {
        (0..5).flat_map(|_| chirps()).map(|chirp| chirp.into_iter().map(change).collect()).collect()
    };
    for chirps in [changed(|v| v + Complex64::new(2300.0, 1500.0)), changed(|v| v * 60.0)] {
        let found = found(written(&right, &chirps), None);
        let Candidate { layout, counts, .. } = found.best();
        assert_eq!((layout, counts.samples, counts.receivers), (&right, SAMPLES, 3), "{:#?}", found.sentences());
    }
}

#[test]
fn rows_of_a_nearly_continuous_echo_are_separated() {
    // Two transmitters and four receivers: from row to row of a loop the phase goes on but for a hundredth of a turn.
    let loops = rows(16, 1000, noise(7, 8.0), |n| {
        Complex64::from_polar(900.0, TAU * (13.3 * (n % 125) as f64 / 125.0 + 0.29 * (n / 125 % 8) as f64))
    });
    let found = found(written(&in_order(PartOrder::Pairs), &loops), None);
    let counts = found.best().counts;
    assert_eq!((counts.samples, counts.receivers, counts.chirps), (125, 4, 2), "{:#?}", found.sentences());
}

#[test]
fn rows_of_an_echo_that_moves_repeat_up_to_a_turn() {
    for (part_order, chirps) in [(PartOrder::Pairs, 2), (PartOrder::Pairs, 3), (PartOrder::Real, 2)] {
        // Receivers half a wavelength apart, transmitters in turn, and a fifth of a turn from chirp to chirp.
        let loops = rows(40, 480 * chirps, noise(7, 40.0), |n| {
            let row = n / 120;
            let turns = 13.3 * (n % 120) as f64 / 120.0 + 0.21 * (row % (4 * chirps)) as f64 + 0.2 * (row / 4) as f64;
            Complex64::from_polar(900.0, TAU * turns)
        });
        let found = found(written(&in_order(part_order), &loops), None);
        let counts = found.best().counts;
        assert_eq!((counts.samples, counts.receivers, counts.chirps), (120, 4, chirps), "{:#?}", found.sentences());
    }
}

#[test]
fn equal_rows_leave_the_receivers_open() {
    let one = rows(320, SAMPLES, noise(7, 8.0), |n| {
        let echo = |size: f64, bin: f64| Complex64::from_polar(size, TAU * bin * n as f64 / SAMPLES as f64);
        echo(900.0, 13.3) + echo(300.0, 29.7)
    });
    let found = found(written(&in_order(PartOrder::Pairs), &one), None);
    assert_ne!(found.certainty(), Certainty::Sure, "{:#?}", found.sentences());
}

#[test]
fn files_without_echoes_are_refused() {
    let mut state = 1u64;
    let mut byte = move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (state >> 56) as u8
    };
    let random: Vec<u8> = (0..300_000).map(|_| byte()).collect();
    let refused = |bytes: &[u8], profile: Option<&RadarProfile>| {
        find(&mut CaptureStream::new(Cursor::new(bytes)).unwrap(), profile).unwrap_err().to_string()
    };
    assert!(refused(&random, None).contains("spectrum is flat"));
    assert!(refused(&random, Some(&profile(""))).contains("spectrum is flat"));
    assert!(refused(&[0; 100_000], Some(&profile(""))).contains("nothing but zeros"));
    let short = "has 100 bytes; expected at least one chirp, 1152 bytes as the .cfg says";
    assert!(refused(&random[..100], Some(&profile(""))).contains(short));
    assert!(refused(&[], None).contains("has 0 bytes"));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    #[test]
    fn any_bytes_have_a_layout_or_none(bytes in proptest::collection::vec(any::<u8>(), 0..5000), has_profile: bool) {
        let profile = profile("");
        if let Ok(found) = find(&mut CaptureStream::new(Cursor::new(&bytes)).unwrap(), has_profile.then_some(&profile)) {
            prop_assert!(found.best().log_odds().is_finite() && !found.sentences().is_empty());
        }
    }
}
