//! Straight views of one camera image, each beside its depth, with what LiDAR and radar saw projected into both.

use crate::canvas::Canvas;
use crate::colormap::{nearness, viridis};
use crate::depth_bar::{self, DepthBar};
use crate::error::{PlotError, check_width};
use crate::legend::{Entry, Legend, Symbol};
use crate::marks::{self, MarkLabel};
use crate::page::Page;
use crate::palette::{FAINT_TEXT, FRAME, GRID, Ink};
use crate::scale::count;
use crate::text::{Align, Style, Typeface};

/// What to draw of one camera image.
#[derive(Debug, Clone, Copy)]
pub struct CameraPicture<'a> {
    /// Above the picture, in large letters; may be empty.
    pub title: &'a str,
    /// Below the title; may be empty.
    pub subtitle: &'a str,
    /// Width of the picture, pixels, 400 to 10,000; its height follows from the views.
    pub width: u32,
    /// One below the other.
    pub views: &'a [ViewPicture],
}

/// A straight view with its depth and what lies in it. Rows run from the top, pixels' centres lie on whole numbers.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ViewPicture {
    /// Width and height, px.
    pub size: [u32; 2],
    /// Red, green, blue of each pixel; black where there are too few.
    pub rgb: Vec<[u8; 3]>,
    /// Depth of each pixel, m, NaN where there is none; empty where the view has no depth at all.
    pub depth: Vec<f32>,
    /// What is known of the depth, a sentence.
    pub verdict: String,
    /// LiDAR points that the camera sees.
    pub lidar: Vec<PixelDepth>,
    /// Radar detections.
    pub marks: Vec<(PixelDepth, MarkLabel)>,
}

/// Where something appears in a view, and how far away.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PixelDepth {
    /// Column and row, sub-pixel.
    pub pixel: [f64; 2],
    /// Along the view's optical axis, m, above 0.
    pub depth: f64,
}

impl Default for CameraPicture<'_> {
    /// An empty picture, 2400 pixels wide.
    fn default() -> Self {
        Self { title: "", subtitle: "", width: 2400, views: &[] }
    }
}

const WIDTHS: [u32; 2] = [400, 10_000];
/// White between the panels, and above each view for its verdict; in units.
const BETWEEN: f32 = 24.0;
const VERDICT: f32 = 52.0;
/// Where there is no depth.
const NO_DEPTH: Ink = GRID;

/// Draws the views of one image as PNG.
///
/// # Errors
/// A width outside its range, or a picture that can't be made or encoded.
pub fn camera_picture(picture: &CameraPicture<'_>) -> Result<Vec<u8>, PlotError> {
    draw(picture)?.encode()
}

fn draw(picture: &CameraPicture<'_>) -> Result<Canvas, PlotError> {
    check_width(picture.width, WIDTHS[0], WIDTHS[1])?;
    let typeface = Typeface::load()?;
    let width = picture.width as f32;
    let unit = width / 2400.0;
    let page = Page { width, margin: 48.0 * unit, unit };
    let room = width - 2.0 * page.margin - 2.0 * BETWEEN * unit - depth_bar::WIDTH * unit;
    let panel = (room / 2.0).floor();
    let legend = Legend::lay_out(entries(picture), &typeface, width - 2.0 * page.margin, unit);

    let top = page.header(picture.title, picture.subtitle).round();
    let heights = picture.views.iter().map(|view| ((VERDICT * unit) + height(view, panel)).round());
    let bottom = top + heights.clone().sum::<f32>();
    let size = [picture.width, (bottom + page.footer(&legend)).round() as u32];
    let mut canvas = Canvas::new(size)?;
    page.titles(&mut canvas, &typeface, picture.title, picture.subtitle);
    let mut pen = top;
    for (view, height) in picture.views.iter().zip(heights) {
        let block = Block { view, width: panel, unit, typeface: &typeface };
        block.draw(&mut canvas, [page.margin, pen])?;
        pen += height;
    }
    legend.draw(&mut canvas, &typeface, [page.margin, bottom + 16.0 * unit]);
    Ok(canvas)
}

/// Height of a view that is `width` pixels wide; of a very tall one no more than twice that.
fn height(view: &ViewPicture, width: f32) -> f32 {
    let [columns, rows] = view.size.map(|pixels| pixels.max(1) as f32);
    (width * rows / columns).min(2.0 * width).round()
}

