//! Damaged files: whatever is done to a valid one, readers answer with a file or an error, in bounded memory and time.
//!
//! `cargo test --release --test library damage -- --ignored --nocapture` tries hundreds of thousands; `fuzz/` goes on from there.

pub mod allocation;
mod mutate;
mod readers;

use allocation::most_held;
use readers::Reader;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::time::{Duration, Instant};

/// Longest that any input may take.
const LIMIT: Duration = Duration::from_secs(1);

/// Reads `bytes` and says what is wrong with how it went.
fn trial(reader: &Reader, scratch: &Path, number: u64, bytes: &[u8]) -> Result<(bool, usize), String> {
    let mut fastest = Duration::MAX;
    // A machine that is busy elsewhere is no hang.
    for _ in 0..3 {
        let start = Instant::now();
        let read = || catch_unwind(AssertUnwindSafe(|| (reader.read)(scratch, bytes)));
        let (result, most) = most_held(reader.name, number, read);
        fastest = fastest.min(start.elapsed());
        let accepted = result.map_err(|_| "panicked".to_owned())?.is_ok();
        let bound = (reader.bound)(bytes.len());
        if most > bound {
            return Err(format!("held {most} bytes where {bound} are the bound"));
        }
        if fastest <= LIMIT {
            return Ok((accepted, most));
        }
    }
    Err(format!("took {fastest:?}"))
}

/// Tries `count` damaged files on every reader; an input that goes wrong is kept for a look.
fn try_all(count: u64) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for reader in readers::all() {
        for (i, file) in reader.files.iter().enumerate() {
            let (accepted, _) =
                trial(&reader, folder.path(), 0, file).unwrap_or_else(|e| panic!("{}: {e}", reader.name));
            assert!(accepted, "{}: valid file {i} is refused", reader.name);
        }
        let (mut accepted, mut most) = (0, 0);
        for number in 0..count / reader.slow {
            let bytes = mutate::damaged(&reader.files, number);
            match trial(&reader, folder.path(), number, &bytes) {
                Ok((fine, held)) => {
                    accepted += u64::from(fine);
                    most = most.max(held);
                }
                Err(problem) => {
                    let kept = std::env::temp_dir().join(format!("apertura-{}-{number}", reader.name));
                    std::fs::write(&kept, &bytes).expect("the input can be kept");
                    panic!("{} {problem} by input {number}, kept as {}", reader.name, kept.display());
                }
            }
        }
        println!("{}: {} inputs, {accepted} accepted, at most {most} bytes held", reader.name, count / reader.slow);
    }
}

#[test]
fn damaged_files_are_told_in_bounded_memory_and_time() {
    try_all(2_000);
}

/// `DAMAGED=1000000` tries a million of each.
#[test]
#[ignore = "long: hundreds of thousands of inputs"]
fn many_damaged_files_are_told_in_bounded_memory_and_time() {
    let count = std::env::var("DAMAGED").ok().and_then(|n| n.parse().ok()).unwrap_or(200_000);
    try_all(count);
}
