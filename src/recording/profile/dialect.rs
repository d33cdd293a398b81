//! Texts for other radars or programs, refused by name.

use crate::recording::Fault;

/// Refuses a text of another dialect by its name.
pub(super) fn check(text: &str) -> Result<(), Fault> {
    let start = text.trim_start_matches('\u{feff}').trim_start();
    if start.starts_with('{') {
        let studio = start.contains("mmWaveDevices") || start.contains("rfConfig") || start.contains("mmwaveDevices");
        let (name, helps) = if studio {
            ("mmWave Studio's JSON", "the same numbers as profileCfg, channelCfg, chirpCfg and frameCfg in a .cfg")
        } else {
            ("JSON", "a .cfg with profileCfg, channelCfg, chirpCfg and frameCfg")
        };
        return Err(fault(name, helps));
    }
    let has = |word: &str| super::lines::lines(text).any(|line| line.command == word);
    if has("chirpComnCfg") || has("chirpTimingCfg") {
        let helps = "a recording's TOML with carrier_hz, bandwidth_hz and samples, which say the same";
        return Err(fault("the xWRL radars' (chirpComnCfg, chirpTimingCfg)", helps));
    }
    if start.starts_with("<?xml") || start.starts_with('<') {
        return Err(fault("XML", "a .cfg with profileCfg and frameCfg"));
    }
    if start.contains("ar1.ProfileConfig") || start.contains("ar1.ChirpConfig") {
        let helps = "a .cfg with the same numbers as profileCfg, channelCfg, chirpCfg and frameCfg";
        return Err(fault("a Lua script of mmWave Studio (ar1.ProfileConfig)", helps));
    }
    Ok(())
}

fn fault(name: &str, helps: &str) -> Fault {
    Fault::Data(format!("is a text of another dialect, {name}, which is not read; what would help is {helps}"))
}
