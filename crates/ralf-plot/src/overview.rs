//! All scans of a sequence from above, in a fixed frame: raw beside those labelled plausible.

use crate::canvas::Canvas;
use crate::dots::DotField;
use crate::error::{PlotError, check_width};
use crate::extent::{Extent, Tails, Window};
use crate::legend::{Entry, Legend, Symbol};
use crate::marks::{Counts, Mark, MarkLabel, Marks};
use crate::page::Page;
use crate::palette::{FAINT_TEXT, Ink, LIDAR, PATH, PLAUSIBLE, RAW, TITLE};
use crate::panel::Panel;
use crate::scale::{count, multiples, number, share};
use crate::text::{Align, Style, Typeface};

/// What to draw of a sequence. All places are x and y in one fixed frame, m.
#[derive(Clone, Copy)]
pub struct OverviewPicture<'a> {
    /// Above the picture, in large letters; may be empty.
    pub title: &'a str,
    /// Below the title; may be empty.
    pub subtitle: &'a str,
    /// Width of each of the two halves, pixels, 200 to 10,000; the height follows from what is shown.
    pub half_width: u32,
    /// Which part of the ground is shown, in both halves.
    pub extent: Extent,
    /// LiDAR returns, in any order; may be empty.
    pub lidar: &'a [[f64; 2]],
    /// The detections of all scans. They are gone through three times.
    pub marks: &'a dyn Marks,
    /// Where the vehicle drove, in order of time; may be empty.
    pub path: &'a [[f64; 2]],
}

impl Default for OverviewPicture<'_> {
    /// An empty picture, twice 1400 pixels wide.
    fn default() -> Self {
        let extent = Extent::Fit;
        Self { title: "", subtitle: "", half_width: 1400, extent, lidar: &[], marks: &NO_MARKS, path: &[] }
    }
}

const NO_MARKS: [Mark; 0] = [];
const WIDTHS: [u32; 2] = [200, 10_000];
/// Smallest and largest height of a panel, in its widths.
const HEIGHTS: [f64; 2] = [0.4, 1.25];
/// Heights above and below a panel, in units: its heading, the numbers along y, the name of y.
const HEADING: f32 = 52.0;
const NUMBERS: f32 = 40.0;
const AXIS_NAME: f32 = 34.0;

/// Draws a sequence as PNG: on the left all detections, on the right those labelled plausible.
///
/// # Errors
/// A width or radius outside its range, or a picture that can't be made or encoded.
pub fn overview_picture(picture: &OverviewPicture<'_>) -> Result<Vec<u8>, PlotError> {
    draw(picture)?.encode()
}

fn draw(picture: &OverviewPicture<'_>) -> Result<Canvas, PlotError> {
    check_width(picture.half_width, WIDTHS[0], WIDTHS[1])?;
    picture.extent.check()?;
    let typeface = Typeface::load()?;
    let unit = picture.half_width as f32 / 1400.0;
    let page = Page { width: 2.0 * picture.half_width as f32, margin: 56.0 * unit, unit };
    let window = window(picture)?;
    let (numbers, between) = (130.0 * unit, 56.0 * unit);
    let width = ((page.width - 2.0 * page.margin - numbers - between) / 2.0).round();
    let (panels, counts) = panels(picture, &window, width, unit)?;

    let viewport = panels[0].viewport;
    let height = viewport.size()[1] as f32;
    let entries = entries(picture, &counts);
    let legend = Legend::lay_out(entries, &typeface, page.legend_room(width), unit);
    let top = (page.header(picture.title, picture.subtitle) + HEADING * unit).round();
    let bottom = top + height + (NUMBERS + AXIS_NAME) * unit;
    let mut canvas = Canvas::new([2 * picture.half_width, (bottom + page.footer(&legend)).round() as u32])?;
    page.titles(&mut canvas, &typeface, picture.title, picture.subtitle);
    let first = (page.margin + numbers).round();
    let lefts = [first, first + width + between.round()];
    for ((panel, left), heading) in panels.iter().zip(lefts).zip(["All detections", "Labelled plausible"]) {
        canvas.paste(&panel.canvas, [left as i32, top as i32]);
        let style = Style { size: 32.0 * unit, bold: true, ink: TITLE };
        typeface.write(&mut canvas, [left, top - 20.0 * unit], Align::Left, heading, style);
        numbers_along_y(&mut canvas, &typeface, panel, [left, top]);
    }
    numbers_along_x(&mut canvas, &typeface, &panels[0], [first, top]);
    page.below(&mut canvas, &typeface, &legend, &viewport, bottom);
    Ok(canvas)
}

