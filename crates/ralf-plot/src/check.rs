//! What a check of a recording saw of each radar: its own speed beside the vehicle's, and where detections lie on
//! LiDAR points.

use crate::canvas::Canvas;
use crate::error::PlotError;
use crate::palette::{ARTIFACT, FAINT_TEXT, FRAME, GRID, PLAUSIBLE, TEXT, TITLE};
use crate::scale::{count, multiples, nice_at_most, number};
use crate::text::{Align, Style, Typeface};

/// One radar.
#[derive(Debug, Clone, Default)]
pub struct CheckRow<'a> {
    /// Its name.
    pub name: &'a str,
    /// What is said of it.
    pub says: &'a str,
    /// Scans: seconds, the radar's own speed by its range rates, and by the vehicle's motion, m/s.
    pub speeds: &'a [[f64; 3]],
    /// Share (0 to 1) of detections beside a LiDAR point, by added yaw, degrees.
    pub by_yaw: &'a [[f64; 2]],
    /// The same by added time, ms.
    pub by_clock: &'a [[f64; 2]],
}

/// All radars of a sequence.
#[derive(Debug, Clone, Default)]
pub struct CheckPicture<'a> {
    /// Above all.
    pub title: &'a str,
    /// One below the other.
    pub rows: &'a [CheckRow<'a>],
}

const WIDTH: f32 = 1500.0;
const MARGIN: f32 = 50.0;
const HEAD: f32 = 70.0;
/// So many radars are drawn at most: more would make a picture that takes gigabytes, and that nobody looks through.
pub const MOST_CHECK_ROWS: usize = 100;
/// Height of a row, and of the panel in it.
const ROW: (f32, f32) = (230.0, 140.0);
/// Left side and width of the three panels.
const PANELS: [(f32, f32); 3] = [(MARGIN + 40.0, 640.0), (800.0, 290.0), (1160.0, 290.0)];

/// Draws them, as PNG; of more than [`MOST_CHECK_ROWS`] the first, and how many are left out.
pub fn check_picture(picture: &CheckPicture) -> Result<Vec<u8>, PlotError> {
    let (rows, others) = picture.rows.split_at(picture.rows.len().min(MOST_CHECK_ROWS));
    let height = HEAD + ROW.0 * rows.len().max(1) as f32 + MARGIN;
    let mut canvas = Canvas::new([WIDTH as u32, height as u32])?;
    let typeface = Typeface::load()?;
    let title = Style { size: 26.0, bold: true, ink: TITLE };
    typeface.write(&mut canvas, [MARGIN, 44.0], Align::Left, picture.title, title);
    if !others.is_empty() {
        let left_out = format!("{} more radars are not drawn", count(others.len()));
        typeface.write(&mut canvas, [WIDTH - MARGIN, 44.0], Align::Right, &left_out, text());
    }
    for (i, row) in rows.iter().enumerate() {
        let mut sheet = Sheet { canvas: &mut canvas, typeface: &typeface, top: HEAD + ROW.0 * i as f32 };
        sheet.row(row);
    }
    canvas.encode()
}

/// Where a row is drawn.
struct Sheet<'a> {
    canvas: &'a mut Canvas,
    typeface: &'a Typeface,
    top: f32,
}

