//! Maps of coloured cells over two axes of named places, many in one picture with one legend.

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::canvas::{FONT, Figure, drawing};
use super::error::PlotError;

/// An axis of named places.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Places {
    /// What it shows, with the unit.
    pub label: String,
    /// Its places in order.
    pub names: Vec<String>,
}

/// One map.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CellMap {
    /// Above it; drawn above the maps of the first row.
    pub title: String,
    /// Along the bottom.
    pub x: Places,
    /// Up the side; drawn beside the first map of a row.
    pub y: Places,
    /// Place of each cell's kind in the legend, the lowest row first; None is not drawn.
    pub cells: Vec<Option<usize>>,
}

/// Rows of maps with one legend. The maps of a row share their axes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CellMaps {
    /// Name and colour of each kind.
    pub legend: Vec<(String, [u8; 3])>,
    /// The maps.
    pub rows: Vec<Vec<CellMap>>,
}

/// Sizes in pixels: side of a cell, room between maps, room of a title, of the legend's line, of a margin.
const CELL: i32 = 17;
const GAP: i32 = 16;
const TITLE: i32 = 26;
const LEGEND: i32 = 24;
const MARGIN: i32 = 14;

/// Font sizes of places, and of titles and labels; about so wide is a letter of the former.
const SMALL: i32 = 13;
const LARGE: i32 = 16;
const LETTER: i32 = 7;
/// The same of the latter.
const LARGE_LETTER: i32 = 9;

fn longest<'a>(places: impl Iterator<Item = &'a Places>) -> i32 {
    let longest = places.flat_map(|p| &p.names).map(|n| n.chars().count()).max().unwrap_or(0);
    LETTER * longest.min(64) as i32 + 8
}

impl CellMaps {
    fn maps(&self) -> impl Iterator<Item = &CellMap> {
        self.rows.iter().flatten()
    }

    /// Room left of the first map, and below a row.
    fn rooms(&self) -> (i32, i32) {
        (longest(self.maps().map(|m| &m.y)) + 2 * LARGE, longest(self.maps().map(|m| &m.x)) + 2 * LARGE)
    }

    /// Width of each column of maps, which its title fits in, height of each row without its names.
    fn extents(&self) -> (Vec<i32>, Vec<i32>) {
        let columns = self.rows.iter().map(Vec::len).max().unwrap_or(0);
        let width = |c: usize| self.rows.iter().filter_map(|r| r.get(c)).map(|m| m.x.names.len()).max().unwrap_or(0);
        let height = |r: &Vec<CellMap>| r.iter().map(|m| m.y.names.len()).max().unwrap_or(0);
        let px = |cells: usize| CELL * cells.min(1000) as i32;
        let title = |c: usize| self.rows.first().and_then(|r| r.get(c)).map_or(0, |m| m.title.chars().count().min(64));
        let wide = |c: usize| px(width(c)).max(LARGE_LETTER * title(c) as i32);
        ((0..columns).map(wide).collect(), self.rows.iter().map(|r| px(height(r))).collect())
    }
}

impl Figure for CellMaps {
    fn size(&self) -> (u32, u32) {
        let (left, below) = self.rooms();
        let (widths, heights) = self.extents();
        let width = 2 * MARGIN + left + widths.iter().map(|w| w + GAP).sum::<i32>();
        let rows: i32 = heights.iter().map(|h| h + below).sum();
        let height = 2 * MARGIN + TITLE + rows + LEGEND * (self.legend.len() as i32 + 1);
        (width.max(0) as u32, height.max(0) as u32)
    }

    fn draw<B: DrawingBackend>(&self, root: &DrawingArea<B, Shift>) -> Result<(), PlotError> {
        if self.maps().next().is_none() {
            return Err(PlotError::Empty);
        }
        let kinds = self.legend.len();
        let whole = |m: &CellMap| m.cells.len() == m.x.names.len() * m.y.names.len();
        if !self.maps().all(|m| whole(m) && m.cells.iter().flatten().all(|kind| *kind < kinds)) {
            return Err(PlotError::Axis);
        }
        let pen = Pen { root };
        let (left, below) = self.rooms();
        let (widths, heights) = self.extents();
        let mut y = MARGIN + TITLE;
        for (r, (row, height)) in self.rows.iter().zip(&heights).enumerate() {
            let mut x = MARGIN + left;
            for (c, (map, width)) in row.iter().zip(&widths).enumerate() {
                let bottom = y + height;
                self.cells(&pen, map, x, bottom)?;
                if r == 0 {
                    pen.text(&map.title, (x, y - 6), LARGE, (HPos::Left, VPos::Bottom), false)?;
                }
                for (i, name) in map.x.names.iter().enumerate() {
                    let at = (x + CELL * i as i32 + CELL / 2, bottom + 5);
                    pen.text(name, at, SMALL, (HPos::Right, VPos::Center), true)?;
                }
                // one that is too long for its map stands below the first alone
                if c == 0 || LETTER * map.x.label.chars().count() as i32 <= width + GAP {
                    let at = (x, bottom + below - LARGE - 6);
                    pen.text(&map.x.label, at, SMALL, (HPos::Left, VPos::Center), false)?;
                }
                if c == 0 {
                    for (i, name) in map.y.names.iter().enumerate() {
                        let at = (x - 5, bottom - CELL * i as i32 - CELL / 2);
                        pen.text(name, at, SMALL, (HPos::Right, VPos::Center), false)?;
                    }
                    let at = (MARGIN + SMALL, bottom - height / 2);
                    pen.text(&map.y.label, at, SMALL, (HPos::Center, VPos::Center), true)?;
                }
                x += width + GAP;
            }
            y += height + below;
        }
        for (name, colour) in &self.legend {
            pen.cell((MARGIN + left, y), *colour)?;
            pen.text(name, (MARGIN + left + CELL + 8, y + CELL / 2), LARGE, (HPos::Left, VPos::Center), false)?;
            y += LEGEND;
        }
        Ok(())
    }
}

