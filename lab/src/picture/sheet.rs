//! A contact sheet: labelled panels of cloth side by side, one camera and one scale for all.

use std::path::Path;

use image::RgbImage;

use super::camera::{Camera, Frame, View};
use super::canvas::{Area, Canvas};
use super::card;
use super::cloth::{self, Style};
use super::color::Srgb;
use super::contour;
use super::error::PictureError;
use super::framing::{Content, contents, shared_frame};
use super::grid::Grid;
use super::layout::{FOOTER_LINE, Layout, MARGIN};
use super::legend::{self, INK, Keys, SOFT_INK};
use super::raster::Raster;
use super::save::save_png;
use super::solid;
use super::text::{Align, Face, write};
use crate::scene::Solid;

/// Most panels of a sheet.
pub const MAX_PANELS: usize = 12;

/// Background of the sheet.
const PAPER: Srgb = [247, 246, 243];
/// The viewer stands a little to the right and above, so that folds show; degrees.
const YAW: f32 = 25.0;
const PITCH: f32 = 10.0;
/// Free space round the cloth in its window, pixels.
const CLOTH_MARGIN: usize = 20;

/// One cloth of a sheet with what is written above it.
#[derive(Debug, Clone)]
pub struct Panel {
    pub(super) heading: String,
    pub(super) lines: Vec<String>,
    pub(super) grid: Grid,
    style: Option<Style>,
}

impl Panel {
    /// A panel with a heading such as `generated`; the grid may hold positions that are not finite.
    pub fn new(heading: impl Into<String>, grid: Grid) -> Self {
        Self { heading: heading.into(), lines: Vec::new(), grid, style: None }
    }

    /// Sets the colours of this cloth, where they are not those of the sheet. The legend shows the sheet's ramp.
    #[must_use]
    pub fn style(mut self, style: Style) -> Self {
        self.style = Some(style);
        self
    }

    /// Adds a line below the heading, such as `max 5.5 %  p99 1.2 %`; cut where the panel ends.
    /// At most six lines are drawn.
    #[must_use]
    pub fn line(mut self, line: impl Into<String>) -> Self {
        self.lines.push(line.into());
        self
    }
}

/// A sheet of 1 to [`MAX_PANELS`] panels.
///
/// All panels are seen by one camera at one scale, which fits the smallest cloth and whatever the others reach beyond it
/// by up to one rest diagonal; a longer cloth is cut off by its window.
#[derive(Debug, Clone)]
pub struct Sheet {
    title: String,
    pub(super) subtitle: Option<String>,
    pub(super) footer: Option<String>,
    pub(super) panels: Vec<Panel>,
    outline_of: Option<usize>,
    style: Style,
    pitch: f32,
    pub(super) card_width: Option<i32>,
}

impl Sheet {
    /// An empty sheet with a title, such as the description of the fabric.
    pub fn new(title: impl Into<String>) -> Self {
        Self {
            title: title.into(),
            subtitle: None,
            footer: None,
            panels: Vec::new(),
            outline_of: None,
            style: Style::default(),
            pitch: PITCH,
            card_width: None,
        }
    }

    /// Sets the width of a panel in pixels, 120 to 2000; by the number of panels where nothing is said.
    #[must_use]
    pub fn card_width(mut self, pixels: u32) -> Self {
        self.card_width = Some(pixels.clamp(120, 2000) as i32);
        self
    }

    /// Sets how far above the horizon the viewer stands, in degrees below 90; 10 where nothing is said.
    #[must_use]
    pub fn seen_from(mut self, degrees: f32) -> Self {
        self.pitch = degrees.clamp(-89.0, 89.0);
        self
    }

    /// Sets the line below the title, such as the scene and the step.
    #[must_use]
    pub fn subtitle(mut self, subtitle: impl Into<String>) -> Self {
        self.subtitle = Some(subtitle.into());
        self
    }

    /// Adds a panel after the others.
    #[must_use]
    pub fn panel(mut self, panel: Panel) -> Self {
        self.panels.push(panel);
        self
    }

    /// Dashes the outline of this panel (0 is the first) into all others; ignored where there is no such panel.
    #[must_use]
    pub fn outline_of(mut self, panel: usize) -> Self {
        self.outline_of = Some(panel);
        self
    }

