//! The `apertura` program: the app without arguments, a subcommand with them.

use std::process::ExitCode;

fn main() -> ExitCode {
    apertura::commands::main()
}
