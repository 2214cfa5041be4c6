//! What nobody but the radar tells of: beyond the reach of the LiDAR's map, where no ray goes, or behind a wall, and no
//! LiDAR point near, neither where it would be if it stood still nor where its range rate takes it.
//!
//! A world has as much clutter out there as somebody thought of, and a model believes a radar as far as that goes. On a
//! real road nobody can check it. As the paper does, what no other sensor confirms counts less: the setting
//! `learned.unconfirmed` says by how much.

use super::calibration::with_odds;

/// A point of the nearest LiDAR scan so near confirms, sigmas.
const NEAR: f32 = 3.0;
/// Nothing of the map is near, m: farther points are not told apart.
const NOTHING_NEAR: f32 = 3.0;

/// A wall is higher than cars and longer than what waves find their way around, m.
const WALL_TOP: f32 = 2.5;
const WALL_LENGTH: f32 = 4.0;
/// Shares that are all there is, whatever their sum was rounded to.
const ALL: f32 = 0.999;

/// Where to look in a row of evidence.
#[derive(Debug, Clone, Copy)]
pub struct Unconfirmed {
    unseen: Option<usize>,
    chi: Option<usize>,
    map: Option<usize>,
    moving: Option<usize>,
    hidden: Option<usize>,
    chi_of_all: Option<usize>,
    wall_top: Option<usize>,
    wall_length: Option<usize>,
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
            hidden: place("lidar_occluded"),
            chi_of_all: place("lidar_window_chi_least"),
            wall_top: place("sight_wall_top"),
            wall_length: place("sight_wall_length"),
        }
    }

    /// Whether there is a LiDAR that can't speak of the place, and of its points none is near. It can't where the place
    /// lies beyond its map or no ray of any scan around goes there: then none of the nearest scan may be within 3
    /// sigmas and none of the map within 3 m. Nor can it where all rays end before the place and the last thing in the
    /// radar's way is a wall, over 2.5 m high and at least 4 m long: then no scan around may have one within 3 sigmas.
    /// Nor may any scan around have one where its range rate takes the detection, if it moves.
    pub fn is(&self, row: &[f32]) -> bool {
        let value = |place: Option<usize>| place.map_or(f32::NAN, |place| row[place]);
        let (unseen, chi, map) = (value(self.unseen), value(self.chi), value(self.map));
        if unseen.is_nan() || self.chi.is_none() || self.map.is_none() {
            return false;
        }
        // What is absent is no point near.
        let near = chi < NEAR || value(self.moving) > 0.0;
        let near_map = map < NOTHING_NEAR;
        let near_any = value(self.chi_of_all) < NEAR;
        let out_of_sight = map.is_nan() || unseen >= 1.0;
        let walled = value(self.wall_top) > WALL_TOP && value(self.wall_length) >= WALL_LENGTH;
        let hidden = walled && unseen + value(self.hidden) >= ALL;
        !near && (out_of_sight && !near_map || hidden && !near_any)
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
        let names = [
            ["map_distance", "lidar_chi", "lidar_unseen", "lidar_moving_near"],
            ["lidar_occluded", "lidar_window_chi_least", "sight_wall_top", "sight_wall_length"],
        ];
        let unconfirmed = Unconfirmed::among(names.as_flattened().iter().copied());
        for (row, expected) in [
            ([0.6, 9.0, 0.0, 0.0, 1.0, 3.0, 2.6, 4.0], true),
            ([0.6, 9.0, 0.25, absent, 0.75, absent, 5.9, 6.25], true),
            ([0.6, 2.9, 0.0, 0.0, 1.0, 3.0, 2.6, 4.0], false),
            ([0.6, 9.0, 0.0, 0.1, 1.0, 3.0, 2.6, 4.0], false),
            ([0.6, 9.0, 0.0, 0.0, 0.9, 3.0, 2.6, 4.0], false),
            ([0.6, 9.0, 0.0, 0.0, 1.0, 2.9, 2.6, 4.0], false),
            ([0.6, 9.0, 0.0, 0.0, 1.0, 3.0, 2.4, 4.0], false),
            ([0.6, 9.0, 0.0, 0.0, 1.0, 3.0, 2.6, 3.9], false),
            ([0.6, 9.0, 0.0, 0.0, 1.0, 3.0, absent, absent], false),
        ] {
            assert_eq!(unconfirmed.is(&row), expected, "{row:?}");
        }
        assert!(
            !Unconfirmed::among(["map_distance"].into_iter()).is(&[absent]),
            "a model that reads none of it"
        );
    }
}
