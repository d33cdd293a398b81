use super::*;

/// Two transmitters, four receivers, eight samples, two loops.
pub const CFG: &str = "% a small radar
sensorStop
dfeDataOutputMode 1
channelCfg 15 5 0
adcCfg 2 1
profileCfg 0 77 429 7 57.14 0 0 70 1 8 5209 0 0 30
chirpCfg 0 0 0 0 0 0 0 1
chirpCfg 1 1 0 0 0 0 0 4
frameCfg 0 1 2 0 100 1 0
sensorStart
";

fn with(from: &str, to: &str) -> RadarProfile {
    RadarProfile::parse(&CFG.replace(from, to)).unwrap()
}

fn refused(from: &str, to: &str) -> String {
    RadarProfile::parse(&CFG.replace(from, to)).unwrap_err().to_string()
}

#[test]
fn a_profile_is_read_in_si_units() {
    let profile = RadarProfile::parse(CFG).unwrap();
    assert_eq!((profile.samples, profile.receivers, profile.loops, profile.frames), (8, 4, 2, 0));
    assert_eq!(profile.chirp_transmitters, [1, 4]);
    assert!((profile.bandwidth_hz() - 70e12 * 8.0 / 5.209e6).abs() < 1.0);
    let middle = 77e9 + 70e12 * (7e-6 + 4.0 / 5.209e6);
    assert!((profile.carrier_hz() - middle).abs() < 1.0 && (profile.chirp_interval_seconds - 486.14e-6).abs() < 1e-9);
}

#[test]
fn faults_name_line_with_command() {
    for (from, to, parts) in [
        ("frameCfg 0 1 2 0 100 1 0\n", "", ["\"frameCfg\"", "expected profileCfg"]),
        ("profileCfg 0 77", "profileCfg 0 x", ["line 6", "\"x\" is no number; expected"]),
        (" 8 5209 0 0 30", "", ["line 6: profileCfg", "the number of samples as number 10"]),
        (" 8 5209", " 8.5 5209", ["line 6", "8.5"]),
        (" 8 5209", " 1e99 5209", ["line 6", "up to 65536"]),
        ("0 77 429", "0 nan 429", ["start frequency", "above 0"]),
        ("0 77 429", "0 1e30 429", ["start frequency", "at most 1e9"]),
        (" 70 1 8", " 0 1 8", ["the slope in MHz/us is 0", "other than 0"]),
        ("chirpCfg 1 1 0 0", "chirpCfg 1 1 0 5", ["line 8", "the change of frequency is not 0"]),
        ("frameCfg 0 1", "frameCfg 0 2", ["chirp 2", "no chirpCfg"]),
        ("frameCfg 0 1", "frameCfg 1 0", ["line 9", "rising"]),
        ("channelCfg 15", "channelCfg 0", ["line 4", "no receiver"]),
        ("sensorStart", "advFrameCfg 2 0 0 1 0", ["line 10", "names 2 sub-frames, but 0 lines \"subFrameCfg\""]),
    ] {
        let message = refused(from, to);
        assert!(parts.iter().all(|p| message.contains(p)), "{from} -> {to}: {message}");
    }
}

#[test]
fn other_dialects_are_refused_by_name() {
    let xwrl =
        "channelCfg 7 3 0\nchirpComnCfg 13 0 0 128 4 28 0\nchirpTimingCfg 6 32 0 75 60\nframeCfg 2 0 600 64 100 0\n";
    for (text, name) in [
        (xwrl, "xWRL"),
        ("{ \"mmWaveDevices\": [] }", "mmWave Studio's JSON"),
        ("{ \"a\": 1 }", "JSON"),
        ("ar1.ProfileConfig(0, 77, 100)", "Lua"),
        ("<?xml version=\"1.0\"?>\n<radar/>", "XML"),
    ] {
        let message = RadarProfile::parse(text).unwrap_err().to_string();
        assert!(message.contains(name) && message.contains("what would help"), "{message}");
    }
}

#[test]
fn comments_marks_prompts_and_line_ends_do_not_matter() {
    let expected = RadarProfile::parse(CFG).unwrap();
    let said = |text: &[u8]| RadarProfile::parse(&lines::config_text(text)).unwrap();
    assert_eq!(said(CFG.replace('\n', "\r\n").as_bytes()), expected);
    assert_eq!(said(CFG.replace('\n', "\r").as_bytes()), expected);
    assert_eq!(said([b"\xef\xbb\xbf".as_slice(), CFG.as_bytes()].concat().as_slice()), expected);
    let latin = [b"% Gr\xfc\xdfe\n".as_slice(), CFG.as_bytes()].concat();
    assert_eq!(said(&latin), expected);
    let wide: Vec<u8> = [0xff, 0xfe].into_iter().chain(CFG.encode_utf16().flat_map(u16::to_le_bytes)).collect();
    assert_eq!(said(&wide), expected);
    assert_eq!(said(CFG.replace("channelCfg", "mmwDemo:/>channelCfg").as_bytes()), expected);
    assert_eq!(said(CFG.replace("100 1 0\n", "100 1 0 % ten a second\n").as_bytes()), expected);
    assert_eq!(said(CFG.replace("15 5 0", "15, 5, 0;").as_bytes()), expected);
}