impl Sheet<'_> {
    fn row(&mut self, row: &CheckRow) {
        let name = Style { size: 18.0, bold: true, ink: TITLE };
        self.typeface.write(self.canvas, [MARGIN, self.top + 14.0], Align::Left, row.name, name);
        let left = MARGIN + self.typeface.width(row.name, name) + 20.0;
        let room = WIDTH - MARGIN - left;
        let says = self.typeface.fitted(row.says, text(), room);
        self.typeface.write(self.canvas, [left, self.top + 14.0], Align::Left, &says, text());
        self.speeds(row.speeds);
        self.shares(1, row.by_yaw, "share beside LiDAR, by added yaw, degrees");
        self.shares(2, row.by_clock, "share beside LiDAR, by added time, ms");
    }

    fn speeds(&mut self, speeds: &[[f64; 3]]) {
        let places = speeds.iter().flat_map(|[t, seen, told]| [[*t, *seen], [*t, *told]]);
        let label = "speed, m/s over s: dots by range rates, line by the motion";
        let Some(axes) = self.axes(0, places, label) else { return };
        let line: Vec<[f32; 2]> = speeds.iter().map(|[t, _, told]| axes.place([*t, *told])).collect();
        self.canvas.line(&line, 2.0, ARTIFACT);
        for [t, seen, _] in speeds {
            self.canvas.disc(axes.place([*t, *seen]), 2.2, PLAUSIBLE.with_alpha(170));
        }
    }

    fn shares(&mut self, panel: usize, shares: &[[f64; 2]], label: &str) {
        let Some(axes) = self.axes(panel, shares.iter().copied(), label) else { return };
        let line: Vec<[f32; 2]> = shares.iter().map(|place| axes.place(*place)).collect();
        let now = [[0.0, axes.low[1]], [0.0, axes.high[1]]].map(|place| axes.place(place));
        self.canvas.line(&now, 1.5, ARTIFACT);
        self.canvas.line(&line, 2.0, PLAUSIBLE);
    }

    /// Frame, grid and numbers of a panel; `None` where there is nothing to show.
    fn axes(&mut self, panel: usize, places: impl Iterator<Item = [f64; 2]>, label: &str) -> Option<Axes> {
        let (left, width) = PANELS[panel];
        let top = self.top + 34.0;
        let (mut low, mut high) = ([f64::INFINITY, 0.0], [f64::NEG_INFINITY, 0.01]);
        for place in places.filter(|place| place.iter().all(|value| value.is_finite())) {
            for axis in 0..2 {
                low[axis] = f64::min(low[axis], place[axis]);
                high[axis] = f64::max(high[axis], place[axis]);
            }
        }
        self.typeface.write(self.canvas, [left, top + ROW.1 + 36.0], Align::Left, label, faint());
        self.canvas.rectangle_line([left, top], [width, ROW.1], 1.0, FRAME);
        if high[0] <= low[0] {
            self.typeface.write(
                self.canvas,
                [left + 12.0, top + 24.0],
                Align::Left,
                "nothing to show",
                faint(),
            );
            return None;
        }
        high[1] *= 1.05;
        let axes = Axes { left, top, width, low, high };
        self.numbers(&axes);
        Some(axes)
    }

    /// Lines and numbers at round values, a few of each axis.
    fn numbers(&mut self, axes: &Axes) {
        let Axes { left, top, low, high, .. } = *axes;
        let round = |axis: usize| {
            let step = nice_at_most((high[axis] - low[axis]) / 2.0);
            multiples(step, low[axis], high[axis])
        };
        for y in round(1) {
            let level = [[low[0], y], [high[0], y]].map(|place| axes.place(place));
            self.canvas.line(&level, 1.0, GRID);
            let at = [left - 6.0, level[0][1] + 4.0];
            self.typeface.write(self.canvas, at, Align::Right, &number(y), faint());
        }
        for x in round(0) {
            let at = [axes.place([x, low[1]])[0], top + ROW.1 + 17.0];
            self.typeface.write(self.canvas, at, Align::Middle, &number(x), faint());
        }
    }
}

/// From values to pixels.
struct Axes {
    left: f32,
    top: f32,
    width: f32,
    low: [f64; 2],
    high: [f64; 2],
}

impl Axes {
    fn place(&self, value: [f64; 2]) -> [f32; 2] {
        let share =
            |axis: usize| ((value[axis] - self.low[axis]) / (self.high[axis] - self.low[axis])) as f32;
        [self.left + share(0) * self.width, self.top + (1.0 - share(1)) * ROW.1]
    }
}

fn text() -> Style {
    Style { size: 15.0, bold: false, ink: TEXT }
}

fn faint() -> Style {
    Style { size: 13.0, bold: false, ink: FAINT_TEXT }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_radar_without_anything_to_show_is_drawn_as_well() {
        let speeds = [[0.0, 8.0, 8.1], [1.0, 8.2, 8.1], [2.0, f64::NAN, 8.0]];
        let full = CheckRow {
            name: "front",
            speeds: &speeds,
            by_yaw: &[[-1.0, 0.4], [1.0, 0.3]],
            ..CheckRow::default()
        };
        let rows = [full, CheckRow { name: "rear", ..CheckRow::default() }];
        let png = check_picture(&CheckPicture { title: "00", rows: &rows }).unwrap();
        assert!(png.starts_with(b"\x89PNG"));
        assert_eq!(png, check_picture(&CheckPicture { title: "00", rows: &rows }).unwrap());
    }

    #[test]
    fn of_a_fleets_radars_the_first_are_drawn() {
        let of = |rows: usize| {
            let rows = vec![CheckRow { name: "front", ..CheckRow::default() }; rows];
            let png = check_picture(&CheckPicture { title: "all", rows: &rows }).unwrap();
            u32::from_be_bytes([png[20], png[21], png[22], png[23]])
        };
        assert_eq!([of(100), of(4000)], [HEAD + 100.0 * ROW.0 + MARGIN; 2].map(|height| height as u32));
    }
}
