//! The floor that detections must rise above: noise, and what the cells around hold (CFAR by an ordered statistic,
//! Rohling 1983, which few strong neighbours don't mask).

use super::echo::Echo;
use super::equation::{decibel, ratio};
use super::model::RadarModel;
use std::collections::HashMap;
use std::f64::consts::PI;

/// Cells of range on each side that are not looked at, next to the one asked about, and how far those reach that are.
const WINDOW: (i64, i64) = (1, 8);
/// Which of them, in order, tells the floor.
const RANK: f64 = 0.7;
/// Sectors of azimuth.
const SECTORS: f64 = 16.0;

/// A cell of range and range rate, and a sector.
type Cell = [i64; 3];

/// The floor of a scan.
pub(super) struct Floor {
    /// Power by cell and sector.
    sums: HashMap<Cell, f64>,
    /// Power by cell from all angles.
    rings: HashMap<[i64; 2], f64>,
    /// Of a cell: m, and m/s.
    width: f64,
    doppler: f64,
    /// Cells of the radar that share a sector and a range.
    cells: f64,
    leak: f64,
    noise: f64,
}

impl Floor {
    /// Around echoes; `noise` is that of the receiver, as a ratio to its usual one.
    pub(super) fn new(radar: &RadarModel, echoes: &[Echo], noise: f64) -> Self {
        // Coarser than a cell, so that windows reach over some metres.
        let width = (2.0 * radar.cell.range).max(0.4);
        let cells = (2.0 * PI / SECTORS / radar.cell.azimuth).max(1.0) * width / radar.cell.range;
        let mut floor = Self {
            sums: HashMap::new(),
            rings: HashMap::new(),
            width,
            doppler: radar.cell.doppler,
            cells,
            leak: ratio(-1.6 * radar.side_lobe_db - 6.0),
            noise,
        };
        for echo in echoes {
            let cell @ [range, rate, _] = floor.cell(echo);
            *floor.sums.entry(cell).or_default() += echo.power;
            *floor.rings.entry([range, rate]).or_default() += echo.power;
        }
        floor
    }

    fn cell(&self, echo: &Echo) -> Cell {
        let turn = echo.seen.azimuth / (2.0 * PI) * SECTORS;
        [echo.seen.range / self.width, echo.range_rate / self.doppler, turn].map(|value| value.floor() as i64)
    }

    /// Around an echo, dB above the receiver's usual noise: what the cells before and behind it hold at its own range
    /// rate, for radars look there before they look for angles. What leaks over comes from other angles of its cell.
    pub(super) fn level_db(&self, echo: &Echo) -> f64 {
        let [range, rate, sector] = self.cell(echo);
        let mut around = Vec::with_capacity(2 * WINDOW.1 as usize);
        for distance in WINDOW.0 + 1..=WINDOW.1 {
            let near = [range - distance, range + distance].into_iter().filter(|range| *range >= 0);
            let power = |range| self.sums.get(&[range, rate, sector]).copied().unwrap_or(0.0);
            around.extend(near.map(power));
        }
        around.sort_by(f64::total_cmp);
        let ranked = around.get((RANK * around.len() as f64) as usize).copied().unwrap_or(0.0);
        let ring = self.rings.get(&[range, rate]).copied().unwrap_or(0.0);
        let others = (ring - echo.power).max(0.0);
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
