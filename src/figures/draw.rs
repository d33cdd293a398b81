//! Sheets as PNG and SVG.

use super::sheet::{PanelContent, Series, Sheet, SheetAxis, SheetCells, SheetChart, SheetPanel, Stroke};
use crate::picture::{ColourMap, Drawing, Painted, PanelArea, painted};
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;

type SheetDrawn<B> = Result<(), DrawingAreaErrorKind<<B as DrawingBackend>::ErrorType>>;
type Axes<'a, B> = ChartContext<'a, B, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

const PAPER: RGBColor = RGBColor(252, 252, 250);
/// Curves differ by dash as well as by hue.
const HUES: [RGBColor; 5] =
    [RGBColor(200, 70, 10), RGBColor(20, 90, 180), RGBColor(30, 30, 34), RGBColor(120, 60, 150), RGBColor(0, 120, 100)];
const TITLE_PIXELS: i32 = 34;
const BAR_PIXELS: i32 = 58;

fn words(size: f64, colour: &RGBColor) -> TextStyle<'static> {
    FontDesc::new(FontFamily::SansSerif, size, FontStyle::Normal).color(colour)
}

impl Drawing for Sheet {
    fn size(&self) -> (u32, u32) {
        self.pixels()
    }

    fn draw<B: DrawingBackend>(&self, area: &PanelArea<B>) -> Painted {
        let (width, height) = self.panel_pixels;
        for (index, panel) in self.panels.iter().enumerate() {
            let (column, row) = ((index % self.columns) as i32, (index / self.columns) as i32);
            let corner = (column * width as i32, row * height as i32);
            draw_panel(panel, &area.clone().shrink(corner, (width, height)))?;
        }
        Ok(())
    }
}

fn draw_panel<B: DrawingBackend>(panel: &SheetPanel, area: &PanelArea<B>) -> SheetDrawn<B> {
    let (width, height) = area.dim_in_pixel();
    area.draw(&Text::new(panel.title.clone(), (14, 10), words(19.0, &HUES[2])))?;
    let below = area.clone().shrink((0, TITLE_PIXELS), (width as i32, height as i32 - TITLE_PIXELS));
    match &panel.content {
        PanelContent::Chart(chart) => draw_chart(chart, &below),
        PanelContent::Cells(cells) => draw_cells(cells, &below),
    }
}

fn axes<'a, B: DrawingBackend>(
    area: &'a PanelArea<B>,
    x: &SheetAxis,
    y: &SheetAxis,
    right: i32,
) -> Result<Axes<'a, B>, DrawingAreaErrorKind<B::ErrorType>> {
    ChartBuilder::on(area)
        .margin(6)
        .margin_right(right)
        .x_label_area_size(46)
        .y_label_area_size(64)
        .build_cartesian_2d(x.span.clone(), y.span.clone())
}

fn label_axes<B: DrawingBackend>(chart: &mut Axes<'_, B>, x: &SheetAxis, y: &SheetAxis, mesh: bool) -> SheetDrawn<B> {
    let (small, large) = (words(14.0, &RGBColor(84, 90, 98)), words(15.0, &HUES[2]));
    let format = |v: &f64| {
        let v = if v.abs() < 1e-9 { 0.0 } else { *v };
        format!("{}", (v * 1e4).round() / 1e4)
    };
    let mut style = chart.configure_mesh();
    if !mesh {
        style.disable_mesh();
    }
    style
        .x_labels(6)
        .y_labels(6)
        .light_line_style(TRANSPARENT)
        .bold_line_style(RGBColor(226, 229, 232))
        .x_label_formatter(&format)
        .y_label_formatter(&format)
        .label_style(small)
        .axis_desc_style(large)
        .x_desc(x.label)
        .y_desc(y.label)
        .draw()
}

fn draw_chart<B: DrawingBackend>(chart: &SheetChart, area: &PanelArea<B>) -> SheetDrawn<B> {
    let mut on = axes(area, &chart.x, &chart.y, 18)?;
    label_axes(&mut on, &chart.x, &chart.y, true)?;
    for (series, hue) in chart.series.iter().zip(HUES.iter().cycle()) {
        draw_series(&mut on, series, *hue)?;
    }
    if chart.series.iter().any(|s| !s.name.is_empty()) {
        on.configure_series_labels()
            .position(SeriesLabelPosition::UpperRight)
            .background_style(PAPER.mix(0.9))
            .label_font(words(14.0, &HUES[2]))
            .draw()?;
    }
    Ok(())
}

