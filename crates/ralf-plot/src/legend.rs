//! The legend: symbols with their meaning, in rows below a picture.

use crate::canvas::Canvas;
use crate::marks::{self, MarkLabel};
use crate::palette::{Ink, PAPER, PATH, RADAR, TEXT};
use crate::text::{Align, Style, Typeface};
use crate::vehicle::arrowhead;

/// What stands before an entry's text.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Symbol {
    /// A detection as in a single scan.
    Mark(MarkLabel),
    /// A few dots.
    Dots(Ink),
    /// A line.
    Line(Ink),
    /// A radar's wedge.
    Wedge,
    /// Where a path starts.
    Start,
    /// Where a path ends.
    End,
    /// A remark, without a symbol.
    Nothing,
}

/// A symbol and its meaning.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Entry {
    pub(crate) symbol: Symbol,
    pub(crate) text: String,
}

impl Entry {
    pub(crate) fn new(symbol: Symbol, text: impl Into<String>) -> Self {
        Self { symbol, text: text.into() }
    }
}

/// Entries in rows.
pub(crate) struct Legend {
    rows: Vec<Vec<Entry>>,
    unit: f32,
}

/// Height of a row, in units.
pub(crate) const ROW: f32 = 46.0;
const TEXT_SIZE: f32 = 26.0;
const SYMBOL: f32 = 36.0;
const BETWEEN: f32 = 44.0;

impl Legend {
    /// Breaks the entries into rows of at most `room` pixels; lengths are `unit` times those of the usual size.
    pub(crate) fn lay_out(entries: Vec<Entry>, typeface: &Typeface, room: f32, unit: f32) -> Self {
        let mut legend = Self { rows: Vec::new(), unit };
        let mut used = 0.0;
        for entry in entries {
            let width = legend.entry_width(&entry, typeface);
            match legend.rows.last_mut().filter(|_| used + width <= room) {
                Some(row) => row.push(entry),
                None => {
                    legend.rows.push(vec![entry]);
                    used = 0.0;
                }
            }
            used += width + BETWEEN * unit;
        }
        legend
    }

    /// Its height, pixels.
    pub(crate) fn height(&self) -> f32 {
        self.rows.len().max(1) as f32 * ROW * self.unit
    }

    /// Draws it from its upper left corner.
    pub(crate) fn draw(&self, canvas: &mut Canvas, typeface: &Typeface, [left, top]: [f32; 2]) {
        let unit = self.unit;
        for (index, row) in self.rows.iter().enumerate() {
            let middle = top + (index as f32 + 0.5) * ROW * unit;
            let mut pen = left;
            for entry in row {
                self.symbol(canvas, [pen + SYMBOL / 2.0 * unit, middle], entry.symbol);
                let at = [pen + self.symbol_width(entry.symbol), middle + 0.36 * TEXT_SIZE * unit];
                typeface.write(canvas, at, Align::Left, &entry.text, self.style());
                pen += self.entry_width(entry, typeface) + BETWEEN * unit;
            }
        }
    }

    fn style(&self) -> Style {
        Style { size: TEXT_SIZE * self.unit, bold: false, ink: TEXT }
    }

    fn symbol_width(&self, symbol: Symbol) -> f32 {
        if symbol == Symbol::Nothing { 0.0 } else { (SYMBOL + 8.0) * self.unit }
    }

    fn entry_width(&self, entry: &Entry, typeface: &Typeface) -> f32 {
        self.symbol_width(entry.symbol) + typeface.width(&entry.text, self.style())
    }

    fn symbol(&self, canvas: &mut Canvas, [x, y]: [f32; 2], symbol: Symbol) {
        let unit = self.unit;
        let half = SYMBOL / 2.0 * unit;
        match symbol {
            Symbol::Mark(label) => marks::draw(canvas, [x, y], 10.0 * unit, label),
            Symbol::Dots(ink) => {
                for (dx, dy) in [(-11.0, 4.0), (-4.0, -6.0), (1.0, 6.0), (8.0, -3.0), (13.0, 5.0)] {
                    canvas.disc([x + dx * unit, y + dy * unit], 3.4 * unit, ink);
                }
            }
            Symbol::Line(ink) => canvas.line(&[[x - half, y], [x + half, y]], 3.0 * unit, ink),
            Symbol::Wedge => {
                let corners =
                    [[x, y + 0.6 * half], [x - 0.7 * half, y - 0.4 * half], [x + 0.7 * half, y - 0.4 * half]];
                canvas.polygon(&corners, RADAR.with_alpha(150));
            }
            Symbol::Start => start(canvas, [x, y], unit),
            Symbol::End => arrowhead(canvas, [x, y], [0.0, -1.0], 24.0 * unit, unit),
            Symbol::Nothing => {}
        }
    }
}

/// Where a path starts: a white disc with a dark line.
pub(crate) fn start(canvas: &mut Canvas, at: [f32; 2], unit: f32) {
    canvas.disc(at, 8.0 * unit, PAPER);
    canvas.circle(at, 8.0 * unit, 3.0 * unit, PATH);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_flow_into_rows_and_none_is_lost() {
        let typeface = Typeface::load().unwrap();
        let entries = vec![Entry::new(Symbol::Start, "Start of the path"); 5];
        let of = |room| Legend::lay_out(entries.clone(), &typeface, room, 1.0);
        let rows = |legend: &Legend| legend.rows.iter().map(Vec::len).collect::<Vec<_>>();
        assert_eq!(rows(&of(10_000.0)), [5]);
        assert_eq!(rows(&of(700.0)), [2, 2, 1]);
        assert_eq!(rows(&of(1.0)), [1; 5]);
        assert_eq!(of(700.0).height(), 3.0 * ROW);
        assert_eq!(Legend::lay_out(Vec::new(), &typeface, 700.0, 1.0).height(), ROW);
    }
}
