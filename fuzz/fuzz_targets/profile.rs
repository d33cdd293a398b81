//! The `.cfg` of a radar: any bytes, any sub-frame.
#![no_main]

use apertura::recording::{RadarProfile, config_text};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    let text = config_text(data);
    for sub_frame in [None, Some(1)] {
        if let Ok(profile) = RadarProfile::of_sub_frame(&text, sub_frame) {
            assert!(profile.bandwidth_hz() >= 0.0 && profile.samples > 0);
        }
    }
});
