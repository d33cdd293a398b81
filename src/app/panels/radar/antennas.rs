//! Transmitters and receivers in the radar panel: their numbers, their places, and the elements that their pairs make.

use crate::app::widgets::NumberField;
use crate::radar::{Antennas, Radar, counted};
use eframe::egui::{Id, Ui};

pub(super) const NAME: &str = "antennas";

/// Most transmitters, and most receivers, that the panel offers.
const MAX_ANTENNAS: usize = 64;

/// Range for which the panel states the path error of the pairs' midpoints, metres.
const NEAR_RANGE_METRES: f64 = 2.0;

pub(super) const ANTENNAS_TOOLTIP: &str = "Whether every element sends and hears by itself, or each pair of a transmitter and a receiver is an element \
                                  halfway between both. A place of the line that no pair makes is a gap and hears nothing";

pub(super) fn follows(radar: &Radar) -> String {
    match &radar.antennas {
        None => "every element sends and hears by itself".to_owned(),
        Some(antennas) => consequence(radar, antennas),
    }
}

/// Draws the choice between one antenna an element and pairs, with the number of antennas.
pub(super) fn choices(ui: &mut Ui, radar: &mut Radar, label: Id) {
    ui.horizontal(|ui| {
        let alone = ui.selectable_label(radar.is_monostatic(), "one an element").labelled_by(label);
        let pairs = ui.selectable_label(!radar.is_monostatic(), "pairs");
        if alone.clicked() {
            radar.antennas = None;
        } else if pairs.clicked() && radar.is_monostatic() {
            let transmitters = divisor(radar.elements);
            set(radar, transmitters, radar.elements / transmitters);
        }
    });
    counts(ui, radar);
}

fn consequence(radar: &Radar, antennas: &Antennas) -> String {
    let (transmitters, receivers) = (antennas.transmitter_x_metres().len(), antennas.receiver_x_metres().len());
    let pairs = (0..radar.elements).filter(|n| !radar.is_gap(*n)).map(|n| radar.pair(n));
    let apart = pairs.map(|p| (p.transmitter_x_metres - p.receiver_x_metres).abs()).fold(0.0, f64::max);
    let turns = 2.0 * apart * apart / (8.0 * NEAR_RANGE_METRES) / radar.wavelength_metres();
    let mut made = format!("{transmitters} × {receivers} pairs are {} elements", transmitters * receivers);
    if antennas.left_out() > 0 {
        made += &format!(", {} of them at the place of another", antennas.left_out());
    }
    if antennas.gaps() > 0 {
        made += &format!(", with {} that hear nothing between them", counted(antennas.gaps() as u32, "gap", "gaps"));
    }
    if !antennas.is_on_line() {
        let most = antennas.depth_metres().into_iter().fold(0.0, |most: f64, y| most.max(y.abs()));
        made += &format!(", up to {:.1} mm off the line", most * 1e3);
    }
    format!(
        "{made}; at {NEAR_RANGE_METRES:.0} m the way is up to {turns:.2} wavelengths longer than that of their midpoints"
    )
}

/// Draws the numbers of transmitters and receivers, where they stand apart.
fn counts(ui: &mut Ui, radar: &mut Radar) {
    let Some(antennas) = &radar.antennas else {
        return;
    };
    let before = (antennas.transmitter_x_metres().len(), antennas.receiver_x_metres().len());
    let (mut transmitters, mut receivers) = before;
    for (name, count) in [("transmitters", &mut transmitters), ("receivers", &mut receivers)] {
        ui.horizontal(|ui| {
            let field = ui.add(NumberField::new(count).range(1..=MAX_ANTENNAS).speed(0.1));
            field.labelled_by(ui.label(name).id);
        });
    }
    if (transmitters, receivers) != before {
        set(radar, transmitters, receivers);
    }
}

/// Gives the radar that many antennas at its spacing. Numbers that make no array leave the radar as it is.
fn set(radar: &mut Radar, transmitters: usize, receivers: usize) {
    if let Ok(antennas) = Antennas::filled(transmitters, receivers, radar.element_spacing_metres) {
        *radar = radar.clone().with_antennas(antennas);
    }
}

/// The largest divisor of `elements` up to their root: with so many transmitters there are fewest antennas.
fn divisor(elements: usize) -> usize {
    (1..=MAX_ANTENNAS).take_while(|n| n * n <= elements).filter(|n| elements.is_multiple_of(*n)).last().unwrap_or(1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radar::Convention;

    #[test]
    fn elements_are_shared_out_among_fewest_antennas() {
        assert_eq!([1024, 192, 12, 13].map(divisor), [32, 12, 3, 1]);
    }

    #[test]
    fn counts_keep_the_spacing() {
        let mut radar = Radar { elements: 192, ..Radar::default() }.in_convention(Convention::Physical);
        let spacing = radar.element_spacing_metres;
        set(&mut radar, 12, 16);
        radar.validate().unwrap();
        assert_eq!(radar.elements, 192);
        assert!((radar.element_spacing_metres / spacing - 1.0).abs() < 1e-12);
        let before = radar.clone();
        set(&mut radar, 1, 1);
        assert_eq!(radar, before, "one element is no array");
    }
}
