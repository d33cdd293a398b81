//! The palette: any command, found by part of its name.

use crate::app::state::{
    Command, DocumentCommand, Entry, LessonCommand, Panel, ViewCommand, WindowCommand, listed, menu_path, synonyms,
};
use crate::lesson::shipped;
use crate::reconstruct::Reconstructor;
use crate::recording;
use crate::scene::presets;
use eframe::egui::{self, Align2, Button, Context, Event, Key, Modifiers, TextEdit, Ui};
use std::sync::Arc;

#[derive(Default)]
pub struct PaletteMemory {
    open: bool,
    text: String,
    chosen: usize,
    just_opened: bool,
    /// Names of the commands that were run last, the latest first.
    pub recent: Vec<String>,
}

const RECENT_COMMANDS: usize = 8;

impl PaletteMemory {
    pub fn is_open(&self) -> bool {
        self.open
    }

    /// Opens the palette with empty text, or closes it.
    pub fn toggle(&mut self) {
        let recent = std::mem::take(&mut self.recent);
        *self = PaletteMemory { open: !self.open, just_opened: !self.open, recent, ..PaletteMemory::default() };
    }

    /// A palette with a list of recent commands, the latest first.
    pub fn remembering(recent: Vec<String>) -> PaletteMemory {
        PaletteMemory { recent, ..PaletteMemory::default() }
    }

    fn remember(&mut self, name: String) {
        self.recent.retain(|before| *before != name);
        self.recent.insert(0, name);
        self.recent.truncate(RECENT_COMMANDS);
    }
}

/// The menus that lead to a command; methods and lessons have none, and are found in these panels.
fn path(command: &Command) -> String {
    match command {
        Command::View(ViewCommand::Method(_)) => Panel::Controls.title().to_owned(),
        Command::Lesson(LessonCommand::Begin(_)) => Panel::Lesson.title().to_owned(),
        command => menu_path(command).join(" › "),
    }
}

fn matches(name: &str, text: &str) -> bool {
    let name = name.to_lowercase();
    text.to_lowercase().split_whitespace().all(|word| name.contains(word))
}

/// Further search words of a command: name and text of the file that it opens.
fn words(command: &Command) -> [&'static str; 2] {
    let file = match command {
        Command::Document(DocumentCommand::Preset(index)) => presets::ALL.get(*index).map(|file| [file.id, file.toml]),
        Command::Document(DocumentCommand::Recording(index)) => {
            recording::presets::ALL.get(*index).map(|file| [file.id, file.toml])
        }
        Command::Lesson(LessonCommand::Begin(index)) => shipped::ALL.get(*index).map(|file| [file.id, file.toml]),
        _ => None,
    };
    file.unwrap_or_default()
}

/// The commands that match `text` by name, synonym, menu, tooltip or file. Matches of the name come first, those with the text as the whole name before those
/// with it as typed and those with it as whole words; then the most recent. Random scenes, which replace the one on screen, come last of equals.
fn find(methods: &[Arc<dyn Reconstructor>], text: &str, recent: &[String]) -> Vec<Entry> {
    let commands = listed().iter().filter(|e| e.command != Command::Window(WindowCommand::Palette)).cloned();
    let methods = methods.iter().map(|m| Entry {
        command: ViewCommand::Method(m.name()).into(),
        name: format!("Method: {}", m.name()).into(),
        tooltip: m.description(),
        key: None,
    });
    let lessons = shipped::all_read().iter().map(|(index, lesson)| Entry {
        command: LessonCommand::Begin(*index).into(),
        name: format!("Lesson: {}", lesson.title).into(),
        tooltip: &lesson.about,
        key: None,
    });
    let any = |e: &Entry| {
        let [id, file] = words(&e.command);
        let all = [&*e.name, synonyms(&e.command), &path(&e.command), e.tooltip, id, file];
        matches(&all.join(" "), text)
    };
    let mut found: Vec<Entry> = commands.chain(methods).chain(lessons).filter(any).collect();
    let since = |name: &str| recent.iter().position(|r| r == name).unwrap_or(recent.len());
    let whole = |name: &str| name.to_lowercase().contains(text.trim().to_lowercase().as_str());
    let word = |name: &str| text.split_whitespace().all(|word| name.split(' ').any(|of| of.eq_ignore_ascii_case(word)));
    // "street" is the whole name of "Preset: street".
    let own = |name: &str| name.rsplit_once(": ").map_or(name, |(_, own)| own).eq_ignore_ascii_case(text.trim());
    let is_random = |f: &Entry| matches!(f.command, Command::Document(DocumentCommand::RandomScene(_)));
    found.sort_by_key(|f| {
        let name = &*f.name;
        (!matches(name, text), !own(name), !whole(name), !word(name), since(name), is_random(f))
    });
    found
}

