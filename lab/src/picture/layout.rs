//! Where everything stands on a sheet.

use super::camera::Frame;
use super::canvas::Area;
use super::legend::Keys;
use super::sheet::Sheet;
use super::text::Face;

/// Free border of the sheet, pixels.
pub const MARGIN: i32 = 28;
/// Free space between cards, pixels.
const GAP: i32 = 16;
/// Free space between a card's border and its text.
pub const PADDING: i32 = 14;
/// Bounds on the height of a panel's window, as a share of its width.
const WINDOW_ASPECT: (f32, f32) = (0.6, 1.45);
/// Most lines below a panel's heading, and at the bottom of the sheet; what comes after them is left out.
pub const MAX_LINES: usize = 6;
const MAX_FOOTER_LINES: usize = 12;
/// Distance between the lines of the footer.
pub const FOOTER_LINE: i32 = 22;

/// Where everything stands; all in pixels.
pub struct Layout {
    /// Width of the sheet.
    pub width: i32,
    /// Height of the sheet.
    pub height: i32,
    /// Columns of cards.
    pub columns: usize,
    /// Width and height of a card.
    pub card: (i32, i32),
    /// Height of the part of a card that holds its text.
    pub card_text: i32,
    /// Top of the first row of cards.
    pub cards_top: i32,
    /// Box of the legend.
    pub legend: Area,
    /// Top of the footer.
    pub footer_top: i32,
    /// The footer, broken into lines.
    pub footer_lines: Vec<String>,
}

impl Layout {
    /// Lays a sheet out; `frame` gives the windows their shape, `keys` the legend its height.
    pub fn new(sheet: &Sheet, frame: &Frame, keys: &Keys) -> Self {
        let count = sheet.panels.len();
        let columns = match count {
            1..=4 => count,
            5 | 6 => 3,
            7 | 8 => 4,
            9 | 10 => 5,
            _ => 4,
        };
        let rows = count.div_ceil(columns);
        // Few panels are drawn larger.
        let card_width = sheet.card_width.unwrap_or(match columns {
            1 => 760,
            2 => 560,
            3 => 420,
            4 => 356,
            _ => 332,
        });
        let size = frame.size();
        let aspect = (size[1] / size[0].max(1e-6)).clamp(WINDOW_ASPECT.0, WINDOW_ASPECT.1);
        let window_height = ((card_width - 2) as f32 * aspect) as i32;
        let most_lines = sheet.panels.iter().map(|panel| panel.lines.len().min(MAX_LINES)).max().unwrap_or(0) as i32;
        let card_text = PADDING + Face::Heading.height() + most_lines * (Face::Body.height() + 3) + PADDING - 4;
        let card = (card_width, card_text + window_height + 1);
        let width = 2 * MARGIN + columns as i32 * card.0 + (columns as i32 - 1) * GAP;
        let header = Face::Title.height() + if sheet.subtitle.is_some() { 4 + Face::Body.height() } else { 0 };
        let cards_top = MARGIN + header + 20;
        let mut bottom = cards_top + rows as i32 * card.1 + (rows as i32 - 1) * GAP;

        // The legend fills the hole that an incomplete last row leaves, else a strip of its own.
        let hole = columns * rows - count;
        let hole_width = hole as i32 * (card.0 + GAP) - GAP;
        let legend = if hole > 0 && keys.height(hole_width - 2 * PADDING) + PADDING <= card.1 {
            let x = MARGIN + (columns - hole) as i32 * (card.0 + GAP);
            let height = keys.height(hole_width - 2 * PADDING);
            let y = bottom - card.1 + PADDING;
            Area { x: x + PADDING, y, width: hole_width - 2 * PADDING, height }
        } else {
            let legend_width = width - 2 * MARGIN;
            let height = keys.height(legend_width);
            let y = bottom + 22;
            bottom = y + height;
            Area { x: MARGIN, y, width: legend_width, height }
        };
        let footer_lines = match &sheet.footer {
            Some(footer) => {
                wrapped(footer, Face::Small, width - 2 * MARGIN).into_iter().take(MAX_FOOTER_LINES).collect()
            }
            None => Vec::new(),
        };
        let footer_top = bottom + 20;
        let footer = if footer_lines.is_empty() { 0 } else { 20 + footer_lines.len() as i32 * FOOTER_LINE };
        Self {
            width,
            height: bottom + footer + MARGIN,
            columns,
            card,
            card_text,
            cards_top,
            legend,
            footer_top,
            footer_lines,
        }
    }

    /// The box of a panel, border included.
    pub fn card(&self, index: usize) -> Area {
        let (row, column) = ((index / self.columns) as i32, (index % self.columns) as i32);
        Area {
            x: MARGIN + column * (self.card.0 + GAP),
            y: self.cards_top + row * (self.card.1 + GAP),
            width: self.card.0,
            height: self.card.1,
        }
    }

    /// The part of a card that shows the cloth, inside the border.
    pub fn window(&self, index: usize) -> Area {
        let card = self.card(index);
        Area {
            x: card.x + 1,
            y: card.y + self.card_text,
            width: card.width - 2,
            height: card.height - self.card_text - 1,
        }
    }
}

/// Breaks text into lines at its spaces; a word wider than a line is cut when it is written.
fn wrapped(text: &str, face: Face, width: i32) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if { face.width(line).saturating_add(face.width(word)) <= width - face.advance() } => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}
