//! The window in a browser's page, opened by the page's address.

use super::state::{Command, DocumentCommand, LessonCommand};
use super::{App, Options};
use crate::benchmark::one_thread;
use crate::{lesson, platform, recording, scene};

/// Opens the window on the page's canvas, with the options of its address.
pub fn open_page() {
    // Every thread of a page begins with `main`.
    if !platform::has_window() {
        return;
    }
    let address = platform::address();
    if address == "?measure" {
        return platform::tell(&measured());
    }
    let options = options_of(&address);
    let options = options.unwrap_or_else(|problem| Options { problems: vec![problem], ..Options::default() });
    let create: eframe::AppCreator<'static> = Box::new(|creation| Ok(Box::new(App::new(creation, options)?)));
    if let Err(error) = platform::open_window(super::APP_ID, create) {
        platform::tell(&format!("The window could not be opened: {error}"));
    }
}

/// Run times on this page's first thread alone, as JSON.
fn measured() -> String {
    let timed = one_thread::measure().and_then(|timed| serde_json::to_string(&timed).map_err(|e| e.to_string()));
    timed.unwrap_or_else(|problem| format!("The run times can't be measured: {problem}"))
}

/// Key of an address that names a notebook's cell. The page sends its scene to the cell (`page.js`).
const CELL_KEY: &str = "cell";

/// The options in a page's address: `?scene=street`, `?lesson=two-ends` (the beginning of a lesson's name), `?recording=chip-8`, or a shared text behind `#`.
///
/// # Errors
/// A sentence for the person who opened the address.
pub fn options_of(address: &str) -> Result<Options, String> {
    let (query, fragment) = address.split_once('#').unwrap_or((address, ""));
    let mut options = Options::default();
    if !fragment.is_empty() {
        options.commands.push(DocumentCommand::OpenShared(fragment.to_owned()).into());
    }
    for (key, name) in query.trim_start_matches('?').split('&').filter_map(|part| part.split_once('=')) {
        if key == CELL_KEY {
            continue;
        }
        options.commands.push(command_of(key, name)?);
    }
    Ok(options)
}

fn command_of(key: &str, name: &str) -> Result<Command, String> {
    let unknown = |what: &str, known: Vec<&str>| {
        format!("The address asks for the {what} \"{name}\", which there is not. There are: {}.", known.join(", "))
    };
    let find = |known: Vec<&str>| known.iter().position(|id| *id == name).ok_or_else(|| unknown(key, known));
    match key {
        "scene" => Ok(DocumentCommand::Preset(find(scene::presets::ALL.iter().map(|p| p.id).collect())?).into()),
        "recording" => {
            Ok(DocumentCommand::Recording(find(recording::presets::ALL.iter().map(|p| p.id).collect())?).into())
        }
        "lesson" => {
            let index =
                lesson::shipped::by_name(name).map_err(|error| format!("The address asks for a lesson: {error}."))?;
            Ok(Command::Lesson(LessonCommand::Begin(index)))
        }
        _ => Err(format!("The address asks for \"{key}\". It may ask for scene, lesson or recording.")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_address_opens_a_preset_or_a_shared_text() {
        let options = options_of("?scene=street").unwrap();
        let [Command::Document(DocumentCommand::Preset(index))] = options.commands[..] else { panic!() };
        assert_eq!(scene::presets::ALL[index].id, "street");
        let options = options_of("?cell=abc#apertura:1:abc").unwrap();
        let shared = Command::from(DocumentCommand::OpenShared("apertura:1:abc".to_owned()));
        assert_eq!(options.commands, [shared], "the cell of a notebook asks for nothing");
    }

    #[test]
    fn an_unknown_name_is_a_sentence_with_the_known_ones() {
        let problem_of = |address| options_of(address).err().unwrap_or_default();
        let problem = problem_of("?lesson=nowhere");
        assert!(problem.contains("nowhere") && problem.contains("two-ends"), "{problem}");
        assert!(problem_of("?weather=rain").contains("weather"));
    }
}