    /// Sets the text at the bottom; it is broken into lines.
    #[must_use]
    pub fn footer(mut self, footer: impl Into<String>) -> Self {
        self.footer = Some(footer.into());
        self
    }

    /// Sets the colours of the cloth.
    #[must_use]
    pub fn style(mut self, style: Style) -> Self {
        self.style = style;
        self
    }

    /// Draws the sheet; the same sheet gives the same pixels.
    ///
    /// # Errors
    /// [`PictureError::Empty`] without panels, [`PictureError::TooManyPanels`] with more than [`MAX_PANELS`].
    pub fn render(&self) -> Result<RgbImage, PictureError> {
        Ok(self.render_in(&self.frame()?))
    }

    /// Draws sheets of one layout at successive times, all seen by one camera: the pictures of a film.
    ///
    /// # Errors
    /// Those of [`render`](Self::render).
    pub fn render_film(sheets: &[Sheet]) -> Result<Vec<RgbImage>, PictureError> {
        let frames = sheets.iter().map(Sheet::frame).collect::<Result<Vec<Frame>, _>>()?;
        let shared = frames.into_iter().reduce(|a, b| a.union(&b)).ok_or(PictureError::Empty)?;
        Ok(sheets.iter().map(|sheet| sheet.render_in(&shared)).collect())
    }

    fn view(&self) -> View {
        View::new(YAW, self.pitch)
    }

    /// What the camera must show.
    fn frame(&self) -> Result<Frame, PictureError> {
        if self.panels.is_empty() {
            return Err(PictureError::Empty);
        }
        if self.panels.len() > MAX_PANELS {
            return Err(PictureError::TooManyPanels { panels: self.panels.len() });
        }
        let view = self.view();
        Ok(shared_frame(&self.panels, &contents(&self.panels, &view), &view))
    }

    fn render_in(&self, frame: &Frame) -> RgbImage {
        let view = self.view();
        let contents: Vec<Content> = contents(&self.panels, &view);
        let drawn = contents.iter().any(|content| matches!(content, Content::Cloth));

        let mut keys = Keys { outline_of: None, pins: false, pixels_per_metre: drawn.then_some(1.0) };
        let outlined = self.outline_of.filter(|&i| matches!(contents.get(i), Some(Content::Cloth)));
        keys.outline_of = outlined.filter(|_| self.panels.len() > 1).map(|i| self.panels[i].heading.clone());
        keys.pins = self.panels.iter().any(|panel| !panel.grid.pins().is_empty());

        let layout = Layout::new(self, frame, &keys);
        let window = layout.window(0);
        let camera = Camera::fit(view, frame, window.width as usize, window.height as usize, CLOTH_MARGIN);
        keys.pixels_per_metre = drawn.then(|| camera.pixels_per_metre());

        let outlines = outlined
            .map(|reference| contour::outlines(&self.shaded(&camera, window, &self.panels[reference], None)))
            .unwrap_or_default();
        let mut canvas = Canvas::new(layout.width as u32, layout.height as u32, PAPER);
        self.draw_header(&mut canvas, &layout);
        for (index, (panel, content)) in self.panels.iter().zip(&contents).enumerate() {
            card::draw_card(&mut canvas, &layout, index, panel, content);
            let window = layout.window(index);
            match content {
                Content::Cloth => {
                    card::lay_cloth(&mut canvas, window, &self.shaded(&camera, window, panel, panel.grid.solid()));
                    if outlined.is_some_and(|reference| reference != index) {
                        card::draw_outlines(&mut canvas, window, &outlines);
                    }
                    card::draw_pins(&mut canvas, window, &camera, &panel.grid);
                }
                Content::NotFinite => card::draw_alarm(&mut canvas, window, "NOT FINITE", "the simulation blew up"),
                Content::OffScale => card::draw_alarm(&mut canvas, window, "OFF THE SCALE", "finite, but far away"),
            }
        }
        legend::draw(&mut canvas, layout.legend, &self.style, &keys);
        for (i, line) in layout.footer_lines.iter().enumerate() {
            let y = layout.footer_top + i as i32 * FOOTER_LINE;
            let area = Area { x: MARGIN, y, width: layout.width - 2 * MARGIN, height: Face::Small.height() };
            write(&mut canvas, area, line, Face::Small, Align::Left, SOFT_INK);
        }
        canvas.into_image()
    }

