//! A line of the list of commands, and its key.

use super::super::command::Command;
use eframe::egui::{Key, KeyboardShortcut, Modifiers};
use std::borrow::Cow;

/// A command of the list, complete without further input.
#[derive(Debug, Clone, PartialEq)]
pub struct Entry {
    pub command: Command,
    /// Name in menus and the palette.
    pub name: Cow<'static, str>,
    pub tooltip: &'static str,
    pub key: Option<KeyboardShortcut>,
}

/// Commands as the lines of a table: command, name, sentence for tooltips, key.
macro_rules! entries {
    ($($command:expr, $name:literal, $tooltip:literal, $key:expr;)*) => { &[$(entry($command, $name, $tooltip, $key)),*] };
}

pub(super) use entries;

pub(super) const fn entry(
    command: Command,
    name: &'static str,
    tooltip: &'static str,
    key: Option<KeyboardShortcut>,
) -> Entry {
    Entry { command, name: Cow::Borrowed(name), tooltip, key }
}

pub(super) const fn key(key: Key) -> Option<KeyboardShortcut> {
    Some(KeyboardShortcut::new(Modifiers::NONE, key))
}

pub(super) const fn alt(key: Key) -> Option<KeyboardShortcut> {
    Some(KeyboardShortcut::new(Modifiers::ALT, key))
}

pub(super) const fn shift(key: Key) -> Option<KeyboardShortcut> {
    Some(KeyboardShortcut::new(Modifiers::SHIFT, key))
}

pub(super) const fn command(key: Key) -> Option<KeyboardShortcut> {
    Some(KeyboardShortcut::new(Modifiers::COMMAND, key))
}

pub(super) const fn command_shift(key: Key) -> Option<KeyboardShortcut> {
    Some(KeyboardShortcut::new(Modifiers::COMMAND.plus(Modifiers::SHIFT), key))
}

pub(super) fn named(
    command: impl Into<Command>,
    name: impl Into<Cow<'static, str>>,
    tooltip: &'static str,
    key: Option<KeyboardShortcut>,
) -> Entry {
    Entry { command: command.into(), name: name.into(), tooltip, key }
}
