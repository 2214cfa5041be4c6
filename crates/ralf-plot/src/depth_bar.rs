//! The colours of depth with their metres, beside a depth picture.

use crate::canvas::Canvas;
use crate::colormap::{nearness, viridis};
use crate::palette::{FRAME, Ink, TEXT};
use crate::scale::metres;
use crate::text::{Align, Style, Typeface};

/// Width of the bar and its numbers, in units.
pub(crate) const WIDTH: f32 = 116.0;
const BAR: f32 = 28.0;
/// Where numbers stand, m.
const NUMBERS: [f64; 6] = [2.0, 5.0, 10.0, 20.0, 40.0, 80.0];

/// Where a bar is drawn, pixels.
pub(crate) struct DepthBar {
    pub(crate) left: f32,
    pub(crate) top: f32,
    pub(crate) height: f32,
    pub(crate) unit: f32,
}

impl DepthBar {
    /// Draws the bar, far at its top.
    pub(crate) fn draw(&self, canvas: &mut Canvas, typeface: &Typeface) {
        let Self { left, top, height, unit } = *self;
        for row in 0..height as u32 {
            let share = f64::from(row) / f64::from(height);
            let ink = Ink { rgb: viridis(share), alpha: 255 };
            canvas.rectangle([left, top + row as f32], [BAR * unit, 1.0], ink);
        }
        canvas.rectangle_line([left, top], [BAR * unit, height], 1.5 * unit, FRAME);
        let style = Style { size: 24.0 * unit, bold: false, ink: TEXT };
        for depth in NUMBERS {
            let row = top + nearness(depth) as f32 * height;
            let end = left + (BAR + 6.0) * unit;
            canvas.line(&[[left + BAR * unit, row], [end, row]], 2.0 * unit, TEXT);
            let baseline = (row + 0.36 * style.size).clamp(top + 0.72 * style.size, top + height);
            typeface.write(canvas, [end + 6.0 * unit, baseline], Align::Left, &metres(depth), style);
        }
    }
}
