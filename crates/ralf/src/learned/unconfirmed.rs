//! What nobody but the radar tells of: where a LiDAR sees as far, beyond the reach of the LiDAR's map, or where no ray
//! goes and no other scan of a radar had a say; and behind a wall, however far LiDARs see. No LiDAR point is near,
//! neither where it would be if it stood still nor where its range rate takes it.
//!
//! A world has as much clutter out there as somebody thought of, and a model believes a radar as far as that goes. On a
//! real road nobody can check it. As the paper does, what neither another sensor nor time confirms counts less: the
//! setting `learned.unconfirmed` says by how much. Where a radar hears farther than any LiDAR sees, silence says
//! nothing, and the model keeps its word unless a wall is in the way. It does so, too, where the radar saw the place
//! again in half of its scans and radars looked from elsewhere: far away a LiDAR hits a guard rail every few metres,
//! and misses what a radar hears.

use super::calibration::with_odds;

/// A point of the nearest LiDAR scan so near confirms, m: a radar hears one end of a car and a LiDAR sees another, or
/// either sees its middle.
const NEAR: f32 = 2.5;
/// Nor is a point behind a wall as near as this, sigmas.
const NEAR_SIGMAS: f32 = 3.0;
/// What the radar saw again in so large a share of the scans that could have seen it is confirmed by time.
const AGAIN: f32 = 0.5;

/// A wall is higher than cars and longer than what waves find their way around, m.
const WALL_TOP: f32 = 2.5;
const WALL_LENGTH: f32 = 4.0;
/// Shares that are all there is, whatever their sum was rounded to.
const ALL: f32 = 0.999;

/// Where to look in a row of evidence.
#[derive(Debug, Clone, Copy)]
pub(super) struct Unconfirmed {
    unseen: Option<usize>,
    reach: Option<usize>,
    distance: Option<usize>,
    chi: Option<usize>,
    map: Option<usize>,
    moving: Option<usize>,
    again: Option<usize>,
    aspect: Option<usize>,
    hidden: Option<usize>,
    chi_of_all: Option<usize>,
    wall_top: Option<usize>,
    wall_length: Option<usize>,
}

