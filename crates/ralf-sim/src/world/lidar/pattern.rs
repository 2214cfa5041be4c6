//! Which directions a LiDAR looks in.

/// Rows of rays, from the lowest up, swept about the vertical axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Pattern {
    /// Channels.
    pub(crate) channels: usize,
    /// Lowest and highest channel, degrees.
    pub(crate) elevation: [f64; 2],
    /// Between channels about the horizon, as a share of their mean spacing: 1 is even.
    pub(crate) crowding: f64,
    /// Between firings, degrees.
    pub(crate) step: f64,
    /// Full horizontal field of view, degrees.
    pub(crate) width: f64,
    /// m.
    pub(crate) max_range: f64,
}

/// Velodyne VLP-16: 16 channels 2 degrees apart, 100 m (manual 63-9243).
pub(crate) const VLP_16: Pattern = Pattern {
    channels: 16,
    elevation: [-15.0, 15.0],
    crowding: 1.0,
    step: 0.2,
    width: 360.0,
    max_range: 100.0,
};
/// Velodyne HDL-32E as in nuScenes (Caesar et al. 2020): -30.67 to 10.67 degrees, 20 Hz, 70 m usable.
pub(crate) const HDL_32: Pattern = Pattern {
    channels: 32,
    elevation: [-30.67, 10.67],
    crowding: 1.0,
    step: 0.33,
    width: 360.0,
    max_range: 80.0,
};
/// Velodyne HDL-64E as in View-of-Delft (Palffy et al. 2022) and KITTI; every other firing.
pub(crate) const HDL_64: Pattern = Pattern {
    channels: 64,
    elevation: [-24.8, 2.0],
    crowding: 1.0,
    step: 0.34,
    width: 360.0,
    max_range: 120.0,
};
/// Hesai Pandar40P: -25 to 15 degrees, a third of a degree apart about the horizon (of 1.03 on average).
pub(crate) const PANDAR_40: Pattern = Pattern {
    channels: 40,
    elevation: [-25.0, 15.0],
    crowding: 0.32,
    step: 0.25,
    width: 360.0,
    max_range: 160.0,
};
/// Ouster OS1-64: 45 degrees evenly, 1024 columns.
pub(crate) const OS1_64: Pattern = Pattern {
    channels: 64,
    elevation: [-22.5, 22.5],
    crowding: 1.0,
    step: 0.352,
    width: 360.0,
    max_range: 100.0,
};
/// Velodyne VLS-128 as on aiMotive's roof: -25 to 15 degrees, 0.11 apart about the horizon (of 0.31 on average); one of
/// two firings.
pub(crate) const VLS_128: Pattern = Pattern {
    channels: 128,
    elevation: [-25.0, 15.0],
    crowding: 0.35,
    step: 0.42,
    width: 360.0,
    max_range: 220.0,
};
/// Ouster OS0-128 with its wide view of 90 degrees; every other column.
pub(crate) const OS0_128: Pattern = Pattern {
    channels: 128,
    elevation: [-45.0, 45.0],
    crowding: 1.0,
    step: 0.7,
    width: 360.0,
    max_range: 50.0,
};
/// A solid-state one that looks ahead: 120 by 25 degrees (RoboSense M1), a little coarser.
pub(crate) const FORWARD: Pattern = Pattern {
    channels: 100,
    elevation: [-12.5, 12.5],
    crowding: 1.0,
    step: 0.25,
    width: 120.0,
    max_range: 150.0,
};
/// A small one at a corner: 16 channels over 30 degrees, nearby.
pub(crate) const CORNER: Pattern = Pattern {
    channels: 16,
    elevation: [-21.7, 8.3],
    crowding: 1.0,
    step: 0.4,
    width: 220.0,
    max_range: 60.0,
};

impl Pattern {
    /// Elevations of the channels, rad, ascending.
    pub(super) fn elevations(&self) -> Vec<f64> {
        let [low, high] = self.elevation;
        let last = (self.channels - 1).max(1) as f64;
        // The share of the way from the horizon to either end: so dense about the horizon, ever less beyond.
        let bent = |x: f64| x * (self.crowding + (1.0 - self.crowding) * x * x);
        let angle = |i: usize| {
            let even = low + (high - low) * i as f64 / last;
            let end = if even < 0.0 { -low } else { high };
            end * bent(even / end)
        };
        (0..self.channels).map(|i| angle(i).to_radians()).collect()
    }

    /// Azimuths of the firings, rad, in their order: a revolution goes to the left, from the rear to the rear.
    pub(super) fn azimuths(&self) -> Vec<f64> {
        let count = (self.width / self.step).round() as usize;
        (0..count).map(|i| (-self.width / 2.0 + (i as f64 + 0.5) * self.step).to_radians()).collect()
    }

    /// Depression of the lowest channel, rad, above 0.
    pub(crate) fn lowest(&self) -> f64 {
        (-self.elevation[0]).to_radians()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn channels_ascend_from_the_lowest_to_the_highest() {
        for pattern in [VLP_16, HDL_32, HDL_64, PANDAR_40, OS1_64, VLS_128, OS0_128, FORWARD, CORNER] {
            let found = pattern.elevations();
            assert!(found.is_sorted() && found.len() == pattern.channels);
            let ends = [found[0].to_degrees(), found[found.len() - 1].to_degrees()];
            assert!((ends[0] - pattern.elevation[0]).abs() < 1e-9);
            assert!((ends[1] - pattern.elevation[1]).abs() < 1e-9);
            assert!(found.len() * pattern.azimuths().len() < 110_000, "{pattern:?}");
        }
    }

    #[test]
    fn crowded_channels_lie_closer_at_the_horizon() {
        let found = VLS_128.elevations();
        let steps: Vec<f64> = found.windows(2).map(|pair| pair[1] - pair[0]).collect();
        assert!(steps[0] > 5.0 * steps[80]);
    }
}