fn draw_series<B: DrawingBackend>(on: &mut Axes<'_, B>, series: &Series, hue: RGBColor) -> SheetDrawn<B> {
    let style = hue.stroke_width(2);
    let points = series.points.iter().copied();
    let drawn = match series.stroke {
        Stroke::Solid => on.draw_series(LineSeries::new(points, style))?,
        Stroke::Dashed => on.draw_series(DashedLineSeries::new(points, 7, 5, style))?,
        Stroke::Dots => on.draw_series(points.map(|p| Circle::new(p, 4, hue.filled())))?,
    };
    if !series.name.is_empty() {
        drawn.label(series.name).legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], style));
    }
    Ok(())
}

fn draw_cells<B: DrawingBackend>(cells: &SheetCells, area: &PanelArea<B>) -> SheetDrawn<B> {
    let bar = if cells.ends_of_bar.is_some() { BAR_PIXELS } else { 14 };
    let mut on = axes(area, &cells.x, &cells.y, bar)?;
    let (across, up) = on.plotting_area().get_pixel_range();
    let size = ((across.end - across.start) as u32, (up.end - up.start) as u32);
    let corner = (cells.x.span.start, cells.y.span.end);
    if let Some(bitmap) =
        BitMapElement::with_owned_buffer(corner, size, paint(cells, [size.0 as usize, size.1 as usize]))
    {
        let bitmap: BitMapElement<'_, (f64, f64)> = bitmap;
        on.draw_series(std::iter::once(bitmap))?;
    }
    on.draw_series(cells.rings.iter().map(|at| Circle::new(*at, 9, RGBColor(70, 220, 235).stroke_width(2))))?;
    label_axes(&mut on, &cells.x, &cells.y, false)?;
    let Some((low, high)) = cells.ends_of_bar else { return Ok(()) };
    let (x, y) = area.get_pixel_range();
    let (left, top) = (across.end - x.start + 8, up.start - y.start);
    for row in 0..size.1 as i32 {
        let [r, g, b] = cells.colours.colour(1.0 - row as f32 / (size.1.max(2) - 1) as f32);
        area.draw(&Rectangle::new([(left, top + row), (left + 12, top + row + 1)], RGBColor(r, g, b).filled()))?;
    }
    for (text, at) in [(high, top), (low, top + size.1 as i32 - 16)] {
        area.draw(&Text::new(text, (left + 16, at), words(13.0, &RGBColor(84, 90, 98))))?;
    }
    Ok(())
}

fn paint(cells: &SheetCells, size: [usize; 2]) -> Vec<u8> {
    let telling = |v: f32| if cells.colours == ColourMap::Diverging { (v - 0.5).abs() } else { v };
    let more = |most: f32, v: f32| if most.is_nan() || telling(v) > telling(most) { v } else { most };
    painted(size, cells.values.dim(), |under| match under.map(|cell| cells.values[cell]).fold(f32::NAN, more) {
        most if most.is_nan() => [PAPER.0, PAPER.1, PAPER.2],
        most => cells.colours.colour(most),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::{PictureFormat, render_svg};
    use ndarray::array;

    fn sheet() -> Sheet {
        let axis = || SheetAxis::new("bins", 0.0, 2.0);
        let cells = SheetCells {
            x: axis(),
            y: axis(),
            values: array![[0.0, 1.0], [f32::NAN, 0.5]],
            colours: ColourMap::Grey,
            ends_of_bar: Some(("0", "1")),
            rings: vec![(1.0, 1.0)],
        };
        let curve = Series::line("a", [(0.0, 0.0), (2.0, 1.0)]);
        let panels = vec![SheetPanel::chart("Chart", axis(), axis(), vec![curve]), SheetPanel::cells("Cells", cells)];
        Sheet::of(2, (300, 240), panels)
    }

    #[test]
    fn sheets_become_both_kinds_of_file() {
        let sheet = sheet();
        let image = image::load_from_memory(&PictureFormat::Png.bytes_of(&sheet).unwrap()).unwrap();
        assert_eq!((image.width(), image.height()), (600, 240));
        let text = render_svg(&sheet).unwrap();
        assert!(text.contains("Chart") && text.contains("<image") && text.trim_end().ends_with("</svg>"));
    }

    #[test]
    fn the_brightest_cell_under_a_pixel_shows() {
        let PanelContent::Cells(mut cells) = sheet().panels[1].content.clone() else { panic!("cells") };
        cells.values = array![[0.0, 1.0], [0.2, 0.4]];
        assert_eq!(paint(&cells, [1, 2]), [102, 102, 102, 255, 255, 255]);
    }
}
