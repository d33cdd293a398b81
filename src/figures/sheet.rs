//! The content of a figure: panels side by side, each a chart or a map.

use crate::picture::ColourMap;
use ndarray::Array2;
use std::ops::Range;

#[derive(Debug, Clone, PartialEq)]
pub struct Sheet {
    pub panels: Vec<SheetPanel>,
    /// Panels beside one another; the rest follow below.
    pub columns: usize,
    pub panel_pixels: (u32, u32),
}

#[derive(Debug, Clone, PartialEq)]
pub struct SheetPanel {
    pub title: String,
    pub content: PanelContent,
}

#[derive(Debug, Clone, PartialEq)]
pub enum PanelContent {
    Chart(SheetChart),
    Cells(SheetCells),
}

#[derive(Debug, Clone, PartialEq)]
pub struct SheetAxis {
    /// Quantity and unit.
    pub label: &'static str,
    /// The ends of the axis in that unit; the first may be the larger.
    pub span: Range<f64>,
}

#[derive(Debug, Clone, PartialEq)]
pub struct SheetChart {
    pub x: SheetAxis,
    pub y: SheetAxis,
    pub series: Vec<Series>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stroke {
    /// A line from point to point.
    Solid,
    Dashed,
    /// Points alone.
    Dots,
}

#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    pub name: &'static str,
    pub stroke: Stroke,
    pub points: Vec<(f64, f64)>,
}

/// Coloured cells over two axes.
#[derive(Debug, Clone, PartialEq)]
pub struct SheetCells {
    pub x: SheetAxis,
    pub y: SheetAxis,
    /// Values in [0, 1], `[rows from below, columns]`; NaN stays paper.
    pub values: Array2<f32>,
    pub colours: ColourMap,
    /// Labels of 0 and 1 beside the colour bar; `None` for no bar.
    pub ends_of_bar: Option<(&'static str, &'static str)>,
    pub rings: Vec<(f64, f64)>,
}

impl SheetAxis {
    pub fn new(label: &'static str, from: f64, to: f64) -> Self {
        SheetAxis { label, span: from..to }
    }
}

impl Series {
    pub fn line(name: &'static str, points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        Series { name, stroke: Stroke::Solid, points: points.into_iter().collect() }
    }

    pub fn with(self, stroke: Stroke) -> Self {
        Series { stroke, ..self }
    }
}

impl SheetPanel {
    pub fn chart(title: impl Into<String>, x: SheetAxis, y: SheetAxis, series: Vec<Series>) -> Self {
        SheetPanel { title: title.into(), content: PanelContent::Chart(SheetChart { x, y, series }) }
    }

    pub fn cells(title: impl Into<String>, cells: SheetCells) -> Self {
        SheetPanel { title: title.into(), content: PanelContent::Cells(cells) }
    }
}

impl Sheet {
    pub fn of(columns: usize, panel_pixels: (u32, u32), panels: Vec<SheetPanel>) -> Self {
        Sheet { panels, columns: columns.max(1), panel_pixels }
    }

    pub fn pixels(&self) -> (u32, u32) {
        let columns = self.columns.min(self.panels.len()).max(1);
        let rows = self.panels.len().div_ceil(columns).max(1);
        (columns as u32 * self.panel_pixels.0, rows as u32 * self.panel_pixels.1)
    }
}