/// A view beside its depth.
struct Block<'a> {
    view: &'a ViewPicture,
    /// Of a panel, pixels.
    width: f32,
    unit: f32,
    typeface: &'a Typeface,
}

impl Block<'_> {
    fn draw(&self, canvas: &mut Canvas, [left, top]: [f32; 2]) -> Result<(), PlotError> {
        let (unit, height) = (self.unit, height(self.view, self.width));
        let style = Style { size: 28.0 * unit, bold: false, ink: FAINT_TEXT };
        let right = (left + self.width + BETWEEN * unit).round();
        let verdict = self.typeface.fitted(&self.view.verdict, style, self.width);
        self.typeface.write(canvas, [right, top + 30.0 * unit], Align::Left, &verdict, style);
        let top = (top + VERDICT * unit).round();
        let size = [self.width, height];

        let photograph = self.panel(self.view.rgb.iter().copied(), &[])?;
        canvas.paste(&photograph, [left.round() as i32, top as i32]);
        let depth = self.view.depth.iter().map(|depth| depth_colour(f64::from(*depth)));
        let mut depth = self.panel(depth, &self.view.lidar)?;
        if self.view.depth.is_empty() {
            let at = [self.width / 2.0, 48.0 * unit];
            self.typeface.write(&mut depth, at, Align::Middle, "no depth of this view", style);
        }
        canvas.paste(&depth, [right as i32, top as i32]);
        canvas.rectangle_line([left.round(), top], size, 1.5 * unit, FRAME);
        canvas.rectangle_line([right, top], size, 1.5 * unit, FRAME);
        let bar = DepthBar { left: right + self.width + BETWEEN * unit, top, height, unit };
        bar.draw(canvas, self.typeface);
        Ok(())
    }

    /// Pixels, LiDAR points and detections; the latter two are cut at the edges.
    fn panel(&self, rgb: impl Iterator<Item = [u8; 3]>, lidar: &[PixelDepth]) -> Result<Canvas, PlotError> {
        let mut canvas = Canvas::new([self.width as u32, height(self.view, self.width) as u32])?;
        let scale = self.scale();
        let all = self.view.size.map(|pixels| pixels.max(1));
        let pixels = (all[0] as usize).saturating_mul(all[1] as usize);
        let rgb = rgb.chain(std::iter::repeat(NO_DEPTH.rgb)).take(pixels);
        canvas.photograph([0.0; 2], all, rgb, scale)?;
        for point in far_to_near(lidar, |point| point.depth) {
            let ink = Ink { rgb: viridis(nearness(point.depth)), alpha: 255 };
            let at = self.place(point.pixel);
            canvas.disc(at, 3.4 * self.unit, FAINT_TEXT.with_alpha(150));
            canvas.disc(at, 2.6 * self.unit, ink);
        }
        for (point, label) in far_to_near(&self.view.marks, |(point, _)| point.depth) {
            marks::draw(&mut canvas, self.place(point.pixel), radius(point.depth) * self.unit, *label);
        }
        Ok(canvas)
    }

    /// Pixels of the picture per pixel of the view.
    fn scale(&self) -> f32 {
        self.width / self.view.size[0].max(1) as f32
    }

    fn place(&self, pixel: [f64; 2]) -> [f32; 2] {
        pixel.map(|value| (value as f32 + 0.5) * self.scale())
    }
}

/// So that the near lies on top of the far.
fn far_to_near<T>(all: &[T], depth: impl Fn(&T) -> f64) -> Vec<&T> {
    let mut sorted: Vec<&T> = all.iter().collect();
    sorted.sort_by(|a, b| depth(b).total_cmp(&depth(a)));
    sorted
}

/// Of a detection, in units: a little larger where it is near.
fn radius(depth: f64) -> f32 {
    (11.0 * (20.0 / depth).powf(0.3)).clamp(7.0, 16.0) as f32
}

fn depth_colour(depth: f64) -> [u8; 3] {
    if depth > 0.0 { viridis(nearness(depth)) } else { NO_DEPTH.rgb }
}

