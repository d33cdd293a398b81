//! README, docs and the guide: every command, option, address, key and link that they show is tried.

#[cfg(feature = "app")]
mod keys;
mod links;
mod pages;
mod shell;

use crate::cli::*;
use apertura::methods;
use clap::error::ErrorKind;
use pages::{Page, all, root};

/// Options that other programs of the project and cargo have are looked for in these folders.
const OTHER_PROGRAMS: [&str; 6] =
    ["scripts", "packaging", "training", "python/apertura", "examples", "CONTRIBUTING.md"];

/// Names that stand for a method of the reader's.
const PLACEHOLDERS: [&str; 3] = ["M", "NAME", "METHOD"];

/// Subcommands that take seconds: those of every page are run, not only README's.
const QUICK: [&str; 7] = ["maps", "methods", "reconstruct", "budget", "scenes", "lesson", "range-doppler"];

/// Whether this is the name of a subcommand and of one of its options, as in a sentence about the option.
fn names_an_option(command: &clap::Command, arguments: &[String]) -> bool {
    let [subcommand, option] = arguments else { return false };
    let mut has = command.find_subcommand(subcommand).into_iter().flat_map(|c| c.get_arguments());
    has.any(|argument| argument.get_long().is_some_and(|long| option.strip_prefix("--") == Some(long)))
}

fn fault(arguments: &[String]) -> Option<String> {
    let command = apertura::commands::command();
    let words = std::iter::once("apertura".to_owned()).chain(shell::filled(arguments));
    if let Err(error) = command.clone().try_get_matches_from(words)
        && ![ErrorKind::DisplayHelp, ErrorKind::DisplayVersion].contains(&error.kind())
    {
        return Some(error.to_string()).filter(|_| !names_an_option(&command, arguments));
    }
    let first = arguments.first()?;
    let is_file = first.starts_with('-') || first.contains(['.', ':']);
    if !is_file && command.find_subcommand(first).is_none() {
        return Some(format!("no subcommand {first}"));
    }
    let own = arguments.iter().any(|a| a == "--method-command");
    let named = arguments.iter().position(|a| a == "--method").and_then(|at| arguments.get(at + 1));
    let names = named.filter(|_| !own && cfg!(feature = "network")).into_iter().flat_map(|names| names.split(','));
    names
        .filter(|name| !PLACEHOLDERS.contains(name))
        .find_map(|name| methods::by_name(name).err())
        .map(|e| e.to_string())
}

#[test]
fn every_command_of_the_pages_is_one_of_the_programs() {
    let mut faults = Vec::new();
    for page in all() {
        let spans = page.spans.iter().filter(|span| span.starts_with("apertura "));
        // The name of a subcommand alone names it; anything longer is to be typed.
        let typed = spans.filter(|span| span.split_whitespace().count() > 2).cloned();
        for line in page.shell_lines().into_iter().chain(typed) {
            let found = shell::commands(&line).into_iter().filter_map(|arguments| fault(&arguments));
            faults.extend(found.map(|fault| format!("{}: {line}\n{fault}", page.name)));
        }
        let names = page.spans.iter().filter_map(|span| span.strip_prefix("apertura ")).filter(|n| !n.contains(' '));
        faults.extend(names.filter_map(|name| fault(&[name.to_owned(), "--help".to_owned()])));
    }
    assert!(faults.is_empty(), "{} faults:\n{}", faults.len(), faults.join("\n"));
}

fn options() -> BTreeSet<String> {
    let command = apertura::commands::command();
    let all = command.get_subcommands().chain([&command]).flat_map(|c| c.get_arguments());
    all.filter_map(|argument| Some(format!("--{}", argument.get_long()?)))
        .chain(["--help", "--version"].map(str::to_owned))
        .collect()
}

fn text_below(path: &Path) -> String {
    if path.is_file() {
        return std::fs::read_to_string(path).unwrap_or_default();
    }
    let entries = std::fs::read_dir(path).unwrap().map(|e| e.unwrap().path());
    entries.filter(|e| e.is_file()).map(|e| text_below(&e)).collect()
}

#[test]
fn every_option_that_pages_name_is_one_of_a_program() {
    let options = options();
    let others: String = OTHER_PROGRAMS.iter().map(|folder| text_below(&root().join(folder))).collect();
    for page in all() {
        for span in page.spans.iter().filter(|span| span.starts_with("--")) {
            let name = span.split([' ', '=']).next().unwrap();
            assert!(options.contains(name) || others.contains(name), "{}: {span}", page.name);
        }
    }
}

#[test]
fn every_script_that_pages_run_is_there() {
    for page in all() {
        for line in page.shell_lines() {
            for word in line.split_whitespace().filter(|word| word.starts_with("scripts/")) {
                assert!(root().join(word).is_file(), "{}: {line}", page.name);
            }
        }
    }
}

/// A folder like that of a clone after a build: with scenes, recordings and lessons. Files are written into it.
#[cfg(unix)]
fn clone() -> TempDir {
    let folder = folder();
    for made in ["assets/pictures", "target"] {
        std::fs::create_dir_all(folder.path().join(made)).unwrap();
    }
    for shipped in ["assets/scenes", "assets/recordings", "assets/lessons"] {
        std::os::unix::fs::symlink(root().join(shipped), folder.path().join(shipped)).unwrap();
    }
    folder
}