/// The two halves, inked alike: the same crowd is equally dark in both.
fn panels(
    picture: &OverviewPicture<'_>,
    window: &Shown,
    width: f32,
    unit: f32,
) -> Result<([Panel; 2], Counts), PlotError> {
    let mut raw = Panel::new(&window.window, width, HEIGHTS, unit)?;
    let mut plausible = Panel::new(&window.window, width, HEIGHTS, unit)?;
    let radius = (dot_radius(window.detections) * unit).max(0.6);
    let (mut all, mut labelled) = (DotField::empty(&raw.viewport), DotField::empty(&plausible.viewport));
    let mut counts = Counts::default();
    picture.marks.each(&mut |mark| {
        counts.add(mark, &raw.viewport);
        all.add_place(mark.place(), &raw.viewport, radius);
        if mark.label == MarkLabel::Plausible {
            labelled.add_place(mark.place(), &plausible.viewport, radius);
        }
    })?;
    finish(&mut raw, picture, &all, RAW, all.full());
    finish(&mut plausible, picture, &labelled, PLAUSIBLE, all.full());
    Ok(([raw, plausible], counts))
}

/// Which part of the ground is shown, and how many detections there are.
struct Shown {
    window: Window,
    detections: usize,
}

fn window(picture: &OverviewPicture<'_>) -> Result<Shown, PlotError> {
    let mut detections = 0;
    picture.marks.each(&mut |_| detections += 1)?;
    let mut tails = Tails::of_at_most(detections);
    picture.marks.each(&mut |mark| tails.add(mark.place()))?;
    Ok(Shown { window: picture.extent.window_of(tails.bounds(), picture.path), detections })
}

fn finish(panel: &mut Panel, picture: &OverviewPicture<'_>, dots: &DotField, ink: Ink, full: f32) {
    panel.grid();
    panel.lidar(picture.lidar);
    dots.paint(&mut panel.canvas, ink, full);
    panel.path(picture.path);
    panel.path_ends(picture.path);
    panel.frame();
}

fn dot_radius(detections: usize) -> f32 {
    match detections {
        0..3_000 => 3.0,
        3_000..50_000 => 2.0,
        _ => 1.4,
    }
}

fn style(unit: f32) -> Style {
    Style { size: 24.0 * unit, bold: false, ink: FAINT_TEXT }
}

/// Numbers at the grid lines, to the left of a panel, and the name of x above them.
fn numbers_along_x(canvas: &mut Canvas, typeface: &Typeface, panel: &Panel, [left, top]: [f32; 2]) {
    let (unit, style) = (panel.unit, style(panel.unit));
    let [[low, high], [y, _]] = panel.viewport.limits();
    let right = left - 14.0 * unit;
    for x in multiples(panel.grid_step(), low, high) {
        let row = panel.viewport.pixel_from_world([x, y])[1];
        // The name of x stands above the corner.
        if row < 12.0 * unit {
            continue;
        }
        typeface.write(canvas, [right, top + row + 0.36 * style.size], Align::Right, &number(x), style);
    }
    typeface.write(canvas, [right, top - 20.0 * unit], Align::Right, "x (m)", style);
}

