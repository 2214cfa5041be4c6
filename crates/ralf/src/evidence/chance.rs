//! How often chance alone puts a detection where another one lies.

use super::distance::area_within;
use crate::scene::Detection;
use std::f64::consts::PI;

/// How densely detections lie is told from those within this, m.
pub(super) const AROUND: f64 = 5.0;
/// At the same place is what is nearer than this, in standard deviations.
pub(super) const SAME: f64 = 2.0;

/// `ln((hits + 1/2) / (expected + 1/2))`, where `hits` of some scans have a detection at the same place as this one,
/// and `near` is how many they have within [`AROUND`] altogether. So dense, a scan has one at the same place by chance
/// with the probability `1 - exp(-density area)`.
pub(super) fn excess_of(hits: usize, scans: usize, near: usize, detection: &Detection) -> f64 {
    let scans = scans as f64;
    let density = near as f64 / (scans * PI * AROUND * AROUND);
    let expected = scans * (1.0 - (-density * area_within(SAME, detection)).exp());
    ((hits as f64 + 0.5) / (expected + 0.5)).ln()
}
