//! The vehicle from above, and its radars.

use std::f64::consts::PI;

use crate::canvas::Canvas;
use crate::palette::{PAPER, RADAR, VEHICLE, VEHICLE_EDGE, VEHICLE_GLASS};
use crate::viewport::Viewport;

/// The vehicle's size. Its origin is the rear axle's centre.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VehicleOutline {
    /// x of the rear bumper, m, below 0.
    pub rear: f64,
    /// x of the front bumper, m.
    pub front: f64,
    /// Its width, m.
    pub width: f64,
}

impl Default for VehicleOutline {
    /// A car of the middle class: 4.6 m by 1.9 m.
    fn default() -> Self {
        Self { rear: -1.0, front: 3.6, width: 1.9 }
    }
}

/// Where a radar sits on the vehicle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RadarMount {
    /// Forward of the rear axle, m.
    pub x: f64,
    /// To the left, m.
    pub y: f64,
    /// Direction of its boresight, rad, 0 forward, positive to the left.
    pub azimuth: f64,
    /// Full horizontal field of view, rad.
    pub fov: f64,
}

/// A shorter vehicle is drawn as an arrowhead of this length instead, in units.
const LEAST_LENGTH: f32 = 34.0;

impl VehicleOutline {
    /// Front left and rear right corner (x, y in m).
    pub(crate) fn corners(&self) -> [[f64; 2]; 2] {
        [[self.front, self.width / 2.0], [self.rear, -self.width / 2.0]]
    }

    /// Draws the vehicle with its front up; lines are `unit` times as thick as in a picture of the usual size.
    pub(crate) fn draw(&self, canvas: &mut Canvas, viewport: &Viewport, unit: f32) {
        let [[left, front], [right, rear]] = self.corners().map(|corner| viewport.pixel_from_world(corner));
        if rear - front < LEAST_LENGTH * unit {
            let at = viewport.pixel_from_world([(self.front + self.rear) / 2.0, 0.0]);
            return arrowhead(canvas, at, [0.0, -1.0], LEAST_LENGTH * unit, unit);
        }
        body(canvas, [left, front], [right - left, rear - front], 2.2 * unit);
    }
}

/// Body, windscreen, and an arrow on the roof that shows the heading.
fn body(canvas: &mut Canvas, [left, front]: [f32; 2], [width, length]: [f32; 2], line: f32) {
    let at = |across: f32, along: f32| [left + width * across, front + length * along];
    let outline = [
        (0.03, 0.0),
        (0.5, -0.015),
        (0.97, 0.0),
        (1.005, 0.2),
        (1.005, 0.8),
        (0.97, 1.0),
        (0.5, 1.01),
        (0.03, 1.0),
        (-0.005, 0.8),
        (-0.005, 0.2),
    ]
    .map(|(across, along)| at(across, along));
    let windscreen = [(0.1, 0.35), (0.5, 0.25), (0.9, 0.35), (0.83, 0.45), (0.5, 0.41), (0.17, 0.45)]
        .map(|(across, along)| at(across, along));
    canvas.curve(&outline, VEHICLE);
    canvas.curve(&windscreen, VEHICLE_GLASS);
    canvas.curve_line(&outline, line, VEHICLE_EDGE);
    canvas.line(&[at(0.5, 0.86), at(0.5, 0.56)], line, VEHICLE_EDGE);
    canvas.line(&[at(0.32, 0.66), at(0.5, 0.55), at(0.68, 0.66)], line, VEHICLE_EDGE);
}

/// An arrowhead around `at` that points along `direction` (columns, rows; of length 1).
pub(crate) fn arrowhead(canvas: &mut Canvas, at: [f32; 2], direction: [f32; 2], length: f32, unit: f32) {
    let [ahead, down] = direction;
    let corner = |along: f32, across: f32| {
        [at[0] + length * (along * ahead - across * down), at[1] + length * (along * down + across * ahead)]
    };
    let corners = [corner(0.5, 0.0), corner(-0.5, 0.38), corner(-0.28, 0.0), corner(-0.5, -0.38)];
    canvas.polygon_line(&corners, 4.0 * unit, PAPER);
    canvas.polygon(&corners, VEHICLE_EDGE);
}

impl RadarMount {
    /// Draws a wedge as wide as the field of view, at least `least` pixels long.
    pub(crate) fn draw(&self, canvas: &mut Canvas, viewport: &Viewport, least: f32) {
        let length = f64::from(least).max(1.1 * viewport.scale()) / viewport.scale();
        let half = (self.fov / 2.0).clamp(0.0, PI);
        let rim = (0..=16).map(|step| self.azimuth + half * (f64::from(step) / 8.0 - 1.0));
        let rim = rim.map(|angle| [self.x + length * angle.cos(), self.y + length * angle.sin()]);
        let corners = std::iter::once([self.x, self.y]).chain(rim);
        let corners: Vec<[f32; 2]> = corners.map(|corner| viewport.pixel_from_world(corner)).collect();
        canvas.polygon(&corners, RADAR.with_alpha(150));
    }
}
