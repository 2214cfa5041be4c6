//! What surrounds the panels of a figure: its titles above, legend and scale bar below.

use crate::canvas::Canvas;
use crate::legend::{Legend, ROW};
use crate::palette::{FAINT_TEXT, TEXT, TITLE};
use crate::scale::{metres, nice_at_most};
use crate::text::{Align, Style, Typeface};
use crate::viewport::Viewport;

/// Lengths of a page, pixels.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Page {
    /// The whole width.
    pub(crate) width: f32,
    /// White at each side.
    pub(crate) margin: f32,
    /// Lengths are this many times those of a picture of the usual size.
    pub(crate) unit: f32,
}

/// Title and subtitle: baseline below the top, in units.
const TITLE_AT: f32 = 78.0;
const SUBTITLE_AT: f32 = 122.0;
/// Part of the panel's width that the scale bar may take.
const BAR: f64 = 0.16;

impl Page {
    /// Height of the titles and the white around them.
    pub(crate) fn header(&self, title: &str, subtitle: &str) -> f32 {
        let lines = match (title.is_empty(), subtitle.is_empty()) {
            (true, true) => return self.margin,
            (_, true) => TITLE_AT,
            (_, false) => SUBTITLE_AT,
        };
        (lines + 34.0) * self.unit
    }

    /// Height of a legend and the white around it.
    pub(crate) fn footer(&self, legend: &Legend) -> f32 {
        legend.height() + 52.0 * self.unit
    }

    /// How much of the width legends may take beside a scale bar.
    pub(crate) fn legend_room(&self, panel_width: f32) -> f32 {
        self.width - 2.0 * self.margin - (BAR as f32) * panel_width - 150.0 * self.unit
    }

    /// Writes the titles; what doesn't fit is cut.
    pub(crate) fn titles(&self, canvas: &mut Canvas, typeface: &Typeface, title: &str, subtitle: &str) {
        let large = Style { size: 42.0 * self.unit, bold: true, ink: TITLE };
        let small = Style { size: 28.0 * self.unit, bold: false, ink: FAINT_TEXT };
        for (text, style, baseline) in [(title, large, TITLE_AT), (subtitle, small, SUBTITLE_AT)] {
            let text = typeface.fitted(text, style, self.width - 2.0 * self.margin);
            typeface.write(canvas, [self.margin, baseline * self.unit], Align::Left, &text, style);
        }
    }

    /// Draws legend and scale bar, from `top` on.
    pub(crate) fn below(
        &self,
        canvas: &mut Canvas,
        typeface: &Typeface,
        legend: &Legend,
        viewport: &Viewport,
        top: f32,
    ) {
        let top = top + 16.0 * self.unit;
        legend.draw(canvas, typeface, [self.margin, top]);
        self.scale_bar(canvas, typeface, viewport, top + ROW / 2.0 * self.unit);
    }

    /// A bar of a round length, its right end at the margin.
    fn scale_bar(&self, canvas: &mut Canvas, typeface: &Typeface, viewport: &Viewport, row: f32) {
        let shown = f64::from(viewport.size()[0]) / viewport.scale();
        let length = nice_at_most(shown * BAR);
        let right = self.width - self.margin;
        let left = right - (length * viewport.scale()) as f32;
        let (line, tip) = (3.5 * self.unit, 9.0 * self.unit);
        canvas.line(&[[left, row], [right, row]], line, TEXT);
        for end in [left, right] {
            canvas.line(&[[end, row - tip], [end, row + tip]], line, TEXT);
        }
        let style = Style { size: 26.0 * self.unit, bold: false, ink: TEXT };
        let at = [left - 16.0 * self.unit, row + 0.36 * style.size];
        typeface.write(canvas, at, Align::Right, &metres(length), style);
    }
}
