//! One scan from above, in the vehicle frame.

use crate::canvas::Canvas;
use crate::error::{PlotError, check_width};
use crate::extent::{Extent, is_place};
use crate::legend::{Entry, Legend, Symbol};
use crate::marks::{self, Counts, Mark, MarkLabel};
use crate::page::Page;
use crate::palette::{FAINT_TEXT, LIDAR, PAPER, PATH};
use crate::panel::Panel;
use crate::scale::{count, share};
use crate::text::{Align, Style, Typeface};
use crate::values::ValueScale;
use crate::vehicle::{RadarMount, VehicleOutline};

/// No radar hears farther, m: what is said to lie beyond isn't what the view is fitted to.
const FARTHEST_HEARD: f64 = 1000.0;

/// What to draw of one scan. All places are x (forward) and y (left) in the vehicle frame, m.
#[derive(Debug, Clone, Copy)]
pub struct ScanPicture<'a> {
    /// Above the picture, in large letters; may be empty.
    pub title: &'a str,
    /// Below the title; may be empty.
    pub subtitle: &'a str,
    /// Width of the picture, pixels, 200 to 10,000; its height follows from what is shown.
    pub width: u32,
    /// Which part of the ground is shown.
    pub extent: Extent,
    /// LiDAR returns, in any order.
    pub lidar: &'a [[f64; 2]],
    /// The detections.
    pub marks: &'a [Mark],
    /// What the colours of those with a value mean.
    pub scale: Option<ValueScale<'a>>,
    /// Where the vehicle was and will be, in order of time; may be empty.
    pub path: &'a [[f64; 2]],
    /// The vehicle's radars; may be empty.
    pub radars: &'a [RadarMount],
    /// The vehicle's size.
    pub vehicle: VehicleOutline,
}

impl Default for ScanPicture<'_> {
    /// An empty picture, 1600 pixels wide.
    fn default() -> Self {
        Self {
            title: "",
            subtitle: "",
            width: 1600,
            extent: Extent::Fit,
            lidar: &[],
            marks: &[],
            scale: None,
            path: &[],
            radars: &[],
            vehicle: VehicleOutline::default(),
        }
    }
}

const WIDTHS: [u32; 2] = [200, 10_000];
/// Smallest and largest height of the panel, in its widths.
const HEIGHTS: [f64; 2] = [0.55, 1.1];

/// Draws one scan as PNG.
///
/// # Errors
/// A width or radius outside its range, or a picture that can't be made or encoded.
pub fn scan_picture(picture: &ScanPicture<'_>) -> Result<Vec<u8>, PlotError> {
    draw(picture)?.encode()
}

fn draw(picture: &ScanPicture<'_>) -> Result<Canvas, PlotError> {
    check_width(picture.width, WIDTHS[0], WIDTHS[1])?;
    picture.extent.check()?;
    let typeface = Typeface::load()?;
    let width = picture.width as f32;
    let unit = width / 1600.0;
    let page = Page { width, margin: 48.0 * unit, unit };
    let panel = ground(picture, &typeface, width - 2.0 * page.margin, unit)?;

    let [panel_width, panel_height] = panel.viewport.size().map(|pixels| pixels as f32);
    let entries = entries(picture, &Counts::of(picture.marks, &panel.viewport));
    let legend = Legend::lay_out(entries, &typeface, page.legend_room(panel_width), unit);
    let top = page.header(picture.title, picture.subtitle).round();
    let height = top + panel_height + page.footer(&legend);
    let mut canvas = Canvas::new([picture.width, height.round() as u32])?;
    page.titles(&mut canvas, &typeface, picture.title, picture.subtitle);
    canvas.paste(&panel.canvas, [page.margin.round() as i32, top as i32]);
    page.below(&mut canvas, &typeface, &legend, &panel.viewport, top + panel_height);
    Ok(canvas)
}

fn ground(picture: &ScanPicture<'_>, typeface: &Typeface, width: f32, unit: f32) -> Result<Panel, PlotError> {
    let kept = match picture.extent {
        Extent::Fit => picture.vehicle.corners().to_vec(),
        Extent::Radius(_) => vec![[0.0, 0.0]],
    };
    let window = picture.extent.window(scattered(picture), &kept);
    let mut panel = Panel::new(&window, width, HEIGHTS, unit)?;
    let ranges = panel.rings();
    panel.lidar(picture.lidar);
    panel.ring_labels(&ranges, picture.marks, typeface);
    panel.path(picture.path);
    for radar in picture.radars {
        radar.draw(&mut panel.canvas, &panel.viewport, 16.0 * unit);
    }
    picture.vehicle.draw(&mut panel.canvas, &panel.viewport, unit);
    detections(&mut panel, picture.marks);
    axes(&mut panel, typeface);
    panel.frame();
    Ok(panel)
}

