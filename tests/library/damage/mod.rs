//! Damaged files: after any damage to a valid one, readers answer with a file or an error, in bounded memory and time.

pub mod allocation;
mod mutate;
mod readers;

use crate::prelude::*;
use allocation::most_held;
use readers::Reader;
use std::panic::{AssertUnwindSafe, catch_unwind};

const MAX_READ_TIME: Duration = Duration::from_secs(1);

fn trial(reader: &Reader, scratch: &Path, number: u64, bytes: &[u8]) -> Result<(bool, usize), String> {
    let mut fastest = Duration::MAX;
    // A machine that is busy with other work is no hang, so the time is taken several times.
    for _ in 0..3 {
        let start = Instant::now();
        let read = || catch_unwind(AssertUnwindSafe(|| (reader.read)(scratch, bytes)));
        let (result, most) = most_held(reader.name, number, read);
        fastest = fastest.min(start.elapsed());
        let accepted = result.map_err(|_| "panicked".to_owned())?.is_ok();
        let bound = reader.bound[0] + reader.bound[1] * bytes.len();
        if most > bound {
            return Err(format!("held {most} bytes where {bound} are the bound"));
        }
        if fastest <= MAX_READ_TIME {
            return Ok((accepted, most));
        }
    }
    Err(format!("took {fastest:?}"))
}

fn try_all(count: u64, only: Option<&str>) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let readers: Vec<Reader> = readers::all().into_iter().filter(|r| only.is_none_or(|name| r.name == name)).collect();
    assert!(!readers.is_empty(), "there is no reader {only:?}");
    for reader in readers {
        for (i, file) in reader.files.iter().enumerate() {
            let (accepted, _) =
                trial(&reader, folder.path(), 0, file).unwrap_or_else(|e| panic!("{}: {e}", reader.name));
            assert!(accepted, "{}: valid file {i} is refused", reader.name);
        }
        let (mut accepted, mut most, began) = (0, 0, Instant::now());
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
        let tried = count / reader.slow;
        let (name, seconds) = (reader.name, began.elapsed().as_secs_f32());
        println!("{name}: {tried} inputs in {seconds:.0} s, {accepted} accepted, at most {most} bytes held");
    }
}

#[test]
fn damaged_files_fail_within_bounds() {
    try_all(2_000, None);
}

#[test]
#[ignore = "long: hundreds of thousands of inputs"]
fn many_damaged_files_fail_within_bounds() {
    let count = std::env::var("DAMAGED").ok().and_then(|n| n.parse().ok()).unwrap_or(200_000);
    try_all(count, std::env::var("READER").ok().as_deref());
}
