//! What nobody but the radar tells of: beyond the reach of the LiDAR's map, with no LiDAR point near; and where no ray
//! goes and nothing of the map is near, either.
//!
//! In simulated worlds most of the strong, standing detections out there are real, so that a model believes the radar.
//! On a real motorway nobody can check it. As the paper does, what no other sensor confirms counts less: the setting
//! `learned.unconfirmed` says by how much.

/// A LiDAR point so near confirms, sigmas.
const NEAR: f32 = 3.0;
/// Nothing of the map is near, m: farther points are not told apart.
const NOTHING_NEAR: f32 = 3.0;

/// Where to look in a row of evidence.
#[derive(Debug, Clone, Copy)]
pub struct Unconfirmed {
    unseen: Option<usize>,
    chi: Option<usize>,
    map: Option<usize>,
}

impl Unconfirmed {
    /// For rows of features of these names.
    pub fn among<'a>(names: impl Iterator<Item = &'a str> + Clone) -> Self {
        let place = |wanted: &str| names.clone().position(|name| name == wanted);
        Self { unseen: place("lidar_unseen"), chi: place("lidar_chi"), map: place("map_distance") }
    }

    /// Whether there is a LiDAR, and the detection lies either beyond its map and no point of the nearest scan within 3
    /// sigmas, or where no ray of any scan around goes and no point of the map is within 3 m.
    pub fn is(&self, row: &[f32]) -> bool {
        let value = |place: Option<usize>| place.map_or(f32::NAN, |place| row[place]);
        let (unseen, chi, map) = (value(self.unseen), value(self.chi), value(self.map));
        let is_looked_for = !unseen.is_nan();
        // What is absent is no point near.
        let near = chi < NEAR;
        let beyond = map.is_nan() && !near;
        let unseen = map >= NOTHING_NEAR && unseen >= 1.0;
        is_looked_for && self.chi.is_some() && self.map.is_some() && (beyond || unseen)
    }

    /// The probability of a row; of one that is unconfirmed, with its odds multiplied by the factor.
    pub fn weighed(&self, row: &[f32], probability: f64, factor: f64) -> f64 {
        if self.is(row) { with_odds(probability, factor) } else { probability }
    }
}

/// A probability whose odds are multiplied.
fn with_odds(probability: f64, factor: f64) -> f64 {
    let scaled = probability * factor;
    scaled / (1.0 - probability + scaled).max(f64::MIN_POSITIVE)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_lidars_look_for_and_do_not_find_beyond_their_map_is_unconfirmed() {
        let names = ["map_distance", "lidar_chi", "lidar_unseen"];
        let unconfirmed = Unconfirmed::among(names.into_iter());
        let absent = f32::NAN;
        for (row, expected) in [
            ([absent, 9.0, 0.5], true),
            ([absent, absent, 1.0], true),
            ([absent, 1.0, 0.5], false),
            ([3.0, 9.0, 0.5], false),
            ([3.0, absent, 1.0], true),
            ([3.0, absent, 0.9], false),
            ([2.9, absent, 1.0], false),
            ([absent, absent, absent], false),
        ] {
            assert_eq!(unconfirmed.is(&row), expected, "{row:?}");
        }
        assert!(
            !Unconfirmed::among(["map_distance"].into_iter()).is(&[absent]),
            "a model that reads none of it"
        );
    }

    #[test]
    fn odds_are_multiplied() {
        assert!((with_odds(0.75, 0.1) - 0.3 / 1.3).abs() < 1e-12, "3 to 1 becomes 3 to 10");
        assert_eq!([0.0, 1.0].map(|p| with_odds(p, 0.1)), [0.0, 1.0]);
        assert_eq!(with_odds(0.25, 1.0), 0.25);
    }
}
