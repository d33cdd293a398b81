//! What lists of rows share: the keys after a click on one.

use eframe::egui::Response;

/// Gives `list` the keys once the click on one of its rows is over, if one `was_clicked`. Not at once: egui takes the focus from what
/// a click did not hit, once more in a frame that is laid out anew, and what the click brings up may have moved the rows away.
pub fn focus_after_click(list: &Response, was_clicked: &mut bool) {
    if *was_clicked {
        if list.ctx.input(|i| i.pointer.any_click()) {
            list.ctx.request_repaint();
        } else {
            list.request_focus();
            *was_clicked = false;
        }
    }
}
