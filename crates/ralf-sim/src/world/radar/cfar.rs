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

#[cfg(test)]
mod tests {
    use super::super::model::tests::radar;
    use super::*;
    use crate::truth::Truth;
    use ralf::label::Cause;
    use ralf::space::Spherical;

    fn echo(range: f64, level_db: f64) -> Echo {
        let seen = Spherical { range, azimuth: 0.1, elevation: 0.0 };
        Echo::new(seen, 0.0, level_db, Truth::artifact(Cause::Road))
    }

    fn floor_db(echoes: &[Echo], range: f64) -> f64 {
        Floor::new(&radar(), echoes, 1.0).level_db(&echo(range, 0.0))
    }

    #[test]
    fn the_floor_is_the_noise_where_nothing_is() {
        assert!(floor_db(&[], 30.0).abs() < 1e-9);
        assert!((Floor::new(&radar(), &[], 4.0).level_db(&echo(30.0, 0.0)) - 6.02).abs() < 0.01);
    }

    #[test]
    fn one_strong_neighbour_does_not_mask_and_clutter_all_around_does() {
        assert!(floor_db(&[echo(32.0, 60.0)], 30.0) < 0.1);
        let clutter = |level: f64| (0..200).map(|i| echo(0.3 * f64::from(i), level)).collect::<Vec<Echo>>();
        let [weak, strong] = [10.0, 40.0].map(|level| floor_db(&clutter(level), 30.0));
        assert!(weak < 5.0 && strong > 20.0 && strong < 40.0, "{weak} {strong}");
        assert!(floor_db(&clutter(40.0), 90.0) < 0.1, "the floor follows range");
    }
}
