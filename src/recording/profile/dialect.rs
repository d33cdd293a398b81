//! Texts for other radars or programs, refused by name.

use super::error::ProfileError;

/// Refuses a text of another dialect by its name.
pub(super) fn check(text: &str) -> Result<(), ProfileError> {
    let start = text.trim_start_matches('\u{feff}').trim_start();
    if start.starts_with('{') {
        let studio = start.contains("mmWaveDevices") || start.contains("rfConfig") || start.contains("mmwaveDevices");
        let (name, helps) = if studio {
            ("mmWave Studio's JSON", "the same numbers as profileCfg, channelCfg, chirpCfg and frameCfg in a .cfg")
        } else {
            ("JSON", "a .cfg with profileCfg, channelCfg, chirpCfg and frameCfg")
        };
        return Err(ProfileError::Dialect { name, helps });
    }
    let has = |word: &str| super::lines::lines(text).any(|line| line.command == word);
    if has("chirpComnCfg") || has("chirpTimingCfg") {
        let helps = "a recording's TOML with carrier_hz, bandwidth_hz and samples, which say the same";
        return Err(ProfileError::Dialect { name: "the xWRL radars' (chirpComnCfg, chirpTimingCfg)", helps });
    }
    if start.starts_with("<?xml") || start.starts_with('<') {
        return Err(ProfileError::Dialect { name: "XML", helps: "a .cfg with profileCfg and frameCfg" });
    }
    if start.contains("ar1.ProfileConfig") || start.contains("ar1.ChirpConfig") {
        let helps = "a .cfg with the same numbers as profileCfg, channelCfg, chirpCfg and frameCfg";
        return Err(ProfileError::Dialect { name: "a Lua script of mmWave Studio (ar1.ProfileConfig)", helps });
    }
    Ok(())
}
