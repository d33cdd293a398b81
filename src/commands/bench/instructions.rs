//! What the planner chooses, timed with every instruction set: each in a process of its own, since a process keeps to one.

use crate::benchmark::front::Front;
use crate::commands::{CommandError, print, print_json};
use crate::signal::simd::{SIMD_VARIABLE, Simd};
use std::process::Command;

/// Runs this program's `bench` with each set that the processor has, and prints all in one table.
pub fn run(reflectors: &[u32], repeats: u32, json: bool) -> Result<(), CommandError> {
    let program = std::env::current_exe().map_err(CommandError::failed)?;
    let counts = reflectors.iter().map(u32::to_string).collect::<Vec<_>>().join(",");
    let mut fronts = Vec::new();
    for simd in Simd::available() {
        let mut command = Command::new(&program);
        command.env(SIMD_VARIABLE, simd.name());
        command.args(["bench", "--json", "--algorithms", "plan", "--reflectors", &counts]);
        let output = command.args(["--repeats", &repeats.to_string()]).output().map_err(CommandError::failed)?;
        if !output.status.success() {
            let said = String::from_utf8_lossy(&output.stderr);
            return Err(CommandError::Usage(format!("bench with {simd} failed: {}", said.trim())));
        }
        fronts.push(serde_json::from_slice::<Front>(&output.stdout).map_err(CommandError::failed)?);
    }
    if json {
        return print_json(&fronts);
    }
    print(&table(&fronts))?;
    for simd in Simd::ALL.into_iter().filter(|simd| !Simd::available().contains(simd)) {
        print(&format!("left out: {simd}, which this processor lacks"))?;
    }
    Ok(())
}

/// Milliseconds, and multiples of the bare transform with the same instructions.
fn table(fronts: &[Front]) -> String {
    let heads = fronts.iter().map(|f| format!(" {:>18}", format!("{} ms (x bare)", f.simd)));
    let mut lines = vec![format!("{:7} {:>10} {:>9}{}", "task", "reflectors", "tolerance", heads.collect::<String>())];
    let cell = |ms: f64, bare: f64| format!(" {:>18}", format!("{ms:.2} ({:.2})", ms / bare));
    let bare = fronts.iter().map(|f| cell(f.bare_fft_ms, f.bare_fft_ms));
    lines.push(format!("{:28}{}", "bare transform, one thread", bare.collect::<String>()));
    let rows = fronts.first().map(|f| f.rows.as_slice()).unwrap_or_default();
    for (i, row) in rows.iter().enumerate() {
        let times = fronts.iter().filter_map(|f| Some(cell(f.rows.get(i)?.median_ms, f.bare_fft_ms)));
        lines.push(format!(
            "{:7} {:>10} {:>9.0e}{}",
            row.task.name(),
            row.reflectors,
            row.tolerance,
            times.collect::<String>()
        ));
    }
    lines.join("\n")
}
