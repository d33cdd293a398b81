//! State of the switches among the commands, which menus tick.

use super::command::{Command, EditCommand, ViewCommand, WindowCommand};
use super::{Panel, Projection, State, Units};
use eframe::egui::ThemePreference;

impl State {
    /// Whether the switch of a command is on; `None` where the command is no switch.
    pub fn is_on(&self, command: &Command) -> Option<bool> {
        let settings = &self.settings;
        match command {
            Command::View(command) => match command {
                ViewCommand::ToggleProjection => Some(settings.projection == Projection::Cartesian),
                ViewCommand::SetProjection(projection) => Some(settings.projection == *projection),
                ViewCommand::ToggleUnits => Some(settings.units == Units::Decibels),
                ViewCommand::SetUnits(units) => Some(settings.units == *units),
                ViewCommand::SetDirections(directions) => Some(settings.directions == *directions),
                ViewCommand::ToggleOneScale => Some(settings.one_scale),
                ViewCommand::ToggleFineColumns => Some(settings.fine_columns),
                ViewCommand::ToggleAbsoluteDifference => Some(settings.difference.absolute),
                ViewCommand::ToggleWholeDifference => Some(!settings.difference.whole),
                ViewCommand::Colours(colours) => Some(settings.colours == *colours),
                ViewCommand::Normalise(normalisation) => Some(settings.normalisation == *normalisation),
                ViewCommand::Detect(statistic) => Some(settings.cfar.map(|cfar| cfar.statistic) == *statistic),
                ViewCommand::ToggleDeveloper => Some(settings.developer),
                ViewCommand::ToggleReflectors => Some(settings.show_reflectors),
                ViewCommand::ToggleFound => Some(settings.show_found),
                ViewCommand::ToggleFieldsOfView => Some(settings.show_fields_of_view),
                ViewCommand::ToggleTheory => Some(settings.show_theory),
                ViewCommand::ToggleKinds => Some(settings.show_kinds),
                ViewCommand::Method(name) => Some(settings.method == *name),
                _ => None,
            },
            Command::Edit(EditCommand::SetCoordinates(coordinates)) => Some(settings.coordinates == *coordinates),
            Command::Window(command) => match command {
                WindowCommand::TogglePanel(panel) => Some(self.arrangement.is_open(*panel)),
                WindowCommand::Maximise(panel) => Some(self.arrangement.is_maximised(*panel)),
                WindowCommand::ArrangeFor(task) => Some(self.arrangement.task == *task),
                WindowCommand::Present => Some(self.is_presenting()),
                WindowCommand::ToggleTheme => Some(match settings.theme {
                    ThemePreference::System => self.dark,
                    chosen => chosen == ThemePreference::Dark,
                }),
                WindowCommand::ToggleCaptions => Some(self.captions),
                _ => None,
            },
            _ => None,
        }
    }

    /// Ends the captions at the first drag, in which the user saw the maps follow. The scene then explains the drag.
    pub fn note_first_drag(&mut self) {
        self.tells_first_drag |= self.shows_captions();
        self.captions = false;
    }

    /// Whether maps and scene have captions; they have none during a lesson.
    pub fn shows_captions(&self) -> bool {
        self.captions && self.lesson.is_none() && !self.arrangement.is_open(Panel::Lesson)
    }
}
