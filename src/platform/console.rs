//! The console that the program was started from, if any.

use std::io::Write;

/// Takes the console of the parent process. On Windows a program with a window has none of its own.
pub fn join() {
    #[cfg(windows)]
    {
        use windows_sys::Win32::System::Console::{ATTACH_PARENT_PROCESS, AttachConsole};
        // SAFETY: takes no pointer. It fails where there is no console, and where the program has one already.
        let _joined = unsafe { AttachConsole(ATTACH_PARENT_PROCESS) };
    }
}

/// Writes a sentence to standard error. A program started by a double click on Windows has none; there the system shows a box.
pub fn say(sentence: &str) {
    #[cfg(all(windows, feature = "app"))]
    if std::os::windows::io::AsRawHandle::as_raw_handle(&std::io::stderr()).is_null() {
        rfd::MessageDialog::new().set_title("apertura").set_description(sentence).show();
        return;
    }
    note(sentence);
}

/// Writes a line to standard error, or nothing where that can't be written: a full disk, or a reader that has gone away, ends no command.
pub fn note(line: &str) {
    let _unwritten = writeln!(std::io::stderr(), "{line}");
}
