//! LiDAR matching: is there a surface where the radar saw something? (paper, algorithm 1; docs/method.md, section 4)

use crate::config::LidarConfig;
use crate::label::UNLABELED;
use crate::scene::{Association, Frame, LidarCloud, LidarSnapshot, LidarView};
use crate::space::Neighbor;

/// What the LiDAR says of one detection.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LidarMatch {
    /// Mean mismatch with the `K` nearest points, at most `lidar.max_mismatch`.
    pub d: f64,
    /// The class that most of these carry, where they carry any (docs/method.md, section 11).
    pub semantic: Option<u16>,
}

/// The mismatch of each detection with its `K` nearest LiDAR points above the ground. `None` for all where the branch
/// is off or there is no such point, and for detections without a position.
///
/// With `lidar.dynamic`, which the paper doesn't have, a detection is also compared with each point where its Doppler
/// velocity takes it at the time of the point; the smaller mismatch counts.
pub fn match_detections(frame: &Frame, config: &LidarConfig) -> Vec<Option<LidarMatch>> {
    let mut matches = vec![None; frame.scan.len()];
    let Some(view) = frame.lidar.as_ref().filter(|_| config.enabled) else { return matches };
    let Some(cloud) = frame.lidar_cloud() else { return matches };
    if cloud.is_empty() {
        return matches;
    }
    let mut association = cloud.association(config.neighbours);
    for (found, detection) in matches.iter_mut().zip(&frame.scan.detections) {
        let Some(detection) = detection else { continue };
        // A point beyond the cap says nothing but its class.
        if !view.moment.has_classes() {
            association.set_reach(cloud.reach(detection, config.max_mismatch));
        }
        let d = cloud.mean_mismatch(&mut association, detection);
        let d = d.map_or(config.max_mismatch, |d| d.min(config.max_mismatch));
        *found = Some(LidarMatch { d, semantic: majority(&view.moment, association.found()) });
    }
    if config.dynamic {
        association.set_reach(f64::INFINITY);
        match_movers(frame, view, &cloud, &mut association, &mut matches);
    }
    matches
}

/// Compares the detections that move with each point at the point's own time, and keeps the smaller mismatch. A
/// detection that moves less in that time than its own range is uncertain by stays as it is.
fn match_movers(
    frame: &Frame,
    view: &LidarView,
    cloud: &LidarCloud,
    association: &mut Association,
    matches: &mut [Option<LidarMatch>],
) {
    let t_ns = frame.scan.t_ns();
    for (found, mover) in matches.iter_mut().zip(frame.movers()) {
        let (Some(found), Some(mover)) = (found, mover) else { continue };
        if cloud.farthest_move(&mover, t_ns) <= frame.radar.sigma_range {
            continue;
        }
        let d = cloud.mean_mismatch_of_mover(association, &mover, t_ns);
        if let Some(d) = d.filter(|d| *d < found.d) {
            *found = LidarMatch { d, semantic: majority(&view.moment, association.found()) };
        }
    }
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