/// The places that the view is fitted to: the detections, or the LiDAR returns where there are none. Of few, none is
/// left out as one of the farthest, but a damaged number must not make all others one dot.
fn scattered<'a>(picture: &ScanPicture<'a>) -> Box<dyn Iterator<Item = [f64; 2]> + 'a> {
    let is_near = |place: &[f64; 2]| place[0].hypot(place[1]) <= FARTHEST_HEARD;
    if picture.marks.iter().any(|mark| is_near(&mark.place())) {
        Box::new(picture.marks.iter().map(Mark::place).filter(is_near))
    } else {
        Box::new(picture.lidar.iter().copied().filter(is_near))
    }
}

/// Plausible detections lie on top, so that none of the fewer is hidden by the many.
fn detections(panel: &mut Panel, marks: &[Mark]) {
    let radius = match marks.len() {
        0..1000 => 7.0,
        1000..5000 => 5.0,
        _ => 3.5,
    };
    let mut upwards: Vec<&Mark> = marks.iter().filter(|mark| is_place(&mark.place())).collect();
    upwards.sort_by_key(|mark| level(mark.label));
    for mark in upwards {
        let at = panel.viewport.pixel_from_world(mark.place());
        if panel.viewport.contains(at, -2.0 * radius) {
            marks::draw(&mut panel.canvas, at, radius * panel.unit, mark.label);
        }
    }
}

/// What lies on what: brighter values on darker ones.
fn level(label: MarkLabel) -> u16 {
    match label {
        MarkLabel::Unlabelled => 0,
        MarkLabel::Artifact => 1,
        MarkLabel::Plausible => 2,
        MarkLabel::Valued(shade) => 3 + u16::from(shade),
    }
}

/// Two small arrows in the lower left corner: where x and y point.
fn axes(panel: &mut Panel, typeface: &Typeface) {
    let unit = panel.unit;
    let rows = panel.viewport.size()[1] as f32;
    let [x, y] = [92.0 * unit, rows - 34.0 * unit];
    let (length, tip, line) = (44.0 * unit, 8.0 * unit, 2.6 * unit);
    let canvas = &mut panel.canvas;
    canvas.rectangle([8.0 * unit, rows - 128.0 * unit], [112.0 * unit, 120.0 * unit], PAPER.with_alpha(225));
    let (up, left) = ([x, y - length], [x - length, y]);
    canvas.line(&[up, [x, y], left], line, FAINT_TEXT);
    canvas.line(&[[up[0] - tip, up[1] + tip], up, [up[0] + tip, up[1] + tip]], line, FAINT_TEXT);
    canvas.line(&[[left[0] + tip, left[1] - tip], left, [left[0] + tip, left[1] + tip]], line, FAINT_TEXT);
    let style = Style { size: 22.0 * unit, bold: false, ink: FAINT_TEXT };
    typeface.write(canvas, [x, up[1] - 10.0 * unit], Align::Middle, "x", style);
    typeface.write(canvas, [left[0] - 8.0 * unit, y + 7.0 * unit], Align::Right, "y", style);
}