impl Unconfirmed {
    /// For rows of features of these names.
    pub(super) fn among<'a>(names: impl Iterator<Item = &'a str> + Clone) -> Self {
        let place = |wanted: &str| names.clone().position(|name| name == wanted);
        Self {
            unseen: place("lidar_unseen"),
            reach: place("lidar_reach"),
            distance: place("lidar_distance"),
            chi: place("lidar_chi"),
            map: place("map_distance"),
            moving: place("lidar_moving_near"),
            again: place("persistence_moving"),
            aspect: place("persistence_aspect"),
            hidden: place("lidar_occluded"),
            chi_of_all: place("lidar_window_chi_least"),
            wall_top: place("sight_wall_top"),
            wall_length: place("sight_wall_length"),
        }
    }

    /// Whether no LiDAR can speak of the place, and of its points none is near. A LiDAR that sees so far can't where
    /// the place lies beyond its map: then none of the nearest scan may be within 2.5 m, and the radar may not have
    /// seen it again in half of its scans, if radars looked from elsewhere. Nor can it where no ray goes: of that the
    /// model judges by what time tells, so only what no other scan of the radar could have seen is meant. However far a
    /// LiDAR sees, it can't where no ray goes past the place and the last thing in the radar's way is a wall, over
    /// 2.5 m high and at least 4 m long: then no scan around may have a point within 3 sigmas. Nor may any scan around
    /// have one where its range rate takes the detection, if it moves.
    pub(super) fn is(&self, row: &[f32]) -> bool {
        let value = |place: Option<usize>| place.map_or(f32::NAN, |place| row[place]);
        let unseen = value(self.unseen);
        if unseen.is_nan() || self.chi.is_none() || self.map.is_none() || value(self.moving) > 0.0 {
            return false;
        }
        // What is absent is no point near. Models from before a column do as well as they can.
        let [near_nearest, near_any] = [self.chi, self.chi_of_all].map(|chi| value(chi) < NEAR_SIGMAS);
        let near = self.distance.map_or(near_nearest, |distance| row[distance] < NEAR);
        let sees_as_far = self.reach.is_none_or(|reach| row[reach] <= 1.0);
        let seen_again = value(self.again) >= AGAIN && !value(self.aspect).is_nan();
        let silent = sees_as_far && !near;
        let away = value(self.map);
        let beyond = silent && away.is_nan() && !seen_again;
        let seen_once = self.again.is_some_and(|again| row[again].is_nan());
        let unlooked = silent && seen_once && unseen >= ALL && away >= NEAR;
        let walled = value(self.wall_top) > WALL_TOP && value(self.wall_length) >= WALL_LENGTH;
        let hidden = walled && unseen + value(self.hidden) >= ALL && !near_nearest && !near_any;
        beyond || unlooked || hidden
    }

    /// The probability of a row; of one that is unconfirmed, with its odds multiplied by the factor.
    pub(super) fn weighed(&self, row: &[f32], probability: f64, factor: f64) -> f64 {
        if self.is(row) { with_odds(probability, factor) } else { probability }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ABSENT: f32 = f32::NAN;

    #[test]
    fn what_lies_beyond_the_map_is_unconfirmed_unless_a_point_is_near() {
        let names = [
            "map_distance",
            "lidar_distance",
            "lidar_moving_near",
            "lidar_reach",
            "lidar_unseen",
            "lidar_chi",
        ];
        let unconfirmed = Unconfirmed::among(names.into_iter());
        for ([map, distance, moving, reach, unseen], expected) in [
            ([ABSENT, 2.6, ABSENT, 0.9, 0.5], true),
            ([ABSENT, ABSENT, ABSENT, 0.9, 1.0], true),
            ([ABSENT, 2.4, ABSENT, 0.9, 0.5], false),
            ([ABSENT, 2.6, 0.0, 0.9, 0.5], true),
            ([ABSENT, 2.6, 0.2, 0.9, 0.5], false),
            ([3.0, ABSENT, ABSENT, 0.5, 1.0], false),
            ([ABSENT; 5], false),
        ] {
            // Standard deviations are nothing to go by so far away.
            let row = [map, distance, moving, reach, unseen, 2.0];
            assert_eq!(unconfirmed.is(&row), expected, "{row:?}");
        }
    }

    #[test]
    fn time_confirms_what_radars_see_again_from_elsewhere() {
        let names = ["map_distance", "lidar_unseen", "lidar_chi", "persistence_moving", "persistence_aspect"];
        let unconfirmed = Unconfirmed::among(names.into_iter());
        for (again, aspect, expected) in
            [(0.5, 0.0, false), (0.4, 0.9, true), (0.9, ABSENT, true), (ABSENT, ABSENT, true)]
        {
            assert_eq!(unconfirmed.is(&[ABSENT, 0.5, ABSENT, again, aspect]), expected, "{again} {aspect}");
        }
    }

    #[test]
    fn where_no_ray_goes_a_single_scan_of_a_radar_is_unconfirmed() {
        let names = ["map_distance", "lidar_distance", "lidar_unseen", "lidar_chi", "persistence_moving"];
        let unconfirmed = Unconfirmed::among(names.into_iter());
        for ([map, distance, unseen, again], expected) in [
            ([3.0, ABSENT, 1.0, ABSENT], true),
            ([3.0, 2.6, 1.0, ABSENT], true),
            ([3.0, 2.4, 1.0, ABSENT], false),
            ([2.4, ABSENT, 1.0, ABSENT], false),
            ([3.0, ABSENT, 0.9, ABSENT], false),
            ([3.0, ABSENT, 1.0, 0.0], false),
        ] {
            let row = [map, distance, unseen, 2.0, again];
            assert_eq!(unconfirmed.is(&row), expected, "{row:?}");
        }
        let blind_to_time = Unconfirmed::among(names[..4].iter().copied());
        assert!(!blind_to_time.is(&[3.0, ABSENT, 1.0, 2.0]));
    }

    #[test]
    fn the_silence_of_a_lidar_that_does_not_see_as_far_says_nothing() {
        let names = ["map_distance", "lidar_distance", "lidar_unseen", "lidar_reach", "lidar_chi"];
        let unconfirmed = Unconfirmed::among(names.into_iter());
        for (unseen, reach, expected) in
            [(0.5, 1.0, true), (0.5, 1.1, false), (1.0, 1.0, true), (1.0, 1.1, false), (1.0, ABSENT, false)]
        {
            assert_eq!(
                unconfirmed.is(&[ABSENT, ABSENT, unseen, reach, ABSENT]),
                expected,
                "{unseen} {reach}"
            );
        }
    }

    #[test]
    fn what_lies_behind_walls_is_unconfirmed_unless_a_point_is_near() {
        let names = [
            ["map_distance", "lidar_chi", "lidar_unseen", "lidar_moving_near", "lidar_reach"],
            [
                "lidar_occluded",
                "lidar_window_chi_least",
                "sight_wall_top",
                "sight_wall_length",
                "lidar_distance",
            ],
        ];
        let unconfirmed = Unconfirmed::among(names.as_flattened().iter().copied());
        for ([chi, unseen, moving, hidden, chi_of_all, top, length], expected) in [
            ([9.0, 0.0, 0.0, 1.0, 3.0, 2.6, 4.0], true),
            ([9.0, 0.25, ABSENT, 0.75, ABSENT, 5.9, 6.25], true),
            ([2.9, 0.0, 0.0, 1.0, 3.0, 2.6, 4.0], false),
            ([9.0, 0.0, 0.1, 1.0, 3.0, 2.6, 4.0], false),
            ([9.0, 0.0, 0.0, 0.9, 3.0, 2.6, 4.0], false),
            ([9.0, 0.0, 0.0, 1.0, 2.9, 2.6, 4.0], false),
            ([9.0, 0.0, 0.0, 1.0, 3.0, 2.4, 4.0], false),
            ([9.0, 0.0, 0.0, 1.0, 3.0, 2.6, 3.9], false),
            ([9.0, 0.0, 0.0, 1.0, 3.0, ABSENT, ABSENT], false),
        ] {
            let row = [0.6, chi, unseen, moving, 0.3, hidden, chi_of_all, top, length, 0.5];
            assert_eq!(unconfirmed.is(&row), expected, "{row:?}");
        }
    }

    #[test]
    fn a_model_that_reads_less_goes_by_what_it_reads() {
        let unconfirmed = Unconfirmed::among(["map_distance", "lidar_unseen", "lidar_chi"].into_iter());
        for (chi, expected) in [(2.9, false), (3.0, true), (ABSENT, true)] {
            assert_eq!(unconfirmed.is(&[ABSENT, 0.5, chi]), expected, "{chi}");
        }
        assert!(!Unconfirmed::among(["map_distance"].into_iter()).is(&[ABSENT]), "nothing of it");
    }
}
