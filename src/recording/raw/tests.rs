use super::*;
use std::f64::consts::TAU;
use std::fs;

/// Two transmitters, four receivers, 64 samples, four loops.
pub const CFG: &str = "channelCfg 15 5 0\nadcCfg 2 1\nadcbufCfg -1 0 0 1 1\nprofileCfg 0 77 30 6 60 0 0 50 1 64 4000 0 0 30\n\
                   chirpCfg 0 0 0 0 0 0 0 1\nchirpCfg 1 1 0 0 0 0 0 4\nframeCfg 0 1 4 0 100 1 0\n";

/// One frame of I Q pairs: an echo in range bin 11.4, at broadside.
fn frame() -> Vec<u8> {
    let sample = |n: usize| {
        let turns = TAU * 11.4 * (n % 64) as f64 / 64.0;
        let noise = |of: usize| ((n * of) % 23) as f64 / 4.0;
        [(900.0 * turns.cos() + noise(7)) as i16, (900.0 * turns.sin() + noise(13)) as i16]
    };
    (0..4 * 2 * 4 * 64).flat_map(sample).flat_map(i16::to_le_bytes).collect()
}

pub fn folder(files: &[(&str, &[u8])]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    files.iter().for_each(|(name, bytes)| fs::write(folder.path().join(name), bytes).unwrap());
    folder
}

#[test]
fn parts_of_a_split_capture_are_read_as_one() {
    let bytes = frame();
    let (first, second) = bytes.split_at(bytes.len() / 2 + 100);
    let folder = folder(&[("adc_Raw_0.bin", first), ("adc_Raw_1.bin", second), ("c.cfg", CFG.as_bytes())]);
    let recording = open(&folder.path().join("adc_Raw_0.bin"), None).unwrap();
    assert!(recording.doubts.iter().any(|d| d.contains("goes on in 1 more")), "{:?}", recording.doubts);
    let whole = self::folder(&[("w.bin", &bytes), ("w.cfg", CFG.as_bytes())]);
    assert_eq!(recording.samples, open(&whole.path().join("w.bin"), None).unwrap().samples);
}

/// Files of a cascade's four chips, receivers at `places` in half wavelengths: one transmitter, an echo in range bin 11.4 at cos 0.3, eight loops.
fn cascade(places: [f64; 16]) -> tempfile::TempDir {
    let sample = |receiver: usize, n: usize| {
        let turns = TAU * (11.4 * n as f64 / 64.0) - TAU * 0.5 * 0.3 * places[receiver];
        let noise = |of: usize| ((n * of + receiver) % 23) as f64 / 4.0;
        [(900.0 * turns.cos() + noise(7)) as i16, (900.0 * turns.sin() + noise(13)) as i16]
    };
    let chirp = |chip: usize| (0..64).flat_map(move |n| (4 * chip..4 * chip + 4).flat_map(move |r| sample(r, n)));
    let cfg = CFG.replace("frameCfg 0 1 4", "frameCfg 0 0 8").replace("adcbufCfg -1 0 0 1 1", "adcbufCfg -1 0 0 0 1");
    let folder = folder(&[("c.cfg", cfg.as_bytes())]);
    for (chip, name) in ["master", "slave1", "slave2", "slave3"].into_iter().enumerate() {
        let bytes: Vec<u8> = (0..8).flat_map(|_| chirp(chip)).flat_map(i16::to_le_bytes).collect();
        fs::write(folder.path().join(format!("{name}_0000_data.bin")), bytes).unwrap();
    }
    folder
}

#[test]
fn any_chip_of_a_cascade_opens_all_four() {
    let folder = cascade(boards::BY_CHIP.receivers.try_into().unwrap());
    for name in ["master_0000_data.bin", "slave2_0000_data.bin"] {
        let imported = import(&folder.path().join(name), None, None).unwrap();
        let toml = imported.origin.toml();
        let parts = ["file = \"master_0000_data.bin\"", "chips = [\"slave1_0000_data.bin\""];
        assert!(parts.iter().all(|part| toml.contains(part)), "{toml}");
        let recording = imported.origin.recording().unwrap();
        // Places from 0 to 53, of which 16 hold a receiver.
        assert_eq!((recording.radar.elements, recording.missing.len()), (54, 38));
        assert!(recording.doubts.iter().any(|d| d.contains("four chips of a cascade")), "{:?}", recording.doubts);
        fs::write(folder.path().join("r.toml"), toml).unwrap();
        assert_eq!(super::super::file::load(&folder.path().join("r.toml")).unwrap().samples, recording.samples);
    }
}

#[test]
fn the_order_of_chips_is_the_sharper_one() {
    let from_left = boards::by_name("cascade").unwrap().receivers;
    for places in [from_left, boards::BY_CHIP.receivers] {
        let folder = cascade(places.try_into().unwrap());
        let toml = import(&folder.path().join("master_0000_data.bin"), None, None).unwrap().origin.toml().to_owned();
        let starts_left = toml.contains("receiver_x_metres = [0.0,");
        assert_eq!(starts_left, places[0] == 0.0, "{toml}");
    }
}

