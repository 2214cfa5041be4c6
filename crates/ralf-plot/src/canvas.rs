//! A picture in the making, and the shapes that figures are made of. All lengths are pixels.

use tiny_skia::{
    FillRule, FilterQuality, LineCap, LineJoin, Paint, Path, PathBuilder, Pixmap, PixmapPaint, Rect, Stroke,
    StrokeDash, Transform,
};

use crate::error::PlotError;
use crate::palette::{Ink, PAPER};

/// A picture in the making. Shapes without any area, or not finite, leave no trace.
pub(crate) struct Canvas {
    pixmap: Pixmap,
}

impl Canvas {
    /// White paper.
    pub(crate) fn new([width, height]: [u32; 2]) -> Result<Self, PlotError> {
        let mut pixmap = Pixmap::new(width, height).ok_or(PlotError::Size { width, height })?;
        pixmap.fill(colour(PAPER));
        Ok(Self { pixmap })
    }

    /// Width and height.
    pub(crate) fn size(&self) -> [u32; 2] {
        [self.pixmap.width(), self.pixmap.height()]
    }

    /// The picture as PNG.
    pub(crate) fn encode(&self) -> Result<Vec<u8>, PlotError> {
        self.pixmap.encode_png().map_err(|error| PlotError::Encode(error.to_string()))
    }

    /// Lays another picture onto this one, its upper left corner at `corner`.
    pub(crate) fn paste(&mut self, other: &Self, [left, top]: [i32; 2]) {
        let paint = PixmapPaint::default();
        self.pixmap.draw_pixmap(left, top, other.pixmap.as_ref(), &paint, Transform::identity(), None);
    }

    /// A picture of `rgb` pixels, row by row, `scale` times as large; what lies outside this one is cut.
    pub(crate) fn photograph(
        &mut self,
        [left, top]: [f32; 2],
        [width, height]: [u32; 2],
        rgb: impl Iterator<Item = [u8; 3]>,
        scale: f32,
    ) -> Result<(), PlotError> {
        let mut image = Pixmap::new(width, height).ok_or(PlotError::Size { width, height })?;
        for (pixel, [red, green, blue]) in image.data_mut().as_chunks_mut::<4>().0.iter_mut().zip(rgb) {
            *pixel = [red, green, blue, 255];
        }
        let paint = PixmapPaint { quality: FilterQuality::Bilinear, ..PixmapPaint::default() };
        let place = Transform::from_row(scale, 0.0, 0.0, scale, left, top);
        self.pixmap.draw_pixmap(0, 0, image.as_ref(), &paint, place, None);
        Ok(())
    }

    /// Covers part (0..1) of one pixel with ink; pixels outside the picture are left alone.
    pub(crate) fn blend(&mut self, [column, row]: [i64; 2], ink: Ink, coverage: f32) {
        let [width, height] = self.size().map(i64::from);
        if column < 0 || row < 0 || column >= width || row >= height {
            return;
        }
        let opacity = coverage.clamp(0.0, 1.0) * f32::from(ink.alpha) / 255.0;
        let first = 4 * (row * width + column) as usize;
        // Paper is opaque, so that premultiplied colours are the colours themselves.
        for (below, above) in self.pixmap.data_mut()[first..first + 3].iter_mut().zip(ink.rgb) {
            *below = (f32::from(*below) + (f32::from(above) - f32::from(*below)) * opacity).round() as u8;
        }
    }

    /// A filled circle.
    pub(crate) fn disc(&mut self, [x, y]: [f32; 2], radius: f32, ink: Ink) {
        self.fill(PathBuilder::from_circle(x, y, radius), ink);
    }

    /// A circle's line.
    pub(crate) fn circle(&mut self, [x, y]: [f32; 2], radius: f32, width: f32, ink: Ink) {
        self.stroke(PathBuilder::from_circle(x, y, radius), width, ink);
    }

    /// A circle's line in dashes, as long as the gaps between them.
    pub(crate) fn dashed_circle(&mut self, [x, y]: [f32; 2], radius: f32, width: f32, dash: f32, ink: Ink) {
        let stroke = Stroke { width, dash: StrokeDash::new(vec![dash, dash], 0.0), ..Stroke::default() };
        if let Some(path) = PathBuilder::from_circle(x, y, radius) {
            self.pixmap.stroke_path(&path, &paint(ink), &stroke, Transform::identity(), None);
        }
    }

    /// A saltire, its arms `radius` long along each axis.
    pub(crate) fn cross(&mut self, [x, y]: [f32; 2], radius: f32, width: f32, ink: Ink) {
        let mut path = PathBuilder::new();
        for slope in [-radius, radius] {
            path.move_to(x - radius, y - slope);
            path.line_to(x + radius, y + slope);
        }
        self.stroke(path.finish(), width, ink);
    }

    /// A line through all points.
    pub(crate) fn line(&mut self, points: &[[f32; 2]], width: f32, ink: Ink) {
        self.stroke(through(points, false), width, ink);
    }