#[test]
fn the_last_of_equal_commands_counts() {
    assert_eq!(with("sensorStart", "channelCfg 3 5 0").receivers, 2);
    assert_eq!(with("sensorStart", "profileCfg 0 77 429 7 57.14 0 0 70 1 16 5209 0 0 30").samples, 16);
    assert_eq!(with(" 8 5209", " 125 5209").samples, 125);
    assert!(refused("sensorStart", "flushCfg").contains("profileCfg"));
}

#[test]
fn data_format_and_corrections_are_read() {
    let more = "adcbufCfg -1 0 1 0 1\nlvdsStreamCfg -1 1 1 1\ncompRangeBiasAndRxChanPhase 0.05 1 0 -1 0 0 1\n";
    let profile = with("sensorStart", more);
    assert_eq!((profile.q_first, profile.interleaved, profile.has_headers), (Some(true), Some(true), true));
    let of_old_sdk = with("sensorStart", "adcbufCfg 0 0 1 1");
    assert_eq!((of_old_sdk.q_first, of_old_sdk.interleaved), (Some(false), Some(false)));
    assert_eq!(profile.range_bias_metres, 0.05);
    assert_eq!(profile.channel_factors, [Complex64::ONE, -Complex64::ONE, Complex64::I]);
    let real = with("adcCfg 2 1", "adcCfg 2 0");
    assert!(real.real && real.complex_samples() == 4);
    assert!(refused("sensorStart", "compRangeBiasAndRxChanPhase 1e9 1 0").contains("range bias is 1000000000"));
}

#[test]
fn transmitters_that_send_together_are_told_apart() {
    let both = CFG.replace(" 0 0 0 0 1\n", " 0 0 0 0 5\n").replace(" 0 0 0 0 4\n", " 0 0 0 0 5\n");
    let said = |more: &str| RadarProfile::parse(&both.replace("sensorStart", more)).unwrap();
    assert!(said("bpmCfg -1 1 0 1").both_transmitters);
    assert!(!said("bpmCfg -1 0 0 1").both_transmitters && !said("").both_transmitters);
    assert!(!with("sensorStart", "bpmCfg -1 1 0 1").both_transmitters, "each chirp has one transmitter");
}

#[test]
fn profiles_that_are_alike_are_one() {
    let second = "profileCfg 1 77 429 7 57.14 0 0 70 1 8 5209 0 0 48\nchirpCfg 1 1 1 0 0 0 0 4\n";
    let profile = with("sensorStart", second);
    assert!(profile.notes[0].contains("2 profiles that are alike"), "{:?}", profile.notes);
    let other = second.replace("70 1 8", "60 1 8");
    assert!(refused("sensorStart", &other).contains("profiles that differ"));
    let unused = "profileCfg 1 60 429 7 57.14 0 0 70 1 8 5209 0 0 48\n";
    assert_eq!(with("sensorStart", unused).start_hz, 77e9);
}

#[test]
fn one_sub_frame_of_several_is_chosen() {
    let advanced = CFG.replace(
        "frameCfg 0 1 2 0 100 1 0\n",
        "chirpCfg 2 2 1 0 0 0 0 1\nprofileCfg 1 77 429 7 57.14 0 0 50 1 16 5209 0 0 30\nadvFrameCfg 2 0 10 1 0\n\
         subFrameCfg 0 0 0 2 4 100 0 1 1 50\nsubFrameCfg 1 0 2 1 8 100 0 2 1 50\n",
    );
    let [first, second] = [0, 1].map(|n| RadarProfile::of_sub_frame(&advanced, Some(n)).unwrap());
    assert_eq!((first.samples, first.loops, first.chirp_transmitters.len(), first.numbers_before), (8, 4, 2, 0));
    assert_eq!((second.samples, second.loops, second.numbers_before), (16, 16, 4 * 2 * 4 * 8));
    assert_eq!((first.frame_numbers, first.frames), (4 * 2 * 4 * 8 + 16 * 4 * 16, 10));
    assert!(first.notes[0].contains("2 sub-frames"));
    let message = RadarProfile::of_sub_frame(&advanced, Some(2)).unwrap_err().to_string();
    assert!(message.contains("sub_frame = 0 to 1"), "{message}");
}
