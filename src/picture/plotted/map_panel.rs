//! One range-angle map with title, axes and colour bar.

use super::canvas::{FAINT_INK, HAIRLINE, INK, Painted, PanelArea, PictureError, painted};
use super::text::{self, Weight};
use crate::picture::colour::{ColourMap, Rgb};
use crate::picture::detections::CellVerdict;
use crate::radar::{MIN_FINE_COLUMNS, Radar};
use ndarray::{Array2, CowArray, Ix2};
use plotters::prelude::*;

/// The cells of a panel, `[range bins, columns]` as they are drawn, the leftmost column first.
#[derive(Debug, Clone)]
pub(super) enum MapCells<'a> {
    Lambda(CowArray<'a, f32, Ix2>, ColourMap),
    Above(CowArray<'a, f32, Ix2>, f32),
    /// The output above its threshold: hits, misses and false alarms.
    Detections(Array2<CellVerdict>),
}

#[derive(Debug, Clone)]
pub(super) struct MapPanel<'a> {
    pub title: String,
    pub cells: MapCells<'a>,
}

const NOTHING: Rgb = [22, 26, 34];
const HIT: Rgb = [245, 245, 240];

const TITLE_HEIGHT: i32 = 40;
const BAR_SPACE: i32 = 62;

/// Space to the right of the legend, pixels.
const LEGEND_MARGIN: i32 = 8;

pub(super) struct MapAxes {
    /// Values at the left and the right end of the axis, rising.
    pub x: [f64; 2],
    pub y: [f64; 2],
    pub x_title: &'static str,
    /// Digits of its labels after the point.
    pub x_digits: usize,
}

impl MapPanel<'_> {
    pub(super) fn draw<B: DrawingBackend>(&self, area: &PanelArea<B>, radar: &Radar) -> Painted {
        // A column stands for the direction in its middle; half of one counts where there are few.
        let half = if radar.elements < MIN_FINE_COLUMNS { 0.0 } else { 0.5 };
        let x = [0.0, 1.0].map(|across| radar.cos_of_column(radar.column_across(across) + half));
        let axes = MapAxes { x, y: [0.0, radar.max_range_metres()], x_title: "cos \u{3b8}", x_digits: 1 };
        self.draw_over(area, &axes)
    }

    pub(super) fn draw_over<B: DrawingBackend>(&self, area: &PanelArea<B>, axes: &MapAxes) -> Painted {
        let (width, height) = area.dim_in_pixel();
        let (width, height) = (width as i32, height as i32);
        text::line(area, (62, 8), &self.title, 21, Weight::Bold, &INK)?;

        let chart_area = area.clone().shrink((0, TITLE_HEIGHT), (width - BAR_SPACE, height - TITLE_HEIGHT));
        let ([left, right], [bottom, top]) = (axes.x, axes.y);
        let mut chart = ChartBuilder::on(&chart_area)
            .x_label_area_size(52)
            .y_label_area_size(62)
            .margin_right(2)
            .build_cartesian_2d(left..right, bottom..top)?;
        let (x, y) = chart.plotting_area().get_pixel_range();
        let size = ((x.end - x.start) as u32, (y.end - y.start) as u32);
        let pixels = painted([size.0 as usize, size.1 as usize], self.cells.dim(), |cells| self.cells.colour(cells));
        let bitmap: BitMapElement<_> = BitMapElement::with_owned_buffer((left, top), size, pixels)
            .ok_or_else(|| PictureError::new("a map has no room"))?;
        chart.draw_series(std::iter::once(bitmap))?;
        chart
            .configure_mesh()
            .disable_mesh()
            .x_labels(5)
            .y_labels(8)
            .x_label_formatter(&|v| format!("{:.*}", axes.x_digits, if v.abs() < 1e-9 { 0.0 } else { *v }))
            .y_label_formatter(&|v| format!("{v:.0}"))
            .x_desc(axes.x_title)
            .y_desc("range (m)")
            .label_style(text::style(16, Weight::Normal, &FAINT_INK))
            .axis_desc_style(text::style(17, Weight::Normal, &INK))
            .axis_style(HAIRLINE)
            .draw()?;

        let (chart_x, chart_y) = area.get_pixel_range();
        let (bar_left, bar_top, bar_height) = (x.end - chart_x.start + 12, y.start - chart_y.start, size.1 as i32);
        match &self.cells {
            MapCells::Lambda(_, colours) => colour_bar(area, (bar_left, bar_top), bar_height, *colours),
            MapCells::Above(..) => Ok(()),
            MapCells::Detections(_) => legend(area),
        }
    }
}

impl MapCells<'_> {
    fn dim(&self) -> (usize, usize) {
        match self {
            MapCells::Lambda(map, _) => map.dim(),
            MapCells::Above(map, _) => map.dim(),
            MapCells::Detections(kinds) => kinds.dim(),
        }
    }

    /// Of several cells on a pixel the brightest, a hit or a false alarm wins.
    fn colour(&self, cells: &mut dyn Iterator<Item = [usize; 2]>) -> Rgb {
        match self {
            MapCells::Lambda(map, colours) => colours.colour(cells.map(|c| map[c]).fold(0.0, f32::max)),
            MapCells::Above(map, eta) => {
                if cells.map(|c| map[c]).any(|v| v > *eta) {
                    HIT
                } else {
                    NOTHING
                }
            }
            MapCells::Detections(kinds) => cells.map(|c| kinds[c]).max().unwrap_or(CellVerdict::Nothing).fill(true),
        }
    }
}

fn colour_bar<B: DrawingBackend>(area: &PanelArea<B>, (x, y): (i32, i32), height: i32, colours: ColourMap) -> Painted {
    const WIDTH: i32 = 14;
    for row in 0..height {
        let [r, g, b] = colours.colour(1.0 - row as f32 / (height - 1).max(1) as f32);
        let strip = Rectangle::new([(x, y + row), (x + WIDTH, y + row + 1)], RGBColor(r, g, b).filled());
        area.draw(&strip)?;
    }
    for (value, part) in [("1", 0.0), ("0.5", 0.5), ("0", 1.0)] {
        let at = y + (f64::from(height) * part) as i32 - 8;
        text::line(area, (x + WIDTH + 6, at), value, 15, Weight::Normal, &FAINT_INK)?;
    }
    text::line(area, (x, y - 24), "\u{39b}", 17, Weight::Normal, &INK)
}

fn legend<B: DrawingBackend>(area: &PanelArea<B>) -> Painted {
    // The legend takes the space of the colour bar in other panels: the title stands left of it.
    let (width, _) = area.dim_in_pixel();
    let mut x = width as i32 - LEGEND_MARGIN;
    for detection in CellVerdict::VISIBLE_VERDICTS.into_iter().rev() {
        let name = detection.name();
        let style = text::style(15, Weight::Normal, &FAINT_INK);
        let (name_width, _) = area.estimate_text_size(name, &style)?;
        x -= name_width as i32;
        area.draw(&Text::new(name, (x, 13), style))?;
        x -= 19;
        let square = [(x, 14), (x + 13, 27)];
        let [r, g, b] = detection.fill(true);
        area.draw(&Rectangle::new(square, RGBColor(r, g, b).filled()))?;
        area.draw(&Rectangle::new(square, FAINT_INK))?;
        x -= 8;
    }
    Ok(())
}
