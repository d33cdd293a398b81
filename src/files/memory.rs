//! The memory in use by the process (Linux only).

/// Starts a new measurement of [`peak_resident_bytes`].
pub fn reset_peak_resident() {
    // Elsewhere peak sizes are not reported.
    let _not_linux = std::fs::write("/proc/self/clear_refs", "5");
}

/// Largest resident size of the process since [`reset_peak_resident`].
pub fn peak_resident_bytes() -> Option<u64> {
    status("VmHWM:")
}

/// Resident size of the process now.
pub fn resident_bytes() -> Option<u64> {
    status("VmRSS:")
}

fn status(key: &str) -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|l| l.starts_with(key))?;
    Some(1024 * line.split_whitespace().nth(1)?.parse::<u64>().ok()?)
}
