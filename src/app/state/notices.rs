//! Messages on screen about finished work and errors.

/// Most messages on screen; a new one replaces the oldest.
const MAX_NOTICES: usize = 5;

/// The kind of a message.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NoticeKind {
    Info,
    Error,
}

/// One message.
pub struct Notice {
    pub number: u64,
    pub kind: NoticeKind,
    pub text: String,
    /// Time at which it goes away, seconds of egui's clock; set when it is first drawn.
    pub until: Option<f64>,
}

/// The messages on screen, oldest first.
#[derive(Default)]
pub struct Notices {
    pub list: Vec<Notice>,
    count: u64,
}

impl Notices {
    /// Shows a message. The same message already on screen stays longer instead.
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

    /// Shows a message for a short time.
    pub fn info(&mut self, text: impl Into<String>) {
        self.add(NoticeKind::Info, text.into());
    }

    /// Shows an error for a longer time, and logs it.
    pub fn error(&mut self, text: impl Into<String>) {
        let text = text.into();
        tracing::warn!("{text}");
        self.add(NoticeKind::Error, text);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_stands_there_once_until_others_need_its_room() {
        let mut notices = Notices::default();
        notices.add(NoticeKind::Error, "a".to_owned());
        notices.add(NoticeKind::Error, "a".to_owned());
        assert_eq!(notices.list.len(), 1);
        (0..9).for_each(|i| notices.add(NoticeKind::Info, i.to_string()));
        assert_eq!(notices.list.len(), MAX_NOTICES);
        assert_eq!(notices.list.last().unwrap().text, "8");
    }
}
