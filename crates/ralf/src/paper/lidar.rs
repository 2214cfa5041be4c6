//! LiDAR matching: is there a surface where the radar saw something? (paper, algorithm 1; docs/method.md, section 4)

use crate::config::LidarConfig;
use crate::label::UNLABELED;
use crate::scene::{Detection, Frame, LidarCloud, LidarSearch, Mover};

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
/// Two settings are ours. With `lidar.scans` above 1 the points are those of several scans. What moves by its Doppler
/// velocity was elsewhere in all but the nearest of them, and is compared with that one alone. With `lidar.dynamic` it
/// is also compared with each point of all of them at the place where its velocity takes it by the time of that point,
/// and the smaller mismatch counts. What moves by less than `sigma_r` between the radar scan and these points counts as
/// standing.
pub fn match_detections(frame: &Frame, config: &LidarConfig) -> Vec<Option<LidarMatch>> {
    let mut matches = vec![None; frame.scan.len()];
    let clouds = if config.enabled { frame.lidar_clouds() } else { Vec::new() };
    if clouds.iter().all(LidarCloud::is_empty) {
        return matches;
    }
    let (t_ns, sigma_range) = (frame.scan.t_ns(), frame.radar.sigma_range);
    let mut search = LidarSearch::new(&clouds, config.neighbours);
    let movers = if config.dynamic || clouds.len() > 1 { frame.movers() } else { Vec::new() };
    for (i, detection) in frame.scan.detections.iter().enumerate() {
        let Some(detection) = detection else { continue };
        let mover = movers.get(i).and_then(Option::as_ref);
        let mover = mover.filter(|mover| search.farthest_move(mover, t_ns) > sigma_range);
        let scans = if mover.is_some() { 1 } else { clouds.len() };
        let standing = as_standing(&mut search, detection, scans, config.max_mismatch);
        let moving = mover.filter(|_| config.dynamic).and_then(|mover| as_moving(&mut search, mover, t_ns));
        matches[i] = Some(moving.filter(|moving| moving.d < standing.d).unwrap_or(standing));
    }
    matches
}

/// Algorithm 1 for one detection: the mean of the mismatches with its `K` nearest points of the first so many clouds.
fn as_standing(
    search: &mut LidarSearch,
    detection: &Detection,
    clouds: usize,
    max_mismatch: f64,
) -> LidarMatch {
    let d = search.mean_mismatch(detection, clouds, max_mismatch);
    let d = d.map_or(max_mismatch, |d| d.min(max_mismatch));
    LidarMatch { d, semantic: majority(search.classes()) }
}

/// The same with the detection taken along to the time of each point.
fn as_moving(search: &mut LidarSearch, mover: &Mover, t_ns: i64) -> Option<LidarMatch> {
    let d = search.mean_mismatch_of_mover(mover, t_ns)?;
    Some(LidarMatch { d, semantic: majority(search.classes()) })
}

/// The class of most neighbours; of equally frequent ones the one that comes nearer. Unlabeled points don't vote.
fn majority(classes: impl Iterator<Item = u16>) -> Option<u16> {
    let mut votes: Vec<(u16, usize)> = Vec::new();
    for class in classes.filter(|class| *class != UNLABELED) {
        match votes.iter_mut().find(|(voted, _)| *voted == class) {
            Some((_, count)) => *count += 1,
            None => votes.push((class, 1)),
        }
    }
    votes.iter().rev().max_by_key(|(_, count)| *count).map(|(class, _)| *class)
}
