//! How far off a sensor can be mounted, and how large images are.

use crate::space::{Transform, check_rigid};

/// No sensor of a vehicle is farther from it, m.
pub const FARTHEST: f64 = 1000.0;

/// The most pixels a side of an image, or of a view, has: memory is asked for by what a file says here.
pub const MOST_PIXELS: usize = 16_384;

/// Refuses, with what was expected and found, a mounting that no sensor has: numbers that aren't finite, a rotation
/// that isn't one, and places farther than [`FARTHEST`] along an axis.
pub fn check_mounting(vehicle_from_sensor: &Transform) -> Result<(), String> {
    check_rigid(vehicle_from_sensor)?;
    match vehicle_from_sensor.translation.vector.iter().find(|value| value.abs() > FARTHEST) {
        Some(far) if far.abs() >= 1e9 => Err(format!("at most {FARTHEST} m from the vehicle, found {far:e}")),
        Some(far) => Err(format!("at most {FARTHEST} m from the vehicle, found {far}")),
        None => Ok(()),
    }
}

/// Refuses sizes (px) that no image, or view, has.
pub(super) fn check_size(what: &str, width: usize, height: usize) -> Result<(), String> {
    if [width, height].iter().all(|pixels| (1..=MOST_PIXELS).contains(pixels)) {
        return Ok(());
    }
    Err(format!("{what} of 1 x 1 to {MOST_PIXELS} x {MOST_PIXELS} pixels, found {width} x {height}"))
}
