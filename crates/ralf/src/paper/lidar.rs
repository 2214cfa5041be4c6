//! LiDAR matching: is there a surface where the radar saw something? (paper, algorithm 1; docs/method.md, section 4)

use crate::config::LidarConfig;
use crate::label::UNLABELED;
use crate::scene::{Frame, LidarCloud, LidarSnapshot};
use crate::space::Neighbor;

/// What the LiDAR says of one detection.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LidarMatch {
    /// Mean mismatch with the `K` nearest points.
    pub d: f64,
    /// The class that most of these carry, where they carry any (docs/method.md, section 11).
    pub semantic: Option<u16>,
}

/// The mismatch of each detection with its `K` nearest LiDAR points above the ground. `None` for all where the branch
/// is off or there is no such point, and for detections without a position.
pub fn match_detections(frame: &Frame, config: &LidarConfig) -> Vec<Option<LidarMatch>> {
    let mut matches = vec![None; frame.scan.len()];
    let Some(view) = frame.lidar.as_ref().filter(|_| config.enabled) else { return matches };
    let cloud = LidarCloud::new(view, frame.radar);
    let mut association = cloud.association(config.neighbours);
    for (found, detection) in matches.iter_mut().zip(&frame.scan.detections) {
        let Some(detection) = detection else { continue };
        if let Some(d) = cloud.mean_mismatch(&mut association, detection) {
            *found = Some(LidarMatch { d, semantic: majority(&view.moment, association.found()) });
        }
    }
    matches
}

/// The class of most neighbours; of equally frequent ones the one that comes nearer. Unlabeled points don't vote.
fn majority(moment: &LidarSnapshot, found: &[Neighbor]) -> Option<u16> {
    let mut votes: Vec<(u16, usize)> = Vec::new();
    for neighbor in found {
        let class = moment.class(neighbor.id);
        if class == UNLABELED {
            continue;
        }
        match votes.iter_mut().find(|(voted, _)| *voted == class) {
            Some((_, count)) => *count += 1,
            None => votes.push((class, 1)),
        }
    }
    votes.iter().rev().max_by_key(|(_, count)| *count).map(|(class, _)| *class)
}