/// Draws the palette, if it is open; it lists `methods` besides the commands.
pub fn show(ctx: &Context, methods: &[Arc<dyn Reconstructor>], memory: &mut PaletteMemory) -> Vec<Command> {
    if !memory.open {
        return Vec::new();
    }
    // The keys are the palette's alone.
    let [up, down, enter, escape] = [Key::ArrowUp, Key::ArrowDown, Key::Enter, Key::Escape]
        .map(|key| ctx.input_mut(|i| i.consume_key(Modifiers::NONE, key)));
    let area = egui::Window::new("Commands")
        .title_bar(false)
        .resizable(false)
        .collapsible(false)
        .anchor(Align2::CENTER_TOP, [0.0, 60.0])
        .fixed_size([ctx.content_rect().width().clamp(240.0, 640.0) - 40.0, 340.0])
        .show(ctx, |ui| contents(ui, methods, memory, [up, down, enter]));
    let Some(area) = area else { return Vec::new() };
    let run = area.inner.flatten().map(|found| {
        memory.remember(found.name.into_owned());
        found.command
    });
    if run.is_some() || escape || area.response.clicked_elsewhere() {
        memory.open = false;
    }
    run.into_iter().collect()
}

/// Draws the field first and searches by its new text: Enter may come in the same frame as the last letter.
fn contents(
    ui: &mut Ui,
    methods: &[Arc<dyn Reconstructor>],
    memory: &mut PaletteMemory,
    [up, down, enter]: [bool; 3],
) -> Option<Entry> {
    let before = memory.text.clone();
    if memory.just_opened {
        // The field has no focus yet, but the frame may hold letters already.
        let typed = ui.input(|i| i.events.iter().filter_map(text_of).collect::<String>());
        memory.text += &typed;
    }
    let edit = TextEdit::singleline(&mut memory.text)
        .hint_text("Type a command, or what you want to do")
        .desired_width(f32::INFINITY);
    let response = ui.add(edit);
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::TextInput, true, "Find a command"));
    if std::mem::take(&mut memory.just_opened) {
        response.request_focus();
    }
    if memory.text != before {
        memory.chosen = 0;
    }
    let mut found = find(methods, &memory.text, &memory.recent);
    let last = found.len().saturating_sub(1);
    memory.chosen = match (up, down) {
        (true, _) => memory.chosen.saturating_sub(1),
        (_, true) => memory.chosen + 1,
        _ => memory.chosen,
    }
    .min(last);
    ui.separator();
    if found.is_empty() {
        ui.weak("No command is found by these words.");
    }
    let clicked = list(ui, &found, memory.chosen, up || down);
    let run = clicked.or((enter && !found.is_empty()).then_some(memory.chosen))?;
    Some(found.swap_remove(run))
}

fn text_of(event: &Event) -> Option<&str> {
    if let Event::Text(text) = event { Some(text) } else { None }
}

