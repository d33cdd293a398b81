use super::super::layout::{PartOrder, ReceiverOrder};
use super::super::profile::tests::CFG;
use super::*;
use proptest::prelude::*;
use std::io::Cursor;

fn profile() -> RadarProfile {
    RadarProfile::parse(CFG).unwrap()
}

fn capture(lanes: usize, receivers: ReceiverOrder) -> Capture {
    let text = format!("lanes = {lanes}\nreceivers = \"interleaved\"\nchirps = [0, 1]");
    Capture { receivers, ..toml::from_str(&text).unwrap() }
}

type Read = Result<(Array3<Complex64>, Vec<String>), Fault>;

fn read(capture: &Capture, bytes: &[u8], profile: &RadarProfile) -> Read {
    capture.read(Cursor::new(bytes), Some(profile), &[], true)
}

fn expected(turn: usize, chirp: usize, receiver: usize, sample: usize) -> Complex64 {
    let code = (1000 * turn + 100 * chirp + 10 * receiver + sample) as f64;
    Complex64::new(code, -code - 1.0)
}

/// `loops` loops as the lanes send them, written out by the words of the capture card's documentation.
fn file(loops: usize, lanes: usize, receivers: ReceiverOrder) -> Vec<u8> {
    let mut stream = Vec::new();
    for turn in 0..loops {
        for chirp in 0..2 {
            match receivers {
                ReceiverOrder::OneAfterAnother => {
                    (0..4).for_each(|r| (0..8).for_each(|s| stream.push(expected(turn, chirp, r, s))));
                }
                ReceiverOrder::Interleaved => {
                    (0..8).for_each(|s| (0..4).for_each(|r| stream.push(expected(turn, chirp, r, s))));
                }
            }
        }
    }
    let part = |v: f64| (v as i16).to_le_bytes();
    let block = |b: &[Complex64]| -> Vec<u8> {
        b.iter().flat_map(|v| part(v.re)).chain(b.iter().flat_map(|v| part(v.im))).collect()
    };
    stream.chunks_exact(lanes).flat_map(block).collect()
}

#[test]
fn every_layout_gives_every_sample_its_place() {
    for lanes in [2, 4] {
        for order in [ReceiverOrder::OneAfterAnother, ReceiverOrder::Interleaved] {
            let layout = Capture { frame: 1, loop_choice: ChirpChoice::Number(1), ..capture(lanes, order) };
            let (found, _) = read(&layout, &file(4, lanes, order), &profile()).unwrap();
            assert_eq!(found.dim(), (2, 4, 8));
            for ((chirp, receiver, sample), v) in found.indexed_iter() {
                assert_eq!(*v, expected(3, chirp, receiver, sample), "{lanes} lanes, {order:?}");
            }
        }
    }
    let order = ReceiverOrder::OneAfterAnother;
    let turned = Capture { chirps: Some(vec![1]), ..capture(2, order) };
    let (found, _) = read(&turned, &file(2, 2, order), &profile()).unwrap();
    assert_eq!((found.dim(), found[[0, 2, 5]]), ((1, 4, 8), expected(0, 1, 2, 5)));
    let fewer = Capture { receivers_taken: Some(vec![3, 1]), ..capture(2, order) };
    let (found, _) = read(&fewer, &file(2, 2, order), &profile()).unwrap();
    assert_eq!((found.dim(), found[[1, 0, 5]]), ((2, 2, 8), expected(0, 1, 3, 5)));
}

#[test]
fn contradictions_are_refused() {
    let order = ReceiverOrder::OneAfterAnother;
    let whole = file(2, 2, order);
    let message = |capture: Capture, profile: &RadarProfile, bytes: &[u8]| {
        read(&capture, bytes, profile).unwrap_err().to_string()
    };
    let usual = || capture(2, order);
    for (changed, part) in [
        (Capture { lanes: Some(3), ..usual() }, "2 or 4"),
        (Capture { lanes: None, ..usual() }, "parts is missing"),
        (Capture { part_order: Some(PartOrder::Pairs), ..usual() }, "lanes stands beside parts"),
        (Capture { samples: Some(8), ..usual() }, "samples is 8; expected it not beside a .cfg"),
        (Capture { chirps: None, ..usual() }, "chirps is missing; expected some of 0 to 1"),
        (Capture { chirps: Some(vec![0, 0]), ..usual() }, "each once"),
        (Capture { chirps: Some(vec![2]), ..usual() }, "0 to 1"),
        (Capture { receivers_taken: Some(vec![4]), ..usual() }, "receivers_taken is [4]"),
        (Capture { frame: 1, ..usual() }, "frame is 1; expected 0 to 0"),
        (Capture { loop_choice: ChirpChoice::Number(2), ..usual() }, "loop is 2; expected 0 to 1"),
    ] {
        let message = message(changed, &profile(), &whole);
        assert!(message.contains(part), "{message}");
    }
    assert!(message(usual(), &profile(), &whole[..100]).contains("at least 256: a loop has 2 chirps of 4"));
    let odd = RadarProfile { samples: 7, receivers: 3, receiver_numbers: vec![0, 1, 2], ..profile() };
    assert!(message(usual(), &odd, &whole).contains("3 receivers of 7 samples don't fill 2 lanes"));
    let three = "receivers = \"interleaved\"\nparts = \"pairs\"\nsamples = 8";
    let unsaid: Capture = toml::from_str(three).unwrap();
    let told = unsaid.read(Cursor::new(&whole), None, &[], true).unwrap_err().to_string();
    assert!(told.contains("receiver_count is missing"), "{told}");
}