fn entries(picture: &ScanPicture<'_>, counts: &Counts) -> Vec<Entry> {
    let of = |name: &str, part: usize| format!("{name} {} ({})", count(part), share(part, counts.all()));
    // A scan as the radar gave it has no labels to count.
    let raw = counts.unlabelled > 0 && counts.unlabelled == counts.all();
    let mut entries = if let Some(scale) = &picture.scale {
        scale.entries()
    } else if raw {
        vec![Entry::new(Symbol::Mark(MarkLabel::Unlabelled), format!("Detections {}", count(counts.all())))]
    } else {
        vec![
            Entry::new(Symbol::Mark(MarkLabel::Plausible), of("Plausible", counts.plausible)),
            Entry::new(Symbol::Mark(MarkLabel::Artifact), of("Artifact", counts.artifact)),
        ]
    };
    let mut add = |wanted: bool, symbol: Symbol, text: String| {
        if wanted {
            entries.push(Entry::new(symbol, text));
        }
    };
    let name = if picture.scale.is_some() { "Not observed" } else { "Unlabelled" };
    let unlabelled = of(name, counts.unlabelled);
    add(
        counts.unlabelled > 0 && !(raw && picture.scale.is_none()),
        Symbol::Mark(MarkLabel::Unlabelled),
        unlabelled,
    );
    add(!picture.lidar.is_empty(), Symbol::Dots(LIDAR), "LiDAR".to_owned());
    add(!picture.radars.is_empty(), Symbol::Wedge, "Radar".to_owned());
    add(!picture.path.is_empty(), Symbol::Line(PATH), "Path".to_owned());
    add(counts.outside > 0, Symbol::Nothing, format!("{} outside the view", count(counts.outside)));
    add(counts.nowhere > 0, Symbol::Nothing, format!("{} without a position", count(counts.nowhere)));
    entries
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::palette::{ARTIFACT, PLAUSIBLE};

    const AHEAD: Mark = Mark { x: 10.0, y: 0.0, label: MarkLabel::Plausible };
    const LEFT: Mark = Mark { x: 0.0, y: 10.0, label: MarkLabel::Artifact };

    /// Middle of all pixels of one colour: column and row.
    fn middle(canvas: &Canvas, colour: [u8; 3], rows: std::ops::Range<u32>) -> [f64; 2] {
        let [width, _] = canvas.size();
        let pixels = rows.flat_map(|row| (0..width).map(move |column| [column, row]));
        let hits: Vec<[u32; 2]> = pixels.filter(|pixel| canvas.rgb(*pixel) == colour).collect();
        assert!(!hits.is_empty(), "{colour:?} is nowhere");
        [0, 1].map(|axis| hits.iter().map(|hit| f64::from(hit[axis]) + 0.5).sum::<f64>() / hits.len() as f64)
    }

    #[test]
    fn ahead_is_above_the_vehicle_and_left_is_left() {
        let marks = [AHEAD, LEFT];
        let picture = ScanPicture { extent: Extent::Radius(20.0), marks: &marks, ..ScanPicture::default() };
        let canvas = draw(&picture).unwrap();
        // Margins of 48, a square panel of 1504: the origin in its middle, 37.6 pixels per metre.
        let origin = [800.0, 800.0];
        let [column, row] = middle(&canvas, PLAUSIBLE.rgb, 0..1540);
        assert!((column - origin[0]).abs() < 1.0 && (row - (origin[1] - 376.0)).abs() < 1.0);
        let [column, row] = middle(&canvas, ARTIFACT.rgb, 0..1540);
        assert!((column - (origin[0] - 376.0)).abs() < 1.0 && (row - origin[1]).abs() < 1.0);
    }

    #[test]
    fn labels_differ_in_shape() {
        let marks = [AHEAD, Mark { label: MarkLabel::Artifact, ..LEFT }];
        let picture = ScanPicture { extent: Extent::Radius(20.0), marks: &marks, ..ScanPicture::default() };
        let canvas = draw(&picture).unwrap();
        // Beside its middle a disc is inked and a cross is not.
        assert_eq!(canvas.rgb([800 + 5, 424]), PLAUSIBLE.rgb);
        assert_ne!(canvas.rgb([424 + 5, 800]), ARTIFACT.rgb);
        assert_eq!(canvas.rgb([424 + 3, 800 + 3]), ARTIFACT.rgb);
    }

    #[test]
    fn a_damaged_number_does_not_make_all_others_one_dot() {
        let wild = Mark { x: 9e6, ..AHEAD };
        let marks = [AHEAD, LEFT, wild];
        let seen =
            |marks| Extent::Fit.window(scattered(&ScanPicture { marks, ..ScanPicture::default() }), &[]);
        assert_eq!(seen(&marks[..]), seen(&marks[..2]));
    }

    #[test]
    fn the_legend_counts_everything() {
        let nowhere = Mark { x: f64::NAN, y: 1.0, label: MarkLabel::Unlabelled };
        let far = Mark { x: 4000.0, ..AHEAD };
        let marks = [AHEAD, LEFT, nowhere, far];
        let picture = ScanPicture { extent: Extent::Radius(20.0), marks: &marks, ..ScanPicture::default() };
        let typeface = Typeface::load().unwrap();
        let panel = ground(&picture, &typeface, 400.0, 0.25).unwrap();
        let entries = entries(&picture, &Counts::of(&marks, &panel.viewport));
        let texts: Vec<&str> = entries.iter().map(|entry| entry.text.as_str()).collect();
        assert_eq!(
            texts,
            [
                "Plausible 2 (50 %)",
                "Artifact 1 (25 %)",
                "Unlabelled 1 (25 %)",
                "1 outside the view",
                "1 without a position"
            ]
        );
    }

    #[test]
    fn a_raw_scan_counts_no_labels() {
        let raw = |mark: Mark| Mark { label: MarkLabel::Unlabelled, ..mark };
        let marks = [raw(AHEAD), raw(LEFT)];
        let picture = ScanPicture { extent: Extent::Radius(20.0), marks: &marks, ..ScanPicture::default() };
        let panel = ground(&picture, &Typeface::load().unwrap(), 400.0, 0.25).unwrap();
        let entries = entries(&picture, &Counts::of(&marks, &panel.viewport));
        assert_eq!(entries, [Entry::new(Symbol::Mark(MarkLabel::Unlabelled), "Detections 2")]);
    }

    #[test]
    fn where_there_is_no_detection_the_lidar_is_shown() {
        let lidar = [[-200.0, 300.0], [200.0, -300.0]];
        let picture = ScanPicture { lidar: &lidar, ..ScanPicture::default() };
        let panel = ground(&picture, &Typeface::load().unwrap(), 400.0, 0.25).unwrap();
        assert!(
            lidar
                .iter()
                .all(|place| { panel.viewport.contains(panel.viewport.pixel_from_world(*place), 0.0) })
        );
    }
}
