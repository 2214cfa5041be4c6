//! Text on a canvas, in Noto Sans (SIL Open Font License 1.1).

use ab_glyph::{Font, FontRef, Glyph, PxScale, ScaleFont};

use crate::canvas::Canvas;
use crate::error::PlotError;
use crate::palette::Ink;

/// The two weights of the typeface.
pub(crate) struct Typeface {
    regular: FontRef<'static>,
    bold: FontRef<'static>,
}

/// How text looks.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Style {
    /// Height of the em square, pixels.
    pub(crate) size: f32,
    /// Heavy strokes.
    pub(crate) bold: bool,
    /// Its colour.
    pub(crate) ink: Ink,
}

/// Which part of the text lies at its given place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Align {
    Left,
    Middle,
    Right,
}

impl Typeface {
    /// The built-in typeface.
    pub(crate) fn load() -> Result<Self, PlotError> {
        let load =
            |bytes| FontRef::try_from_slice(bytes).map_err(|error| PlotError::Typeface(error.to_string()));
        Ok(Self { regular: load(notosans::REGULAR_TTF)?, bold: load(notosans::BOLD_TTF)? })
    }

    /// Whether it has every character of a text.
    #[cfg(test)]
    pub(crate) fn has(&self, text: &str) -> bool {
        text.chars().all(|character| self.regular.glyph_id(character).0 != 0)
    }

    fn of(&self, style: Style) -> &FontRef<'static> {
        if style.bold { &self.bold } else { &self.regular }
    }

    /// How wide a text is, pixels.
    pub(crate) fn width(&self, text: &str, style: Style) -> f32 {
        self.set(text, style).1
    }

    /// Glyphs on a baseline that starts at (0, 0), and their width.
    fn set(&self, text: &str, style: Style) -> (Vec<Glyph>, f32) {
        let font = self.of(style);
        let scale = font.pt_to_px_scale(style.size * POINTS_PER_PIXEL).unwrap_or(PxScale::from(style.size));
        let scaled = font.as_scaled(scale);
        let (mut pen, mut glyphs) = (0.0, Vec::new());
        for character in text.chars().filter(|character| !character.is_control()) {
            let mut glyph = scaled.scaled_glyph(character);
            pen += glyphs.last().map_or(0.0, |last: &Glyph| scaled.kern(last.id, glyph.id));
            glyph.position.x = pen;
            pen += scaled.h_advance(glyph.id);
            glyphs.push(glyph);
        }
        (glyphs, pen)
    }

    /// The text itself where it fits into `room` pixels, else as much of its beginning as fits, and an ellipsis.
    pub(crate) fn fitted(&self, text: &str, style: Style, room: f32) -> String {
        if self.width(text, style) <= room {
            return text.to_owned();
        }
        let ends = text.char_indices().map(|(end, _)| end).rev();
        let mut shortened = ends.map(|end| format!("{}\u{2026}", text[..end].trim_end()));
        shortened.find(|candidate| self.width(candidate, style) <= room).unwrap_or_default()
    }

    /// Writes one line. `at` is on the baseline, at the side or middle that `align` says.
    pub(crate) fn write(&self, canvas: &mut Canvas, at: [f32; 2], align: Align, text: &str, style: Style) {
        let (glyphs, width) = self.set(text, style);
        let left = match align {
            Align::Left => at[0],
            Align::Middle => at[0] - width / 2.0,
            Align::Right => at[0] - width,
        };
        // A baseline between two rows would blur every letter.
        let (left, baseline) = (left.round(), at[1].round());
        let font = self.of(style);
        for glyph in glyphs {
            if let Some(outline) = font.outline_glyph(glyph) {
                let corner = outline.px_bounds().min;
                let first = [corner.x + left, corner.y + baseline].map(|edge| edge as i64);
                outline.draw(|column, row, coverage| {
                    let pixel = [first[0] + i64::from(column), first[1] + i64::from(row)];
                    canvas.blend(pixel, style.ink, coverage);
                });
            }
        }
    }
}

/// Of a screen with 96 pixels to the inch, as the typeface library counts.
const POINTS_PER_PIXEL: f32 = 72.0 / 96.0;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::palette::TITLE;

    const STYLE: Style = Style { size: 20.0, bold: false, ink: TITLE };

    #[test]
    fn the_em_square_has_the_size_asked_for() {
        let typeface = Typeface::load().unwrap();
        // Noto Sans: a digit is 572 of 1000 units wide.
        assert!((typeface.width("00", STYLE) - 2.0 * 0.572 * 20.0).abs() < 0.1);
        assert_eq!(typeface.width("", STYLE), 0.0);
    }

    #[test]
    fn long_text_is_cut_to_its_room() {
        let typeface = Typeface::load().unwrap();
        let text = "a sequence with a very long name \u{00e9}\u{00e9}\u{00e9}";
        assert_eq!(typeface.fitted(text, STYLE, 1000.0), text);
        let cut = typeface.fitted(text, STYLE, 120.0);
        assert!(cut.starts_with("a seq") && cut.ends_with('\u{2026}'), "{cut}");
        assert!(typeface.width(&cut, STYLE) <= 120.0);
        assert_eq!(typeface.fitted(text, STYLE, 1.0), "");
    }

    #[test]
    fn text_lies_on_its_baseline_and_on_its_side() {
        let typeface = Typeface::load().unwrap();
        let inked = |align| {
            let mut canvas = Canvas::new([100, 40]).unwrap();
            typeface.write(&mut canvas, [50.0, 30.0], align, "H", STYLE);
            let dark = |column, row| canvas.rgb([column, row])[0] < 128;
            let rows: Vec<u32> = (0..40).filter(|row| (0..100).any(|column| dark(column, *row))).collect();
            let columns: Vec<u32> = (0..100).filter(|column| (0..40).any(|row| dark(*column, row))).collect();
            (rows, columns)
        };
        let (rows, columns) = inked(Align::Left);
        assert_eq!(rows.last(), Some(&29));
        assert!(columns[0] >= 50);
        assert!(inked(Align::Right).1.iter().all(|column| *column < 50));
    }
}
