//! What nobody but the radar tells of: beyond the reach of the LiDAR's map, or where no ray goes, and no LiDAR point
//! near, neither where it would be if it stood still nor where its range rate takes it.
//!
//! A world has as much clutter out there as somebody thought of, and a model believes a radar as far as that goes. On a
//! real road nobody can check it. As the paper does, what no other sensor confirms counts less: the setting
//! `learned.unconfirmed` says by how much.

use super::calibration::with_odds;

/// A point of the nearest LiDAR scan so near confirms, sigmas.
const NEAR: f32 = 3.0;
/// Nothing of the map is near, m: farther points are not told apart.
const NOTHING_NEAR: f32 = 3.0;

/// Where to look in a row of evidence.
#[derive(Debug, Clone, Copy)]
pub struct Unconfirmed {
    unseen: Option<usize>,
    chi: Option<usize>,
    map: Option<usize>,
    moving: Option<usize>,
}

impl Unconfirmed {
    /// For rows of features of these names.
    pub fn among<'a>(names: impl Iterator<Item = &'a str> + Clone) -> Self {
        let place = |wanted: &str| names.clone().position(|name| name == wanted);
        Self {
            unseen: place("lidar_unseen"),
            chi: place("lidar_chi"),
            map: place("map_distance"),
            moving: place("lidar_moving_near"),
        }
    }

    /// Whether there is a LiDAR that can't speak of the place, for it lies beyond its map or no ray of any scan around
    /// goes there, and of its points none is near: of the nearest scan within 3 sigmas, of the map within 3 m, and, if
    /// the detection moves, of the scans around where its range rate takes it by their times.
    pub fn is(&self, row: &[f32]) -> bool {
        let value = |place: Option<usize>| place.map_or(f32::NAN, |place| row[place]);
        let (unseen, chi, map) = (value(self.unseen), value(self.chi), value(self.map));
        let is_looked_for = !unseen.is_nan() && self.chi.is_some() && self.map.is_some();
        // What is absent is no point near.
        let near = chi < NEAR || map < NOTHING_NEAR || value(self.moving) > 0.0;
        is_looked_for && !near && (map.is_nan() || unseen >= 1.0)
    }

    /// The probability of a row; of one that is unconfirmed, with its odds multiplied by the factor.
    pub fn weighed(&self, row: &[f32], probability: f64, factor: f64) -> f64 {
        if self.is(row) { with_odds(probability, factor) } else { probability }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_lidars_cannot_speak_of_is_unconfirmed_unless_a_point_is_near() {
        let names = ["map_distance", "lidar_chi", "lidar_unseen", "lidar_moving_near"];
        let unconfirmed = Unconfirmed::among(names.into_iter());
        let absent = f32::NAN;
        for (row, expected) in [
            ([absent, 9.0, 0.5, absent], true),
            ([absent, absent, 1.0, absent], true),
            ([absent, 2.9, 0.5, absent], false),
            ([absent, 9.0, 0.5, 0.0], true),
            ([absent, 9.0, 0.5, 0.2], false),
            ([3.0, 9.0, 0.5, absent], false),
            ([3.0, absent, 1.0, absent], true),
            ([3.0, absent, 1.0, 0.2], false),
            ([3.0, absent, 0.9, absent], false),
            ([2.9, absent, 1.0, absent], false),
            ([absent; 4], false),
        ] {
            assert_eq!(unconfirmed.is(&row), expected, "{row:?}");
        }
        assert!(
            !Unconfirmed::among(["map_distance"].into_iter()).is(&[absent]),
            "a model that reads none of it"
        );
    }
}
