//! Messages on screen: what was done, and what could not be done.

/// Most messages on screen; the oldest make room.
const MAX_NOTICES: usize = 5;

/// What a message is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NoticeKind {
    /// Something was done.
    Info,
    /// Something could not be done.
    Error,
}

/// One message.
pub struct Notice {
    /// Its own, never used again.
    pub number: u64,
    /// What it is about.
    pub kind: NoticeKind,
    /// What it says.
    pub text: String,
    /// Seconds of egui's clock; set when it is first drawn.
    pub until: Option<f64>,
}

/// The messages on screen, oldest first.
#[derive(Default)]
pub struct Notices {
    list: Vec<Notice>,
    count: u64,
}

impl Notices {
    /// Shows a message; one that is there already stays longer instead of standing there twice.
    pub fn add(&mut self, kind: NoticeKind, text: String) {
        match self.list.iter_mut().find(|m| m.kind == kind && m.text == text) {
            Some(same) => same.until = None,
            None => {
                self.count += 1;
                self.list.push(Notice { number: self.count, kind, text, until: None });
                let excess = self.list.len().saturating_sub(MAX_NOTICES);
                self.list.drain(..excess);
            }
        }
    }

    /// Shows a message that passes.
    pub fn info(&mut self, text: impl Into<String>) {
        self.add(NoticeKind::Info, text.into());
    }

    /// Shows a message that stays a while.
    pub fn error(&mut self, text: impl Into<String>) {
        let text = text.into();
        tracing::warn!("{text}");
        self.add(NoticeKind::Error, text);
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.list.len()
    }

    /// The messages, oldest first.
    pub fn list_mut(&mut self) -> &mut Vec<Notice> {
        &mut self.list
    }

    /// Closes all.
    pub fn clear(&mut self) {
        self.list.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_same_message_stands_there_once() {
        let mut notices = Notices::default();
        notices.add(NoticeKind::Error, "a".to_owned());
        notices.add(NoticeKind::Error, "a".to_owned());
        assert_eq!(notices.len(), 1);
    }

    #[test]
    fn old_messages_make_room() {
        let mut notices = Notices::default();
        for i in 0..9 {
            notices.add(NoticeKind::Info, i.to_string());
        }
        assert_eq!(notices.len(), MAX_NOTICES);
        assert_eq!(notices.list.last().unwrap().text, "8");
    }
}
