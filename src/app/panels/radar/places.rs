//! Places of transmitters and receivers as lists of numbers, to be typed or pasted from a spreadsheet.

use crate::app::widgets::{entry_problem, text_entry};
use crate::radar::{Antennas, Radar};
use eframe::egui::Ui;

/// Names of the lists, places along the line and off it.
const LIST_NAMES: [&str; 4] =
    ["transmitters at, mm", "receivers at, mm", "transmitters forward, mm", "receivers forward, mm"];

/// Tooltips of the lists: places along the line, and places off it.
const TOOLTIPS: [&str; 2] = [
    "Places along x with commas, spaces or tabs between them, as a spreadsheet copies them",
    "How far each stands off the line, towards the scene, in the order of its places along x. An empty list is a straight line",
];

/// Digits of a place after the point, millimetres.
const PLACE_DECIMALS: usize = 4;

/// Draws all lists, if `radar` has antennas, and applies the typed places.
pub(super) fn show(ui: &mut Ui, radar: &mut Radar, is_free: bool) {
    let Some(antennas) = radar.antennas.clone() else {
        return;
    };
    let own = [
        antennas.transmitter_x_metres(),
        antennas.receiver_x_metres(),
        antennas.transmitter_y_metres(),
        antennas.receiver_y_metres(),
    ];
    for (list, name) in LIST_NAMES.into_iter().enumerate() {
        let (id, width) = (ui.scope_id().with(name), ui.available_width().min(560.0));
        let read = |text: &str| taken(own, list, places(text)?).map_err(|error| error.to_string());
        let shown = (listed(own[list]), width);
        if let Some(antennas) = text_entry(ui, id, (name, TOOLTIPS[list / 2]), shown, is_free, read) {
            *radar = radar.clone().with_antennas(antennas);
        }
        entry_problem(ui, id);
    }
}

/// The antennas with `places` as list number `list` of `own`. New antennas stand on the line.
fn taken(own: [&[f64]; 4], list: usize, mut places: Vec<f64>) -> Result<Antennas, String> {
    let is_off_line = list >= 2;
    if is_off_line && places.is_empty() {
        places = vec![0.0; own[list].len()];
    }
    let mut lists = own.map(<[f64]>::to_vec);
    if !is_off_line {
        lists[list + 2].resize(places.len(), 0.0);
    }
    lists[list] = places;
    Antennas::new(&lists[0], &lists[1])?.off_line(&lists[2], &lists[3])
}

/// Text of places in metres, as a list in millimetres.
fn listed(x_metres: &[f64]) -> String {
    let one = |x: &f64| {
        let text = format!("{:.PLACE_DECIMALS$}", x * 1e3);
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    };
    x_metres.iter().map(one).collect::<Vec<_>>().join(", ")
}

/// The places in metres of a list in millimetres.
fn places(text: &str) -> Result<Vec<f64>, String> {
    let cells = text.split([',', ';', ' ', '\t', '\n', '\r']).filter(|cell| !cell.is_empty());
    let place = |(i, cell): (usize, &str)| match cell.parse::<f64>().ok().filter(|v| v.is_finite()) {
        Some(millimetres) => Ok(millimetres * 1e-3),
        None => Err(format!("number {}: \"{}\" is no number", i + 1, cell.chars().take(20).collect::<String>())),
    };
    cells.enumerate().map(place).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::widgets::seen::{Harness, Queryable, User};

    #[test]
    fn a_list_is_read_as_it_is_written() {
        assert_eq!(listed(&[-0.008, 0.0, 0.00195]), "-8, 0, 1.95");
        assert_eq!(places("-8, 0;1.5\t2\n").unwrap(), [-0.008, 0.0, 0.0015, 0.002]);
        assert_eq!(places("1, zwei").unwrap_err(), "number 2: \"zwei\" is no number");
    }

    #[test]
    fn a_list_off_the_line_is_taken_with_the_places_it_belongs_to() {
        let antennas = radar().antennas.unwrap();
        let bent = antennas.off_line(&[0.0, -0.002, 0.0], &[0.0; 4]).unwrap();
        let own = [
            bent.transmitter_x_metres(),
            bent.receiver_x_metres(),
            bent.transmitter_y_metres(),
            bent.receiver_y_metres(),
        ];
        let receivers = taken(own, 3, vec![0.001; 4]).unwrap();
        assert_eq!((receivers.transmitter_y_metres()[1], receivers.receiver_y_metres()), (-0.002, &[0.001; 4][..]));
        assert!(taken(own, 2, Vec::new()).unwrap().is_on_line());
        let fewer = taken(own, 0, own[0][..2].to_vec()).unwrap();
        assert_eq!(fewer.transmitter_y_metres(), [0.0, -0.002], "those that stay keep their y");
        let told = taken(own, 3, vec![0.0; 3]).unwrap_err().to_string();
        assert_eq!(told, "receiver_y_metres has 3 numbers; expected 4, one for each antenna");
    }

    fn radar() -> Radar {
        Radar { elements: 6, ..Radar::default() }.of_pairs(3, 4).unwrap()
    }

    /// Number of transmitters after this text was typed, and whether an error was shown.
    fn typed(text: &str) -> (usize, bool) {
        let draw = |ui: &mut Ui, radar: &mut Radar| show(ui, radar, true);
        let mut panel = Harness::builder().with_size([600.0, 300.0]).build_ui_state(draw, radar());
        panel.run();
        panel.enters(LIST_NAMES[0], text);
        let told = panel.query_by_label_contains("is no number").is_some();
        (panel.state().antennas.as_ref().unwrap().transmitter_x_metres().len(), told)
    }

    #[test]
    fn places_are_typed_and_what_is_no_number_is_told() {
        let apart = 8.0 * radar().element_spacing_metres;
        assert_eq!(typed(&listed(&[0.0, apart, 2.0 * apart, 3.0 * apart])), (4, false));
        assert_eq!(typed("0, viel"), (3, true));
    }
}