    /// A filled polygon.
    pub(crate) fn polygon(&mut self, corners: &[[f32; 2]], ink: Ink) {
        self.fill(through(corners, true), ink);
    }

    /// A polygon's line.
    pub(crate) fn polygon_line(&mut self, corners: &[[f32; 2]], width: f32, ink: Ink) {
        self.stroke(through(corners, true), width, ink);
    }

    /// A filled closed curve that is drawn towards each corner in turn and meets the polygon halfway between two.
    pub(crate) fn curve(&mut self, corners: &[[f32; 2]], ink: Ink) {
        self.fill(rounded(corners), ink);
    }

    /// The line of a closed curve.
    pub(crate) fn curve_line(&mut self, corners: &[[f32; 2]], width: f32, ink: Ink) {
        self.stroke(rounded(corners), width, ink);
    }

    /// A filled rectangle from its upper left corner.
    pub(crate) fn rectangle(&mut self, [left, top]: [f32; 2], [width, height]: [f32; 2], ink: Ink) {
        self.fill(Rect::from_xywh(left, top, width, height).map(PathBuilder::from_rect), ink);
    }

    /// A rectangle's line.
    pub(crate) fn rectangle_line(
        &mut self,
        [left, top]: [f32; 2],
        [width, height]: [f32; 2],
        line: f32,
        ink: Ink,
    ) {
        self.stroke(Rect::from_xywh(left, top, width, height).map(PathBuilder::from_rect), line, ink);
    }

    fn fill(&mut self, path: Option<Path>, ink: Ink) {
        if let Some(path) = path {
            self.pixmap.fill_path(&path, &paint(ink), FillRule::Winding, Transform::identity(), None);
        }
    }

    fn stroke(&mut self, path: Option<Path>, width: f32, ink: Ink) {
        if let Some(path) = path {
            let stroke =
                Stroke { width, line_cap: LineCap::Round, line_join: LineJoin::Round, ..Stroke::default() };
            self.pixmap.stroke_path(&path, &paint(ink), &stroke, Transform::identity(), None);
        }
    }
}

fn through(points: &[[f32; 2]], closed: bool) -> Option<Path> {
    let mut path = PathBuilder::new();
    let (first, rest) = points.split_first()?;
    path.move_to(first[0], first[1]);
    for point in rest {
        path.line_to(point[0], point[1]);
    }
    if closed {
        path.close();
    }
    path.finish()
}

fn rounded(corners: &[[f32; 2]]) -> Option<Path> {
    let halfway = |a: [f32; 2], b: [f32; 2]| [(a[0] + b[0]) / 2.0, (a[1] + b[1]) / 2.0];
    let start = halfway(*corners.last()?, *corners.first()?);
    let mut path = PathBuilder::new();
    path.move_to(start[0], start[1]);
    for (corner, next) in corners.iter().zip(corners.iter().cycle().skip(1)) {
        let end = halfway(*corner, *next);
        path.quad_to(corner[0], corner[1], end[0], end[1]);
    }
    path.close();
    path.finish()
}

fn paint(ink: Ink) -> Paint<'static> {
    let mut paint = Paint::default();
    paint.set_color(colour(ink));
    paint
}

fn colour(ink: Ink) -> tiny_skia::Color {
    let [red, green, blue] = ink.rgb;
    tiny_skia::Color::from_rgba8(red, green, blue, ink.alpha)
}

#[cfg(test)]
impl Canvas {
    /// Red, green, blue of a pixel.
    pub(crate) fn rgb(&self, [column, row]: [u32; 2]) -> [u8; 3] {
        let pixel = self.pixmap.pixel(column, row).unwrap();
        [pixel.red(), pixel.green(), pixel.blue()]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::palette::PLAUSIBLE;

    #[test]
    fn shapes_land_where_they_are_put() {
        let mut canvas = Canvas::new([40, 20]).unwrap();
        canvas.disc([10.0, 5.0], 3.0, PLAUSIBLE);
        canvas.blend([30, 15], PLAUSIBLE, 0.5);
        canvas.blend([40, 15], PLAUSIBLE, 1.0);
        canvas.blend([-1, 3], PLAUSIBLE, 1.0);
        assert_eq!(canvas.rgb([10, 5]), PLAUSIBLE.rgb);
        assert_eq!(canvas.rgb([10, 15]), PAPER.rgb);
        assert_eq!(canvas.rgb([30, 15]), [128, 185, 217]);
        assert_eq!([canvas.rgb([0, 16]), canvas.rgb([39, 2])], [PAPER.rgb; 2]);
    }

    #[test]
    fn shapes_without_area_leave_no_trace() {
        let mut canvas = Canvas::new([8, 8]).unwrap();
        canvas.disc([f32::NAN, 5.0], 3.0, PLAUSIBLE);
        canvas.line(&[], 1.0, PLAUSIBLE);
        canvas.polygon(&[[1.0, 1.0]], PLAUSIBLE);
        assert_eq!(canvas.encode(), Canvas::new([8, 8]).unwrap().encode());
        assert!(Canvas::new([0, 8]).is_err());
    }
}