/// Numbers at the grid lines below a panel, as many as have room, and the name of y.
fn numbers_along_y(canvas: &mut Canvas, typeface: &Typeface, panel: &Panel, [left, top]: [f32; 2]) {
    let (unit, style) = (panel.unit, style(panel.unit));
    let [[x, _], [low, high]] = panel.viewport.limits();
    let [width, height] = panel.viewport.size().map(|pixels| pixels as f32);
    let baseline = top + height + 32.0 * unit;
    let mut free_until = left + width + 18.0 * unit;
    for y in multiples(panel.grid_step(), low, high) {
        let text = number(y);
        let half = typeface.width(&text, style) / 2.0;
        let column = left + panel.viewport.pixel_from_world([x, y])[0];
        if column + half <= free_until && column - half >= left - 18.0 * unit {
            typeface.write(canvas, [column, baseline], Align::Middle, &text, style);
            free_until = column - half - 12.0 * unit;
        }
    }
    typeface.write(canvas, [left + width / 2.0, baseline + AXIS_NAME * unit], Align::Middle, "y (m)", style);
}

fn entries(picture: &OverviewPicture<'_>, counts: &Counts) -> Vec<Entry> {
    let plausible =
        format!("Labelled plausible {} ({})", count(counts.plausible), share(counts.plausible, counts.all()));
    let mut entries = vec![
        Entry::new(Symbol::Dots(RAW), format!("All detections {}", count(counts.all()))),
        Entry::new(Symbol::Dots(PLAUSIBLE), plausible),
    ];
    let mut add = |wanted: bool, symbol: Symbol, text: String| {
        if wanted {
            entries.push(Entry::new(symbol, text));
        }
    };
    add(!picture.lidar.is_empty(), Symbol::Dots(LIDAR), "LiDAR".to_owned());
    add(!picture.path.is_empty(), Symbol::Line(PATH), "Path of the vehicle".to_owned());
    add(!picture.path.is_empty(), Symbol::Start, "Start".to_owned());
    add(picture.path.len() > 1, Symbol::End, "End".to_owned());
    add(counts.outside > 0, Symbol::Nothing, format!("{} outside the view", count(counts.outside)));
    add(counts.nowhere > 0, Symbol::Nothing, format!("{} without a position", count(counts.nowhere)));
    entries
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::palette::PAPER;

    #[test]
    fn artifacts_are_on_the_left_alone() {
        let mark = |x, label| Mark { x, y: 0.0, label };
        let marks = [mark(10.0, MarkLabel::Plausible), mark(-10.0, MarkLabel::Artifact)];
        let picture =
            OverviewPicture { marks: &marks, extent: Extent::Radius(20.0), ..OverviewPicture::default() };
        let ([raw, plausible], _) = panels(&picture, &window(&picture).unwrap(), 400.0, 1.0).unwrap();
        let at = |panel: &Panel, x: f64| {
            let pixel = panel.viewport.pixel_from_world([x, 0.0]).map(|edge| edge as u32);
            panel.canvas.rgb(pixel)
        };
        assert_eq!([at(&raw, 10.0), at(&raw, -10.0)], [RAW.rgb; 2]);
        assert_eq!(at(&plausible, 10.0), PLAUSIBLE.rgb);
        assert_ne!(at(&plausible, -10.0), RAW.rgb);
        assert_eq!(plausible.canvas.rgb([50, 50]), PAPER.rgb);
    }

    #[test]
    fn the_legend_gives_the_share_of_all() {
        let mark = |label| Mark { x: 1.0, y: 2.0, label };
        let marks =
            [MarkLabel::Plausible, MarkLabel::Artifact, MarkLabel::Artifact, MarkLabel::Unlabelled].map(mark);
        let picture = OverviewPicture { marks: &marks, ..OverviewPicture::default() };
        let counts = Counts { plausible: 1, artifact: 2, unlabelled: 1, ..Counts::default() };
        let texts: Vec<String> = entries(&picture, &counts).into_iter().map(|entry| entry.text).collect();
        assert_eq!(texts, ["All detections 4", "Labelled plausible 1 (25 %)"]);
    }
}