fn entries(picture: &CameraPicture<'_>) -> Vec<Entry> {
    let labels = picture.views.iter().flat_map(|view| view.marks.iter().map(|(_, label)| *label));
    let of = |wanted: MarkLabel| count(labels.clone().filter(|label| *label == wanted).count());
    let points: usize = picture.views.iter().map(|view| view.lidar.len()).sum();
    let lidar = Ink { rgb: viridis(nearness(15.0)), alpha: 255 };
    vec![
        Entry::new(Symbol::Mark(MarkLabel::Plausible), format!("Plausible {}", of(MarkLabel::Plausible))),
        Entry::new(Symbol::Mark(MarkLabel::Artifact), format!("Artifact {}", of(MarkLabel::Artifact))),
        Entry::new(Symbol::Dots(lidar), format!("LiDAR {}, coloured by its own depth", count(points))),
        Entry::new(Symbol::Line(NO_DEPTH), "No depth"),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::palette::{ARTIFACT, PLAUSIBLE};

    const AT: PixelDepth = PixelDepth { pixel: [30.0, 20.0], depth: 20.0 };

    fn view() -> ViewPicture {
        ViewPicture {
            size: [100, 50],
            rgb: vec![[10, 20, 30]; 5000],
            depth: vec![80.0; 5000],
            marks: vec![
                (AT, MarkLabel::Plausible),
                (PixelDepth { pixel: [70.0, 20.0], ..AT }, MarkLabel::Artifact),
            ],
            lidar: vec![PixelDepth { pixel: [50.0, 40.0], depth: 2.0 }],
            ..ViewPicture::default()
        }
    }

    /// The left upper corners of both panels of the first view, and pixels of the picture per pixel of the view.
    const CORNERS: [[u32; 2]; 2] = [[48, 100], [1142, 100]];
    const SCALE: f64 = 10.7;

    fn drawn(view: ViewPicture) -> Canvas {
        draw(&CameraPicture { views: &[view], ..CameraPicture::default() }).unwrap()
    }

    fn place(corner: [u32; 2], [column, row]: [f64; 2]) -> [u32; 2] {
        [corner[0] + ((column + 0.5) * SCALE) as u32, corner[1] + ((row + 0.5) * SCALE) as u32]
    }

    #[test]
    fn what_is_seen_lies_at_its_pixel_in_both_panels() {
        let canvas = drawn(view());
        for (corner, background) in CORNERS.into_iter().zip([[10, 20, 30], viridis(0.0)]) {
            assert_eq!(canvas.rgb(place(corner, AT.pixel)), PLAUSIBLE.rgb);
            assert_eq!(canvas.rgb(place(corner, [70.0, 20.0])), ARTIFACT.rgb);
            assert_eq!(canvas.rgb(place(corner, [10.0, 10.0])), background);
        }
        assert_eq!(canvas.rgb(place(CORNERS[1], [50.0, 40.0])), viridis(1.0), "LiDAR, on its own depth");
        assert_eq!(canvas.rgb(place(CORNERS[0], [50.0, 40.0])), [10, 20, 30], "not in the photograph");
    }

    #[test]
    fn a_view_without_depth_is_empty_and_says_so() {
        let canvas = drawn(ViewPicture { depth: vec![], lidar: vec![], ..view() });
        assert_eq!(canvas.rgb(place(CORNERS[1], [10.0, 30.0])), NO_DEPTH.rgb);
        assert_eq!(canvas.rgb(place(CORNERS[1], AT.pixel)), PLAUSIBLE.rgb);
        let inked = |column| (100..160).any(|row| canvas.rgb([column, row]) != NO_DEPTH.rgb);
        assert!((1600..1850).any(inked), "the words");
    }

    #[test]
    fn views_are_stacked_and_odd_ones_drawn() {
        let [one, two] = [1, 2].map(|count| {
            let views = vec![view(); count];
            draw(&CameraPicture { views: &views, ..CameraPicture::default() }).unwrap().size()
        });
        assert_eq!((one[0], two[0], two[1] - one[1]), (2400, 2400, 535 + 52));
        let nowhere = PixelDepth { pixel: [f64::NAN, 1e9], depth: f64::NAN };
        drawn(ViewPicture { lidar: vec![nowhere], marks: vec![(nowhere, MarkLabel::Artifact)], ..view() });
        drawn(ViewPicture { rgb: vec![], depth: vec![f32::NAN; 7], ..view() });
        drawn(ViewPicture::default());
        let narrow = CameraPicture { width: 20, ..CameraPicture::default() };
        assert!(matches!(camera_picture(&narrow), Err(PlotError::Width { found: 20, .. })));
    }
}
