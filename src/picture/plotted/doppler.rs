//! A range-Doppler map as a picture.

use super::PictureFormat;
use super::canvas::{Drawing, Painted, PanelArea, PictureError};
use super::map_panel::{MapAxes, MapCells, MapPanel};
use crate::maps::doppler::RangeDopplerMap;
use crate::maps::{Normalisation, RangeAngleMap};
use crate::picture::ColourMap;
use crate::radar::Radar;
use plotters::prelude::*;

const SIZE: (u32, u32) = (900, 700);

/// The bytes of a file with the map, its axes and the scale of its colours.
/// # Errors
/// [`PictureError`] when plotters can't draw.
pub fn compose_range_doppler(
    radar: &Radar,
    map: &RangeDopplerMap,
    normalisation: Normalisation,
    colours: ColourMap,
    format: PictureFormat,
) -> Result<Vec<u8>, PictureError> {
    let lambda = map.log_magnitude().normalise(normalisation);
    format.bytes_of(&Picture { radar, lambda: &lambda, colours })
}

struct Picture<'a> {
    radar: &'a Radar,
    lambda: &'a RangeAngleMap,
    colours: ColourMap,
}

impl Drawing for Picture<'_> {
    fn size(&self) -> (u32, u32) {
        SIZE
    }

    fn draw<B: DrawingBackend>(&self, root: &PanelArea<B>) -> Painted {
        let radar = self.radar;
        let velocity = |column: f64| radar.velocity_of_column_metres_per_second(column);
        let range = |bin: f64| radar.range_of_bin_metres(bin);
        let x = [velocity(-0.5), velocity(radar.chirps as f64 - 0.5)];
        let y = [range(-0.5), range(radar.samples as f64 - 0.5)];
        let axes = MapAxes { x, y, x_title: "radial velocity (m/s)", x_digits: usize::from(x[1] < 5.0) };
        let most = radar.unambiguous_velocity_metres_per_second();
        let title = format!("Range-Doppler, {} chirps, unambiguous \u{b1}{most:.1} m/s", radar.chirps);
        MapPanel { title, cells: MapCells::Lambda(self.lambda.lambda.view().into(), self.colours) }
            .draw_over(root, &axes)
    }
}