/// Whether every file that is read is there, and no word in capitals stands for one.
#[cfg(unix)]
fn has_inputs(folder: &TempDir, arguments: &[String]) -> bool {
    if arguments.iter().any(|argument| argument.chars().all(|c| c.is_ascii_uppercase())) {
        return false;
    }
    let is_written = |at: usize| at > 0 && ["-o", "--output"].contains(&arguments[at - 1].as_str());
    let is_file = |name: &str| [".toml", ".npz"].iter().any(|ending| name.ends_with(ending));
    (0..arguments.len())
        .filter(|&at| is_file(&arguments[at]) && !is_written(at))
        .all(|at| folder.path().join(&arguments[at]).is_file())
}

#[cfg(unix)]
fn run(folder: &TempDir, arguments: &[String]) {
    println!("apertura {}", arguments.join(" "));
    apertura(folder).args(arguments).assert().success();
}

#[cfg(all(unix, feature = "network", feature = "app"))]
#[test]
fn every_command_of_the_readme_runs() {
    let (folder, page) = (clone(), Page::read("README.md"));
    let typed = page.spans.iter().filter(|span| span.starts_with("apertura ")).cloned();
    let commands: Vec<_> =
        page.shell_lines().into_iter().chain(typed).flat_map(|line| shell::commands(&line)).collect();
    assert!(commands.len() >= 10, "README shows ten commands");
    commands.iter().for_each(|arguments| run(&folder, &shell::shortened(arguments)));
}

#[cfg(all(unix, feature = "network", feature = "app"))]
#[test]
fn every_quick_command_of_the_other_pages_runs() {
    let mut count = 0;
    for page in all().iter().filter(|page| page.name != "README.md") {
        let folder = clone();
        let spans = page.spans.iter().filter(|span| span.starts_with("apertura ") && span.contains(" -")).cloned();
        for arguments in page.shell_lines().into_iter().chain(spans).flat_map(|line| shell::commands(&line)) {
            let is_quick = arguments.first().is_some_and(|name| QUICK.contains(&name.as_str()));
            if is_quick && has_inputs(&folder, &arguments) {
                count += 1;
                run(&folder, &shell::shortened(&arguments));
            }
        }
    }
    assert!(count >= 8, "{count} commands ran");
}

#[cfg(feature = "app")]
#[test]
fn every_address_that_pages_show_opens_something() {
    let mut count = 0;
    for page in all() {
        for address in page.spans.iter().filter(|span| span.starts_with('?') && span.contains('=')) {
            count += 1;
            let problem = apertura::app::options_of(address).err();
            assert!(problem.is_none(), "{}: {address}: {problem:?}", page.name);
        }
    }
    assert!(count >= 3, "{count} addresses");
}

#[cfg(feature = "network")]
#[test]
fn the_page_of_methods_is_the_programs_list() {
    let text = std::fs::read_to_string(root().join("docs/methods.md")).unwrap();
    let mut rows: Vec<&str> = text.lines().filter(|line| line.starts_with("| `")).collect();
    let takes = |recording: &str, name: &str| {
        let recording = apertura::recording::presets::Preset::by_id(recording).unwrap().load().unwrap();
        let method = methods::by_name(name).unwrap();
        let asked = method.check_array(&recording.radar).and_then(|()| method.check_hearing(&recording.two_ends()));
        if asked.is_ok() { "yes" } else { "no" }
    };
    for method in methods::all() {
        let name = method.name();
        let [chip, cascade] = ["chip-8", "cascade-86"].map(|recording| takes(recording, name));
        let row = format!("| `{name}` | {} | {chip} | {cascade} |", method.description());
        let at = rows.iter().position(|found| *found == row).unwrap_or_else(|| panic!("docs/methods.md lacks\n{row}"));
        rows.remove(at);
    }
    assert!(rows.is_empty(), "docs/methods.md has more: {rows:#?}");
}

#[cfg(feature = "network")]
#[test]
fn methods_are_listed_and_say_which_radar_they_refuse() {
    let folder = folder();
    let listed = apertura(&folder).arg("methods").assert().success();
    let text = String::from_utf8(listed.get_output().stdout.clone()).unwrap();
    assert_eq!(text.lines().filter(|line| line.starts_with("  ")).count(), methods::all().len());
    let refused = contains("transmitters stand apart").and(contains(format!("{:<27}yes", "iaa")));
    apertura(&folder).args(["methods", crate::recordings::CHIP]).assert().success().stdout(refused);
}

#[test]
fn the_readme_says_how_many_decibels_lambda_spans() {
    let folder = folder();
    let mut command = apertura(&folder);
    command.arg("maps").arg(root().join("assets/scenes/street.toml")).args(["-o", "street.npz"]);
    let text = String::from_utf8(command.assert().success().get_output().stdout.clone()).unwrap();
    let number = |before: &str| text.split_once(before).unwrap().1.split(' ').next().unwrap().parse::<f64>().unwrap();
    let readme = std::fs::read_to_string(root().join("README.md")).unwrap();
    for said in [format!("spans {:.0} dB", number("spans ")), format!("0.9 is {:.0} dB below", number("0.9 is "))] {
        assert!(readme.contains(&said), "{said}");
    }
}

#[test]
fn the_readme_is_short_and_names_features_that_there_are() {
    let page = Page::read("README.md");
    let words = std::fs::read_to_string(root().join("README.md")).unwrap().split_whitespace().count();
    assert!(words <= 1300, "{words} words");
    let [(_, block)] = page.blocks.iter().filter(|(language, _)| language == "toml").collect::<Vec<_>>()[..] else {
        panic!()
    };
    let manifest: toml::Table = toml::from_str(&std::fs::read_to_string(root().join("Cargo.toml")).unwrap()).unwrap();
    let said: toml::Table = toml::from_str(block).unwrap();
    for feature in said["apertura"]["features"].as_array().unwrap() {
        assert!(manifest["features"].get(feature.as_str().unwrap()).is_some(), "{feature}");
    }
}