impl CellMaps {
    fn cells<B: DrawingBackend>(&self, pen: &Pen<'_, B>, map: &CellMap, x: i32, bottom: i32) -> Result<(), PlotError> {
        let columns = map.x.names.len();
        for (i, kind) in map.cells.iter().enumerate() {
            let Some((_, colour)) = kind.and_then(|k| self.legend.get(k)) else {
                continue;
            };
            let (row, column) = ((i / columns) as i32, (i % columns) as i32);
            pen.cell((x + CELL * column, bottom - CELL * (row + 1)), *colour)?;
        }
        Ok(())
    }
}

struct Pen<'a, B: DrawingBackend> {
    root: &'a DrawingArea<B, Shift>,
}

impl<B: DrawingBackend> Pen<'_, B> {
    /// A cell by its upper left corner, a line of white around it.
    fn cell(&self, (x, y): (i32, i32), [r, g, b]: [u8; 3]) -> Result<(), PlotError> {
        let corners = [(x, y), (x + CELL - 2, y + CELL - 2)];
        self.root.draw(&Rectangle::new(corners, RGBColor(r, g, b).filled())).map_err(drawing)
    }

    /// A text around a place; turned it reads upwards, and `anchor` is that of the text before it is turned.
    fn text(&self, text: &str, at: (i32, i32), size: i32, (h, v): (HPos, VPos), turned: bool) -> Result<(), PlotError> {
        let turn = if turned { FontTransform::Rotate270 } else { FontTransform::None };
        let style = TextStyle::from((FONT, size)).transform(turn).pos(Pos::new(h, v));
        self.root.draw_text(text, &style, at).map_err(drawing)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn maps() -> CellMaps {
        let places = |label: &str| Places { label: label.into(), names: vec!["a".into(), "b".into(), "c".into()] };
        let map = CellMap {
            title: "tuned".into(),
            x: places("step"),
            y: places("stiffness"),
            cells: (0..9).map(|i| if i == 4 { None } else { Some(i % 2) }).collect(),
        };
        CellMaps {
            legend: vec![("stable".into(), [0, 158, 115]), ("refused".into(), [86, 180, 233])],
            rows: vec![vec![map.clone(), map.clone()], vec![map]],
        }
    }

    #[test]
    fn every_cell_has_its_colour() {
        let m = maps();
        let png = m.png().unwrap();
        let picture = image::load_from_memory(&png).unwrap().to_rgb8();
        assert_eq!(picture.dimensions(), m.size());
        // two pixels are between cells
        let each = ((CELL - 2) * (CELL - 2)) as usize;
        let of = |colour: [u8; 3]| picture.pixels().filter(|p| p.0 == colour).count();
        // in each of three maps four even cells (the middle one is not drawn) and four odd ones, and one in the legend
        let counts = [of([0, 158, 115]), of([86, 180, 233])];
        assert_eq!(counts, [13 * each; 2]);
        // the lowest row first: the cell above the left end of the bottom is the first
        let (left, _) = m.rooms();
        let bottom = MARGIN + TITLE + 3 * CELL;
        let pixel = |x: i32, y: i32| picture.get_pixel(x as u32, y as u32).0;
        assert_eq!(pixel(MARGIN + left + 3, bottom - 5), [0, 158, 115]);
        assert_eq!(pixel(MARGIN + left + CELL + 3, bottom - 5), [86, 180, 233]);
        assert_eq!(png, m.png().unwrap());
        assert!(m.svg().unwrap().contains("stiffness"));
    }

    #[test]
    fn what_does_not_fit_together_is_an_error() {
        assert_eq!(CellMaps { rows: vec![], ..maps() }.png(), Err(PlotError::Empty));
        let mut m = maps();
        m.rows[0][0].cells.pop();
        assert_eq!(m.png(), Err(PlotError::Axis));
        let mut m = maps();
        m.rows[0][0].cells[0] = Some(2);
        assert_eq!(m.png(), Err(PlotError::Axis));
    }
}
