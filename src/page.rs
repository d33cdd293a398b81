//! The window in a browser: the program of the page.

fn main() {
    apertura::app::open_page();
}