    /// Draws the sheet and writes it as PNG, whole or not at all.
    ///
    /// # Errors
    /// Those of [`render`](Self::render) and [`save_png`].
    pub fn save(&self, path: &Path) -> Result<(), PictureError> {
        save_png(&self.render()?, path)
    }

    /// A panel's cloth, drawn through a window of this size, and what it lies on.
    fn shaded(&self, camera: &Camera, window: Area, panel: &Panel, solid: Option<Solid>) -> Raster {
        let mut raster = Raster::new(window.width as usize, window.height as usize);
        if let Some(solid) = solid {
            solid::draw(&mut raster, camera, &solid);
        }
        cloth::draw(&mut raster, camera, &panel.grid, panel.style.as_ref().unwrap_or(&self.style));
        raster
    }

    fn draw_header(&self, canvas: &mut Canvas, layout: &Layout) {
        let width = layout.width - 2 * MARGIN;
        // A long title is set smaller before it is cut.
        let face = [Face::Title, Face::Heading]
            .into_iter()
            .find(|face| face.width(&self.title) <= width)
            .unwrap_or(Face::Heading);
        let y = MARGIN + (Face::Title.height() - face.height()) / 2;
        let area = Area { x: MARGIN, y, width, height: face.height() };
        write(canvas, area, &self.title, face, Align::Left, INK);
        if let Some(subtitle) = &self.subtitle {
            let area = Area { x: MARGIN, y: MARGIN + Face::Title.height() + 4, width, height: Face::Body.height() };
            write(canvas, area, subtitle, Face::Body, Align::Left, SOFT_INK);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::card::ALARM;
    use super::super::layout::PADDING;
    use super::*;

    /// A square metre, `stretch` times too long, with a few folds.
    fn hanging(stretch: f32) -> Grid {
        let positions: Vec<[f32; 3]> = (0..144)
            .map(|i| {
                let (row, column) = ((i / 12) as f32 / 11.0, (i % 12) as f32 / 11.0);
                [column, -row * stretch, 0.05 * (column * 12.0).sin() * row]
            })
            .collect();
        Grid::new(&positions, 12, 12, 1.0, 1.0).and_then(|grid| grid.with_pins(&[0, 11])).expect("a grid")
    }

    fn sheet(panels: usize) -> Sheet {
        (0..panels).fold(Sheet::new("denim").subtitle("hang2"), |sheet, i| {
            let stretch = 1.0 + 0.05 * i as f32;
            sheet.panel(Panel::new(format!("panel {i}"), hanging(stretch)).line("max 5.5 %  p99 1.2 %"))
        })
    }

    fn hash(image: &RgbImage) -> u64 {
        image
            .as_raw()
            .iter()
            .fold(0xcbf2_9ce4_8422_2325, |hash, &byte| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3))
    }

    fn part(image: &RgbImage, area: Area) -> Vec<u8> {
        image::imageops::crop_imm(image, area.x as u32, area.y as u32, area.width as u32, area.height as u32)
            .to_image()
            .into_raw()
    }

    fn layout_of(sheet: &Sheet) -> Layout {
        let view = View::new(YAW, PITCH);
        let frame = shared_frame(&sheet.panels, &contents(&sheet.panels, &view), &view);
        Layout::new(sheet, &frame, &Keys { outline_of: None, pins: true, pixels_per_metre: Some(1.0) })
    }

    #[test]
    fn the_same_sheet_has_the_same_pixels_and_another_has_others() {
        let draw = |panels: usize| hash(&sheet(panels).outline_of(0).render().expect("drawn"));
        assert_eq!(draw(3), draw(3));
        let other = sheet(3).style(Style { fabric: [120, 120, 120], ..Style::default() }).outline_of(0);
        assert_ne!(draw(3), hash(&other.render().expect("drawn")));
    }

    #[test]
    fn one_to_twelve_panels_and_no_more() {
        for panels in 1..=MAX_PANELS {
            let sheet = sheet(panels).footer("a footer of several words ".repeat(20));
            let layout = layout_of(&sheet);
            if [1, 3, MAX_PANELS].contains(&panels) {
                let image = sheet.render().expect("drawn");
                assert_eq!((image.width() as i32, image.height() as i32), (layout.width, layout.height));
            }
            for i in 0..panels {
                let card = layout.card(i);
                assert!(card.x >= MARGIN && card.x + card.width <= layout.width - MARGIN);
                let legend = layout.legend;
                assert!(
                    legend.x >= card.x + card.width || legend.y >= card.y + card.height,
                    "{panels}: legend over {i}"
                );
            }
            assert!(layout.legend.y + layout.legend.height <= layout.footer_top);
        }
        assert!(matches!(Sheet::new("none").render(), Err(PictureError::Empty)));
        assert!(matches!(sheet(13).render(), Err(PictureError::TooManyPanels { panels: 13 })));
    }

    #[test]
    fn a_cloth_that_blew_up_says_so_and_leaves_the_others_alone() {
        let plain = sheet(1).panel(Panel::new("b", hanging(1.0)));
        let mut nan = hanging(1.0).positions().to_vec();
        nan[70][1] = f32::NAN;
        let far: Vec<[f32; 3]> = hanging(1.0).positions().iter().map(|p| p.map(|v| v * 1e30)).collect();
        let layout = layout_of(&plain);
        let (first, second) = (layout.card(0), layout.window(1));
        let base = plain.render().expect("drawn");
        let mut seen = vec![part(&base, second)];
        let farthest: Vec<[f32; 3]> = (0..144).map(|i| [if i % 2 == 0 { f32::MAX } else { f32::MIN }; 3]).collect();
        let grid = |positions: &[[f32; 3]]| Grid::new(positions, 12, 12, 1.0, 1.0).expect("a grid");
        let image = sheet(1).panel(Panel::new("b", grid(&farthest))).render().expect("drawn");
        assert_eq!(part(&image, first), part(&base, first));
        let alone = Sheet::new("far").panel(Panel::new("far", grid(&farthest))).outline_of(0);
        assert!(alone.render().is_ok());
        for positions in [nan, far] {
            let grid = Grid::new(&positions, 12, 12, 1.0, 1.0).and_then(|grid| grid.with_pins(&[0])).expect("a grid");
            let image = sheet(1).panel(Panel::new("b", grid)).render().expect("drawn");
            assert_eq!(part(&image, first), part(&base, first), "the scale is that of the good cloth");
            let window = part(&image, second);
            let red = window.chunks_exact(3).filter(|pixel| **pixel == ALARM).count();
            assert!(red > 100, "the words are there");
            assert!(!seen.contains(&window), "no cloth, and another message");
            seen.push(window);
        }
        let only_bad = vec![[f32::INFINITY; 3]; 144];
        let grid = Grid::new(&only_bad, 12, 12, 1.0, 1.0).expect("a grid");
        assert!(Sheet::new("bad").panel(Panel::new("bad", grid)).outline_of(0).render().is_ok());
    }

    #[test]
    fn long_text_stays_in_its_card() {
        let long = "a heading that is much longer than its card is wide ".repeat(4);
        let short = sheet(1).panel(Panel::new("b", hanging(1.0)).line("c"));
        let wordy = sheet(1).panel(Panel::new(long.clone(), hanging(1.0)).line(long));
        let layout = layout_of(&short);
        let (a, b) = (short.render().expect("drawn"), wordy.render().expect("drawn"));
        let card = layout.card(1);
        for (x, y, pixel) in a.enumerate_pixels() {
            let (x, y) = (x as i32, y as i32);
            let text = (card.x + PADDING..card.x + card.width - PADDING).contains(&x)
                && (card.y..card.y + layout.card_text).contains(&y);
            assert!(text || pixel == b.get_pixel(x as u32, y as u32), "{x} {y}");
        }
    }

    #[test]
    fn saving_names_the_folder_that_is_not_there() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("sheet.png");
        sheet(2).save(&path).expect("written");
        assert_eq!(image::open(&path).expect("a PNG").to_rgb8(), sheet(2).render().expect("drawn"));
        let error = sheet(2).save(&folder.path().join("nowhere").join("sheet.png")).expect_err("refused");
        assert!(error.to_string().contains("nowhere"), "{error}");
    }
}
