//! Messages on screen about finished work and errors.

/// Most messages on screen; a new one replaces the oldest.
const MAX_NOTICES: usize = 5;

pub struct Notice {
    pub number: u64,
    pub is_error: bool,
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
    fn add(&mut self, is_error: bool, text: String) {
        match self.list.iter_mut().find(|m| m.is_error == is_error && m.text == text) {
            Some(same) => same.until = None,
            None => {
                self.count += 1;
                self.list.push(Notice { number: self.count, is_error, text, until: None });
                let excess = self.list.len().saturating_sub(MAX_NOTICES);
                self.list.drain(..excess);
            }
        }
    }

    /// Shows a message for a short time.
    pub fn info(&mut self, text: impl Into<String>) {
        self.add(false, text.into());
    }

    /// Shows an error for a longer time, and logs it.
    pub fn error(&mut self, text: impl Into<String>) {
        let text = text.into();
        tracing::warn!("{text}");
        self.add(true, text);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_stands_there_once_until_others_need_its_room() {
        let mut notices = Notices::default();
        notices.error("a");
        notices.error("a");
        assert_eq!(notices.list.len(), 1);
        (0..9).for_each(|i| notices.info(i.to_string()));
        assert_eq!(notices.list.len(), MAX_NOTICES);
        assert_eq!(notices.list.last().unwrap().text, "8");
    }
}
