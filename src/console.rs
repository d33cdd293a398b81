//! `apertura.com`, the program that a console on Windows starts. It starts `apertura.exe` beside it and ends with its exit code.
//!
//! `apertura.exe` is marked as a program with a window, so that a double click opens no console. A console does not wait for such a
//! program. It waits for this one. Where a command names no ending, a console looks for `.com` before `.exe`.

use std::io;
use std::process::{Command, ExitCode};

fn main() -> ExitCode {
    match run() {
        Ok(code) => std::process::exit(code),
        Err(error) => {
            eprintln!("apertura: apertura.exe can't be started: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run() -> io::Result<i32> {
    // Ctrl-C reaches both programs. It ends the other one, whose exit code says so.
    #[cfg(windows)]
    ctrlc::set_handler(|| {}).map_err(io::Error::other)?;
    let program = std::env::current_exe()?.with_extension("exe");
    let status = Command::new(program).args(std::env::args_os().skip(1)).status()?;
    Ok(status.code().unwrap_or(1))
}