#[test]
fn a_cut_file_gives_its_whole_frames() {
    let order = ReceiverOrder::OneAfterAnother;
    let ten = RadarProfile { frames: 10, ..profile() };
    let (found, notes) = read(&capture(2, order), &file(5, 2, order), &ten).unwrap();
    assert_eq!(found[[1, 3, 7]], expected(0, 1, 3, 7));
    assert!(notes[0].contains("2 whole frames and 256 bytes of another (50 %)"), "{notes:?}");
    let (_, notes) = read(&capture(2, order), &file(4, 2, order), &ten).unwrap();
    assert!(notes[0].contains("2 whole frames, not the 10"), "{notes:?}");
    let (_, notes) = read(&capture(2, order), &file(1, 2, order), &ten).unwrap();
    assert!(notes[0].contains("cut") && notes[0].contains("1 whole loops"), "{notes:?}");
}

#[test]
fn zeros_saturation_constants_and_real_samples_are_noted() {
    let order = ReceiverOrder::OneAfterAnother;
    let long = RadarProfile { samples: 64, loops: 1, ..profile() };
    let notes = |change: &dyn Fn(usize) -> [i16; 2]| {
        let words = |n: usize| change(n).into_iter().flat_map(i16::to_le_bytes);
        let bytes: Vec<u8> = (0..2 * 4 * 64).flat_map(words).collect();
        let pairs = Capture { lanes: None, part_order: Some(PartOrder::Pairs), ..capture(2, order) };
        read(&pairs, &bytes, &long).unwrap().1.join(" ")
    };
    let wave = |n: usize, of: f64| [(of * (n as f64).cos()) as i16, (of * (n as f64).sin()) as i16];
    assert_eq!(notes(&|n| wave(n, 900.0)), "");
    let lost = notes(&|n| if n < 70 { [0, 0] } else { wave(n, 900.0) });
    assert!(lost.contains("zeros, as lost packets leave them, spoil 1 of the frame's 2"), "{lost}");
    assert!(notes(&|n| wave(n, 60000.0)).contains("saturated"));
    assert!(notes(&|n| wave(n, 900.0).map(|v| v + 3000)).contains("constant part"));
    assert!(notes(&|n| [wave(n, 900.0)[0], 0]).contains("real samples, stored as complex"));
}

#[test]
fn channels_are_multiplied_by_transmitter() {
    let factors: Vec<Complex64> = (0..12).map(|n| Complex64::new(f64::from(n), 1.0)).collect();
    let order = ReceiverOrder::OneAfterAnother;
    // Transmitters 0 and 2 of three, then of two.
    for (factors, second) in [(factors.clone(), 8), (factors[..8].to_vec(), 4)] {
        let turned = RadarProfile { channel_factors: factors.clone(), ..profile() };
        let (found, _) = read(&capture(2, order), &file(2, 2, order), &turned).unwrap();
        assert_eq!(found[[1, 1, 3]], expected(0, 1, 1, 3) * factors[second + 1]);
    }
    let few = RadarProfile { channel_factors: factors[..3].to_vec(), ..profile() };
    let (_, notes) = read(&capture(2, order), &file(2, 2, order), &few).unwrap();
    assert!(notes.iter().any(|n| n.contains("factors of 3 channels, but 8")), "{notes:?}");
}

proptest! {
    #[test]
    fn any_bytes_are_read_or_refused(bytes in proptest::collection::vec(any::<u8>(), 0..1200), frame in 0usize..9) {
        let layout = Capture { frame, loop_choice: ChirpChoice::Joined(Join::Strongest), ..capture(2, ReceiverOrder::OneAfterAnother) };
        if let Ok((found, _)) = read(&layout, &bytes, &profile()) {
            prop_assert_eq!(found.dim(), (2, 4, 8));
        }
    }
}
