//! LiDAR matching: the mismatch of each detection with its nearest LiDAR points (paper, algorithm 1; docs/method.md,
//! section 4).

use crate::label::UNLABELED;
use crate::scene::{Association, Detections, LidarMoment, LidarView, Located};
use crate::sensors::{Elevation, Radar};
use crate::space::{Neighbor, Transform};

/// What the LiDAR says of one detection.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LidarMatch {
    /// Mean mismatch with the `K` nearest points.
    pub d: f64,
    /// The class that most of these carry, where they carry any (docs/method.md, section 11).
    pub semantic: Option<u16>,
}

/// The mismatch of each detection with its `neighbours` nearest points of the moment's reference cloud; `None` for all
/// where that cloud is empty, and for detections without a place.
pub fn match_detections(
    radar: &Radar,
    detections: &Detections,
    LidarView { moment, vehicle_from_moment }: &LidarView,
    neighbours: usize,
) -> Vec<Option<LidarMatch>> {
    let horizontal_index;
    // Distances in space are the same in every frame, so the shared index is asked in its own. Horizontal ones are not.
    let (index, index_from_vehicle) = match radar.elevation {
        Elevation::Measured => (moment.index(), vehicle_from_moment.inverse()),
        Elevation::None => {
            horizontal_index = moment.horizontal_index(radar, vehicle_from_moment);
            (&horizontal_index, Transform::identity())
        }
    };
    let mut association = Association::new(index, radar.elevation, neighbours);
    let mut answer = |detection: &Located| {
        let place = index_from_vehicle * detection.position;
        let d =
            association.mean_mismatch(detection, &place, |id| moment.reference(id, vehicle_from_moment))?;
        Some(LidarMatch { d, semantic: majority(moment, association.found()) })
    };
    detections.located.iter().map(|detection| answer(detection.as_ref()?)).collect()
}

/// The class of most neighbours; of equally frequent ones the one that comes nearer. Unlabeled points don't vote.
fn majority(moment: &LidarMoment, found: &[Neighbor]) -> Option<u16> {
    let classes = found.iter().map(|neighbor| moment.class(neighbor.id));
    let mut votes: Vec<(u16, usize)> = Vec::new();
    for class in classes.filter(|class| *class != UNLABELED) {
        match votes.iter_mut().find(|(voted, _)| *voted == class) {
            Some((_, count)) => *count += 1,
            None => votes.push((class, 1)),
        }
    }
    votes.iter().rev().max_by_key(|(_, count)| *count).map(|(class, _)| *class)
}
