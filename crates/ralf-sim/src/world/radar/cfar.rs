//! The floor that detections must rise above: noise, and what the cells around hold (CFAR by an ordered statistic,
//! Rohling 1983, which few strong neighbours don't mask).

use super::echo::Echo;
use super::equation::{decibel, ratio};
use super::model::RadarModel;
use std::f64::consts::PI;

/// Cells of range on each side that are looked at, and those next to the one asked about that are not.
const WINDOW: (usize, usize) = (8, 1);
/// Which of them, in order, tells the floor.
const RANK: f64 = 0.7;
/// Sectors of azimuth.
const SECTORS: usize = 16;

/// The floor of a scan.
pub(super) struct Floor {
    /// Power by sector and range.
    sums: Vec<Vec<f64>>,
    /// Power by range over all sectors.
    ring: Vec<f64>,
    width: f64,
    /// Cells that share a sector and a range.
    cells: f64,
    leak: f64,
    noise: f64,
}

impl Floor {
    /// Around echoes; `noise` is that of the receiver, as a ratio to its usual one.
    pub(super) fn new(radar: &RadarModel, echoes: &[Echo], noise: f64) -> Self {
        // Coarser than a cell, so that windows reach over some metres.
        let width = (2.0 * radar.cell.range).max(0.4);
        let bins = (radar.max_range / width).ceil() as usize + 1;
        let cells = (2.0 * PI / SECTORS as f64 / radar.cell.azimuth).max(1.0) * width / radar.cell.range;
        let mut floor = Self {
            sums: vec![vec![0.0; bins]; SECTORS],
            ring: vec![0.0; bins],
            width,
            cells,
            leak: ratio(-1.6 * radar.side_lobe_db - 6.0),
            noise,
        };
        for echo in echoes {
            let [sector, bin] = floor.place(echo);
            floor.sums[sector][bin] += echo.power;
            floor.ring[bin] += echo.power;
        }
        floor
    }

    fn place(&self, echo: &Echo) -> [usize; 2] {
        let turn = (echo.seen.azimuth / (2.0 * PI) + 0.5).clamp(0.0, 0.999_999);
        let bin = ((echo.seen.range / self.width) as usize).min(self.ring.len() - 1);
        [(turn * SECTORS as f64) as usize, bin]
    }

    /// Around an echo, dB above the receiver's usual noise. What leaks over comes from the other angles of its range.
    pub(super) fn level_db(&self, echo: &Echo) -> f64 {
        let [sector, bin] = self.place(echo);
        let sums = &self.sums[sector];
        let mut around = Vec::with_capacity(2 * WINDOW.0);
        for distance in WINDOW.1 + 1..=WINDOW.0 {
            let near = [bin.checked_sub(distance), Some(bin + distance)];
            around.extend(near.into_iter().flatten().filter_map(|bin| sums.get(bin)));
        }
        around.sort_by(f64::total_cmp);
        let ranked = around.get((RANK * around.len() as f64) as usize).copied().unwrap_or(0.0);
        let others = (self.ring[bin] - sums[bin]).max(0.0);
        decibel(self.noise + ranked / self.cells + self.leak * others)
    }
}
