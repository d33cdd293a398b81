//! Writes the man pages and the shell completions of `apertura` into the folders `man` and `completions` of the folder that is named.

use clap_complete::Shell;
use std::error::Error;
use std::path::{Path, PathBuf};

const SHELLS: [Shell; 3] = [Shell::Bash, Shell::Fish, Shell::Zsh];

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args_os().nth(1).map(PathBuf::from).ok_or("expected the name of a folder")?;
    write(&folder)
}

fn write(folder: &Path) -> Result<(), Box<dyn Error>> {
    let [man, completions] = ["man", "completions"].map(|name| folder.join(name));
    for made in [&man, &completions] {
        std::fs::create_dir_all(made)?;
    }
    let mut command = apertura::commands::command();
    clap_mangen::generate_to(command.clone(), &man)?;
    for shell in SHELLS {
        clap_complete::generate_to(shell, &mut command, "apertura", &completions)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_subcommand_has_its_page() {
        let folder = tempfile::tempdir().unwrap();
        write(folder.path()).unwrap();
        for command in apertura::commands::command().get_subcommands().filter(|c| c.get_name() != "help") {
            let page = folder.path().join(format!("man/apertura-{}.1", command.get_name()));
            assert!(std::fs::read_to_string(page).unwrap().contains("SYNOPSIS"));
        }
        for file in ["apertura.bash", "apertura.fish", "_apertura"] {
            let text = std::fs::read_to_string(folder.path().join("completions").join(file)).unwrap();
            assert!(text.contains("reconstruct") && text.contains("--method"), "{file}");
        }
    }
}