fn list(ui: &mut Ui, found: &[Entry], chosen: usize, moved: bool) -> Option<usize> {
    let mut clicked = None;
    egui::ScrollArea::vertical().auto_shrink([false, false]).max_height(300.0).show(ui, |ui| {
        for (index, line) in found.iter().enumerate() {
            // Even an empty key pushes the name to the left.
            let key = line.key.map_or_else(String::new, |key| format!("   {}", ui.ctx().format_shortcut(&key)));
            let beside = path(&line.command) + &key;
            let button = Button::selectable(index == chosen, &*line.name).truncate().shortcut_text(beside);
            let response = ui.add_sized([ui.available_width(), 22.0], button).on_hover_text(line.tooltip);
            if index == chosen && moved {
                response.scroll_to_me(None);
            }
            if response.clicked() {
                clicked = Some(index);
            }
        }
    });
    clicked
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::state::{EditCommand, NewObject};
    use crate::app::widgets::seen;
    use crate::reconstruct::Baseline;

    #[test]
    fn words_match_in_any_order() {
        assert!(matches("Show or hide: Input 0", "input SHOW"));
        assert!(!matches("Show or hide: Input 0", "input 1"));
        assert!(matches("anything", ""));
    }

    fn names(text: &str, recent: &[&str]) -> Vec<String> {
        let recent: Vec<String> = recent.iter().map(|name| (*name).to_owned()).collect();
        find(&[], text, &recent).into_iter().map(|found| found.name.into_owned()).collect()
    }

    #[test]
    fn other_words_find_a_command_too() {
        for (text, wanted) in [
            ("help", "Keys and pointer"),
            ("help", "Show or hide: Guide"),
            ("projector", "Presentation"),
            ("colormap", "Colours: viridis"),
            ("undo drag", "Undo"),
            ("screenshot", "Export picture…"),
            ("view colours", "Colours: grey"),
        ] {
            let found = names(text, &[]);
            assert!(found.iter().any(|name| name == wanted), "{text} finds {found:?}");
        }
        assert!(names("zzz", &[]).is_empty());
    }

    #[test]
    fn presets_lessons_and_methods_are_found_by_any_of_their_words() {
        let methods: Vec<Arc<dyn Reconstructor>> = vec![Arc::new(Baseline)];
        for (text, wanted) in [
            ("parked cars", "Preset: street"),
            ("regulators wide sweep", "Lesson: Range and bandwidth"),
            ("range becomes a frequency", "Lesson: Range and bandwidth"),
            ("thesis compares with", "Method: baseline"),
            ("two reflections", "Recording: cascade 86"),
            ("occlusion", "Lesson: A weak point behind a strong line"),
        ] {
            let found = find(&methods, text, &[]);
            let names: Vec<&str> = found.iter().map(|found| &*found.name).collect();
            assert!(names.contains(&wanted), "{text} finds {names:?}");
        }
    }

    #[test]
    fn commands_that_were_run_last_come_first() {
        let recent = ["Export maps…", "Redo"];
        assert_eq!(names("", &recent)[..2], recent);
        // A match by name comes before a match by synonym.
        let found = names("undo", &["Export maps…"]);
        assert_eq!(found[0], "Undo");
        // A match of the text as typed comes before a match of its words: "Floor: thesis".
        assert!(names("the floor", &[])[0].starts_with("Lesson: The floor"));
        // A match of whole words comes before a match of their beginnings: "Cartesian".
        assert!(names("car", &[])[0].split(' ').any(|word| word == "car"), "{:?}", names("car", &[]));
        // A preset of this name comes before a random scene with this word in its description.
        assert_eq!(names("street", &[])[0], "Preset: street");
        let mut memory = PaletteMemory::remembering(vec!["Redo".to_owned()]);
        memory.remember("Undo".to_owned());
        memory.remember("Redo".to_owned());
        assert_eq!(memory.recent, ["Redo", "Undo"]);
        memory.toggle();
        assert_eq!(memory.recent, ["Redo", "Undo"], "they stay when it opens again");
    }

    #[test]
    fn enter_runs_what_the_text_says_even_in_the_same_frame() {
        let methods: Vec<Arc<dyn Reconstructor>> = vec![Arc::new(Baseline)];
        let draw = |ui: &mut Ui, memory: &mut PaletteMemory| show(ui.ctx(), &methods, memory);
        let mut palette = seen::asking_with([800.0, 600.0], PaletteMemory::default(), draw);
        palette.step();
        for (text, frames_before_enter) in [("add line", 0), ("method: baseline", 2)] {
            palette.state_mut().0.toggle();
            palette.step();
            // `event` would give each key a frame of its own.
            palette.input_mut().events.push(Event::Text(text.to_owned()));
            palette.run_steps(frames_before_enter);
            let (key, modifiers) = (Key::Enter, Modifiers::NONE);
            let enter = Event::Key { key, physical_key: None, pressed: true, repeat: false, modifiers };
            palette.input_mut().events.push(enter);
            palette.step();
            assert!(!palette.state().0.is_open());
        }
        let add = Command::from(EditCommand::Add(NewObject::Line, None));
        assert_eq!(palette.state().1, [add, ViewCommand::Method("baseline").into()]);
    }
}