#[test]
fn a_chip_without_the_others_is_noted() {
    let bytes = frame();
    let folder =
        folder(&[("master_0000_data.bin", &bytes), ("slave2_0000_data.bin", &bytes), ("c.cfg", CFG.as_bytes())]);
    let told = |name: &str| open(&folder.path().join(name), None).unwrap().doubts.join(" ");
    assert!(told("master_0000_data.bin").contains("missing slave1_0000_data.bin, slave3_0000_data.bin"));
    assert!(told("slave2_0000_data.bin").contains("missing slave1_0000_data.bin, slave3_0000_data.bin"));
}

#[test]
fn a_capture_of_one_element_is_refused() {
    let one = CFG.replace("channelCfg 15", "channelCfg 1").replace("frameCfg 0 1", "frameCfg 0 0");
    let folder = folder(&[("a.bin", &frame()), ("a.cfg", one.as_bytes())]);
    let told = open(&folder.path().join("a.bin"), None).unwrap_err().to_string();
    assert!(told.contains("one transmitter and one receiver, which tell ranges and no directions"), "{told}");
}

#[test]
fn transmitters_at_another_height_are_left_out_of_the_line() {
    let three = CFG.replace("frameCfg 0 1 4", "chirpCfg 2 2 0 0 0 0 0 2\nframeCfg 0 2 4");
    let bytes = [frame(), frame()].concat();
    let folder = folder(&[("a.bin", &bytes), ("a.cfg", three.as_bytes())]);
    let imported = import(&folder.path().join("a.bin"), None, None).unwrap();
    assert!(imported.origin.toml().contains("chirps = [0, 1]"), "{}", imported.origin.toml());
    let told = "Chirps 2 of a loop are sent at another height";
    assert!(imported.origin.doubts.iter().any(|d| d.contains(told)), "{:?}", imported.origin.doubts);
}

#[test]
fn places_of_a_cfg_make_the_line() {
    let across = "antGeometry0 0 1 2 3 4 5 6 7\n";
    let planar = "antGeometry0 0 -1 -1 0 -2 -3 -3 -2 -2 -3 -3 -2\nantGeometry1 -1 -1 0 0 -1 -1 0 0 -3 -3 -2 -2\n";
    let both = format!("bpmCfg -1 1 0 1\n{across}");
    for (what, masks, more, elements) in [
        ("places across alone stand at one height", [1, 2], across, 8),
        ("the longest line of a planar board", [1, 2], planar, 4),
        ("transmitters that send together", [3, 3], &both, 8),
    ] {
        let mask = |n: usize| format!(" 0 0 0 0 {}\n", masks[n]);
        let cfg = CFG.replace(" 0 0 0 0 1\n", &mask(0)).replace(" 0 0 0 0 4\n", &mask(1)) + more;
        let folder = folder(&[("a.bin", &frame()), ("a.cfg", cfg.as_bytes())]);
        let recording = open(&folder.path().join("a.bin"), None).unwrap();
        assert_eq!(recording.radar.elements, elements, "{what}");
        let told = recording.doubts.iter().any(|d| d.contains("antGeometry"));
        assert!(told || masks[0] == 3, "{what}: {:?}", recording.doubts);
    }
}

#[test]
fn files_of_no_capture_are_refused() {
    let folder = folder(&[
        ("a.cfg", CFG.as_bytes()),
        ("b.cfg", b"{ \"mmWaveDevices\": [] }"),
        ("empty.bin", b""),
        ("odd.dat", &[7; 999]),
        ("rows.raw", b"set,index,squared_error\n1,0,210.5\n"),
        ("scene.bin", b"[[object]]\nkind = \"point\"\n"),
    ]);
    let told = |path: &str, config: Option<&str>| {
        let config = config.map(|c| folder.path().join(c));
        open(&folder.path().join(path), config.as_deref()).unwrap_err().to_string()
    };
    assert!(told("a.cfg", None).contains("a.cfg: the .cfg sets a radar up and holds no samples"));
    let short = "empty.bin: has 0 bytes; expected at least one chirp, 1024 bytes as the .cfg says";
    assert!(told("empty.bin", Some("a.cfg")).contains(short) && told("empty.bin", None).contains("has 0 bytes"));
    assert!(told("odd.dat", Some("b.cfg")).contains("b.cfg: is a text of another dialect, mmWave Studio's JSON"));
    assert!(told("rows.raw", None).contains("rows.raw: the file is a text file; expected a capture of 16-bit samples"));
    assert!(told("scene.bin", Some("a.cfg")).contains("scene.bin: the file is a scene (.toml)"));
    assert!(told("no.bin", Some("a.cfg")).contains("no.bin: No such file"));
    fs::create_dir(folder.path().join("folder.bin")).unwrap();
    assert!(told("folder.bin", Some("a.cfg")).contains("is a folder"));
}

#[test]
fn boards_have_the_places_of_their_guides() {
    let cascade = boards::by_name("CASCADE").unwrap();
    let flat: Vec<f64> = cascade.transmitters.iter().filter(|[_, up]| *up == 0.0).map(|[x, _]| *x).collect();
    let antennas = crate::radar::Antennas::new(&flat, cascade.receivers).unwrap();
    assert_eq!((antennas.pairs().len(), antennas.gaps()), (86, 0));
    assert!(boards::ALL.iter().all(|b| ["SWRU", "SPRUI", "TIDU"].iter().any(|of| b.guide.contains(of))));
    assert_eq!(boards::by_name("another"), None);
}
